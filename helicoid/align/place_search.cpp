#include "helicoid/align/place_search.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr float kCell = 0.10F;
/// From this distance on a point scores nothing, in cells.
constexpr int kReach = 3;
constexpr int kFull = 255;
/// Levels of the pyramid: the coarsest covers 16 x 16 cells.
constexpr int kLevels = 5;
constexpr std::size_t kMostPoints = 100;
constexpr int kMostSide = 2000;

struct Cell {
  int column = 0, row = 0;
};

/// How near each cell is to a surface, and the largest of that over squares of 2, 4, 8 and 16 cells.
class ScorePyramid {
 public:
  explicit ScorePyramid(const Reference& reference) {
    float high_x = -HUGE_VALF;
    float high_y = -HUGE_VALF;
    low_x_ = low_y_ = HUGE_VALF;
    for (std::size_t i = 0; i < reference.size(); ++i) {
      const SurfaceElement e = reference.element(i);
      low_x_ = std::min(low_x_, e.x);
      low_y_ = std::min(low_y_, e.y);
      high_x = std::max(high_x, e.x);
      high_y = std::max(high_y, e.y);
    }
    low_x_ -= (kReach + 1) * kCell;
    low_y_ -= (kReach + 1) * kCell;
    columns_ = std::min(kMostSide, static_cast<int>((high_x - low_x_) / kCell) + kReach + 2);
    rows_ = std::min(kMostSide, static_cast<int>((high_y - low_y_) / kCell) + kReach + 2);
    levels_[0].assign(static_cast<std::size_t>(columns_) * rows_, 0);
    for (std::size_t i = 0; i < reference.size(); ++i) stamp(reference.element(i));
    for (int level = 1; level < kLevels; ++level) coarsen(level);
  }

  [[nodiscard]] Cell cell_of(float x, float y) const {
    return {static_cast<int>(std::floor((x - low_x_) / kCell)), static_cast<int>(std::floor((y - low_y_) / kCell))};
  }

  /// The largest score within the square of 2^level cells whose lowest corner this is.
  [[nodiscard]] int at(int level, int column, int row) const {
    const int side = 1 << level;
    // The stored squares begin up to a side below the grid.
    const int c = column + side - 1;
    const int r = row + side - 1;
    const int width = columns_ + side - 1;
    const int height = rows_ + side - 1;
    if (c < 0 || r < 0 || c >= width || r >= height) return 0;
    return levels_[level][static_cast<std::size_t>(r) * width + c];
  }

 private:
  void stamp(const SurfaceElement& e) {
    const Cell middle = cell_of(e.x, e.y);
    for (int dr = -kReach; dr <= kReach; ++dr) {
      for (int dc = -kReach; dc <= kReach; ++dc) {
        const int c = middle.column + dc;
        const int r = middle.row + dr;
        if (c < 0 || r < 0 || c >= columns_ || r >= rows_) continue;
        const float dx = low_x_ + (static_cast<float>(c) + 0.5F) * kCell - e.x;
        const float dy = low_y_ + (static_cast<float>(r) + 0.5F) * kCell - e.y;
        const float near = std::max(0.0F, std::sqrt(dx * dx + dy * dy) - 0.5F * kCell) / (kReach * kCell);
        const int score = std::max(0, static_cast<int>(kFull * (1 - near)));
        std::uint8_t& cell = levels_[0][static_cast<std::size_t>(r) * columns_ + c];
        cell = std::max(cell, static_cast<std::uint8_t>(score));
      }
    }
  }

  void coarsen(int level) {
    const int half = 1 << (level - 1);
    const int side = 2 * half;
    const int width = columns_ + side - 1;
    const int height = rows_ + side - 1;
    levels_[level].resize(static_cast<std::size_t>(width) * height);
    for (int r = 0; r < height; ++r) {
      for (int c = 0; c < width; ++c) {
        const int column = c - side + 1;
        const int row = r - side + 1;
        const int most =
            std::max(std::max(at(level - 1, column, row), at(level - 1, column + half, row)),
                     std::max(at(level - 1, column, row + half), at(level - 1, column + half, row + half)));
        levels_[level][static_cast<std::size_t>(r) * width + c] = static_cast<std::uint8_t>(most);
      }
    }
  }

  float low_x_ = 0, low_y_ = 0;
  int columns_ = 0, rows_ = 0;
  std::vector<std::uint8_t> levels_[kLevels];
};

/// A square of placements at one heading: offsets from the middle in cells.
struct Square {
  int level = 0;
  int heading = 0;
  int column = 0, row = 0;
  int bound = 0;
};

