// One map from its command line to its files: for `map`, and for `ledger`, which maps the same logs anew.
#pragma once

#include <string>
#include <vector>

#include "helicoid/mapping/decision.hpp"

namespace helicoid {

/// As the command line of `map` has it (contract: *helicoid map*).
struct MapArguments {
  std::vector<std::string> logs;
  std::vector<std::string> named;
  std::string out;
  std::string laser;
  std::string join = "sightings";
  std::string decisions_file;
  std::vector<Decision> decisions;  ///< if no file is named
  std::size_t every = 1;
  double from = 0;
  double to = 1e300;
  int threads = 1;
  bool no_charts = false;
  bool no_closures = false;
  bool online = false;
  bool force = false;
  bool json = false;
};

/// Maps, writes and reports; the exit code.
[[nodiscard]] int run_map_command(const MapArguments& a);

}  // namespace helicoid
