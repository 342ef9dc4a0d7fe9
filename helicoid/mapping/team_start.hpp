// Where a team's fit begins: nobody knows where the robots started, nor where landmarks stand.
#pragma once

#include <functional>
#include <vector>

#include "helicoid/mapping/team_graph.hpp"

namespace helicoid {

struct TeamStartOptions {
  double step = 10;      ///< seconds of all robots' logs that are taken in at a time
  double recent = 60;    ///< what was measured so many seconds ago still tells how islands lie to each other
  double growth = 1.25;  ///< what lies farther back than that is fitted again each time the log is so much longer
};

struct TeamStart {
  std::vector<Pose2> poses;              ///< of every node, in its island's plane
  std::vector<std::uint32_t> island_of;  ///< by node; islands are numbered from 0
  std::uint32_t islands = 0;
};

/// The robots' logs are taken in step by step, in order of time: each robot begins on an island of its own, landmarks
/// are placed by whom sees them, and islands are joined (IV-C: rigid alignment first) as soon as things that two of
/// them have in common determine how they lie. What was taken in is fitted before the next step: most often the
/// recent part alone, so that a log twice as long takes twice the time.
[[nodiscard]] TeamStart start_team(const TeamNodes& nodes, const TeamGraph& team, const TeamStartOptions& options = {},
                                   const std::function<void(double)>& progress = {});

}  // namespace helicoid
