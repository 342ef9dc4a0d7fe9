// Active loop closing (Stachniss, Haehnel and Burgard 2004): where two parts of the manifold lie over one another in
// the plane though only a long way round relates them, a robot that drives across gives the mapper what closes the
// loop.
#pragma once

#include <optional>
#include <span>
#include <string>
#include <vector>

#include "helicoid/exploration/team.hpp"
#include "helicoid/exploration/travel.hpp"
#include "helicoid/manifold/neighbours.hpp"

namespace helicoid {

/// Two patches that see the same floor and are not known well enough relative to one another to be on one sheet.
struct LoopGap {
  PatchId from, beyond;
  ManifoldPoint goal;        ///< in `from`: where the patch beyond was taken, or as near as `from` shows floor
  double heading_patch = 0;  ///< to turn to there: as the patch beyond looks, radians, in `from`
  double known_to = 0;       ///< how they lie to one another, 95 %, metres
  double way_round = 0;      ///< from relation to relation, metres
};

/// Lengths in metres.
struct LoopGapOptions {
  double near = 10;             ///< that the two patches lie to one another in the plane
  double least_way_round = 20;  ///< what is tied over less is one sheet
  double times_round = 3;       ///< and over less than so many times as far as they lie apart
  /// Known to less than this nobody can say that they see the same floor.
  NeighbourOptions overlap{2.0, 0.5};
  double depth = 0.4;  ///< before what either sees behind it: a thin wall's two sides are no common floor
  /// By expected gain: a robot drives so far to have a place known better by a metre.
  double drive_per_metre = 500;
  double same = 4;             ///< gaps whose middles lie this near are one
  double arrived = 0.5;        ///< a robot this near to the goal is there
  double look_time = 4;        ///< that it then looks, seconds
  double slowest = 0.15;       ///< a robot that is slower on its way than this has met something, metres a second
  double patience = 20;        ///< that it is given besides, seconds
  std::size_t most_tries = 2;  ///< of one place
};

/// The map's gaps, either way across, by `from` and `beyond`.
[[nodiscard]] std::vector<LoopGap> find_loop_gaps(const Map& map, const Neighbours& neighbours,
                                                  const LoopGapOptions& options = {});

/// Who drives across which gap, and what came of it.
class LoopGapDesk {
 public:
  explicit LoopGapDesk(const LoopGapOptions& options = {}) : options_(options) {}

  /// `range`: how far each member may drive besides its way home, metres; below 0: it is not to be told anything.
  /// Nobody is sent while there is other work; who is on the way goes on.
  void step(double now, const Map& map, const Neighbours& neighbours, std::span<const TeamMember> members,
            std::span<const Travel> travel, std::span<const double> range, bool other_work);

  /// Where a robot is to go; nothing: it is not needed.
  [[nodiscard]] std::optional<Goal> goal_of(RobotId robot) const;
  /// The places that are left as they are, as of the last step, in words, to be added to a sentence; empty: none.
  [[nodiscard]] std::string left_in_words() const;

 private:
  struct Crossing {
    RobotId robot;
    LoopGap gap;
    double deadline = 0;
    double there_since = -1;  ///< below 0: not there yet
  };
  void look_after(double now, std::span<const TeamMember> members, std::span<const Travel> travel,
                  std::span<const double> range);
  void send(double now, const Map& map, std::span<const TeamMember> members, std::span<const Travel> travel,
            std::span<const double> range);
  [[nodiscard]] bool is_same(const Map& map, const LoopGap& a, const LoopGap& b) const;
  [[nodiscard]] std::size_t tries_of(const Map& map, const LoopGap& gap) const;
  void note_left(const Map& map);

  LoopGapOptions options_;
  std::vector<LoopGap> gaps_;
  std::size_t patches_then_ = 0, relations_then_ = 0;  ///< when they were found
  std::vector<Crossing> crossings_;
  std::vector<LoopGap> tried_;
  std::vector<double> left_;  ///< by place, how well it is known, 95 %, metres
};

}  // namespace helicoid
