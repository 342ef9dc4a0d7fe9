#include "helicoid/charts/contour.hpp"

#include <array>
#include <cmath>

namespace helicoid::charts {

namespace {

/// How far beyond free space a surface may lie and still bound it: the grid leaves cells along walls undecided.
constexpr int kWallReach = 2;

enum Heading : int { kEast, kNorth, kWest, kSouth };
struct Offset {
  int x, y;
};
constexpr std::array<Offset, 4> kAhead{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};

class Tracer {
 public:
  Tracer(const GridFrame& frame, const std::vector<CellState>& states)
      : frame_(frame), states_(states), visited_(frame.size(), 0) {}

  std::vector<Contour> trace() {
    std::vector<Contour> contours;
    for (int row = 0; row < frame_.height; ++row) {
      for (int column = 0; column < frame_.width; ++column) {
        if (!is_free(column, row)) continue;
        for (int heading = kEast; heading <= kSouth; ++heading) {
          const Offset beyond = right_of(heading);
          if (is_free(column + beyond.x, row + beyond.y) || visited(column, row, heading)) continue;
          contours.push_back(follow(column, row, heading));
        }
      }
    }
    return contours;
  }

 private:
  [[nodiscard]] bool is_free(int column, int row) const {
    return frame_.inside(column, row) && states_[frame_.index(column, row)] == CellState::free;
  }
  static Offset right_of(int heading) { return kAhead[static_cast<std::size_t>((heading + 3) % 4)]; }
  [[nodiscard]] bool visited(int column, int row, int heading) const {
    return (visited_[frame_.index(column, row)] >> heading & 1) != 0;
  }
  [[nodiscard]] bool wall_near(int column, int row) const {
    for (int dy = -kWallReach + 1; dy < kWallReach; ++dy) {
      for (int dx = -kWallReach + 1; dx < kWallReach; ++dx) {
        if (frame_.inside(column + dx, row + dy) &&
            states_[frame_.index(column + dx, row + dy)] == CellState::occupied) {
          return true;
        }
      }
    }
    return false;
  }

  /// Walks along the edges of free cells, the free cell at (column, row) on the left, until it comes round.
  Contour follow(int column, int row, int heading) {
    Contour contour;
    while (!visited(column, row, heading)) {
      auto& mark = visited_[frame_.index(column, row)];
      mark = static_cast<std::uint8_t>(mark | 1U << static_cast<unsigned>(heading));
      const Offset beyond = right_of(heading);
      contour.steps.push_back(
          {2 * column + 1 + beyond.x, 2 * row + 1 + beyond.y, wall_near(column + beyond.x, row + beyond.y)});
      const Offset ahead = kAhead[static_cast<std::size_t>(heading)];
      if (!is_free(column + ahead.x, row + ahead.y)) {
        heading = (heading + 1) % 4;
      } else if (!is_free(column + ahead.x + beyond.x, row + ahead.y + beyond.y)) {
        column += ahead.x;
        row += ahead.y;
      } else {
        column += ahead.x + beyond.x;
        row += ahead.y + beyond.y;
        heading = (heading + 3) % 4;
      }
    }
    return contour;
  }

  const GridFrame& frame_;
  const std::vector<CellState>& states_;
  std::vector<std::uint8_t> visited_;
};

}  // namespace

std::vector<Contour> trace_contours(const GridFrame& frame, const std::vector<CellState>& states) {
  return Tracer(frame, states).trace();
}

double signed_area(const Contour& contour) {
  std::int64_t twice = 0;
  for (std::size_t i = 0; i < contour.steps.size(); ++i) {
    const Contour::Step& a = contour.steps[i];
    const Contour::Step& b = contour.steps[i + 1 < contour.steps.size() ? i + 1 : 0];
    twice += static_cast<std::int64_t>(a.x2) * b.y2 - static_cast<std::int64_t>(b.x2) * a.y2;
  }
  return static_cast<double>(twice) / 8;
}

}  // namespace helicoid::charts
