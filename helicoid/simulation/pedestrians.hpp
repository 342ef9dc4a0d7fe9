// People who walk about in a building.
#pragma once

#include <functional>
#include <span>
#include <vector>

#include "helicoid/base/random.hpp"
#include "helicoid/simulation/laser_simulator.hpp"

namespace helicoid {

inline constexpr double kPersonRadius = 0.18;  ///< metres

/// They go straight through open space and choose anew at a wall or at their goal. Nobody comes nearer to an avoided
/// disc than is polite; whoever stands so near walks away.
class Pedestrians {
 public:
  /// Draws a place inside the building; where people go can be seen from such a place.
  using Somewhere = std::function<Vector2d(Random&)>;
  Pedestrians(const RayCaster& walls, int count, Somewhere somewhere, Random random,
              std::span<const Disc> avoided = {});

  /// All go on for dt seconds.
  void walk(const RayCaster& walls, double dt, std::span<const Disc> avoided = {});
  [[nodiscard]] std::size_t count() const { return people_.size(); }
  [[nodiscard]] const Vector2d& place(std::size_t person) const { return people_[person].at; }

 private:
  struct Person {
    Vector2d at, target;
  };
  [[nodiscard]] Vector2d open_place(const RayCaster& walls);
  Somewhere somewhere_;
  Random random_;
  std::vector<Person> people_;
};

}  // namespace helicoid
