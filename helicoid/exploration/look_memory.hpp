// What became of the looks that were taken, so that exploring ends: a frontier that a robot has stood before and that
// shows nothing new, or that nobody gets to, is let be.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/exploration/frontiers.hpp"
#include "helicoid/exploration/team.hpp"

namespace helicoid {

struct LookMemoryOptions {
  double arrived = 0.5;    ///< a robot this near to its goal is there, metres
  double look_time = 4;    ///< after standing there this long it has looked, seconds
  double advanced = 0.3;   ///< an edge that has moved by this since is another one to look at, metres
  double more_gain = 1.0;  ///< one that shows this much more than after the last look is looked at again, m2
  double same = 0.8;       ///< edges whose middles are this near are one, metres
  double slowest = 0.15;   ///< a robot that is slower on its way than this has met something, metres a second
  double patience = 20;    ///< that it is given besides, seconds
  double stalled = 30;     ///< nor does one get there that has come no nearer for so long, seconds
  double nearer = 0.5;     ///< metres that count as nearer
  double detour = 3.0;     ///< a way that has become so much longer is another one, metres
  double rest = 45;        ///< a frontier that nobody got to is tried again after this, seconds
  int most_tries = 3;      ///< and so often at most
};

class LookMemory {
 public:
  explicit LookMemory(const LookMemoryOptions& options = {}) : options_(options) {}

  /// A robot is on its way to a frontier; `way`: metres left. Called at every plan.
  void note_going(double now, const Map& map, RobotId robot, const Frontier& frontier, double way);
  /// It is told something else.
  void note_not_going(RobotId robot);

  /// True if the frontier need not be looked at (any more, or for now).
  [[nodiscard]] bool is_let_be(double now, const Map& map, const Frontier& frontier) const;
  /// True if it will be tried again later.
  [[nodiscard]] bool is_resting(double now, const Map& map, const Frontier& frontier) const;
  /// True if the two are one edge.
  [[nodiscard]] bool is_same(const Map& map, const ManifoldPoint& middle, const ManifoldPoint& other) const;
  /// The frontier that a robot is on its way to; null: none.
  [[nodiscard]] const ManifoldPoint* going_to(RobotId robot) const;

 private:
  struct Going {
    RobotId robot;
    ManifoldPoint middle;
    double deadline = 0;
    double least_way = 0;        ///< metres
    double nearer_since = 0;     ///< when it last came nearer
    double there_since = -1;     ///< below 0: not there yet
    ManifoldPoint middle_there;  ///< of the edge when the robot got there
  };
  struct Verdict {
    ManifoldPoint middle;
    int looks = 0;
    double gain_m2 = 0;  ///< after the last look
    int failures = 0;
    double rests_until = 0;
  };
  Going* going(RobotId robot);
  Verdict& verdict_on(const Map& map, const ManifoldPoint& middle);
  [[nodiscard]] const Verdict* find_verdict(const Map& map, const ManifoldPoint& middle) const;

  LookMemoryOptions options_;
  std::vector<Going> going_;
  std::vector<Verdict> verdicts_;
};

}  // namespace helicoid
