#include "helicoid/exploration/explorer.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace helicoid {

/// What one plan is made from, and how far it has come.
struct Explorer::Situation {
  double now;
  const Map& map;
  std::span<const Travel> travel;
  std::span<const TeamMember> members;
  std::span<const Doubt> doubts;
  std::vector<std::uint8_t> is_free;  ///< by member: may still be told something
  std::vector<Frontier> frontiers;    ///< that are worth a look
  Eigen::MatrixXd way;                ///< by member and frontier, metres
  bool waits = false;                 ///< something will be tried again, or is on its way
  double ways_home = 0;               ///< of those who are on their way home, metres
  bool stranded = false;              ///< somebody sees no way home

  void tell(TeamPlan& plan, std::size_t member, Goal goal) {
    goal.robot = members[member].robot;
    plan.goals[member] = std::move(goal);
    is_free[member] = 0;
  }
};

namespace {

using Choice = std::vector<std::optional<std::size_t>>;

ManifoldPoint here(const TeamMember& member) {
  return point_of(member.pose);
}

FrontierLeft left_out(const Frontier& frontier, std::string reason) {
  return {frontier.island, frontier.middle, frontier.length, frontier.gain_m2, std::move(reason)};
}

std::string why_closed(const Frontier& frontier) {
  if (frontier.is_narrow) return fmt::format("opening of {:.2f} m", frontier.opening);
  return frontier.status == FrontierStatus::unreachable ? "no way there" : "looked at or tried in vain";
}

/// How many of each reason, the most telling first: "opening of 0.31 m", "2 x no way there".
std::string summary_of(std::span<const FrontierLeft> left) {
  std::vector<std::pair<std::string, int>> counts;
  for (const FrontierLeft& frontier : left) {
    const auto same = [&](const auto& entry) { return entry.first == frontier.reason; };
    const auto found = std::find_if(counts.begin(), counts.end(), same);
    if (found != counts.end()) ++found->second;
    if (found == counts.end()) counts.emplace_back(frontier.reason, 1);
  }
  std::string text;
  for (const auto& [reason, count] : counts) {
    if (!text.empty()) text += ", ";
    text += count > 1 ? fmt::format("{} x {}", count, reason) : reason;
  }
  return text;
}

}  // namespace

const char* name_of(EndState state) {
  switch (state) {
    case EndState::exploring: return "exploring";
    case EndState::returning: return "returning";
    case EndState::explored: return "explored";
    case EndState::stopped: break;
  }
  return "stopped";
}

Explorer::Explorer(const ExplorerOptions& options)
    : options_(options),
      finder_(options.frontiers),
      looks_(options.looks),
      desk_(options.rendezvous),
      gaps_(options.loop_gaps) {}

TeamPlan Explorer::plan(double now, const Map& map, const Neighbours& neighbours, std::span<const Travel> travel,
                        std::span<const TeamMember> members, std::span<const Doubt> doubts,
                        std::span<const Order> orders) {
  Situation s{now, map, travel, members, doubts, {}, {}, {}, false, 0, false};
  TeamPlan plan;
  orders_.take(orders);
  for (const TeamMember& member : members) {
    plan.goals.push_back({member.robot, GoalKind::stay, here(member), std::nullopt, "nothing to look at for now", 0});
    s.is_free.push_back(member.available ? 1 : 0);
  }
  sort_out_frontiers(s, neighbours, plan);
  plan.settled = desk_.step(now, map, members, travel, doubts);
  for (const Settled& settled : plan.settled)
    ++(settled.outcome == MeetingOutcome::met ? meetings_.met : meetings_.absent);
  obey(s, plan);
  spare_batteries(s, plan);
  keep_meetings(s, plan);
  arrange_meetings(s, plan);
  cross_gaps(s, neighbours, plan);
  assign(s, plan);
  go_home(s, plan);
  conclude(s, plan);
  return plan;
}

void Explorer::sort_out_frontiers(Situation& s, const Neighbours& neighbours, TeamPlan& plan) {
  // Where only one can get to that is dead or out of contact, nobody looks.
  std::vector<Travel> of_available;
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    if (s.members[i].available) of_available.push_back(s.travel[i]);
  }
  for (Frontier& frontier : finder_.find(s.map, neighbours, of_available)) {
    if (!is_to_be_looked_at(frontier)) {
      plan.frontiers_left.push_back(left_out(frontier, why_closed(frontier)));
    } else if (orders_.is_forbidden(s.map, frontier.goal) || orders_.is_forbidden(s.map, frontier.middle)) {
      plan.frontiers_left.push_back(left_out(frontier, "forbidden"));
    } else if (looks_.is_let_be(s.now, s.map, frontier)) {
      s.waits = s.waits || looks_.is_resting(s.now, s.map, frontier);
      plan.frontiers_left.push_back(left_out(frontier, why_closed(frontier)));
    } else {
      s.frontiers.push_back(std::move(frontier));
    }
  }
  s.way.resize(std::ssize(s.members), std::ssize(s.frontiers));
  for (std::size_t r = 0; r < s.members.size(); ++r) {
    for (std::size_t f = 0; f < s.frontiers.size(); ++f) {
      s.way(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(f)) = s.travel[r](s.frontiers[f].goal);
    }
  }
  plan.frontiers = s.frontiers;
}

