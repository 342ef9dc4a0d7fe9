#include "helicoid/exploration/sighting_chance.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "helicoid/base/random.hpp"
#include "helicoid/manifold/stated_confidence.hpp"

namespace helicoid {

namespace {

constexpr int kSamples = 400;
constexpr double kStep = 0.10;  // metres along the line of sight
constexpr double kBody = 0.40;  // metres: so near to either robot nothing else can stand

/// The line of sight, through what patch a saw as free.
bool is_open(const Patch& a, const Vector2d& from_a, const Vector2d& to_a) {
  const double distance = (to_a - from_a).norm();
  for (double at = kBody; at < distance - kBody; at += kStep) {
    if (!is_ground(a, from_a + at / distance * (to_a - from_a))) return false;
  }
  // And a little beyond where it stands: a robot that would stand behind a corner is not in view.
  return is_ground(a, to_a);
}

/// A square root of a covariance; of one that is not positive, of its diagonal.
Matrix3d root_of(const Matrix3d& covariance) {
  const Eigen::LLT<Matrix3d> factor(covariance);
  if (factor.info() == Eigen::Success) return factor.matrixL();
  return covariance.diagonal().cwiseMax(0).cwiseSqrt().asDiagonal();
}

}  // namespace

std::optional<StandingNoise> standing_beside(const Map& map, PatchId patch, const ManifoldPose& robot,
                                             const StandingNoise& on_its_sheet) {
  if (robot.patch == patch) return on_its_sheet;
  if (map.island_of(robot.patch) != map.island_of(patch)) return std::nullopt;
  const StatedConfidence stated(map, map.island_with(patch));
  if (!stated.is_determined()) return std::nullopt;
  const Matrix3d said = stated.between(patch, robot.patch).covariance;
  // Along either axis of the ellipse as along its longer one, and what a heading is off turns the robot's place.
  const double lever = robot.T_patch_robot.distance() * std::sqrt(said(2, 2));
  const double position = std::sqrt(said.topLeftCorner<2, 2>().trace());
  return StandingNoise{std::hypot(on_its_sheet.position, position, lever),
                       std::hypot(on_its_sheet.heading, std::sqrt(said(2, 2)))};
}

double view_chance(const Map& map, const Doubt& doubt, const Pose2& T_a_watcher, const Pose2& T_b_shown,
                   const SightingModel& model, const PairsNoise& noise, std::uint64_t seed) {
  Random random(seed);
  const Matrix3d root = root_of(doubt.T_a_b.covariance);
  const auto disturbed = [&](const Pose2& pose, const StandingNoise& by) {
    return pose * Pose2{by.position * random.normal(), by.position * random.normal(), by.heading * random.normal()};
  };
  const Patch& a = map.patch(doubt.a);
  int seen = 0;
  for (int i = 0; i < kSamples; ++i) {
    const Vector3d error = root * Vector3d(random.normal(), random.normal(), random.normal());
    const Pose2 T_a_b = Pose2::from_vector(doubt.T_a_b.T_a_b.vector() + error);
    const Pose2 watcher = disturbed(T_a_watcher, noise.watcher);
    const Vector2d shown = (T_a_b * disturbed(T_b_shown, noise.shown)).translation();
    const Vector2d view = watcher.inverse() * shown;
    const bool in_view =
        view.norm() <= model.range && std::abs(std::atan2(view.y(), view.x())) <= model.field_of_view / 2;
    if (in_view && is_open(a, watcher.translation(), shown)) ++seen;
  }
  return static_cast<double>(seen) / kSamples;
}

double sighting_chance(double view_chance, const SightingModel& model, int looks) {
  // Where the robots stand does not change between looks: whether they are in view is drawn once, each look anew.
  return view_chance * (1 - std::pow(1 - model.reliability, std::max(0, looks)));
}

}  // namespace helicoid
