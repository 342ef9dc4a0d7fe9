#include "helicoid/simulation/simulator.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kTick = 0.05;         // seconds
constexpr double kFirstStamp = 1000;   // seconds
constexpr double kRobotRadius = 0.22;  // of what others' lasers see, metres
constexpr double kMeeting = 2.5;       // robots nearer than this get out of one another's way, metres
constexpr int kPatience = 160;         // ticks
constexpr double kClearance = 0.32;    // that they keep from walls meanwhile, metres
constexpr double kPersonRadius = 0.18;
constexpr double kPersonSpeed = 0.9;      // metres / second
constexpr double kFarthestWalk = 8;       // metres
constexpr double kNearestSighting = 0.3;  // nearer, the fiducial does not fit into the picture; metres

}  // namespace

std::string simulated_robot_name(std::size_t robot) {
  return fmt::format("robot{}", robot + 1);
}

Result<Simulator> Simulator::make(const World& world, const SimulationOptions& options) {
  if (world.routes.empty()) {
    return fail("{}: has no route to drive; add a polyline or polygon of class \"route\"", world.name);
  }
  if (options.robots < 1) return fail("a simulation needs at least one robot");
  return Simulator(world, options);
}

Simulator::Simulator(const World& world, const SimulationOptions& options)
    : options_(options), walls_(world.walls), routes_(world.routes), laser_(simulated_lms200()), random_(options.seed) {
  std::vector<double> materials(world.walls.size());
  Random of_materials = random_.split();
  for (double& bias : materials) bias = options_.laser_noise.material_sigma * of_materials.normal();
  for (int i = 0; i < options_.robots; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Route& route = world.routes[index % world.routes.size()];
    const bool backward = options_.alternate && i % 2 == 1;
    Robot robot{RouteDriver(route, static_cast<double>(i) / options_.robots, backward, options_.limits),
                random_.split(),
                {},
                Vector3d::Zero(),
                1,
                1,
                0,
                {},
                false};
    robot.laser_bias = {options_.laser_noise.range_bias_sigma * robot.random.normal(),
                        options_.laser_noise.bearing_scale_sigma * robot.random.normal(), materials};
    robot.distance_scale = 1 + options_.odometry_noise.distance_scale_sigma * robot.random.normal();
    robot.turn_scale = 1 + options_.odometry_noise.turn_scale_sigma * robot.random.normal();
    robot.drift = options_.odometry_noise.drift_bias_sigma * robot.random.normal();
    robots_.push_back(std::move(robot));
  }
  for (int i = 0; i < options_.people; ++i) {
    const Vector2d at = open_place();
    people_.push_back({at, open_place()});
  }
  last_sighting_.assign(robots_.size() * robots_.size(), -1e9);
}

std::optional<SimulatedEvent> Simulator::next() {
  while (events_.empty()) {
    if (std::all_of(robots_.begin(), robots_.end(), [](const Robot& r) { return r.done; })) return std::nullopt;
    tick();
  }
  SimulatedEvent event = std::move(events_.front());
  events_.pop();
  return event;
}

double Simulator::progress() const {
  double laps = 0;
  for (const Robot& robot : robots_) laps += std::min(robot.driver.laps_driven(), static_cast<double>(options_.laps));
  return laps / (static_cast<double>(robots_.size()) * options_.laps);
}

void Simulator::tick() {
  if (!people_.empty()) move_people();
  const long scan_ticks = std::max(1L, std::lround(options_.scan_period / kTick));
  for (std::size_t i = 0; i < robots_.size(); ++i) {
    if (robots_[i].done) continue;
    if (ticks_ > 0) move_robot(i);
    for (std::size_t j = 0; j < i; ++j) {
      const Pose2& other = robots_[j].driver.T_world_robot();
      const Vector2d gap = robots_[i].driver.T_world_robot().translation() - other.translation();
      closest_approach_ = std::min(closest_approach_, gap.norm());
    }
    if (robots_[i].driver.laps() >= options_.laps) {
      robots_[i].done = true;
      continue;
    }
    if (ticks_ % scan_ticks == 0) scan(i);
    if (options_.sightings && ticks_ % scan_ticks == 0) sight(i);
  }
  ++ticks_;
}

