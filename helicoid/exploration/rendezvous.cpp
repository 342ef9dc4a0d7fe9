#include "helicoid/exploration/rendezvous.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

/// Where the other may stand: so far ahead of the watcher, nearest to the middle of its view first.
constexpr double kDistances[] = {2.5, 2.0, 3.0, 1.5, 3.5};            // metres
constexpr double kBearings[] = {0, 0.3, -0.3, 0.6, -0.6, 0.9, -0.9};  // radians
constexpr float kDepth = 0.4F;                                        // before what patch a saw behind it, metres

/// Where a doubt would move what lies about its second place, in the plane of the first.
Pose2 correction_of(const Map& map, const Doubt& doubt) {
  return map.T_plane_patch(doubt.a) * doubt.T_a_b.T_a_b * map.T_plane_patch(doubt.b).inverse();
}

bool is_small(const Pose2& off, double most) {
  constexpr double kTurn = 0.35;  // radians
  return off.distance() <= most && std::abs(off.yaw) <= kTurn;
}

/// True if both would lay one part of the map over another in the same way, seen from the second doubt's place.
bool lays_alike(const Map& map, const Doubt& first, const Doubt& second, const Pose2& T_by_first, double alike) {
  const Pose2 T_plane_b = map.T_plane_patch(second.b);
  const Pose2 off = (T_by_first * T_plane_b).inverse() * correction_of(map, second) * T_plane_b;
  return map.island_of(first.a) != map.island_of(first.b) && is_small(off, alike);
}

/// True if the map has the two places where the doubt has them.
bool is_as_doubted(const Map& map, const Doubt& doubt, double same) {
  return map.island_of(doubt.a) == map.island_of(doubt.b) &&
         is_small(map.T_plane_patch(doubt.b).inverse() * map.T_plane_patch(doubt.a) * doubt.T_a_b.T_a_b, same);
}

Settled met(const Meeting& meeting) {
  Settled settled;
  settled.doubt = meeting.doubt.id;
  settled.outcome = MeetingOutcome::met;
  settled.watcher = meeting.watcher_robot;
  settled.shown = meeting.shown_robot;
  settled.chance = 1;
  return settled;
}

/// Robots that saw each other have joined the islands of the two places as the doubt has it. The map may have taken the
/// doubt itself as well then, as evidence, so that it is open no longer.
Settled settled_on_the_way(const Meeting& meeting) {
  Settled settled = met(meeting);
  settled.by_chance = !meeting.brought_together;
  settled.reason = settled.by_chance ? "the two places are one: others of their islands saw each other meanwhile"
                                     : "the two places are one: who was sent there met the others on the way";
  return settled;
}

ManifoldPoint watcher_post(const Doubt& doubt, const Posts& posts) {
  return {doubt.a, posts.T_a_watcher.translation()};
}
ManifoldPoint shown_post(const Doubt& doubt, const Posts& posts) {
  return {doubt.b, posts.T_b_shown.translation()};
}

}  // namespace

std::optional<Posts> find_posts(const Map& map, const Doubt& doubt, const Travel& to_b,
                                const RendezvousOptions& options) {
  const SeenFree free(map.patch(doubt.a));
  const Pose2 T_b_a = doubt.T_a_b.T_a_b.inverse();
  std::optional<Posts> best;
  for (const double bearing : kBearings) {
    for (const double distance : kDistances) {
      const Vector2d p_a = distance * Vector2d(std::cos(bearing), std::sin(bearing));
      if (distance > 0.7 * options.sighting.range || !free.is_deep(p_a.cast<float>(), kDepth)) continue;
      const Pose2 T_b_shown = T_b_a * Pose2{p_a.x(), p_a.y(), bearing + std::numbers::pi};
      if (!is_ground(map.patch(doubt.b), T_b_shown.translation())) continue;
      if (!std::isfinite(to_b({doubt.b, T_b_shown.translation()}))) continue;
      const double chance =
          view_chance(map, doubt, {}, T_b_shown, options.sighting, {options.standing, options.standing});
      if (!best || chance > best->chance) best = Posts{{}, T_b_shown, chance};
      if (best->chance > 0.995) return best;
    }
  }
  return best;
}

