#include "helicoid/simulation/live_simulation.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/simulation/reachable_floor.hpp"
#include "helicoid/simulation/simulator.hpp"

namespace helicoid {

namespace {

constexpr double kLongestStep = 0.03;  // of a robot between two looks at what it might touch, metres
constexpr double kContactEnds = 0.02;  // a gap from which on a contact is over, metres
constexpr double kRoomToJoin = 0.10;   // round a robot that appears, metres
constexpr int kHalvings = 12;          // of a step that ends at a contact
constexpr double kSpacing = 1e-3;      // between the stamps of two robots, seconds
constexpr double kMicrosecond = 1e-6;

double towards(double now, double wanted, double most) {
  return now + std::clamp(wanted - now, -most, most);
}

double finite_or_zero(double value) {
  return std::isfinite(value) ? value : 0;
}

}  // namespace

Result<LiveSimulation> LiveSimulation::make(const World& world, std::vector<LiveRobot> robots,
                                            const LiveOptions& options) {
  if (robots.empty()) return fail("a simulation needs at least one robot");
  if (!(options.period > 0) || !(options.radius > 0)) return fail("a simulation's period and radius must be above 0");
  if (!(options.metres_per_charge > 0)) return fail("a battery must drive some way: metres_per_charge is above 0");
  const RayCaster walls(world.walls);
  for (std::size_t i = 0; i < robots.size(); ++i) {
    const Vector2d at = robots[i].T_world_start.translation();
    if (!at.allFinite() || !std::isfinite(robots[i].T_world_start.yaw)) return fail("start {}: is no pose", i + 1);
    if (walls.clearance(at, options.radius) < options.radius) {
      return fail("{}: start {} at ({:.2f}, {:.2f}) is nearer to a wall than the robot's radius of {:.2f} m",
                  world.name, i + 1, at.x(), at.y(), options.radius);
    }
    for (std::size_t j = 0; j < i; ++j) {
      const double between = (robots[j].T_world_start.translation() - at).norm();
      if (between >= 2 * options.radius || robots[i].joins_at != robots[j].joins_at) continue;
      return fail("{}: starts {} and {} are {:.2f} m apart: two robots of radius {:.2f} m do not fit", world.name,
                  j + 1, i + 1, between, options.radius);
    }
  }
  std::vector<Vector2d> floor;
  if (options.people > 0) {
    std::vector<Pose2> starts(robots.size());
    std::transform(robots.begin(), robots.end(), starts.begin(), [](const LiveRobot& r) { return r.T_world_start; });
    const Result<ReachableFloor> reachable = find_reachable_floor(world, starts, {options.radius});
    if (!reachable) return tl::unexpected(reachable.error());
    floor = reachable->swept_centres();
  }
  return LiveSimulation(world, std::move(robots), options, std::move(floor));
}

LiveSimulation::LiveSimulation(const World& world, std::vector<LiveRobot> robots, const LiveOptions& options,
                               std::vector<Vector2d> floor)
    : options_(options), plan_(std::move(robots)), walls_(world.walls), laser_(simulated_lms200()) {
  Random random(options.seed);
  const std::vector<double> materials = draw_materials(world.walls.size(), options.laser_noise, random.split());
  std::vector<Disc> starts;
  for (const LiveRobot& robot : plan_) {
    Random own = random.split();
    LaserBias bias = draw_laser_bias(options.laser_noise, materials, own);
    const Odometer odometer(options.odometry_noise, own);
    bodies_.push_back({robot.T_world_start, own, std::move(bias), odometer});
    starts.push_back({robot.T_world_start.translation(), options.radius});
  }
  const auto on_the_floor = [places = std::move(floor)](Random& r) { return places[r.below(places.size())]; };
  people_.emplace(walls_, options.people, on_the_floor, random, starts);
  last_sighting_.assign(bodies_.size() * bodies_.size(), -std::numeric_limits<double>::infinity());
}

void LiveSimulation::command(std::size_t robot, const DriveCommand& command) {
  bodies_[robot].command = {
      std::clamp(finite_or_zero(command.speed), -options_.top_speed, options_.top_speed),
      std::clamp(finite_or_zero(command.turn_rate), -options_.top_turn_rate, options_.top_turn_rate)};
}

std::vector<LiveEvent> LiveSimulation::tick() {
  ++ticks_;
  const double swift = std::max(options_.top_speed * options_.period, 1e-9);
  const int steps = std::max(1, static_cast<int>(std::ceil(swift / kLongestStep)));
  const double dt = options_.period / steps;
  for (int k = 0; k < steps; ++k) {
    walk_people(dt);
    for (std::size_t i = 0; i < bodies_.size(); ++i) {
      if (alive(i)) drive(i, dt);
    }
  }
  join_robots();
  std::vector<LiveEvent> events;
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    if (alive(i)) report(i, events);
  }
  return events;
}

