// One Newton step on a g2o graph from where it stands, by CHOLMOD at its best setting: prints the step's relative
// residual and CPU seconds of ordering, factorising and solving. The baseline of `helicoid bench --filter "step of
// fit"`, in a process of its own so that the program need not carry CHOLMOD.
#include <algorithm>
#include <cstdio>

#include "bench/cholmod_solution.hpp"
#include "helicoid/fit/linear_system.hpp"
#include "helicoid/io/graph_reader.hpp"

int main(int argc, char** argv) {
  using namespace helicoid;
  if (argc != 2) return 2;
  const Result<GraphFile> file = read_graph(argv[1]);
  if (!file) {
    std::fprintf(stderr, "%s\n", file.error().message.c_str());
    return 1;
  }
  LinearSystem system(file->graph, default_gauge(file->graph));
  system.linearise(file->graph.poses);
  const std::vector<double> rights[] = {{system.gradient().begin(), system.gradient().end()}};
  const BlockMatrix& H = system.information();
  CholmodSolution best = solve_by_cholmod(H, rights, CholmodMode::automatic);
  for (const CholmodMode mode : {CholmodMode::simplicial, CholmodMode::supernodal}) {
    CholmodSolution other = solve_by_cholmod(H, rights, mode);
    if (other.total_s() < best.total_s()) best = std::move(other);
  }
  std::printf("%.6g %.6f %.6f %.6f\n", relative_residual(H, best.columns[0], rights[0]), best.order_s, best.factorise_s,
              best.solve_s);
  return 0;
}
