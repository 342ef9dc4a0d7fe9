#include "helicoid/mapping/landmark_place.hpp"

#include <algorithm>
#include <cmath>
#include <map>

namespace helicoid {

namespace {

/// So many places are compared with one another, evenly taken.
constexpr std::size_t kMostCompared = 200;

}  // namespace

Vector2d medoid(std::span<const Vector2d> places) {
  const std::size_t step = 1 + (places.size() - 1) / kMostCompared;
  Vector2d best = places.front();
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < places.size(); i += step) {
    double sum = 0;
    for (std::size_t j = 0; j < places.size(); j += step) sum += (places[i] - places[j]).norm();
    if (sum < least) least = sum, best = places[i];
  }
  return best;
}

std::vector<Pose2> reseat_landmarks(const TeamGraph& team, const std::vector<bool>& wrong) {
  std::vector<Pose2> poses = team.graph.poses;
  std::map<std::uint32_t, std::vector<Vector2d>> seen;
  std::map<std::uint32_t, std::size_t> wrong_of;
  for (std::size_t i = team.odometry; i < team.graph.relations.size(); ++i) {
    const GraphRelation& r = team.graph.relations[i];
    if (!team.graph.is_landmark[r.b]) continue;
    seen[r.b].push_back(poses[r.a] * std::get<PointPosition>(r.measurement).p_a);
    wrong_of[r.b] += wrong[i] ? 1 : 0;
  }
  for (const auto& [landmark, places] : seen) {
    if (2 * wrong_of[landmark] <= places.size()) continue;
    const Vector2d place = medoid(places);
    poses[landmark] = {place.x(), place.y(), 0};
  }
  return poses;
}

}  // namespace helicoid