/// Robots whose time has come; while something stands on its start a robot waits.
void LiveSimulation::join_robots() {
  for (std::size_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    if (body.joined || is_dead(i) || plan_[i].joins_at > now()) continue;
    const std::vector<Thing> near = things_within(i, body.T_world_robot.translation(), kRoomToJoin);
    body.joined = std::all_of(near.begin(), near.end(), [](const Thing& t) { return t.kind == Thing::Kind::wall; });
  }
}

void LiveSimulation::walk_people(double dt) {
  std::vector<Disc> robots;
  for (const Body& body : bodies_) {
    if (body.joined) robots.push_back({body.T_world_robot.translation(), options_.radius});
  }
  people_->walk(walls_, dt, robots);
}

void LiveSimulation::drive(std::size_t robot, double dt) {
  Body& body = bodies_[robot];
  body.wheels = {towards(body.wheels.speed, body.command.speed, options_.acceleration * dt),
                 towards(body.wheels.turn_rate, body.command.turn_rate, options_.turn_acceleration * dt)};
  const Vector3d motion = dt * Vector3d(body.wheels.speed, 0, body.wheels.turn_rate);
  body.odometer.count(exponential(motion), body.random);
  body.driven += std::abs(dt * body.wheels.speed);
  const Pose2 before = body.T_world_robot;
  Pose2 after = before * exponential(motion);
  if (!things_within(robot, after.translation(), 0).empty()) {
    // The wheels slip from where the robot touches: it turns with them, but gets no farther.
    double free = 0;
    double blocked = 1;
    for (int k = 0; k < kHalvings; ++k) {
      const double half = 0.5 * (free + blocked);
      const Vector2d at = (before * exponential(half * motion)).translation();
      (things_within(robot, at, 0).empty() ? free : blocked) = half;
    }
    note_contacts(robot, (before * exponential(blocked * motion)).translation());
    const Vector2d stop = free > 0 ? (before * exponential(free * motion)).translation() : before.translation();
    after = {stop.x(), stop.y(), after.yaw};
  }
  body.T_world_robot = after;
  body.twist = (before.inverse() * after).vector() / dt;
  end_contacts(robot);
}

/// How much is left between a robot that stands here and a thing; infinity if it is more than `reach`.
double LiveSimulation::gap(const Vector2d& at, const Thing& thing, double reach) const {
  const auto between = [&](const Vector2d& centre, double radius) {
    return (centre - at).norm() - radius - options_.radius;
  };
  switch (thing.kind) {
    case Thing::Kind::wall: return walls_.clearance(at, options_.radius + reach) - options_.radius;
    case Thing::Kind::robot: return between(bodies_[thing.index].T_world_robot.translation(), options_.radius);
    case Thing::Kind::person: return between(people_->place(thing.index), kPersonRadius);
  }
  return std::numeric_limits<double>::infinity();
}

