// Look-alikes that another program reports: each is held against the scans before it may agree with others.
#pragma once

#include <vector>

#include "helicoid/mapping/loop_closer.hpp"
#include "helicoid/mapping/map_in_progress.hpp"

namespace helicoid {

class ReportedPlaces {
 public:
  /// The robot says that it stood, at this time, where `there` stood at another.
  void add(RobotId robot, RobotId there, double stamp, const Lookalike& alike);

  /// To be called after every scan: enters what can be placed now into the ledger, and acts on what is accepted.
  /// Between islands nothing is accepted without `options.join_on_evidence` or an operator. True if the map has
  /// changed.
  bool take_placed(MapInProgress& progress, LoopCloser& closer, bool last, const MapperOptions& options);

  /// Of robots that were nowhere at that time.
  [[nodiscard]] std::size_t waiting() const { return waiting_.size(); }

 private:
  struct Waiting {
    RobotId robot, there;
    double stamp = 0;
    Lookalike alike;
  };
  std::vector<Waiting> waiting_;
};

}  // namespace helicoid
