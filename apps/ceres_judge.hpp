// Ceres as a judge of fits: a program of its own that is built beside this one where Ceres is installed.
#pragma once

#include <string>
#include <vector>

#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

struct Judged {
  double cost = 0;  ///< sum of e^T Omega e
  double cpu_s = 0;
  int iterations = 0;
  std::vector<Pose2> poses;
};

/// A judge's program. Judges are built beside this program and not into it: what they link is under licences of its
/// own.
[[nodiscard]] std::string judge_beside(const std::string& program, const std::string& judge);
/// Why there is no judge; empty: there is one. `program`: the path of this program.
[[nodiscard]] std::string missing_judge(const std::string& program);
/// Fits the graph from its poses. Error: the judge could not be run, or not read what it was given.
[[nodiscard]] Result<Judged> judge(const GraphFile& file, const std::string& program);

/// The path of the program that is running.
[[nodiscard]] std::string this_program();

}  // namespace helicoid
