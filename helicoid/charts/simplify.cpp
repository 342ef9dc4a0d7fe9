#include "helicoid/charts/simplify.hpp"

#include <algorithm>
#include <utility>

namespace helicoid::charts {

namespace {

double square_distance(const Vector2d& p, const Vector2d& a, const Vector2d& b) {
  const Vector2d along = b - a;
  const double length = along.squaredNorm();
  const double at = length > 0 ? std::clamp((p - a).dot(along) / length, 0.0, 1.0) : 0.0;
  return (p - a - at * along).squaredNorm();
}

}  // namespace

std::vector<Vector2d> simplify(std::span<const Vector2d> line, double tolerance) {
  if (line.size() < 3) return {line.begin(), line.end()};
  std::vector<char> kept(line.size(), 0);
  kept.front() = kept.back() = 1;
  std::vector<std::pair<std::size_t, std::size_t>> open{{0, line.size() - 1}};
  while (!open.empty()) {
    const auto [first, last] = open.back();
    open.pop_back();
    double farthest = tolerance * tolerance;
    std::size_t split = 0;
    for (std::size_t i = first + 1; i < last; ++i) {
      const double square = square_distance(line[i], line[first], line[last]);
      if (square > farthest) {
        farthest = square;
        split = i;
      }
    }
    if (split == 0) continue;
    kept[split] = 1;
    open.emplace_back(first, split);
    open.emplace_back(split, last);
  }
  std::vector<Vector2d> simple;
  for (std::size_t i = 0; i < line.size(); ++i) {
    if (kept[i] != 0) simple.push_back(line[i]);
  }
  return simple;
}

}  // namespace helicoid::charts
