// Maps what robots report, decides where they go and steers them there: all that a team without an operator needs.
#pragma once

#include <cmath>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "apps/explore_journal.hpp"
#include "helicoid/exploration/explorer.hpp"
#include "helicoid/mapping/mapper.hpp"
#include "helicoid/navigation/distance_field.hpp"
#include "helicoid/navigation/driven_neighbours.hpp"
#include "helicoid/navigation/kept_way.hpp"
#include "helicoid/navigation/plan_route.hpp"
#include "helicoid/navigation/route_follower.hpp"
#include "helicoid/sensor/drive_command.hpp"

namespace helicoid {

struct PilotOptions {
  MapperOptions mapper;
  NavigationOptions navigation;
  FollowerOptions follower;
  ExplorerOptions explorer;
  double route_period = 4;     ///< a route is planned anew this often: more is known by then, seconds
  double closed_for = 15;      ///< where a robot was blocked no other way leads through for so long, seconds
  double closed_radius = 0.4;  ///< metres
  double in_the_way = 0.8;     ///< a robot this near to where another one is blocked is what blocks it, metres
  double aside_for = 20;       ///< a robot that made room stays there for so long, seconds
  double propose_period = 10;  ///< islands are compared with one another this often, seconds
  /// What looks alike is taken for the same place at once, and nobody goes to see: an experiment's baseline.
  bool greedy = false;
};

/// Where CPU time went, seconds of this thread.
struct PilotTimes {
  double map_s = 0;    ///< the mapper
  double floor_s = 0;  ///< neighbours, floors, distances
  double plan_s = 0;   ///< who goes where, by which way
  double steer_s = 0;
};

class TeamPilot {
 public:
  /// Who else may decide where robots go: an experiment's baseline. Asked instead of the explorer.
  using Planner = std::function<TeamPlan(double now, const Map&, const Neighbours&, std::span<const Travel>,
                                         std::span<const TeamMember>)>;

  /// All robots of the team, and those of them (by number) that this pilot steers.
  TeamPilot(const PilotOptions& options, std::span<const std::string> names, const LaserModel& laser,
            std::vector<std::size_t> steered, Planner planner = {});
  ~TeamPilot();
  TeamPilot(TeamPilot&&) noexcept;
  TeamPilot& operator=(TeamPilot&&) noexcept;

  /// The next event of a robot, in its own order.
  void take(const Event& event);
  /// Thinks over where everybody goes; about once a second of the robots' clocks.
  void plan(double now, std::span<const Order> orders = {});
  /// What a robot is to do next; after each of its scans. `dt`: seconds since the last one.
  [[nodiscard]] DriveCommand steer(std::size_t robot, double now, double dt);
  /// A robot that cannot be told anything for now, or ever again: what it mapped stays.
  void set_reachable(std::size_t robot, bool reachable);
  /// 1 full, 0 empty.
  void set_battery(std::size_t robot, double battery);

  [[nodiscard]] const Map& map() const { return mapper_.map(); }
  [[nodiscard]] const Mapper& mapper() const { return mapper_; }
  [[nodiscard]] const TeamPlan& team_plan() const { return plan_; }
  [[nodiscard]] const ExploreJournal& journal() const { return journal_; }
  [[nodiscard]] const PilotTimes& times() const { return times_; }
  [[nodiscard]] std::size_t merges() const { return merges_; }
  /// The map, when all is over; the pilot is of no use afterwards.
  [[nodiscard]] Mapper release_mapper() { return std::move(mapper_); }

 private:
  struct Member;
  [[nodiscard]] Member* member(RobotId robot);
  [[nodiscard]] const std::string& name(RobotId robot) const { return map().robot(robot).name; }
  void tell_of(const Event& event, const Sighting& sighting);
  void note_islands(double now);
  void note_closures(double now);
  [[nodiscard]] std::vector<Doubt> open_doubts() const;
  void compare_islands(double now);
  void settle(double now, const Settled& settled);
  void direct(Member& member, const Goal& goal, double now);
  /// A robot that `goes_on` to where it was going keeps its way unless the new one is better.
  void find_way(Member& member, double now, bool goes_on);
  [[nodiscard]] bool is_let_pass(const Member& blocked, const ManifoldPoint& obstruction, double now);

  PilotOptions options_;
  LaserModel laser_;
  Mapper mapper_;
  Explorer explorer_;
  Planner planner_;
  DrivenNeighbours driven_;
  std::optional<NavigableMap> floor_;
  std::vector<ForbiddenFloor> forbidden_;
  std::vector<Member> members_;  ///< those on the map, in the order in which they came
  std::vector<std::size_t> steered_;
  TeamPlan plan_;
  ExploreJournal journal_;
  PilotTimes times_;
  std::size_t merges_ = 0, closures_ = 0;
  double proposed_at_ = -HUGE_VAL;
};

}  // namespace helicoid
