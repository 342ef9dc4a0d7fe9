// Robots that are driven while the simulation runs: commands go in, events come out. Seeded; without a clock of its
// own.
#pragma once

#include <cstdint>
#include <limits>
#include <numbers>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <vector>

#include "helicoid/sensor/drive_command.hpp"
#include "helicoid/simulation/laser_simulator.hpp"
#include "helicoid/simulation/odometer.hpp"
#include "helicoid/simulation/pedestrians.hpp"
#include "helicoid/simulation/sighting_simulator.hpp"

namespace helicoid {

struct LiveRobot {
  Pose2 T_world_start;
  double joins_at = 0;                                       ///< seconds; until then it is not in the building
  double dies_at = std::numeric_limits<double>::infinity();  ///< seconds; from then on it stands there, silent
};

struct LiveOptions {
  std::uint64_t seed = 1;
  double period = 0.1;           ///< of a tick, in which each robot scans once; seconds
  double radius = 0.20;          ///< of a robot, metres
  double top_speed = 0.6;        ///< metres / second
  double top_turn_rate = 1.0;    ///< radians / second
  double acceleration = 1.0;     ///< metres / second^2
  double turn_acceleration = 3;  ///< radians / second^2
  /// A full battery drives so far, metres; a robot whose battery is empty stands there, silent.
  double metres_per_charge = std::numeric_limits<double>::infinity();
  LaserNoise laser_noise;
  OdometryNoise odometry_noise;
  int people = 0;                           ///< that walk about on the floor that robots can reach
  bool sightings = true;                    ///< robots report one another by their fiducials
  double sighting_range = 8;                ///< metres
  double sighting_view = std::numbers::pi;  ///< the camera's whole field of view, ahead; radians
  double sighting_period = 1;               ///< at most one of a pair in this time, seconds
  SightingNoise sighting_noise;
};

struct LiveEvent {
  Event event;
  Pose2 T_world_robot;  ///< the truth
};

/// Robots with differential drives, a laser at the centre of each. A robot that comes upon something stops there, while
/// its wheels go on and are counted; it may turn and back away.
class LiveSimulation {
 public:
  /// Errors: no robots; a start in or at a wall, or where another robot starts at the same time.
  [[nodiscard]] static Result<LiveSimulation> make(const World& world, std::vector<LiveRobot> robots,
                                                   const LiveOptions& options);

  /// What a robot does from now on, as fast as its drive lets it; what is not finite is a stop.
  void command(std::size_t robot, const DriveCommand& command);
  /// Everything moves on by one period. The events of all living robots: robot by robot, which is by stamp, too.
  std::vector<LiveEvent> tick();

  /// Seconds since the beginning; an event's stamp is later by kFirstStamp, and by less than a period.
  [[nodiscard]] double now() const { return static_cast<double>(ticks_) * options_.period; }
  static constexpr double kFirstStamp = 1000;

  [[nodiscard]] std::size_t robots() const { return bodies_.size(); }
  [[nodiscard]] const Pose2& T_world_robot(std::size_t robot) const { return bodies_[robot].T_world_robot; }
  /// It has joined and has not died.
  [[nodiscard]] bool alive(std::size_t robot) const { return bodies_[robot].joined && !is_dead(robot); }
  /// 1 full, 0 empty.
  [[nodiscard]] double battery(std::size_t robot) const {
    return std::max(0.0, 1 - bodies_[robot].driven / options_.metres_per_charge);
  }
  [[nodiscard]] const LaserModel& laser() const { return laser_; }

  /// A robot came upon something. What touches counts once until it has let go, however long it pushes.
  struct Contact {
    double stamp = 0;  ///< as events have it
    std::size_t robot = 0;
    std::string with;  ///< "wall", another robot's name, or "person"
    Vector2d p_world;  ///< where the robot stood
  };
  [[nodiscard]] std::size_t collisions() const { return contacts_.size(); }
  [[nodiscard]] std::span<const Contact> contacts() const { return contacts_; }

 private:
  struct Body {
    Pose2 T_world_robot;
    Random random;
    LaserBias laser_bias;
    Odometer odometer;
    DriveCommand command = {};
    DriveCommand wheels = {};           ///< what they do now
    Vector3d twist = Vector3d::Zero();  ///< of the robot in its own frame, metres and radians a second
    bool joined = false;
    double driven = 0;  ///< by its wheels, metres
  };
  /// What a robot can come upon: the walls, another robot, a person.
  struct Thing {
    enum class Kind : std::uint8_t { wall, robot, person } kind = Kind::wall;
    std::size_t index = 0;
    friend auto operator<=>(const Thing&, const Thing&) = default;
  };
  /// `floor`: places that people walk about.
  LiveSimulation(const World& world, std::vector<LiveRobot> robots, const LiveOptions& options,
                 std::vector<Vector2d> floor);
  [[nodiscard]] bool is_dead(std::size_t robot) const { return now() >= plan_[robot].dies_at || battery(robot) <= 0; }
  void join_robots();
  void walk_people(double dt);
  void drive(std::size_t robot, double dt);
  [[nodiscard]] double gap(const Vector2d& at, const Thing& thing, double reach) const;
  [[nodiscard]] std::vector<Thing> things_within(std::size_t robot, const Vector2d& at, double reach) const;
  void note_contacts(std::size_t robot, const Vector2d& at);
  void end_contacts(std::size_t robot);
  [[nodiscard]] std::vector<Disc> discs_around(std::size_t robot) const;
  void report(std::size_t robot, std::vector<LiveEvent>& events);
  void sight(std::size_t robot, double stamp, std::vector<LiveEvent>& events);

  LiveOptions options_;
  std::vector<LiveRobot> plan_;
  RayCaster walls_;
  LaserModel laser_;
  std::vector<Body> bodies_;
  std::optional<Pedestrians> people_;
  std::vector<double> last_sighting_;  ///< by pair, seconds
  std::set<std::pair<std::size_t, Thing>> touching_;
  std::vector<Contact> contacts_;
  long ticks_ = 0;
};

}  // namespace helicoid
