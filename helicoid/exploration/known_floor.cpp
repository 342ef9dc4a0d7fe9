#include "helicoid/exploration/known_floor.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/geometry/row_spans.hpp"

namespace helicoid {

FloorSquare square_at(const Vector2d& p_plane) {
  const auto at = [](double metres) { return static_cast<std::int32_t>(std::floor(metres / kSeenSquare)); };
  return {at(p_plane.y()), at(p_plane.x())};
}

Vector2d middle_of(const FloorSquare& square) {
  return {(square.column + 0.5) * kSeenSquare, (square.row + 0.5) * kSeenSquare};
}

KnownSquares::KnownSquares(const Map& map, IslandId island) {
  std::vector<RowSpan> spans;
  RowScanner scanner;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    if (map.island_of(id) != island) continue;
    scanner.scan(map.patch(id).free_space, map.T_plane_patch(id), kSeenSquare,
                 [&](const RowSpan& span) { spans.push_back(span); });
  }
  if (spans.empty()) return;
  FloorSquare high = low_ = {spans.front().row, spans.front().first};
  for (const RowSpan& span : spans) {
    low_ = {std::min(low_.row, span.row), std::min(low_.column, span.first)};
    high = {std::max(high.row, span.row), std::max(high.column, span.last)};
  }
  width_ = high.column - low_.column + 1;
  height_ = high.row - low_.row + 1;
  is_known_.assign(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_), 0);
  for (const RowSpan& span : spans) {
    const auto row = is_known_.begin() + static_cast<std::ptrdiff_t>(span.row - low_.row) * width_;
    std::fill(row + (span.first - low_.column), row + (span.last - low_.column + 1), std::uint8_t{1});
  }
  for (std::size_t i = 0; i < is_known_.size(); ++i) {
    if (is_known_[i] == 0) continue;
    const auto at = static_cast<std::int32_t>(i);
    squares_.push_back({low_.row + at / width_, low_.column + at % width_});
  }
}

bool KnownSquares::has(const FloorSquare& square) const {
  const std::int32_t row = square.row - low_.row;
  const std::int32_t column = square.column - low_.column;
  if (row < 0 || column < 0 || row >= height_ || column >= width_) return false;
  return is_known_[static_cast<std::size_t>(row) * static_cast<std::size_t>(width_) +
                   static_cast<std::size_t>(column)] != 0;
}

const KnownSquares& KnownFloor::of(IslandId island) {
  const auto found = known_.find(island);
  return found != known_.end() ? found->second : known_.try_emplace(island, map_, island).first->second;
}

}  // namespace helicoid
