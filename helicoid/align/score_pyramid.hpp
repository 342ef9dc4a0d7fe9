// How near each spot of a reference is to a surface, at several resolutions: what bounds the score of whole squares of
// placements at once (Olson 2009; Hess et al. 2016).
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "helicoid/align/reference.hpp"

namespace helicoid {

/// A cell of the pyramid's finest level.
struct ScoreCell {
  int column = 0, row = 0;
};

class ScorePyramid {
 public:
  static constexpr float kCell = 0.10F;  ///< metres
  static constexpr int kFull = 255;      ///< the score of a cell on a surface; 0 from 30 cm on
  static constexpr int kLevels = 5;      ///< the coarsest covers 16 x 16 cells

  /// Of a reference's surfaces, in its frame; of an empty one: nothing scores.
  explicit ScorePyramid(const Reference& reference);

  /// The cell in which a point of the reference's frame (metres) lies; it need not be on the grid.
  [[nodiscard]] ScoreCell cell_of(float x, float y) const;

  /// The largest score within the square of 2^level cells whose lowest corner this is; off the grid nothing scores.
  [[nodiscard]] int at(int level, int column, int row) const {
    const Level& of = levels_[static_cast<std::size_t>(level)];
    // The stored squares begin up to a side below the grid.
    const int c = column + of.below;
    const int r = row + of.below;
    if (c < 0 || r < 0 || c >= of.width || r >= of.height) return 0;
    return of.scores[static_cast<std::size_t>(r) * static_cast<std::size_t>(of.width) + static_cast<std::size_t>(c)];
  }

 private:
  struct Level {
    int below = 0, width = 0, height = 0;
    std::vector<std::uint8_t> scores;
  };
  void stamp(const SurfaceElement& e);
  /// Each square is the largest of the four squares of half its side within it.
  [[nodiscard]] static Level coarsened(const Level& fine, int half);

  float low_x_ = 0, low_y_ = 0;
  std::array<Level, kLevels> levels_;
};

}  // namespace helicoid
