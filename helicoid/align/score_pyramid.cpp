#include "helicoid/align/score_pyramid.hpp"

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

/// From this distance on a point scores nothing, in cells.
constexpr int kReach = 3;
constexpr int kMostSide = 2000;

/// into[i] = the larger of itself, row[i] and row[i - half], where there is such a cell: `into` is longer by half.
void raise_to(const std::uint8_t* row, int width, int half, std::uint8_t* into) {
  for (int i = 0; i < width; ++i) into[i] = std::max(into[i], row[i]);
  for (int i = 0; i < width; ++i) into[i + half] = std::max(into[i + half], row[i]);
}

}  // namespace

ScorePyramid::ScorePyramid(const Reference& reference) {
  if (reference.empty()) return;
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
  Level& finest = levels_[0];
  finest.width = std::min(kMostSide, static_cast<int>((high_x - low_x_) / kCell) + kReach + 2);
  finest.height = std::min(kMostSide, static_cast<int>((high_y - low_y_) / kCell) + kReach + 2);
  finest.scores.assign(static_cast<std::size_t>(finest.width) * static_cast<std::size_t>(finest.height), 0);
  for (std::size_t i = 0; i < reference.size(); ++i) stamp(reference.element(i));
  for (std::size_t level = 1; level < kLevels; ++level) {
    levels_[level] = coarsened(levels_[level - 1], 1 << (level - 1));
  }
}

ScoreCell ScorePyramid::cell_of(float x, float y) const {
  return {static_cast<int>(std::floor((x - low_x_) / kCell)), static_cast<int>(std::floor((y - low_y_) / kCell))};
}

void ScorePyramid::stamp(const SurfaceElement& e) {
  Level& finest = levels_[0];
  const ScoreCell middle = cell_of(e.x, e.y);
  for (int dr = -kReach; dr <= kReach; ++dr) {
    for (int dc = -kReach; dc <= kReach; ++dc) {
      const int c = middle.column + dc;
      const int r = middle.row + dr;
      if (c < 0 || r < 0 || c >= finest.width || r >= finest.height) continue;
      const float dx = low_x_ + (static_cast<float>(c) + 0.5F) * kCell - e.x;
      const float dy = low_y_ + (static_cast<float>(r) + 0.5F) * kCell - e.y;
      const float near = std::max(0.0F, std::sqrt(dx * dx + dy * dy) - 0.5F * kCell) / (kReach * kCell);
      const int score = std::max(0, static_cast<int>(kFull * (1 - near)));
      std::uint8_t& cell = finest.scores[static_cast<std::size_t>(r) * static_cast<std::size_t>(finest.width) +
                                         static_cast<std::size_t>(c)];
      cell = std::max(cell, static_cast<std::uint8_t>(score));
    }
  }
}

ScorePyramid::Level ScorePyramid::coarsened(const Level& fine, int half) {
  Level coarse{fine.below + half, fine.width + half, fine.height + half, {}};
  const auto width = static_cast<std::size_t>(coarse.width);
  coarse.scores.assign(width * static_cast<std::size_t>(coarse.height), 0);
  for (int r = 0; r < fine.height; ++r) {
    const std::uint8_t* row = fine.scores.data() + static_cast<std::size_t>(r) * static_cast<std::size_t>(fine.width);
    for (const int to : {r, r + half}) {
      raise_to(row, fine.width, half, coarse.scores.data() + static_cast<std::size_t>(to) * width);
    }
  }
  return coarse;
}

}  // namespace helicoid
