#include "apps/benchmarks/bench_graphs.hpp"

#include <filesystem>

#include "helicoid/base/random.hpp"
#include "helicoid/fit/initial_guess.hpp"

namespace helicoid {

namespace {

std::string path_of(const std::string& name, const BenchOptions& options) {
  return options.data + "/posegraphs/" + name + ".g2o.gz";
}

}  // namespace

GraphFile make_grid(std::uint32_t side) {
  Random random(side);
  GraphFile file;
  std::vector<Pose2> truth;
  const auto at = [side](std::uint32_t row, std::uint32_t column) {
    return row * side + (row % 2 == 0 ? column : side - 1 - column);
  };
  for (std::uint32_t i = 0; i < side * side; ++i) {
    const std::uint32_t row = i / side;
    const std::uint32_t column = row % 2 == 0 ? i % side : side - 1 - i % side;
    truth.push_back({static_cast<double>(column), static_cast<double>(row), row % 2 == 0 ? 0.0 : radians(180)});
    file.ids.push_back(i);
  }
  const Matrix3d information = Vector3d(400, 400, 3000).asDiagonal();
  const auto relate = [&](std::uint32_t a, std::uint32_t b) {
    const Pose2 noise{0.05 * random.normal(), 0.05 * random.normal(), 0.018 * random.normal()};
    file.graph.relations.push_back({a, b, PosePose{truth[a].inverse() * truth[b] * noise, information}, b != a + 1});
  };
  for (std::uint32_t row = 0; row < side; ++row) {
    for (std::uint32_t column = 0; column < side; ++column) {
      const std::uint32_t i = row * side + column;
      if (i > 0) relate(i - 1, i);
      if (row > 0 && at(row - 1, column) + 1 != at(row, column)) relate(at(row - 1, column), at(row, column));
    }
  }
  // As an online mapper would start: near.
  for (const Pose2& T : truth) {
    file.graph.poses.push_back(T * Pose2{0.2 * random.normal(), 0.2 * random.normal(), 0.05 * random.normal()});
  }
  return file;
}

bool is_recorded(const std::string& name, const BenchOptions& options) {
  return std::filesystem::exists(path_of(name, options));
}

Result<GraphFile> read_recorded(const std::string& name, const BenchOptions& options) {
  Result<GraphFile> file = read_graph(path_of(name, options));
  if (file) file->graph.poses = odometry_start(file->graph, file->is_placed);
  return file;
}

}  // namespace helicoid
