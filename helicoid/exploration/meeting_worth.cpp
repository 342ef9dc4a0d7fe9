#include "helicoid/exploration/meeting_worth.hpp"

#include <algorithm>
#include <map>
#include <numeric>
#include <tuple>

namespace helicoid {

namespace {

bool is_between_the_same(const Map& map, const Doubt& x, const Doubt& y) {
  const auto same = [&](PatchId p, PatchId q) { return map.island_of(p) == map.island_of(q); };
  return (same(x.a, y.a) && same(x.b, y.b)) || (same(x.a, y.b) && same(x.b, y.a));
}

/// The floor that need not be seen twice if the doubt's places are one, m2: half of what is open, each square once.
double saved_m2(const Map& map, const Doubt& doubt, std::span<const Frontier> frontiers, double reach) {
  const bool between_islands = map.island_of(doubt.a) != map.island_of(doubt.b);
  const auto is_near = [&](const Frontier& frontier, PatchId place) {
    const Vector2d apart = project(map, frontier.middle) - map.T_plane_patch(place).translation();
    return map.island_of(place) == frontier.island && (between_islands || apart.norm() <= reach);
  };
  std::map<std::tuple<IslandId, std::int32_t, std::int32_t>, double> open;
  for (const Frontier& frontier : frontiers) {
    if (!is_near(frontier, doubt.a) && !is_near(frontier, doubt.b)) continue;
    for (const SeenSquare& square : frontier.seen) {
      double& m2 = open[{frontier.island, square.row, square.column}];
      m2 = std::max(m2, square.area);
    }
  }
  return std::accumulate(open.begin(), open.end(), 0.0, [](double sum, const auto& e) { return sum + 0.5 * e.second; });
}

double worth_of(const TeamAtWork& team, std::span<const std::uint8_t> is_free, const AssignmentOptions& options) {
  const Eigen::MatrixXd way = ways_of_free(team.way, is_free);
  const std::vector<std::optional<std::size_t>> nobody(is_free.size());
  return team_value(team.frontiers, way, nobody, assign_frontiers(team.frontiers, way, nobody, options), options);
}

}  // namespace

double likelihood_of(const Map& map, const Doubt& doubt, std::span<const Doubt> open, const RendezvousDesk& desk,
                     const MeetingRecord& record) {
  const bool between_islands = map.island_of(doubt.a) != map.island_of(doubt.b);
  double alike = 1;
  double all = 1;
  for (const Doubt& other : open) {
    if (!between_islands || other.id == doubt.id || !is_between_the_same(map, doubt, other)) continue;
    ++all;
    if (desk.asks_the_same(map, doubt, other)) ++alike;
  }
  const double usual = (record.met + 1.0) / (record.met + record.absent + 1.0);
  return usual * std::min(alike / all, 1 / (1 + doubt.ambiguity));
}

bool is_worth_meeting(const Map& map, const Doubt& doubt, double likelihood, const Pairing& pair,
                      const TeamAtWork& team, const AssignmentOptions& assignment, const MeetingWorthOptions& options) {
  if (team.frontiers.empty()) return true;
  std::vector<std::uint8_t> others(team.is_free.begin(), team.is_free.end());
  others[pair.watcher] = others[pair.shown] = 0;
  const double saved = saved_m2(map, doubt, team.frontiers, options.doubt_reach);
  // Whoever has the shorter way waits for the other.
  const double cost = 2 * (pair.longest + options.standing_m);
  return worth_of(team, others, assignment) + likelihood * assignment.metres_per_m2 * saved - cost >=
         worth_of(team, team.is_free, assignment);
}

}  // namespace helicoid
