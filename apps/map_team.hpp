// helicoid map of a team without lasers.
#pragma once

#include <string>

namespace helicoid {

struct TeamMapArguments {
  std::string folder;  ///< of the MRCLAM collection's form
  std::string out;
  bool no_charts = false;
  bool force = false;
  bool json = false;
};

/// Estimates, writes and prints; returns the exit code.
int map_team(const TeamMapArguments& arguments);

}  // namespace helicoid