std::optional<Pairing> choose_pair(const Posts& posts, const Doubt& doubt, std::span<const Travel> travel,
                                   std::span<const std::uint8_t> is_free) {
  std::optional<Pairing> best;
  for (std::size_t w = 0; w < travel.size(); ++w) {
    if (is_free[w] == 0) continue;
    const double way_w = travel[w](watcher_post(doubt, posts));
    if (!std::isfinite(way_w)) continue;
    for (std::size_t s = 0; s < travel.size(); ++s) {
      if (s == w || is_free[s] == 0) continue;
      const double way_s = travel[s](shown_post(doubt, posts));
      if (!std::isfinite(way_s)) continue;
      const Pairing pair{w, s, std::max(way_w, way_s)};
      if (!best || pair.longest < best->longest) best = pair;
    }
  }
  return best;
}

Goal Meeting::goal_of(RobotId robot) const {
  const bool watches = robot == watcher_robot;
  const Pose2& post = watches ? posts.T_a_watcher : posts.T_b_shown;
  return {robot,
          GoalKind::rendezvous,
          watches ? watcher_post(doubt, posts) : shown_post(doubt, posts),
          post.yaw,
          fmt::format("to see whether two places are one (doubt {})", doubt.id),
          doubt.id};
}

void RendezvousDesk::begin(double now, const Map& map, const Doubt& doubt, const Posts& posts, const Pairing& pair,
                           std::span<const TeamMember> members) {
  Meeting meeting{doubt, posts, pair.watcher, pair.shown, members[pair.watcher].robot, members[pair.shown].robot};
  meeting.deadline = now + options_.patience + pair.longest / options_.slowest;
  meeting.between_islands = map.island_of(doubt.a) != map.island_of(doubt.b);
  meetings_.push_back(std::move(meeting));
}

const Meeting* RendezvousDesk::meeting_of(RobotId robot) const {
  const auto found = std::find_if(meetings_.begin(), meetings_.end(), [&](const Meeting& m) { return m.has(robot); });
  return found != meetings_.end() ? &*found : nullptr;
}

RendezvousDesk::Past& RendezvousDesk::past_of(const Doubt& doubt) {
  for (Past& past : past_) {
    if (past.doubt.id == doubt.id) return past;
  }
  return past_.emplace_back(Past{doubt, false, 0, 0});
}

bool RendezvousDesk::asks_the_same(const Map& map, const Doubt& a, const Doubt& b) const {
  const auto near = [&](PatchId p, PatchId q) {
    return map.island_of(p) == map.island_of(q) &&
           (map.T_plane_patch(p).translation() - map.T_plane_patch(q).translation()).norm() <= options_.alike;
  };
  if (a.id == b.id || (near(a.a, b.a) && near(a.b, b.b)) || (near(a.a, b.b) && near(a.b, b.a))) return true;
  // Between two islands one answer is that to all that would join them alike.
  const auto same_island = [&](PatchId p, PatchId q) { return map.island_of(p) == map.island_of(q); };
  if (same_island(a.a, b.a) && same_island(a.b, b.b))
    return lays_alike(map, a, b, correction_of(map, a), options_.alike);
  if (same_island(a.a, b.b) && same_island(a.b, b.a)) {
    return lays_alike(map, a, b, correction_of(map, a).inverse(), options_.alike);
  }
  return false;
}

bool RendezvousDesk::is_open(double now, const Map& map, const Doubt& doubt) const {
  const bool answered = std::any_of(past_.begin(), past_.end(), [&](const Past& past) {
    const bool closed = past.settled || past.failures >= options_.most_tries || now < past.rests_until;
    return closed && asks_the_same(map, past.doubt, doubt);
  });
  return !answered && std::none_of(meetings_.begin(), meetings_.end(),
                                   [&](const Meeting& m) { return asks_the_same(map, m.doubt, doubt); });
}

bool RendezvousDesk::is_resting(double now, const Doubt& doubt) const {
  return std::any_of(past_.begin(), past_.end(), [&](const Past& past) {
    return past.doubt.id == doubt.id && !past.settled && past.failures < options_.most_tries && now < past.rests_until;
  });
}

void RendezvousDesk::saw(const SeenTeammate& sighting) {
  for (Meeting& meeting : meetings_) {
    const bool observes = meeting.has(sighting.observer);
    const bool is_observed = meeting.has(sighting.observed);
    if (sighting.between_islands && (observes || is_observed)) meeting.brought_together = true;
    if (meeting.there_since < 0 || !observes || !is_observed) continue;
    const Vector2d between =
        (meeting.posts.T_a_watcher.inverse() * meeting.doubt.T_a_b.T_a_b * meeting.posts.T_b_shown).translation();
    const double allowed =
        options_.range_error + confidence_interval(meeting.doubt.T_a_b.covariance).position + 2 * options_.at_post;
    if (sighting.range && std::abs(*sighting.range - between.norm()) > allowed) continue;
    meeting.sighted = true;
  }
}

