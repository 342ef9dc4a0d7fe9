#include "helicoid/exploration/ground_window.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// Cells of a patch hold while it has moved by no more than this.
constexpr double kMoved = 0.03;
constexpr double kTurned = radians(0.4);

std::int32_t cell_at(double metres) {
  return static_cast<std::int32_t>(std::floor(metres / kGroundCell));
}

void add_disc(std::vector<RowSpan>& spans, const Vector2d& middle, double radius) {
  const auto first = static_cast<std::int32_t>(std::ceil((middle.y() - radius) / kGroundCell - 0.5));
  const auto last = static_cast<std::int32_t>(std::floor((middle.y() + radius) / kGroundCell - 0.5));
  for (std::int32_t row = first; row <= last; ++row) {
    const double dy = (row + 0.5) * kGroundCell - middle.y();
    const double half = std::sqrt(std::max(0.0, radius * radius - dy * dy));
    const auto from = static_cast<std::int32_t>(std::ceil((middle.x() - half) / kGroundCell - 0.5));
    const auto to = static_cast<std::int32_t>(std::floor((middle.x() + half) / kGroundCell - 0.5));
    if (from <= to) spans.push_back({row, from, to});
  }
}

std::vector<GroundCell> obstacle_cells(const PatchView& view, const Pose2& T_plane_patch) {
  const Matrix2d R = T_plane_patch.rotation();
  std::vector<GroundCell> cells;
  for (const PatchView::Surface& surface : view.surfaces()) {
    const Vector2d from = R * surface.from_patch.cast<double>() + T_plane_patch.translation();
    const Vector2d along = R * (surface.to_patch - surface.from_patch).cast<double>();
    const int steps = std::max(1, static_cast<int>(std::ceil(along.norm() / (0.7 * kGroundCell))));
    for (int k = 0; k < steps; ++k) {
      const GroundCell cell = ground_cell(from + along * (static_cast<double>(k) / steps));
      if (cells.empty() || cells.back() != cell) cells.push_back(cell);
    }
  }
  return cells;
}

}  // namespace

GroundCell ground_cell(const Vector2d& p_plane) {
  return {cell_at(p_plane.y()), cell_at(p_plane.x())};
}

Vector2d centre_of(const GroundCell& cell) {
  return {(cell.column + 0.5) * kGroundCell, (cell.row + 0.5) * kGroundCell};
}

PatchCells find_cells(const PatchView& view, const Pose2& T_plane_patch, double body) {
  PatchCells cells{T_plane_patch, {}, {}, {}, {}};
  cells.free = row_spans(view.patch().free_space, T_plane_patch, kGroundCell);
  add_disc(cells.free, T_plane_patch.translation(), body);
  cells.obstacles = obstacle_cells(view, T_plane_patch);
  cells.low = cells.high = ground_cell(T_plane_patch.translation());
  const auto take_in = [&](const GroundCell& c) {
    cells.low = {std::min(cells.low.row, c.row), std::min(cells.low.column, c.column)};
    cells.high = {std::max(cells.high.row, c.row), std::max(cells.high.column, c.column)};
  };
  for (const RowSpan& span : cells.free) {
    take_in({span.row, span.first});
    take_in({span.row, span.last});
  }
  for (const GroundCell& c : cells.obstacles) take_in(c);
  return cells;
}

const PatchCells& PatchCellTable::of(const PatchView& view, const Pose2& T_plane_patch) {
  constexpr double kBody = 0.25;
  const std::size_t patch = view.patch().id.index();
  if (known_.size() <= patch) known_.resize(patch + 1);
  Known& known = known_[patch];
  const Pose2& then = known.cells.T_plane_patch;
  const bool moved = std::hypot(then.x - T_plane_patch.x, then.y - T_plane_patch.y) > kMoved ||
                     std::abs(wrap_angle(then.yaw - T_plane_patch.yaw)) > kTurned;
  if (known.patch != &view.patch() || moved) known = {&view.patch(), find_cells(view, T_plane_patch, kBody)};
  return known.cells;
}

GroundWindow::GroundWindow(const GroundCell& middle, int half_width)
    : low_{middle.row - half_width, middle.column - half_width},
      width_(2 * half_width + 1),
      flags_(static_cast<std::size_t>(width_) * static_cast<std::size_t>(width_), 0) {}

void GroundWindow::add(const PatchCells& cells) {
  if (cells.high.row < low_.row || cells.high.column < low_.column || cells.low.row >= low_.row + width_ ||
      cells.low.column >= low_.column + width_) {
    return;
  }
  for (const RowSpan& span : cells.free) {
    if (span.row < low_.row || span.row >= low_.row + width_) continue;
    const std::int32_t first = std::max(span.first, low_.column);
    const std::int32_t last = std::min(span.last, low_.column + width_ - 1);
    if (first > last) continue;
    std::uint8_t* row = flags_.data() + index({span.row, first});
    for (std::int32_t k = 0; k <= last - first; ++k) row[k] |= kFree;
  }
  for (const GroundCell& c : cells.obstacles) {
    if (holds(c)) flags_[index(c)] |= kObstacle;
  }
}

void GroundWindow::mark_near_obstacles(int reach) {
  for (std::size_t k = 0; k < flags_.size(); ++k) {
    if ((flags_[k] & kObstacle) == 0) continue;
    const int row = static_cast<int>(k) / width_;
    const int column = static_cast<int>(k) % width_;
    for (int r = std::max(0, row - reach); r <= std::min(width_ - 1, row + reach); ++r) {
      for (int c = std::max(0, column - reach); c <= std::min(width_ - 1, column + reach); ++c) {
        flags_[static_cast<std::size_t>(r) * static_cast<std::size_t>(width_) + static_cast<std::size_t>(c)] |= kNear;
      }
    }
  }
}

bool GroundWindow::has_room(const GroundCell& c, double radius) const {
  const int reach = static_cast<int>(std::ceil(radius));
  for (int r = -reach; r <= reach; ++r) {
    for (int k = -reach; k <= reach; ++k) {
      if (r * r + k * k > radius * radius) continue;
      const GroundCell cell{c.row + r, c.column + k};
      if (!is_free(cell) || is_obstacle(cell)) return false;
    }
  }
  return true;
}

}  // namespace helicoid
