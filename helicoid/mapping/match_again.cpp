#include "helicoid/mapping/match_again.hpp"

#include <cmath>

#include "helicoid/mapping/fit_islands.hpp"
#include "helicoid/mapping/relate.hpp"

namespace helicoid {

namespace {

constexpr double kLever = 2;  // so far off lie the points that a turn moves, metres

bool holds_at(const Relation& relation, const Pose2& T_a_b) {
  const Pose2 moved = relation.T_a_b.inverse() * T_a_b;
  return moved.distance() + kLever * std::abs(moved.yaw) <= relation.radius;
}

/// Nothing if the match holds, or cannot be made there.
std::optional<Relation> matched_where_it_lies(const Map& map, const Relation& relation) {
  const Pose2 T_a_b = map.T_plane_patch(relation.a).inverse() * map.T_plane_patch(relation.b);
  const bool is_match = relation.correspondences > 0;
  return is_match && !holds_at(relation, T_a_b) ? match_anew(map, relation, T_a_b) : std::nullopt;
}

}  // namespace

std::size_t match_again(const Map& map, MapEditor& editor) {
  constexpr int kRounds = 4;
  std::size_t made = 0;
  for (int round = 0; round < kRounds; ++round) {
    const std::size_t before = made;
    for (std::size_t i = 0; i < map.relations().size(); ++i) {
      const auto id = make_id<RelationId>(i);
      if (const std::optional<Relation> now = matched_where_it_lies(map, map.relation(id))) {
        editor.revise_relation(id, *now);
        ++made;
      }
    }
    if (made == before) break;
    fit_islands(map, editor);
  }
  return made;
}

}  // namespace helicoid