void Explorer::obey(Situation& s, TeamPlan& plan) const {
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    const Order* order = s.is_free[i] != 0 ? orders_.of(s.members[i].robot) : nullptr;
    if (order == nullptr) continue;
    s.waits = s.waits || order->kind == OrderKind::send || order->kind == OrderKind::pause;
    const ManifoldPoint point = order->kind == OrderKind::send   ? order->point
                                : order->kind == OrderKind::home ? s.members[i].home
                                                                 : here(s.members[i]);
    s.tell(plan, i, {{}, GoalKind::operator_, point, std::nullopt, "the operator's order", 0});
  }
}

void Explorer::spare_batteries(Situation& s, TeamPlan& plan) {
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    const TeamMember& member = s.members[i];
    const double way = s.travel[i](member.home);
    const double left = (member.battery - options_.battery_reserve) * options_.metres_per_charge;
    const bool was_recalled = std::find(recalled_.begin(), recalled_.end(), member.robot) != recalled_.end();
    if (std::isfinite(way) && left < 1.2 * way && !was_recalled) recalled_.push_back(member.robot);
    if (s.is_free[i] == 0 || (!was_recalled && !(std::isfinite(way) && left < 1.2 * way))) continue;
    s.tell(plan, i, {{}, GoalKind::home, member.home, std::nullopt, "low battery", 0});
  }
}

void Explorer::keep_meetings(Situation& s, TeamPlan& plan) const {
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    const Meeting* meeting = s.is_free[i] != 0 ? desk_.meeting_of(s.members[i].robot) : nullptr;
    if (meeting == nullptr) continue;
    s.waits = true;
    s.tell(plan, i, meeting->goal_of(s.members[i].robot));
  }
}

/// The map itself tells how the two places lie to each other, well enough.
bool Explorer::is_known(const Map& map, const Doubt& doubt) const {
  return map.island_of(doubt.a) == map.island_of(doubt.b) && finder_.edges().same_sheet(doubt.a, doubt.b);
}

void Explorer::arrange_meetings(Situation& s, TeamPlan& plan) {
  if (!options_.meet) return;
  // Anybody who can reach b's place stands for all: whether there is a place at all.
  const Travel to_b = [&](const ManifoldPoint& p) {
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t i = 0; i < s.members.size(); ++i) {
      if (std::isinf(least) && s.is_free[i] != 0) least = s.travel[i](p);
    }
    return least;
  };
  KnownFloor floor(s.map);
  // While there is other work each plan thinks of a few, in turn.
  int asked = s.frontiers.empty() ? std::numeric_limits<int>::min() : 0;
  for (std::size_t k = 0; k < s.doubts.size(); ++k) {
    const Doubt& doubt = s.doubts[(doubt_turn_ + k) % s.doubts.size()];
    s.waits = s.waits || desk_.is_resting(s.now, doubt);
    if (std::count(s.is_free.begin(), s.is_free.end(), 1) < 2 || asked >= options_.doubts_a_plan) continue;
    if (is_known(s.map, doubt) || !desk_.is_open(s.now, s.map, doubt)) continue;
    ++asked;
    const std::optional<Posts> posts = find_posts(s.map, doubt, to_b, options_.rendezvous);
    if (!posts || posts->chance < options_.rendezvous.sure) continue;
    const std::optional<Pairing> pair = choose_pair(*posts, doubt, s.travel, s.is_free);
    if (!pair) continue;
    const double likelihood = likelihood_of(s.map, doubt, s.doubts, desk_, meetings_);
    const TeamAtWork team{s.frontiers, s.way};
    if (!is_worth_meeting(s.map, doubt, likelihood, *pair, team, floor, options_.meeting_worth)) continue;
    desk_.begin(s.now, s.map, doubt, *posts, *pair, s.members);
    keep_meetings(s, plan);
  }
  doubt_turn_ += static_cast<std::size_t>(options_.doubts_a_plan);
}

