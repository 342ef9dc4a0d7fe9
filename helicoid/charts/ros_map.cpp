#include "helicoid/charts/ros_map.hpp"

#include <filesystem>

#include "helicoid/base/whole_file.hpp"

namespace helicoid {

Result<void> write_ros_map(const OccupancyGrid& grid, const std::string& stem) {
  const GridFrame& frame = grid.frame;
  const std::vector<CellState> states = classify(grid);
  std::string image = fmt::format("P5\n{} {}\n255\n", frame.width, frame.height);
  image.reserve(image.size() + frame.size());
  for (int row = frame.height - 1; row >= 0; --row) {
    for (int column = 0; column < frame.width; ++column) {
      const CellState state = states[frame.index(column, row)];
      const int grey = state == CellState::occupied ? 0 : state == CellState::free ? 254 : 205;
      image.push_back(static_cast<char>(grey));
    }
  }
  if (Result<void> written = write_whole_file(stem + ".pgm", image); !written) return written;
  const std::string name = std::filesystem::path(stem).filename().string();
  return write_whole_file(
      stem + ".yaml", fmt::format("image: {}.pgm\nmode: trinary\nresolution: {:.6f}\norigin: [{:.6f}, {:.6f}, 0.0]\n"
                                  "negate: 0\noccupied_thresh: {}\nfree_thresh: {}\n",
                                  name, frame.resolution, frame.origin.x(), frame.origin.y(), grid.model.occupied_above,
                                  grid.model.free_below));
}

}  // namespace helicoid
