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

/// A place on a route.
Vector2d draw_place(std::span<const Route> routes, Random& random) {
  const Route& route = routes[random.below(routes.size())];
  const std::size_t i = random.below(route.points.size());
  const Vector2d& a = route.points[i];
  const Vector2d& b = route.points[(i + 1) % route.points.size()];
  return i + 1 < route.points.size() || route.closed ? a + random.uniform() * (b - a) : a;
}

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
    : options_(options), walls_(world.walls), laser_(simulated_lms200()) {
  Random random(options.seed);
  const std::vector<double> materials = draw_materials(world.walls.size(), options_.laser_noise, random.split());
  for (int i = 0; i < options_.robots; ++i) {
    const auto index = static_cast<std::size_t>(i);
    const Route& route = world.routes[index % world.routes.size()];
    const bool backward = options_.alternate && i % 2 == 1;
    Random own = random.split();
    LaserBias bias = draw_laser_bias(options_.laser_noise, materials, own);
    const Odometer odometer(options_.odometry_noise, own);
    robots_.push_back({RouteDriver(route, static_cast<double>(i) / options_.robots, backward, options_.limits), own,
                       std::move(bias), odometer});
  }
  const auto beside_a_route = [routes = world.routes](Random& r) { return draw_place(routes, r); };
  people_.emplace(walls_, options_.people, beside_a_route, random);
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
  people_->walk(walls_, kTick);
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

/// Everything round but the robot itself.
std::vector<Disc> Simulator::discs_around(std::size_t index) const {
  std::vector<Disc> discs;
  const Vector2d here = robots_[index].driver.T_world_robot().translation();
  for (std::size_t person = 0; person < people_->count(); ++person) {
    // People step aside.
    const Vector2d& at = people_->place(person);
    if ((at - here).norm() > kPersonRadius + kRobotRadius) discs.push_back({at, kPersonRadius});
  }
  for (std::size_t j = 0; j < robots_.size(); ++j) {
    if (j != index) discs.push_back({robots_[j].driver.T_world_robot().translation(), kRobotRadius});
  }
  return discs;
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
  robot.twist = truth.vector() / kTick;
  robot.odometer.count(truth, robot.random);
  const double stamp = kFirstStamp + kTick * static_cast<double>(ticks_);
  events_.push({{make_id<RobotId>(index), stamp, Odometry{robot.odometer.T_odom_robot()}},
                robot.driver.T_world_robot(),
                robot.driver.laps()});
}

void Simulator::scan(std::size_t index) {
  Robot& robot = robots_[index];
  Scan scan;
  scan.ranges = simulate_ranges(walls_, discs_around(index), laser_, robot.driver.T_world_robot(), robot.twist,
                                options_.laser_noise, robot.laser_bias, robot.random);
  scan.T_odom_robot = robot.odometer.T_odom_robot();
  // A millisecond after the odometry, and robot by robot: stamps name one scan each.
  const double stamp = kFirstStamp + kTick * static_cast<double>(ticks_) + 1e-3 * static_cast<double>(index + 1);
  events_.push({{make_id<RobotId>(index), stamp, std::move(scan)}, robot.driver.T_world_robot(), robot.driver.laps()});
}

void Simulator::sight(std::size_t index) {
  Robot& robot = robots_[index];
  const Pose2& T_world_robot = robot.driver.T_world_robot();
  const double now = kTick * static_cast<double>(ticks_);
  const std::vector<Disc> discs = discs_around(index);
  for (std::size_t j = 0; j < robots_.size(); ++j) {
    double& last = last_sighting_[index * robots_.size() + j];
    if (j == index || now - last < options_.sighting_period) continue;
    std::optional<Sighting> sighting =
        simulate_sighting(walls_, discs, T_world_robot, robots_[j].driver.T_world_robot(), simulated_robot_name(j),
                          {options_.sighting_range, options_.sighting_view}, options_.sighting_noise, robot.random);
    if (!sighting) continue;
    last = now;
    const double stamp = kFirstStamp + now + 1e-3 * static_cast<double>(index + 1) + 5e-4;
    events_.push({{make_id<RobotId>(index), stamp, std::move(*sighting)}, T_world_robot, robot.driver.laps()});
  }
}

}  // namespace helicoid
