// Pose graphs of other programs: g2o's (VERTEX_SE2, VERTEX_XY, EDGE_SE2, EDGE_SE2_XY, EDGE_BEARING_SE2_XY,
// EDGE_PRIOR_SE2, FIX) and TORO's (VERTEX2, EDGE2), plain or gzipped, mixed as they come.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/fit/relation_graph.hpp"
#include "helicoid/io/skipped.hpp"

namespace helicoid {

struct GraphFile {
  std::vector<std::int64_t> ids;     ///< of the graph's nodes, ascending
  RelationGraph graph;               ///< nodes without a VERTEX line stand at the origin
  std::vector<bool> is_placed;       ///< had a VERTEX line
  std::vector<std::uint32_t> fixed;  ///< nodes of FIX lines
  bool is_toro = false;              ///< relations came as EDGE2
  std::vector<Skipped> skipped;
  std::string warning;  ///< of a damaged archive; empty if all is well
};

/// Lines that tell nothing usable are left out and counted: unknown kinds, numbers that are missing or not finite, a
/// vertex that was there before, a relation of a node with itself or between kinds that do not fit, an information that
/// is not positive semi-definite. Errors: cannot be read; holds no relation.
[[nodiscard]] Result<GraphFile> read_graph(const std::string& path);
[[nodiscard]] GraphFile parse_graph(const std::string& text, const std::string& name);

/// The file's graph with these poses: as TORO lines if it came so, as g2o otherwise. Lengths to the nanometre.
[[nodiscard]] std::string to_graph_text(const GraphFile& file, const std::vector<Pose2>& poses);

}  // namespace helicoid
