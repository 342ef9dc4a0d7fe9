#include "apps/grid_picture.hpp"

#include <fmt/format.h>

#include <iterator>

#include "apps/svg_drawing.hpp"

namespace helicoid {

namespace {

/// SVG's path of all cells of this state, row by row in runs; y down.
std::string runs_of(const GridFrame& frame, const std::vector<CellState>& states, CellState state) {
  std::string path;
  for (int row = 0; row < frame.height; ++row) {
    for (int column = 0; column < frame.width; ++column) {
      const int first = column;
      while (column < frame.width && states[frame.index(column, row)] == state) ++column;
      const int length = column - first;
      if (length == 0) continue;
      fmt::format_to(std::back_inserter(path), "M{} {}h{}v1h-{}z", first, frame.height - 1 - row, length, length);
    }
  }
  return path;
}

}  // namespace

std::string draw_grid(const OccupancyGrid& grid) {
  const GridFrame& frame = grid.frame;
  const std::vector<CellState> states = classify(grid);
  SvgDrawing drawing(frame.width, frame.height);
  drawing.rectangle({0, 0}, {static_cast<double>(frame.width), static_cast<double>(frame.height)}, charts::kUnknown);
  drawing.area(runs_of(frame, states, CellState::free), charts::kFree);
  drawing.area(runs_of(frame, states, CellState::occupied), charts::kWall);
  return drawing.finish();
}

}  // namespace helicoid
