#include "helicoid/simulation/mark_simulator.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>

#include "helicoid/base/random.hpp"

namespace helicoid {

namespace {

constexpr double kTick = 0.05;     // seconds
constexpr double kBegin = 1000.0;  // the first stamp, seconds

/// A robot on its way to one random place after another.
struct Driver {
  Random random;
  Pose2 T_world_robot;
  Vector2d goal;
  double forward_gain, turning_gain;
  std::deque<Velocity> told;  ///< and not yet done
};

class MarkSimulator {
 public:
  explicit MarkSimulator(const MarkSimulation& options) : options_(options), random_(options.seed) {
    for (int i = 0; i < options.landmarks; ++i) {
      team_.landmarks.push_back(somewhere(random_));
      team_.log.landmarks.push_back(fmt::format("landmark{}", 6 + i));
    }
    for (int i = 0; i < options.robots; ++i) {
      Random own = random_.split();
      const Vector2d start = somewhere(own);
      Driver driver{own, {start.x(), start.y(), own.uniform(-3, 3)}, somewhere(own), 0, 0, {}};
      driver.forward_gain = options.forward_gain * driver.random.uniform(0.97, 1.03);
      driver.turning_gain = options.turning_gain * driver.random.uniform(0.97, 1.03);
      drivers_.push_back(driver);
      team_.log.robots.push_back({fmt::format("robot{}", i + 1), {}, {}});
    }
    team_.truth.resize(drivers_.size());
  }

  SimulatedTeam run() {
    const auto ticks = static_cast<int>(options_.seconds / kTick);
    const int looks = std::max(1, static_cast<int>(1 / (options_.rate * kTick)));
    for (int k = 0; k < ticks; ++k) {
      const double stamp = kBegin + k * kTick;
      if (k % 2 == 0) team_.stamps.push_back(stamp);
      for (std::size_t i = 0; i < drivers_.size(); ++i) {
        if (k % 2 == 0) team_.truth[i].push_back(drivers_[i].T_world_robot);
        // Robots look one after another, as cameras do that nobody triggers.
        if ((k + static_cast<int>(i)) % looks == 0) look(i, stamp);
      }
      for (std::size_t i = 0; i < drivers_.size(); ++i) drive(i, stamp);
    }
    return std::move(team_);
  }

 private:
  Vector2d somewhere(Random& random) const {
    return {random.uniform(0, options_.width), random.uniform(0, options_.height)};
  }

  void drive(std::size_t i, double stamp) {
    Driver& d = drivers_[i];
    Vector2d ahead = d.T_world_robot.inverse() * d.goal;
    if (ahead.norm() < 0.4) {
      d.goal = somewhere(d.random);
      ahead = d.T_world_robot.inverse() * d.goal;
    }
    const double off = std::atan2(ahead.y(), ahead.x());
    const double turning = std::clamp(2 * off, -0.4, 0.4);
    d.told.push_back({stamp, options_.speed * (std::abs(off) < 0.7 ? 1 : 0.5), turning});
    team_.log.robots[i].velocities.push_back(d.told.back());
    if (d.told.front().stamp > stamp - options_.delay) return;
    const Velocity v = d.told.front();
    d.told.pop_front();
    const double turn = d.turning_gain * v.turning * kTick +
                        std::sqrt(options_.turning_share * std::abs(v.turning) * kTick) * d.random.normal();
    const double way =
        d.forward_gain * v.forward * kTick + std::sqrt(options_.forward_rate * kTick) * d.random.normal();
    d.T_world_robot = d.T_world_robot * exponential({way, 0, turn});
  }

  void look(std::size_t i, double stamp) {
    Driver& d = drivers_[i];
    const auto robots = static_cast<std::uint32_t>(drivers_.size());
    const auto subjects = robots + static_cast<std::uint32_t>(team_.landmarks.size());
    for (std::uint32_t subject = 0; subject < subjects; ++subject) {
      const Vector2d p_world =
          subject < robots ? drivers_[subject].T_world_robot.translation() : team_.landmarks[subject - robots];
      const Vector2d p = d.T_world_robot.inverse() * p_world;
      const double bearing = std::atan2(p.y(), p.x());
      const bool in_view =
          subject != i && p.norm() > 0.3 && p.norm() < options_.range && std::abs(bearing) < options_.view;
      if (!in_view || !d.random.chance(options_.seen)) continue;
      std::uint32_t taken_for = subject;
      if (d.random.chance(options_.wrong)) taken_for = static_cast<std::uint32_t>(d.random.below(subjects));
      const double range = p.norm() * (1 + options_.range_share * d.random.normal());
      const double measured = bearing + options_.bearing_sigma * d.random.normal();
      if (taken_for == i) continue;
      if (taken_for != subject) ++team_.wrong;
      team_.log.robots[i].detections.push_back({stamp, taken_for, range, measured});
    }
  }

  MarkSimulation options_;
  Random random_;
  std::vector<Driver> drivers_;
  SimulatedTeam team_;
};

}  // namespace

SimulatedTeam simulate_marks(const MarkSimulation& options) {
  return MarkSimulator(options).run();
}

}  // namespace helicoid
