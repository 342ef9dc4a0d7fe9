// The team's plan (paper V, VI): where each robot should go next, until all that can be reached is known.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/exploration/frontiers.hpp"
#include "helicoid/exploration/look_memory.hpp"
#include "helicoid/exploration/loop_gap.hpp"
#include "helicoid/exploration/meeting_worth.hpp"
#include "helicoid/exploration/orders.hpp"
#include "helicoid/exploration/rendezvous.hpp"
#include "helicoid/exploration/team.hpp"
#include "helicoid/exploration/team_assignment.hpp"

namespace helicoid {

struct ExplorerOptions {
  FrontierOptions frontiers;
  AssignmentOptions assignment;
  LookMemoryOptions looks;
  RendezvousOptions rendezvous;
  MeetingWorthOptions meeting_worth;
  LoopGapOptions loop_gaps;
  bool coordinated = true;          ///< false: each robot goes to its nearest frontier, whatever the others do
  bool meet = true;                 ///< doubts are settled by rendezvous
  bool revisit = true;              ///< loops that only a long way round closes are closed before the team goes home
  int doubts_a_plan = 4;            ///< that a meeting is thought of for
  double metres_per_charge = 2000;  ///< a full battery drives so far
  double battery_reserve = 0.10;    ///< of a charge, left when a robot is home
  double at_home = 0.5;             ///< a robot this near to its home is there, metres
  double farewell = 60;             ///< a plan that has said "home" for so long without anyone getting nearer ends, s
};

/// A frontier that is not looked at, and why.
struct FrontierLeft {
  IslandId island;
  ManifoldPoint middle;
  double length = 0;  ///< metres
  double gain_m2 = 0;
  std::string reason;  ///< "opening of 0.31 m", ...
};

enum class EndState : std::uint8_t {
  exploring,  ///< not the end
  returning,  ///< nothing is left to be done but to drive home
  explored,   ///< all that can be reached is known; everybody who can is home
  stopped,    ///< the operator's orders or batteries leave nobody to explore what is left
};
[[nodiscard]] const char* name_of(EndState state);

struct TeamPlan {
  std::vector<Goal> goals;  ///< of each member, in their order
  EndState end_state = EndState::exploring;
  bool finished = false;
  std::string reason;  ///< of the end state, in words
  std::vector<FrontierLeft> frontiers_left;
  std::vector<Frontier> frontiers;  ///< all that are open, for pictures
  std::vector<Settled> settled;     ///< doubts, since the last plan
};

class Explorer {
 public:
  explicit Explorer(const ExplorerOptions& options = {});

  /// About once a second. `travel`: how far each member has to everywhere, by member. `doubts`: those that are open;
  /// `orders`: those given since the last plan.
  TeamPlan plan(double now, const Map& map, const Neighbours& neighbours, std::span<const Travel> travel,
                std::span<const TeamMember> members, std::span<const Doubt> doubts, std::span<const Order> orders);
  /// One robot saw another: for meetings.
  void saw(const SeenTeammate& sighting) { desk_.saw(sighting); }

 private:
  struct Situation;
  void sort_out_frontiers(Situation& s, const Neighbours& neighbours, TeamPlan& plan);
  void obey(Situation& s, TeamPlan& plan) const;
  void spare_batteries(Situation& s, TeamPlan& plan);
  void keep_meetings(Situation& s, TeamPlan& plan) const;
  void arrange_meetings(Situation& s, TeamPlan& plan);
  [[nodiscard]] bool is_known(const Map& map, const Doubt& doubt) const;
  void cross_gaps(Situation& s, const Neighbours& neighbours, TeamPlan& plan);
  void assign(Situation& s, TeamPlan& plan);
  void go_home(Situation& s, TeamPlan& plan);
  void conclude(Situation& s, TeamPlan& plan);

  ExplorerOptions options_;
  FrontierFinder finder_;
  OrderBook orders_;
  LookMemory looks_;
  RendezvousDesk desk_;
  MeetingRecord meetings_;
  LoopGapDesk gaps_;
  std::size_t doubt_turn_ = 0;     ///< where the next plan begins to think of doubts
  std::vector<RobotId> recalled_;  ///< their batteries were low
  double nearest_home_ = 0;        ///< the sum of the ways home, at its least since returning
  double nearest_home_at_ = -1;    ///< when; below 0: not returning
};

}  // namespace helicoid
