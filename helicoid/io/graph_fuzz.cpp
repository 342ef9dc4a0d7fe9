// Whatever a graph file holds, it can be fitted or is refused, and a graph survives being written.
#include <cstdint>
#include <cstdlib>

#include "helicoid/fit/fit_from_start.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/io/graph_reader.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace helicoid;
  GraphFile file = parse_graph(std::string(reinterpret_cast<const char*>(data), size), "fuzz");
  if (file.graph.relations.empty()) return 0;
  const GraphFile again = parse_graph(to_graph_text(file, file.graph.poses), "again");
  if (again.ids != file.ids || again.graph.relations.size() > file.graph.relations.size()) std::abort();
  file.graph.poses = odometry_start(file.graph, file.is_placed);
  FitOptions options;
  options.max_iterations = 5;
  const StartedFit fitted = fit_from(file.graph, FitStart::automatic, options);
  if (fitted.result.poses.size() != file.ids.size()) std::abort();
  return 0;
}
