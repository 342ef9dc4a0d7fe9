// Robots on given routes through a world: events in time order, with the truth beside them. Streaming, seeded.
#pragma once

#include <limits>
#include <optional>
#include <queue>
#include <string>
#include <vector>

#include "helicoid/simulation/drive.hpp"
#include "helicoid/simulation/laser_simulator.hpp"
#include "helicoid/simulation/odometer.hpp"
#include "helicoid/simulation/pedestrians.hpp"
#include "helicoid/simulation/sighting_simulator.hpp"

namespace helicoid {

struct SimulationOptions {
  int robots = 1;
  std::uint64_t seed = 1;
  int laps = 1;
  bool alternate = false;    ///< every second robot drives a closed route backward
  double scan_period = 0.2;  ///< seconds
  LaserNoise laser_noise;
  OdometryNoise odometry_noise;
  int people = 0;  ///< that walk about between random places beside the routes
  DriveLimits limits;
  bool sightings = false;                   ///< robots report one another by their fiducials
  double sighting_range = 8;                ///< metres
  double sighting_view = std::numbers::pi;  ///< the camera's whole field of view, ahead; radians
  double sighting_period = 1;               ///< at most one of a pair in this time, seconds
  SightingNoise sighting_noise;
};

struct SimulatedEvent {
  Event event;
  Pose2 T_world_robot;  ///< the truth
  int lap = 0;
};

[[nodiscard]] std::string simulated_robot_name(std::size_t robot);

class Simulator {
 public:
  /// Errors: a world without a route.
  [[nodiscard]] static Result<Simulator> make(const World& world, const SimulationOptions& options);

  /// The next event; empty when every robot has driven its laps.
  [[nodiscard]] std::optional<SimulatedEvent> next();
  [[nodiscard]] const LaserModel& laser() const { return laser_; }
  /// The share of all laps that is driven, 0..1.
  [[nodiscard]] double progress() const;
  /// The smallest distance between two robots' centres so far, metres; infinity for one robot. Robots keep to the right
  /// where there is room, but in a door they drive through one another.
  [[nodiscard]] double closest_approach() const { return closest_approach_; }

 private:
  struct Robot;
  Simulator(const World& world, const SimulationOptions& options);
  void tick();
  [[nodiscard]] std::vector<Disc> discs_around(std::size_t index) const;
  [[nodiscard]] double way_aside(std::size_t index);
  void move_robot(std::size_t index);
  void scan(std::size_t index);
  void sight(std::size_t index);

  SimulationOptions options_;
  RayCaster walls_;
  LaserModel laser_;
  std::vector<Robot> robots_;
  std::optional<Pedestrians> people_;
  std::vector<double> last_sighting_;  ///< by pair
  std::queue<SimulatedEvent> events_;
  double closest_approach_ = std::numeric_limits<double>::infinity();
  long ticks_ = 0;
};

struct Simulator::Robot {
  RouteDriver driver;
  Random random;
  LaserBias laser_bias;
  Odometer odometer;
  Vector3d twist = Vector3d::Zero();  ///< of the robot in its own frame, metres and radians a second
  int patience = 0;  ///< ticks that another has been near; below 0: that it will not get out of the way
  bool done = false;
};

}  // namespace helicoid
