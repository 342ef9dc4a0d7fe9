// Planned rendezvous (paper I, VI; design 5.6): a pair of robots goes to stand at two places that may be one. If they
// see each other, they are; if both were surely there and did not, they are not.
#pragma once

#include <optional>
#include <span>
#include <vector>

#include "helicoid/exploration/sighting_chance.hpp"
#include "helicoid/exploration/team.hpp"
#include "helicoid/exploration/travel.hpp"

namespace helicoid {

struct RendezvousOptions {
  SightingModel sighting;
  StandingNoise standing;
  double sure = 0.95;        ///< absence counts when a sighting was at least as likely as this
  double at_post = 0.50;     ///< a robot this near to its post stands there, metres
  double facing = 0.5;       ///< and looks where it should, to this, radians
  int least_looks = 4;       ///< that are waited for
  double range_error = 0.6;  ///< a sighting that is farther off what the doubt predicts is of another place, metres
  double patience = 20;      ///< beside the time for the way, before a meeting is given up, seconds
  double slowest = 0.20;     ///< metres a second
  double same = 1.0;         ///< the map has a doubt's places where that has them, to this, metres
  double alike = 3.0;        ///< doubts both of whose places are this near to another's ask the same, metres
  double rest = 60;          ///< before it is tried again, seconds
  int most_tries = 2;
};

/// Where the two stand, on a patch each.
struct Posts {
  Pose2 T_a_watcher;  ///< on Doubt::a
  Pose2 T_b_shown;    ///< on Doubt::b
  double chance = 0;  ///< view_chance there
};
/// The watcher stands where patch a was taken; the other where it would be in full view, a few metres ahead, on floor
/// of patch b for which `can_stand` holds. None if there is no such place.
[[nodiscard]] std::optional<Posts> find_posts(const Map& map, const Doubt& doubt, const Travel& to_b,
                                              const RendezvousOptions& options = {});

enum class MeetingOutcome : std::uint8_t { met, absent };

/// What a meeting said about a doubt.
struct Settled {
  std::size_t doubt = 0;
  MeetingOutcome outcome = MeetingOutcome::absent;
  RobotId watcher, shown;
  double chance = 0;       ///< of a sighting, if the places were one
  bool by_chance = false;  ///< islands were joined meanwhile, and neither of the two had part in it
  std::string reason;
};

/// One pair of robots on its way to a doubt's two places, or there.
struct Meeting {
  Doubt doubt;
  Posts posts;
  std::size_t watcher = 0, shown = 0;  ///< places in the list of members
  RobotId watcher_robot, shown_robot;
  double deadline = 0;
  double there_since = -1;        ///< both at their posts; below 0: not yet
  bool sighted = false;           ///< by one another, at their posts
  bool brought_together = false;  ///< one of them and a robot of another island saw each other, anywhere
  bool between_islands = false;   ///< when it began

  [[nodiscard]] bool has(RobotId robot) const { return robot == watcher_robot || robot == shown_robot; }
  [[nodiscard]] Goal goal_of(RobotId robot) const;
};

/// The pair for which the longer of the two ways is shortest; none if no two robots can get there. `travel` by member.
struct Pairing {
  std::size_t watcher = 0, shown = 0;
  double longest = 0;  ///< the longer way, metres
};
[[nodiscard]] std::optional<Pairing> choose_pair(const Posts& posts, const Doubt& doubt, std::span<const Travel> travel,
                                                 std::span<const std::uint8_t> is_free);

/// What one sighting is to a meeting.
struct SeenTeammate {
  double stamp = 0;
  RobotId observer, observed;
  std::optional<double> range;   ///< metres
  bool between_islands = false;  ///< the two were on different ones
};

class RendezvousDesk {
 public:
  explicit RendezvousDesk(const RendezvousOptions& options = {}) : options_(options) {}

  /// One robot saw another.
  void saw(const SeenTeammate& sighting);
  /// Sends a pair; its members are told by goal_of until the meeting ends.
  void begin(double now, const Map& map, const Doubt& doubt, const Posts& posts, const Pairing& pair,
             std::span<const TeamMember> members);
  /// Looks after the meetings: what has been settled since the last call. `doubts`: all that are open, which those are
  /// not that the map contradicts or has taken; meetings about others are ended, and settled if the map has come to
  /// have their two places as one.
  std::vector<Settled> step(double now, const Map& map, std::span<const TeamMember> members,
                            std::span<const Travel> travel, std::span<const Doubt> doubts);

  [[nodiscard]] const std::vector<Meeting>& meetings() const { return meetings_; }
  [[nodiscard]] const Meeting* meeting_of(RobotId robot) const;
  /// True if a doubt may be asked about: neither it nor one that asks the same has been settled, nor given up, and
  /// nobody is on the way to it.
  [[nodiscard]] bool is_open(double now, const Map& map, const Doubt& doubt) const;
  /// True if it will be tried again.
  [[nodiscard]] bool is_resting(double now, const Doubt& doubt) const;

  /// True if one answer is that to both: they are about the same places, or would join two islands alike.
  [[nodiscard]] bool asks_the_same(const Map& map, const Doubt& a, const Doubt& b) const;

 private:
  struct Past {
    Doubt doubt;
    bool settled = false;
    int failures = 0;
    double rests_until = 0;
  };
  [[nodiscard]] bool stand_there(const Meeting& meeting, const Map& map, std::span<const TeamMember> members,
                                 std::span<const Travel> travel) const;
  [[nodiscard]] std::optional<Settled> judge(double now, const Map& map, Meeting& meeting,
                                             std::span<const TeamMember> members) const;
  Past& past_of(const Doubt& doubt);

  RendezvousOptions options_;
  std::vector<Meeting> meetings_;
  std::vector<Past> past_;
};

}  // namespace helicoid