void Explorer::cross_gaps(Situation& s, const Neighbours& neighbours, TeamPlan& plan) {
  if (!options_.revisit) return;
  std::vector<double> range;
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    const double home = s.travel[i](s.members[i].home);
    const double left = (s.members[i].battery - options_.battery_reserve) * options_.metres_per_charge / 1.2;
    range.push_back(s.is_free[i] == 0 ? -1 : left - (std::isfinite(home) ? home : 0));
  }
  gaps_.step(s.now, s.map, neighbours, s.members, s.travel, range, !s.frontiers.empty() || s.waits);
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    const std::optional<Goal> goal = s.is_free[i] != 0 ? gaps_.goal_of(s.members[i].robot) : std::nullopt;
    if (goal) s.tell(plan, i, *goal);
  }
}

void Explorer::assign(Situation& s, TeamPlan& plan) {
  Choice going(s.members.size());
  for (std::size_t r = 0; r < s.members.size(); ++r) {
    const ManifoldPoint* middle = looks_.going_to(s.members[r].robot);
    double nearest = options_.looks.same;
    for (std::size_t f = 0; middle != nullptr && f < s.frontiers.size(); ++f) {
      if (s.map.island_of(middle->patch) != s.frontiers[f].island) continue;
      const double apart = (project(s.map, *middle) - project(s.map, s.frontiers[f].middle)).norm();
      if (apart > nearest) continue;
      nearest = apart;
      going[r] = f;
    }
  }
  const Eigen::MatrixXd way_of_free = ways_of_free(s.way, s.is_free);
  const Choice chosen = options_.coordinated ? assign_frontiers(s.frontiers, way_of_free, going, options_.assignment)
                                             : nearest_frontiers(way_of_free);
  for (std::size_t r = 0; r < chosen.size(); ++r) {
    if (!chosen[r]) {
      looks_.note_not_going(s.members[r].robot);
      continue;
    }
    const Frontier& frontier = s.frontiers[*chosen[r]];
    const double way = s.way(static_cast<Eigen::Index>(r), static_cast<Eigen::Index>(*chosen[r]));
    looks_.note_going(s.now, s.map, s.members[r].robot, frontier, way);
    s.tell(plan, r,
           {{},
            GoalKind::frontier,
            frontier.goal,
            frontier.heading_patch,
            fmt::format("{:.1f} m2 to see over an edge of {:.1f} m", frontier.gain_m2, frontier.length),
            0});
  }
}

void Explorer::go_home(Situation& s, TeamPlan& plan) {
  if (!s.frontiers.empty() || s.waits) return;
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    if (s.is_free[i] == 0) continue;
    const double way = s.travel[i](s.members[i].home);
    s.stranded = s.stranded || !std::isfinite(way);
    if (std::isfinite(way) && way > options_.at_home) s.ways_home += way;
    s.tell(plan, i, {{}, GoalKind::home, s.members[i].home, std::nullopt, "nothing is left to look at", 0});
  }
}

void Explorer::conclude(Situation& s, TeamPlan& plan) {
  const auto explores = [](const Goal& g) {
    return g.kind == GoalKind::frontier || g.kind == GoalKind::rendezvous || g.kind == GoalKind::revisit;
  };
  const bool works = s.waits || std::any_of(plan.goals.begin(), plan.goals.end(), explores);
  if (works) {
    nearest_home_at_ = -1;
    plan.reason = fmt::format("{} frontiers to look at", s.frontiers.size());
    return;
  }
  // Those who were called home by batteries or by the operator count, too.
  for (std::size_t i = 0; i < s.members.size(); ++i) {
    const bool recalled = plan.goals[i].kind == GoalKind::home && plan.goals[i].reason == "low battery";
    const double way = recalled ? s.travel[i](s.members[i].home) : 0;
    if (std::isfinite(way) && way > options_.at_home) s.ways_home += way;
  }
  if (nearest_home_at_ < 0 || s.ways_home < nearest_home_ - 0.5) {
    nearest_home_ = s.ways_home;
    nearest_home_at_ = s.now;
  }
  const bool all_home = s.ways_home <= 0 && !s.stranded;
  plan.finished = all_home || s.now - nearest_home_at_ > options_.farewell;
  plan.end_state = !s.frontiers.empty() ? EndState::stopped : plan.finished ? EndState::explored : EndState::returning;
  plan.reason = s.frontiers.empty() ? "no frontier is left that a robot can look at"
                                    : fmt::format("{} frontiers are left, and nobody to look", s.frontiers.size());
  if (!plan.frontiers_left.empty()) {
    plan.reason += fmt::format("; {} not looked at: {}", plan.frontiers_left.size(), summary_of(plan.frontiers_left));
  }
  plan.reason += gaps_.left_in_words();
  if (plan.finished && !all_home) plan.reason += "; not everybody got home";
}

}  // namespace helicoid