/// A place that can be seen from a place on a route: inside the building, outside of furniture.
Vector2d Simulator::open_place() {
  const Route& route = routes_[random_.below(routes_.size())];
  const std::size_t i = random_.below(route.points.size());
  const Vector2d& a = route.points[i];
  const Vector2d& b = route.points[(i + 1) % route.points.size()];
  const Vector2d from = i + 1 < route.points.size() || route.closed ? a + random_.uniform() * (b - a) : a;
  const double angle = random_.uniform(-std::numbers::pi, std::numbers::pi);
  const Vector2d direction(std::cos(angle), std::sin(angle));
  const double reach = std::min(walls_.cast(from, direction, kFarthestWalk).distance, kFarthestWalk);
  return from + random_.uniform() * std::max(0.0, reach - 2 * kPersonRadius) * direction;
}

/// Everything round but the robot itself.
std::vector<Disc> Simulator::discs_around(std::size_t index) const {
  std::vector<Disc> discs;
  const Vector2d here = robots_[index].driver.T_world_robot().translation();
  for (const Person& person : people_) {
    // People step aside.
    if ((person.at - here).norm() > kPersonRadius + kRobotRadius) discs.push_back({person.at, kPersonRadius});
  }
  for (std::size_t j = 0; j < robots_.size(); ++j) {
    if (j != index) discs.push_back({robots_[j].driver.T_world_robot().translation(), kRobotRadius});
  }
  return discs;
}

bool Simulator::hidden(const Vector2d& from, const Vector2d& to, std::span<const Disc> discs) const {
  const double range = (to - from).norm();
  const Vector2d direction = (to - from) / range;
  if (walls_.cast(from, direction, range).segment >= 0) return true;
  return std::any_of(discs.begin(), discs.end(), [&](const Disc& d) {
    const double along = (d.centre - from).dot(direction);
    const bool is_target = (d.centre - to).norm() < 1e-9;
    return !is_target && along > 0 && along < range && (d.centre - from - along * direction).norm() < d.radius;
  });
}

void Simulator::move_people() {
  // People go straight through open space and choose anew at a wall or at their goal.
  for (Person& person : people_) {
    const Vector2d way = person.target - person.at;
    const double step = kPersonSpeed * kTick;
    const bool arrived = way.norm() < step;
    const bool blocked = !arrived && walls_.cast(person.at, way.normalized(), step + kPersonRadius).segment >= 0;
    if (arrived || blocked) {
      person.target = open_place();
    } else {
      person.at += step * way.normalized();
    }
  }
}

/// How far to the right of its route a robot drives: aside, if another comes towards it and there is room.
double Simulator::way_aside(std::size_t index) {
  const RouteDriver& driver = robots_[index].driver;
  const Vector2d here = driver.T_world_robot().translation();
  bool near = false;
  bool met = false;
  for (const Robot& other : robots_) {
    const Vector2d p_robot_other = driver.T_world_robot().inverse() * other.driver.T_world_robot().translation();
    if (&other == &robots_[index] || p_robot_other.norm() > kMeeting) continue;
    near = true;
    met = met || p_robot_other.x() > -kRobotRadius;
  }
  // Whoever has had another beside it for long drives on, or two robots might yield to one another for ever.
  int& patience = robots_[index].patience;
  patience = patience < 0 ? patience + 1 : near ? patience + 1 : 0;
  if (patience > kPatience) patience = -kPatience;
  if (patience < 0 || !met) return 0;
  for (const double aside : {0.6, 0.45, 0.3, 0.15}) {
    const Vector2d way = driver.target(aside) - here;
    const bool clear = walls_.clearance(driver.target(aside), 1) > kClearance;
    if (clear && walls_.cast(here, way.normalized(), way.norm() + kClearance).segment < 0) return aside;
  }
  return 0;
}