/// What is nearer than `reach` to a robot that stands here.
std::vector<LiveSimulation::Thing> LiveSimulation::things_within(std::size_t robot, const Vector2d& at,
                                                                 double reach) const {
  std::vector<Thing> things;
  const auto add_if_near = [&](const Thing& thing) {
    if (gap(at, thing, reach) < reach) things.push_back(thing);
  };
  add_if_near({Thing::Kind::wall, 0});
  for (std::size_t j = 0; j < bodies_.size(); ++j) {
    if (j != robot && bodies_[j].joined) add_if_near({Thing::Kind::robot, j});
  }
  for (std::size_t j = 0; j < people_->count(); ++j) add_if_near({Thing::Kind::person, j});
  return things;
}

void LiveSimulation::note_contacts(std::size_t robot, const Vector2d& at) {
  for (const Thing& thing : things_within(robot, at, 0)) {
    // Two robots touch each other once, whichever drives.
    const bool known = thing.kind == Thing::Kind::robot && touching_.contains({thing.index, {thing.kind, robot}});
    if (known || !touching_.emplace(robot, thing).second) continue;
    const std::string with = thing.kind == Thing::Kind::wall    ? "wall"
                             : thing.kind == Thing::Kind::robot ? simulated_robot_name(thing.index)
                                                                : "person";
    contacts_.push_back({kFirstStamp + now(), robot, with, bodies_[robot].T_world_robot.translation()});
  }
}

/// A contact is over when whichever of the two has moved has left a gap.
void LiveSimulation::end_contacts(std::size_t robot) {
  std::erase_if(touching_, [&](const auto& touch) {
    const auto& [one, thing] = touch;
    if (one != robot && thing != Thing{Thing::Kind::robot, robot}) return false;
    return gap(bodies_[one].T_world_robot.translation(), thing, kContactEnds) >= kContactEnds;
  });
}

/// Everything round but the robot itself.
std::vector<Disc> LiveSimulation::discs_around(std::size_t robot) const {
  std::vector<Disc> discs;
  for (std::size_t j = 0; j < people_->count(); ++j) discs.push_back({people_->place(j), kPersonRadius});
  for (std::size_t j = 0; j < bodies_.size(); ++j) {
    if (j != robot && bodies_[j].joined) discs.push_back({bodies_[j].T_world_robot.translation(), options_.radius});
  }
  return discs;
}

void LiveSimulation::report(std::size_t robot, std::vector<LiveEvent>& events) {
  Body& body = bodies_[robot];
  // Robot after robot within the period, to the microsecond: stamps name one scan each.
  const double most = 0.9 * options_.period / static_cast<double>(bodies_.size());
  const double spacing = kMicrosecond * std::floor(std::min(kSpacing, most) / kMicrosecond);
  const double stamp = kFirstStamp + now() + spacing * static_cast<double>(robot);
  const auto id = make_id<RobotId>(robot);
  events.push_back({{id, stamp, Odometry{body.odometer.T_odom_robot()}}, body.T_world_robot});
  Scan scan;
  scan.ranges = simulate_ranges(walls_, discs_around(robot), laser_, body.T_world_robot, body.twist,
                                options_.laser_noise, body.laser_bias, body.random);
  scan.T_odom_robot = body.odometer.T_odom_robot();
  events.push_back({{id, stamp + 0.25 * spacing, std::move(scan)}, body.T_world_robot});
  if (options_.sightings) sight(robot, stamp + 0.5 * spacing, events);
}

void LiveSimulation::sight(std::size_t robot, double stamp, std::vector<LiveEvent>& events) {
  Body& body = bodies_[robot];
  const std::vector<Disc> discs = discs_around(robot);
  for (std::size_t j = 0; j < bodies_.size(); ++j) {
    double& last = last_sighting_[robot * bodies_.size() + j];
    if (j == robot || !bodies_[j].joined || now() - last < options_.sighting_period) continue;
    std::optional<Sighting> sighting =
        simulate_sighting(walls_, discs, body.T_world_robot, bodies_[j].T_world_robot, simulated_robot_name(j),
                          {options_.sighting_range, options_.sighting_view}, options_.sighting_noise, body.random);
    if (!sighting) continue;
    last = now();
    events.push_back({{make_id<RobotId>(robot), stamp, std::move(*sighting)}, body.T_world_robot});
  }
}

}  // namespace helicoid
