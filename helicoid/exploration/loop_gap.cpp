#include "helicoid/exploration/loop_gap.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <queue>

#include "helicoid/fit/confident_pairs.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

double apart(const Map& map, PatchId a, PatchId b) {
  return (map.T_plane_patch(a).translation() - map.T_plane_patch(b).translation()).norm();
}

/// How far it is from one patch to the others, from relation to relation; infinity: nothing relates them.
std::vector<double> ways_from(const Map& map, PatchId from) {
  std::vector<double> way(map.patch_count(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, std::uint32_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> queue;
  way[from.index()] = 0;
  queue.emplace(0.0, from.value);
  while (!queue.empty()) {
    const auto [so_far, value] = queue.top();
    queue.pop();
    const PatchId at{value};
    if (so_far > way[at.index()]) continue;
    for (const RelationId id : map.relations_of(at)) {
      const Relation& r = map.relation(id);
      const PatchId next = r.a == at ? r.b : r.a;
      const double longer = so_far + apart(map, at, next);
      if (longer >= way[next.index()]) continue;
      way[next.index()] = longer;
      queue.emplace(longer, next.value);
    }
  }
  return way;
}

/// Where a robot that comes by `from` stands as the patch beyond did, or as near to there as both show floor.
std::optional<Vector2d> crossing_point(const Map& map, PatchId from, PatchId beyond, double depth) {
  constexpr double kStep = 0.5;  // metres
  const Pose2 T_beyond_from = map.T_plane_patch(beyond).inverse() * map.T_plane_patch(from);
  const Vector2d p_beyond = T_beyond_from.inverse().translation();  // of its origin, in `from`
  const SeenFree seen_from(map.patch(from));
  const SeenFree seen_beyond(map.patch(beyond));
  const double way = p_beyond.norm();
  for (double back = 0; back < way; back += kStep) {
    const Vector2d p_from = p_beyond * (1 - back / way);
    if (!seen_from.is_deep(p_from.cast<float>(), static_cast<float>(depth))) continue;
    const Vector2d p = T_beyond_from * p_from;
    if (back == 0 || seen_beyond.is_deep(p.cast<float>(), static_cast<float>(depth))) return p_from;
  }
  return std::nullopt;
}

/// Where the gap is: midway between its two patches, in the plane.
Vector2d middle_of(const Map& map, const LoopGap& gap) {
  return 0.5 * (map.T_plane_patch(gap.from).translation() + map.T_plane_patch(gap.beyond).translation());
}

/// The gaps of one island.
class GapSearch {
 public:
  GapSearch(const Map& map, const Neighbours& neighbours, const Neighbours& overlapping, const LoopGapOptions& options)
      : map_(map), neighbours_(neighbours), overlapping_(overlapping), options_(options) {}

  void search(const Island& island, std::vector<LoopGap>& gaps) const {
    std::optional<RelativeCovariance> exact;
    for (const PatchId from : island.patches) {
      for (LoopGap& gap : gaps_from(from)) {
        if (!exact) exact.emplace(island_poses(map_, island), graph_edges(map_, island));
        if (!exact->is_determined()) return;
        gap.known_to = midway_interval(exact->of(island.place_of(gap.from), island.place_of(gap.beyond))).position;
        gaps.push_back(gap);
      }
    }
  }

 private:
  [[nodiscard]] std::vector<LoopGap> gaps_from(PatchId from) const {
    std::vector<LoopGap> gaps;
    std::vector<double> way;
    const std::vector<PatchId>& known = neighbours_[from.index()];
    for (const PatchId beyond : overlapping_[from.index()]) {
      const double distance = apart(map_, from, beyond);
      if (distance > options_.near || std::binary_search(known.begin(), known.end(), beyond)) continue;
      const double tied = std::max(options_.least_way_round, options_.times_round * distance);
      if (way.empty()) way = ways_from(map_, from);
      if (way[beyond.index()] < tied) continue;
      const std::optional<Vector2d> p_from = crossing_point(map_, from, beyond, options_.depth);
      if (!p_from) continue;
      const double yaw = wrap_angle(map_.T_plane_patch(beyond).yaw - map_.T_plane_patch(from).yaw);
      gaps.push_back({from, beyond, {from, *p_from}, yaw, 0, way[beyond.index()]});
    }
    return gaps;
  }

  const Map& map_;
  const Neighbours& neighbours_;
  const Neighbours& overlapping_;
  const LoopGapOptions& options_;
};

}  // namespace

std::vector<LoopGap> find_loop_gaps(const Map& map, const Neighbours& neighbours, const LoopGapOptions& options) {
  std::vector<LoopGap> gaps;
  const Neighbours overlapping = find_neighbours(map, options.overlap);
  const GapSearch search(map, neighbours, overlapping, options);
  for (const Island& island : map.islands()) search.search(island, gaps);
  return gaps;
}

bool LoopGapDesk::is_same(const Map& map, const LoopGap& a, const LoopGap& b) const {
  return map.island_of(a.from) == map.island_of(b.from) &&
         (middle_of(map, a) - middle_of(map, b)).norm() <= options_.same;
}

std::size_t LoopGapDesk::tries_of(const Map& map, const LoopGap& gap) const {
  return static_cast<std::size_t>(
      std::count_if(tried_.begin(), tried_.end(), [&](const LoopGap& t) { return is_same(map, t, gap); }));
}

void LoopGapDesk::step(double now, const Map& map, const Neighbours& neighbours, std::span<const TeamMember> members,
                       std::span<const Travel> travel, std::span<const double> range, bool other_work) {
  if (other_work && crossings_.empty()) return;
  if (patches_then_ != map.patch_count() || relations_then_ != map.relations().size()) {
    gaps_ = find_loop_gaps(map, neighbours, options_);
    patches_then_ = map.patch_count();
    relations_then_ = map.relations().size();
  }
  look_after(now, members, travel, range);
  if (!other_work) send(now, map, members, travel, range);
  note_left(map);
}

void LoopGapDesk::look_after(double now, std::span<const TeamMember> members, std::span<const Travel> travel,
                             std::span<const double> range) {
  std::erase_if(crossings_, [&](Crossing& crossing) {
    const auto member = static_cast<std::size_t>(
        std::find_if(members.begin(), members.end(), [&](const TeamMember& m) { return m.robot == crossing.robot; }) -
        members.begin());
    const auto is_this = [&](const LoopGap& g) {
      return g.from == crossing.gap.from && g.beyond == crossing.gap.beyond;
    };
    if (std::none_of(gaps_.begin(), gaps_.end(), is_this)) return true;  // closed
    if (member == members.size() || range[member] < 0) return true;
    const bool is_there = travel[member](crossing.gap.goal) <= options_.arrived;
    if (is_there && crossing.there_since < 0) crossing.there_since = now;
    const bool has_looked = crossing.there_since >= 0 && now - crossing.there_since >= options_.look_time;
    if (!has_looked && now <= crossing.deadline) return false;
    tried_.push_back(crossing.gap);
    return true;
  });
}

void LoopGapDesk::send(double now, const Map& map, std::span<const TeamMember> members, std::span<const Travel> travel,
                       std::span<const double> range) {
  if (gaps_.empty()) return;
  std::vector<std::vector<double>> way_to(members.size());
  for (std::size_t i = 0; i < members.size(); ++i) {
    if (range[i] >= 0) way_to[i] = ways_from(map, members[i].pose.patch);
  }
  while (true) {
    const LoopGap* best = nullptr;
    std::size_t who = 0;
    double most = 0;
    for (const LoopGap& gap : gaps_) {
      const auto taken = [&](const Crossing& c) { return is_same(map, c.gap, gap); };
      if (std::any_of(crossings_.begin(), crossings_.end(), taken)) continue;
      if (tries_of(map, gap) >= options_.most_tries) continue;
      for (std::size_t i = 0; i < members.size(); ++i) {
        if (range[i] < 0 || goal_of(members[i].robot)) continue;
        // Who is on the far side already would only go about on floor that it knows.
        if (way_to[i][gap.from.index()] >= way_to[i][gap.beyond.index()]) continue;
        const double way = travel[i](gap.goal);
        const double worth = options_.drive_per_metre * gap.known_to - way;
        // There, and at worst all of it back.
        if (2 * way > range[i] || worth <= most) continue;
        best = &gap;
        who = i;
        most = worth;
      }
    }
    if (best == nullptr) return;
    const double time = travel[who](best->goal) / options_.slowest + options_.patience;
    crossings_.push_back({members[who].robot, *best, now + time});
  }
}

void LoopGapDesk::note_left(const Map& map) {
  left_.clear();
  std::vector<const LoopGap*> seen;
  for (const LoopGap& gap : gaps_) {
    const auto same = [&](const LoopGap* s) { return is_same(map, *s, gap); };
    const auto found = std::find_if(seen.begin(), seen.end(), same);
    if (found == seen.end()) {
      seen.push_back(&gap);
      left_.push_back(gap.known_to);
    } else {
      double& known_to = left_[static_cast<std::size_t>(found - seen.begin())];
      known_to = std::max(known_to, gap.known_to);
    }
  }
}

std::optional<Goal> LoopGapDesk::goal_of(RobotId robot) const {
  const auto found =
      std::find_if(crossings_.begin(), crossings_.end(), [&](const Crossing& c) { return c.robot == robot; });
  if (found == crossings_.end()) return std::nullopt;
  const LoopGap& gap = found->gap;
  const std::string round = std::isfinite(gap.way_round) ? fmt::format(" over {:.0f} m of way", gap.way_round) : "";
  return Goal{
      robot,
      GoalKind::revisit,
      gap.goal,
      gap.heading_patch,
      fmt::format("to tie two parts of the map that meet here: they are known to {:.2f} m{}", gap.known_to, round),
      0};
}

std::string LoopGapDesk::left_in_words() const {
  if (left_.empty()) return "";
  const double worst = *std::max_element(left_.begin(), left_.end());
  return fmt::format("; {} left where parts of the map meet and are known only to {:.2f} m",
                     left_.size() == 1 ? std::string("a place is") : fmt::format("{} places are", left_.size()), worst);
}

}  // namespace helicoid
