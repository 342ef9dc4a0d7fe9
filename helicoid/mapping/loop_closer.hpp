// Decides when a robot has come back (paper IV-B, lazily; design 5.6): keeps the ledger and accepts what agrees.
#pragma once

#include <map>

#include "helicoid/mapping/look_alike.hpp"

namespace helicoid {

/// The entry agreed with others, but all that was mapped spoke against them together. It supports no other any more: to
/// be looked at once more takes as many new ones.
[[nodiscard]] inline bool is_left_open(const Hypothesis& h) {
  return h.state == HypothesisState::open && h.decided_by == DecidedBy::evidence;
}

struct LoopCloserOptions {
  LookAlikeOptions look_alike;
  double search_spacing = 2;         ///< a robot looks for look-alikes this often along its way, metres
  double spacing_again = 8;          ///< the same when all of its way is looked at once more
  std::size_t candidates_again = 1;  ///< places that a patch is then compared with
  double reach_again = 8;            ///< how far off these may be, metres: two robots may each have come that near
  double consistent = 11.345;        ///< chi^2 of a cycle of two hypotheses: 99 % at three degrees of freedom
  std::size_t memory = 60;           ///< entries back that may support a new one
  std::size_t least_agreeing = 3;    ///< hypotheses of different patches that must agree
  double least_way = 2;              ///< the robot's way over which they must extend, metres
  std::size_t least_agreeing_islands = 5;
  double least_way_islands = 8;
  double most_ambiguous = 0.9;  ///< some must be clearer than this:
  std::size_t least_clear = 2;  ///< so many
  /// Together: share of the points that stand in what the other passage saw as free. Furniture that was moved
  /// contradicts a place here and there, a building that merely looks alike nearly everywhere.
  double most_contradicted = 0.015;
  double most_contradicted_one = 0.05;  ///< of any one of them: it speaks for no other
  double outvotes = 1.5;  ///< they weigh this many times as much as any others that cannot be true together with them
  /// However many agree, places do not lie where the map rules it out: chi^2 against its exact word (eq. 9), deviations
  /// times look_alike.drift_inflation, 99.99 % at three degrees of freedom; and by more than this, metres. Aisle after
  /// aisle of a store looks alike, and places that all lie one aisle off agree with one another.
  double ruled_out = 21.108;
  double ruled_out_from = 0.6;
};

class LoopCloser {
 public:
  explicit LoopCloser(const MapperOptions& mapper, const LoopCloserOptions& options = {})
      : mapper_(mapper), options_(options) {}

  /// To be called for every patch that was kept, its relations in the map; `known`: the local map that it was matched
  /// with. The places in the ledger of the entries that are accepted now.
  std::vector<std::size_t> observe(const Map& map, const InformationGraph& graph, PatchId b, const LocalMap& known);

  /// A look-alike between two islands, which may lie on a different floor: more must agree, over a longer way. The
  /// entries that are accepted now; none unless `may_join`.
  std::vector<std::size_t> consider_between(const Map& map, const InformationGraph& graph, Hypothesis found,
                                            bool may_join);

  /// A look-alike of one island that was found elsewhere. The entries that are accepted now.
  std::vector<std::size_t> consider_within(const Map& map, const InformationGraph& graph, Hypothesis found);

  /// Lets every patch be looked at once more, from the first on.
  void start_again(const Map& map);
  /// True if the robot has gone on far enough since the last search for one more at this patch.
  [[nodiscard]] bool is_due_again(const Map& map, PatchId b) const;
  [[nodiscard]] double reach_again() const { return options_.reach_again; }
  /// The same search for one that is due again.
  std::vector<std::size_t> observe_again(const Map& map, const InformationGraph& graph, PatchId b,
                                         const LocalMap& known);

  /// A decision that is made during the run: for entries to come and for those that nobody has decided yet. The entries
  /// that it accepts.
  std::vector<std::size_t> decide(const Map& map, const Decision& decision);

  void record(Hypothesis entry) { ledger_.push_back(std::move(entry)); }
  /// Decides about an entry that was recorded.
  void revise(std::size_t entry, Hypothesis now) { ledger_[entry] = std::move(now); }
  [[nodiscard]] const Ledger& ledger() const { return ledger_; }
  /// How far along its robot's way each patch was kept, metres: up to the last patch that was observed or followed.
  [[nodiscard]] std::span<const double> along() const { return along_; }
  /// Brings it up to the map's last patch.
  void follow_ways(const Map& map);

 private:
  std::vector<std::size_t> look_about(const Map& map, const InformationGraph& graph, PatchId b, const LocalMap& known,
                                      const LookAlikeOptions& options);
  /// Of which it is asked how they lie to b: its possible candidates, and what earlier entries compared with those.
  [[nodiscard]] std::vector<std::uint32_t> poses_in_question(const Map& map, PatchId b,
                                                             std::span<const PatchId> possible,
                                                             const LookAlikeOptions& options) const;
  /// How many entries of different patches must agree, and over what way of the robot, metres.
  struct Quorum {
    std::size_t agreeing;
    double way;
  };
  static constexpr Quorum kForetold{1, 0};
  /// Enters it; those that are accepted now.
  std::vector<std::size_t> enter(const Map& map, const InformationGraph& graph, std::span<const BoundedPose> about_b,
                                 Hypothesis found, const Quorum& quorum);
  /// Places that one patch may lie at, and that cannot all be right, make one another ambiguous.
  void compare_with_one_another(const Map& map, const InformationGraph& graph, std::vector<Hypothesis>& found) const;
  void compare_with_earlier(const Map& map, const InformationGraph& graph, std::span<const BoundedPose> about_b,
                            std::size_t entry);
  /// True if the operator has decided about it, or about one that says the same.
  bool follow_operator(const Map& map, std::size_t entry);
  void withhold_with(std::size_t entry, std::size_t decided);
  /// Little enough speaks against it.
  [[nodiscard]] bool is_sound(std::size_t entry) const;
  /// Those that speak for this entry, itself the last, and that can all be true together; those that were accepted
  /// before them. Empty if it cannot be true with one that was.
  [[nodiscard]] std::vector<std::size_t> true_together_with(std::size_t entry) const;
  /// Those from which there is a telling.
  [[nodiscard]] std::vector<std::size_t> clear_of(const std::vector<std::size_t>& entries) const;
  [[nodiscard]] bool is_quorate(const std::vector<std::size_t>& entries, const Quorum& quorum) const;
  [[nodiscard]] bool is_enough(const std::vector<std::size_t>& agreeing, const Quorum& quorum) const;
  /// Those of them that the map rules out are left open. True if there are any.
  bool leave_what_map_rules_out(const Map& map, const std::vector<std::size_t>& agreeing);
  [[nodiscard]] double way_since_search(const Map& map, PatchId b) const;
  std::vector<std::size_t> accept(const std::vector<std::size_t>& agreeing);

  MapperOptions mapper_;
  LoopCloserOptions options_;
  Ledger ledger_;
  std::map<std::size_t, std::string> told_apart_;  ///< by entry: what rules out its second-best placement, in words
  std::vector<double> along_;
  std::vector<PatchId> last_of_robot_;
  std::vector<double> searched_at_;  ///< by robot, along its way
};

}  // namespace helicoid
