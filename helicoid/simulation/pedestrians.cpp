#include "helicoid/simulation/pedestrians.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace helicoid {

namespace {

constexpr double kSpeed = 0.9;         // metres / second
constexpr double kFarthestWalk = 8;    // metres
constexpr double kPoliteDistance = 1;  // beyond a disc's radius, metres
constexpr int kTries = 1000;           // at a place for a person to begin at

bool is_near(const Vector2d& at, const Disc& disc) {
  return (at - disc.centre).norm() < disc.radius + kPoliteDistance;
}

/// Whether a step leads towards a disc that is near.
bool is_impolite(const Vector2d& from, const Vector2d& to, std::span<const Disc> avoided) {
  return std::any_of(avoided.begin(), avoided.end(), [&](const Disc& disc) {
    return is_near(to, disc) && (to - disc.centre).norm() < (from - disc.centre).norm();
  });
}

}  // namespace

Pedestrians::Pedestrians(const RayCaster& walls, int count, Somewhere somewhere, Random random,
                         std::span<const Disc> avoided)
    : somewhere_(std::move(somewhere)), random_(random) {
  for (int i = 0; i < count; ++i) {
    Vector2d at = open_place(walls);
    const auto is_taken = [&](const Disc& disc) { return is_near(at, disc); };
    for (int k = 0; k < kTries && std::any_of(avoided.begin(), avoided.end(), is_taken); ++k) at = open_place(walls);
    people_.push_back({at, open_place(walls)});
  }
}

/// A place that can be seen from somewhere inside: inside the building, outside of furniture.
Vector2d Pedestrians::open_place(const RayCaster& walls) {
  const Vector2d from = somewhere_(random_);
  const double angle = random_.uniform(-std::numbers::pi, std::numbers::pi);
  const Vector2d direction(std::cos(angle), std::sin(angle));
  const double reach = std::min(walls.cast(from, direction, kFarthestWalk).distance, kFarthestWalk);
  return from + random_.uniform() * std::max(0.0, reach - 2 * kPersonRadius) * direction;
}

void Pedestrians::walk(const RayCaster& walls, double dt, std::span<const Disc> avoided) {
  for (Person& person : people_) {
    const Vector2d way = person.target - person.at;
    const double step = kSpeed * dt;
    const bool arrived = way.norm() < step;
    const bool blocked = !arrived && walls.cast(person.at, way.normalized(), step + kPersonRadius).segment >= 0;
    if (arrived || blocked || is_impolite(person.at, person.at + step * way.normalized(), avoided)) {
      person.target = open_place(walls);
    } else {
      person.at += step * way.normalized();
    }
  }
}

}  // namespace helicoid
