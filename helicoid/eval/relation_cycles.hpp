// How well known relations agree with one another: an estimate of their own noise that no map has a part in.
#pragma once

#include <span>

#include "helicoid/eval/coverage.hpp"
#include "helicoid/eval/relation_error.hpp"

namespace helicoid {

/// Relations a-b, b-c and c-a lead back to where they began, but for their noise.
struct CycleClosure {
  Coverage coverage;  ///< of the way round, against nothing moved: each relation has the stated noise
  /// By what the stated standard deviations have to be multiplied to explain the cycles (the square root of the
  /// variance of unit weight). A noise that belongs to a scan and not to a relation cancels: this is a lower bound.
  double noise_factor = 0;
};

/// All cycles of three relations whose ends have the same robots and stamps (to 1e-4 s), each once. `noise` is of one
/// relation's (x, y, yaw), in the frame of its first end.
[[nodiscard]] CycleClosure close_cycles(std::span<const EvaluatedRelation> relations, const Matrix3d& noise);

}  // namespace helicoid
