#include "helicoid/exploration/meeting_worth.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <set>

namespace helicoid {

namespace {

/// Meetings that it takes for granted beforehand: so many where the places were one, to one where they were not.
constexpr double kOnes = 2;

bool is_between_the_same(const Map& map, const Doubt& x, const Doubt& y) {
  const auto same = [&](PatchId p, PatchId q) { return map.island_of(p) == map.island_of(q); };
  return (same(x.a, y.a) && same(x.b, y.b)) || (same(x.a, y.b) && same(x.b, y.a));
}

/// One place of a doubt and what lies about it.
struct Side {
  PatchId place;
  double reach;  ///< what is counted has its middle so near to the place, metres

  [[nodiscard]] bool is_near(const Map& map, const Vector2d& p_plane) const {
    return (p_plane - map.T_plane_patch(place).translation()).norm() <= reach;
  }
  [[nodiscard]] std::vector<const Frontier*> near(const Map& map, std::span<const Frontier> frontiers) const {
    std::vector<const Frontier*> near;
    for (const Frontier& frontier : frontiers) {
      if (frontier.island != map.island_of(place) || !is_near(map, project(map, frontier.middle))) continue;
      near.push_back(&frontier);
    }
    return near;
  }
};

/// What one side's open floor is to the other, if a transform holds.
struct OpenAsSeenFromThere {
  double known_share = 0;  ///< what is known there, of all that is
  double open_m2 = 0;      ///< what is open there as well
};

/// What is neither known there nor open is wall there, or nobody has been near.
OpenAsSeenFromThere compare_open(std::span<const Frontier* const> here, std::span<const Frontier* const> there,
                                 const KnownSquares& known_there, const Pose2& T_there_here) {
  std::set<FloorSquare> open_there;
  for (const Frontier* frontier : there) {
    for (const SeenSquare& square : frontier->seen) open_there.insert({square.row, square.column});
  }
  std::map<FloorSquare, double> open_on_both;
  double all = 0;
  double again = 0;
  for (const Frontier* frontier : here) {
    double known = 0;
    double open = 0;
    for (const SeenSquare& square : frontier->seen) {
      const FloorSquare at = square_at(T_there_here * middle_of({square.row, square.column}));
      if (known_there.has(at)) {
        known += square.area;
      } else if (open_there.contains(at)) {
        open += square.area;
        double& m2 = open_on_both[{square.row, square.column}];
        m2 = std::max(m2, square.area);
      }
    }
    all += frontier->gain_m2;
    if (known > 0) again += frontier->gain_m2 * known / (known + open);
  }
  OpenAsSeenFromThere result;
  if (all > 0) result.known_share = again / all;
  for (const auto& [square, m2] : open_on_both) result.open_m2 += m2;
  return result;
}

/// The floor that would be seen again from one side, if the doubt's places are one, m2. Of what is known there and not
/// here, the share that is known of what one would look at next; and of what is open on both sides each side's half.
double again_m2(const Map& map, const Side& here, const Side& there, const Pose2& T_there_here,
                std::span<const Frontier> frontiers, KnownFloor& floor) {
  const KnownSquares& known_here = floor.of(map.island_of(here.place));
  const KnownSquares& known_there = floor.of(map.island_of(there.place));
  const Pose2 T_here_there = T_there_here.inverse();
  double beyond = 0;
  for (const FloorSquare& square : known_there.squares()) {
    const Vector2d p_there = middle_of(square);
    if (!there.is_near(map, p_there) || known_here.has(square_at(T_here_there * p_there))) continue;
    beyond += kSeenSquare * kSeenSquare;
  }
  const OpenAsSeenFromThere open =
      compare_open(here.near(map, frontiers), there.near(map, frontiers), known_there, T_there_here);
  return beyond * open.known_share + 0.5 * open.open_m2;
}

double again_m2(const Map& map, const Doubt& doubt, std::span<const Frontier> frontiers, double reach,
                KnownFloor& floor) {
  const bool between_islands = map.island_of(doubt.a) != map.island_of(doubt.b);
  if (between_islands) reach = std::numeric_limits<double>::infinity();
  const Side a{doubt.a, reach};
  const Side b{doubt.b, reach};
  const Pose2 T_plane_a_plane_b = map.T_plane_patch(doubt.a) * doubt.T_a_b.T_a_b * map.T_plane_patch(doubt.b).inverse();
  return again_m2(map, a, b, T_plane_a_plane_b.inverse(), frontiers, floor) +
         again_m2(map, b, a, T_plane_a_plane_b, frontiers, floor);
}

bool has_work(const TeamAtWork& team, std::size_t member) {
  return team.way.row(static_cast<Eigen::Index>(member)).array().isFinite().any();
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
  // That one of the places is the right one, before any of them was ruled out.
  const double p = (record.met + kOnes) / (record.met + kOnes + 1);
  const double places = std::max(record.absent + all / alike, 1 + doubt.ambiguity);
  return p / (places - p * record.absent);
}

bool is_worth_meeting(const Map& map, const Doubt& doubt, double likelihood, const Pairing& pair,
                      const TeamAtWork& team, KnownFloor& floor, const MeetingWorthOptions& options) {
  if (team.frontiers.empty()) return true;
  const double saved = again_m2(map, doubt, team.frontiers, options.doubt_reach, floor);
  // Whoever has the shorter way waits for the other; who has nothing to look at loses nothing by it.
  int busy = 0;
  for (const std::size_t r : {pair.watcher, pair.shown}) busy += has_work(team, r) ? 1 : 0;
  const double cost = busy * (pair.longest + options.standing_m);
  return likelihood * options.metres_per_m2 * saved >= cost;
}

}  // namespace helicoid
