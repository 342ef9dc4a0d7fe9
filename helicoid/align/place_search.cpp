#include "helicoid/align/place_search.hpp"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr float kCell = ScorePyramid::kCell;
constexpr int kFull = ScorePyramid::kFull;
constexpr std::size_t kMostPoints = 100;

/// A square of placements at one heading: offsets from the middle in cells.
struct Square {
  int level = 0;
  int heading = 0;
  int column = 0, row = 0;
  int bound = 0;
};

/// Of the smallest box about the window, along the axes.
Vector2d half_widths(const PlaceWindow& window) {
  Vector2d square(window.half_width, window.half_width);
  if (window.limit.isZero()) return square;
  return window.limit.inverse().diagonal().cwiseSqrt().cwiseMin(square);
}

class Search {
 public:
  Search(const ScorePyramid& pyramid, const ScanPoints& points, const PlaceWindow& window)
      : pyramid_(pyramid), window_(window) {
    std::vector<std::size_t> used;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.weight[i] > 0) used.push_back(i);
    }
    const std::size_t stride = std::max<std::size_t>(1, (used.size() + kMostPoints - 1) / kMostPoints);
    turns_ = static_cast<int>(std::ceil(window.half_turn / window.turn_step));
    const Vector2d half = half_widths(window);
    columns_ = static_cast<int>(std::ceil(half.x() / static_cast<double>(kCell)));
    rows_ = static_cast<int>(std::ceil(half.y() / static_cast<double>(kCell)));
    for (int k = -turns_; k <= turns_; ++k) {
      const Pose2 T = pose_at(k, 0, 0);
      const Matrix2d R = T.rotation();
      std::vector<ScoreCell>& cells = cells_.emplace_back();
      for (std::size_t u = 0; u < used.size(); u += stride) {
        const Vector2d p = R * Vector2d(points.x[used[u]], points.y[used[u]]) + T.translation();
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
        if (!is_within_limit(at)) continue;
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

  [[nodiscard]] bool is_within_limit(const Square& at) const {
    const Vector2d p = static_cast<double>(kCell) * Vector2d(at.column, at.row);
    return p.dot(window_.limit * p) <= 1;
  }

  [[nodiscard]] bool is_apart(const Pose2& a, const Pose2& b) const {
    return std::hypot(a.x - b.x, a.y - b.y) > window_.apart ||
           std::abs(wrap_angle(a.yaw - b.yaw)) > window_.turned_apart;
  }

  [[nodiscard]] int bound(int level, int heading, int column, int row) const {
    int sum = 0;
    for (const ScoreCell& cell : cells_[static_cast<std::size_t>(heading)]) {
      sum += pyramid_.at(level, cell.column + column, cell.row + row);
    }
    return sum;
  }

  [[nodiscard]] std::vector<Square> roots() const {
    std::vector<Square> squares;
    constexpr int kTop = ScorePyramid::kLevels - 1;
    for (int h = 0; h < static_cast<int>(cells_.size()); ++h) {
      for (int r = -rows_; r <= rows_; r += 1 << kTop) {
        for (int c = -columns_; c <= columns_; c += 1 << kTop) squares.push_back({kTop, h, c, r, bound(kTop, h, c, r)});
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
      if (c > columns_ || r > rows_) continue;
      const int b = bound(square.level - 1, square.heading, c, r);
      if (b > best) open.push_back({square.level - 1, square.heading, c, r, b});
    }
    std::sort(open.begin() + static_cast<std::ptrdiff_t>(first), open.end(),
              [](const Square& a, const Square& b) { return a.bound < b.bound; });
  }

  const ScorePyramid& pyramid_;
  PlaceWindow window_;
  int turns_ = 0, columns_ = 0, rows_ = 0;
  std::size_t count_ = 0;
  std::vector<std::vector<ScoreCell>> cells_;  ///< by heading: where the points fall at the middle
};

}  // namespace

PlaceSearch search_place(const ScorePyramid& pyramid, const ScanPoints& points, const PlaceWindow& window) {
  PlaceSearch result;
  if (points.size() == 0) return result;
  const Search search(pyramid, points, window);
  result.best = search.best(window.least_score, nullptr);
  if (result.best.score > 0) {
    result.second = search.best(std::max(window.least_score, 0.85 * result.best.score), &result.best);
  }
  return result;
}

PlaceSearch search_place(const Reference& reference, const ScanPoints& points, const PlaceWindow& window) {
  return search_place(ScorePyramid(reference), points, window);
}

}  // namespace helicoid