void Simulator::move_robot(std::size_t index) {
  Robot& robot = robots_[index];
  const Pose2 before = robot.driver.T_world_robot();
  robot.driver.step(kTick, way_aside(index));
  const Pose2 truth = before.inverse() * robot.driver.T_world_robot();
  const OdometryNoise& noise = options_.odometry_noise;
  robot.twist = truth.vector() / kTick;
  const double distance = truth.distance();
  const double turn = std::abs(truth.yaw);
  Pose2 measured;
  measured.x = robot.distance_scale * truth.x + noise.distance_sigma * std::sqrt(distance) * robot.random.normal();
  measured.y = truth.y;
  measured.yaw = robot.turn_scale * truth.yaw + robot.drift * distance +
                 noise.turn_sigma * std::sqrt(turn) * robot.random.normal() +
                 noise.drift_sigma * std::sqrt(distance) * robot.random.normal();
  if (noise.slip_per_metre > 0 && robot.random.chance(noise.slip_per_metre * distance)) {
    measured.yaw += noise.slip_turn * robot.random.normal();
  }
  if (distance == 0 && turn == 0) measured = {};
  robot.T_odom_robot = robot.T_odom_robot * measured;
  const double stamp = kFirstStamp + kTick * static_cast<double>(ticks_);
  events_.push({{make_id<RobotId>(index), stamp, Odometry{robot.T_odom_robot}},
                robot.driver.T_world_robot(),
                robot.driver.laps()});
}

void Simulator::scan(std::size_t index) {
  Robot& robot = robots_[index];
  Scan scan;
  const LaserNoise& noise = options_.laser_noise;
  Pose2 T_world_laser = robot.driver.T_world_robot();
  if (noise.timing_sigma > 0) {
    T_world_laser = T_world_laser * exponential(noise.timing_sigma * robot.random.normal() * robot.twist);
  }
  scan.ranges = simulate_ranges(walls_, discs_around(index), laser_, T_world_laser, robot.twist, noise,
                                robot.laser_bias, robot.random);
  scan.T_odom_robot = robot.T_odom_robot;
  // A millisecond after the odometry, and robot by robot: stamps name one scan each.
  const double stamp = kFirstStamp + kTick * static_cast<double>(ticks_) + 1e-3 * static_cast<double>(index + 1);
  events_.push({{make_id<RobotId>(index), stamp, std::move(scan)}, robot.driver.T_world_robot(), robot.driver.laps()});
}

void Simulator::sight(std::size_t index) {
  Robot& robot = robots_[index];
  const Pose2& T_world_robot = robot.driver.T_world_robot();
  const double now = kTick * static_cast<double>(ticks_);
  const std::vector<Disc> discs = discs_around(index);
  const SightingNoise& noise = options_.sighting_noise;
  for (std::size_t j = 0; j < robots_.size(); ++j) {
    double& last = last_sighting_[index * robots_.size() + j];
    if (j == index || now - last < options_.sighting_period) continue;
    const Pose2& T_world_other = robots_[j].driver.T_world_robot();
    const Pose2 T_robot_other = T_world_robot.inverse() * T_world_other;
    const double range = T_robot_other.distance();
    const double bearing = std::atan2(T_robot_other.y, T_robot_other.x);
    if (range > options_.sighting_range || range < kNearestSighting) continue;
    if (std::abs(bearing) > 0.5 * options_.sighting_view) continue;
    if (hidden(T_world_robot.translation(), T_world_other.translation(), discs)) continue;
    last = now;
    Sighting s{simulated_robot_name(j),
               range + noise.range_sigma * robot.random.normal(),
               wrap_angle(bearing + noise.bearing_sigma * robot.random.normal()),
               wrap_angle(T_robot_other.yaw + noise.orientation_sigma * robot.random.normal()),
               noise.range_sigma,
               noise.bearing_sigma,
               noise.orientation_sigma};
    const double stamp = kFirstStamp + now + 1e-3 * static_cast<double>(index + 1) + 5e-4;
    events_.push({{make_id<RobotId>(index), stamp, std::move(s)}, T_world_robot, robot.driver.laps()});
  }
}

}  // namespace helicoid