bool RendezvousDesk::stand_there(const Meeting& meeting, const Map& map, std::span<const TeamMember> members,
                                 std::span<const Travel> travel) const {
  const auto stands = [&](std::size_t member, const ManifoldPoint& post, double yaw) {
    const double heading = map.project(members[member].pose).yaw;
    const double wanted = map.T_plane_patch(post.patch).yaw + yaw;
    // On the sheet of the post, not only over it: by the way there.
    return map.island_of(members[member].pose.patch) == map.island_of(post.patch) &&
           travel[member](post) <= options_.at_post && std::abs(wrap_angle(heading - wanted)) <= options_.facing;
  };
  return stands(meeting.watcher, watcher_post(meeting.doubt, meeting.posts), meeting.posts.T_a_watcher.yaw) &&
         stands(meeting.shown, shown_post(meeting.doubt, meeting.posts), meeting.posts.T_b_shown.yaw);
}

std::optional<Settled> RendezvousDesk::judge(double now, const Map& map, Meeting& meeting,
                                             std::span<const TeamMember> members) const {
  const auto looks = static_cast<int>((now - meeting.there_since) / options_.sighting.period);
  Settled settled = met(meeting);
  if (meeting.sighted) {
    settled.reason = "the robots stood at both places and saw each other";
    return settled;
  }
  if (looks < options_.least_looks) return std::nullopt;
  const ManifoldPose& watcher = members[meeting.watcher].pose;
  const ManifoldPose& shown = members[meeting.shown].pose;
  const auto [a, b] = std::pair{meeting.doubt.a, meeting.doubt.b};
  const auto noise_watcher = standing_beside(map, a, watcher, options_.standing);
  const auto noise_shown = standing_beside(map, b, shown, options_.standing);
  if (!noise_watcher || !noise_shown) return std::nullopt;
  const auto on = [&](PatchId patch, const ManifoldPose& robot) {
    return map.T_plane_patch(patch).inverse() * map.project(robot);
  };
  const double view =
      view_chance(map, meeting.doubt, on(a, watcher), on(b, shown), options_.sighting, {*noise_watcher, *noise_shown});
  settled.chance = sighting_chance(view, options_.sighting, looks);
  if (settled.chance < options_.sure) return std::nullopt;
  settled.outcome = MeetingOutcome::absent;
  settled.reason = fmt::format(
      "the robots stood at both places for {} looks and did not see each other, which they "
      "would have by {:.1f} % if the places were one",
      looks, 100 * settled.chance);
  return settled;
}

std::vector<Settled> RendezvousDesk::step(double now, const Map& map, std::span<const TeamMember> members,
                                          std::span<const Travel> travel, std::span<const Doubt> doubts) {
  std::vector<Settled> settled;
  std::erase_if(meetings_, [&](Meeting& meeting) {
    const auto same = [&](const Doubt& d) { return d.id == meeting.doubt.id; };
    const auto doubt = std::find_if(doubts.begin(), doubts.end(), same);
    const auto member_of = [&](RobotId robot) {
      return static_cast<std::size_t>(
          std::find_if(members.begin(), members.end(),
                       [&](const TeamMember& m) { return m.robot == robot && m.available; }) -
          members.begin());
    };
    meeting.watcher = member_of(meeting.watcher_robot);
    meeting.shown = member_of(meeting.shown_robot);
    if (meeting.between_islands && is_as_doubted(map, meeting.doubt, options_.same)) {
      past_of(meeting.doubt).settled = true;
      settled.push_back(settled_on_the_way(meeting));
      return true;
    }
    if (doubt == doubts.end()) return true;
    if (meeting.watcher == members.size() || meeting.shown == members.size() || now > meeting.deadline) {
      Past& past = past_of(meeting.doubt);
      ++past.failures;
      past.rests_until = now + options_.rest;
      return true;
    }
    if (!stand_there(meeting, map, members, travel)) {
      meeting.there_since = -1;
      meeting.sighted = false;
      return false;
    }
    if (meeting.there_since < 0) meeting.there_since = now;
    const std::optional<Settled> outcome = judge(now, map, meeting, members);
    if (!outcome) return false;
    past_of(meeting.doubt).settled = true;
    settled.push_back(*outcome);
    return true;
  });
  return settled;
}

}  // namespace helicoid
