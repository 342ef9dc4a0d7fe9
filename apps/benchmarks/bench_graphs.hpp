// The graphs that the fit's benchmarks share.
#pragma once

#include <string>

#include "apps/bench.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

/// A path to and fro over a square grid, a metre a step, with a relation to the neighbour in the row before.
[[nodiscard]] GraphFile make_grid(std::uint32_t side);

[[nodiscard]] bool is_recorded(const std::string& name, const BenchOptions& options);
/// A recorded graph at its start: the file's, or dead reckoning.
[[nodiscard]] Result<GraphFile> read_recorded(const std::string& name, const BenchOptions& options);

}  // namespace helicoid