class Search {
 public:
  Search(const Reference& reference, const ScanPoints& points, const PlaceWindow& window)
      : pyramid_(reference), window_(window) {
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.weight[i] > 0) used.push_back(i);
    }
    const std::size_t stride = std::max<std::size_t>(1, (used.size() + kMostPoints - 1) / kMostPoints);
    turns_ = static_cast<int>(std::ceil(window.half_turn / window.turn_step));
    shifts_ = static_cast<int>(std::ceil(window.half_width / static_cast<double>(kCell)));
    for (int k = -turns_; k <= turns_; ++k) {
      const Pose2 T = pose_at(k, 0, 0);
      std::vector<Cell>& cells = cells_.emplace_back();
      for (std::size_t u = 0; u < used.size(); u += stride) {
        const Vector2d p = T * Vector2d(points.x[used[u]], points.y[used[u]]);
        cells.push_back(pyramid_.cell_of(static_cast<float>(p.x()), static_cast<float>(p.y())));
      }
    }
    count_ = cells_.front().size();
  }

  /// The best placement apart from `other` that scores at least `least`.
  [[nodiscard]] Placement best(double least, const Placement* other) const {
    Placement found;
    if (count_ == 0) return found;
    const int full = kFull * static_cast<int>(count_);
    int best = std::max(0, static_cast<int>(least * full) - 1);
    std::vector<Square> open = roots();
    const auto worse = [](const Square& a, const Square& b) { return a.bound < b.bound; };
    std::sort(open.begin(), open.end(), worse);
    while (!open.empty()) {
      const Square at = open.back();
      open.pop_back();
      if (at.bound <= best) continue;
      if (at.level == 0) {
        const Pose2 T = pose_at(at.heading - turns_, at.column, at.row);
        if (other != nullptr && !is_apart(T, other->T_reference_scan)) continue;
        best = at.bound;
        found = {T, static_cast<double>(at.bound) / full};
        continue;
      }
      split(at, best, open);
    }
    return found;
  }

 private:
  [[nodiscard]] Pose2 pose_at(int turn, int column, int row) const {
    const Pose2& m = window_.T_reference_scan;
    return {m.x + column * static_cast<double>(kCell), m.y + row * static_cast<double>(kCell),
            wrap_angle(m.yaw + turn * window_.turn_step)};
  }

  [[nodiscard]] bool is_apart(const Pose2& a, const Pose2& b) const {
    return std::hypot(a.x - b.x, a.y - b.y) > window_.apart ||
           std::abs(wrap_angle(a.yaw - b.yaw)) > window_.turned_apart;
  }

  [[nodiscard]] int bound(int level, int heading, int column, int row) const {
    int sum = 0;
    for (const Cell& cell : cells_[static_cast<std::size_t>(heading)]) {
      sum += pyramid_.at(level, cell.column + column, cell.row + row);
    }
    return sum;
  }

  [[nodiscard]] std::vector<Square> roots() const {
    std::vector<Square> squares;
    constexpr int kTop = kLevels - 1;
    for (int h = 0; h < static_cast<int>(cells_.size()); ++h) {
      for (int r = -shifts_; r <= shifts_; r += 1 << kTop) {
        for (int c = -shifts_; c <= shifts_; c += 1 << kTop) squares.push_back({kTop, h, c, r, bound(kTop, h, c, r)});
      }
    }
    return squares;
  }

  /// The four quarters, the most promising one last.
  void split(const Square& square, int best, std::vector<Square>& open) const {
    const int half = 1 << (square.level - 1);
    const std::size_t first = open.size();
    for (int k = 0; k < 4; ++k) {
      const int c = square.column + (k & 1) * half;
      const int r = square.row + (k >> 1) * half;
      if (c > shifts_ || r > shifts_) continue;
      const int b = bound(square.level - 1, square.heading, c, r);
      if (b > best) open.push_back({square.level - 1, square.heading, c, r, b});
    }
    std::sort(open.begin() + static_cast<std::ptrdiff_t>(first), open.end(),
              [](const Square& a, const Square& b) { return a.bound < b.bound; });
  }

  ScorePyramid pyramid_;
  PlaceWindow window_;
  int turns_ = 0, shifts_ = 0;
  std::size_t count_ = 0;
  std::vector<std::vector<Cell>> cells_;  ///< by heading: where the points fall at the middle
};

}  // namespace

PlaceSearch search_place(const Reference& reference, const ScanPoints& points, const PlaceWindow& window) {
  PlaceSearch result;
  if (reference.empty() || points.size() == 0) return result;
  const Search search(reference, points, window);
  result.best = search.best(window.least_score, nullptr);
  if (result.best.score > 0) {
    result.second = search.best(std::max(window.least_score, 0.85 * result.best.score), &result.best);
  }
  return result;
}

}  // namespace helicoid
