// Dense work on one front of the multifrontal Cholesky factorisation (Duff and Reid 1983; Liu 1992), once for each
// class of processors and chosen at run time. On one class the results are the same to the bit; between classes they
// differ by rounding only, since some contract a*b+c and some do not.
#pragma once

#include <cstddef>

namespace helicoid {

/// Rows are padded to whole strips, so that no kernel needs a remainder. Pads hold zeros.
inline constexpr int kStrip = 8;
[[nodiscard]] constexpr int padded(int rows) {
  return (rows + kStrip - 1) / kStrip * kStrip;
}

/// Lower halves are stored column-major in bands of so many columns; a band begins at the row of its own first column,
/// so that next to nothing is stored of what lies above the diagonal. Whole strips of rows, whole blocks of columns.
inline constexpr int kBand = 96;
/// Where the top of a column would stand, were it stored, in a lower half of this height: rows count from there.
[[nodiscard]] constexpr std::ptrdiff_t column_of_half(int height, int column) {
  const std::ptrdiff_t whole = static_cast<std::ptrdiff_t>(height) * column;
  if (column < kBand) return whole;
  const std::ptrdiff_t bands = column / kBand;
  return whole - bands * kBand * (column + 1) + bands * (bands + 1) / 2 * (kBand * kBand);
}
/// From a column to the next in its band.
[[nodiscard]] constexpr std::ptrdiff_t between_columns(int height, int column) {
  return column < kBand ? height : height - column / kBand * kBand;
}
[[nodiscard]] constexpr std::size_t half_size(int height, int columns) {
  return columns == 0 ? 0 : static_cast<std::size_t>(column_of_half(height, columns - 1) + height);
}

/// The shape of a front: its first `pivots` unknowns are eliminated, the `below` others are passed on. Scalars.
/// The panel is the lower half of `leading` x pivots: rows [0, pivots) are the triangle, rows [first_below,
/// first_below + below) what lies beneath it. The update is the lower half of padded(below) x below.
struct FrontShape {
  int pivots = 0;
  int below = 0;

  [[nodiscard]] int first_below() const { return padded(pivots); }
  [[nodiscard]] int leading() const { return padded(pivots) + padded(below); }
  [[nodiscard]] std::size_t panel_size() const { return half_size(leading(), pivots); }
  [[nodiscard]] std::size_t update_size() const { return half_size(padded(below), below); }
  /// Tops of columns of the panel and of the update.
  [[nodiscard]] std::ptrdiff_t panel_column(int column) const { return column_of_half(leading(), column); }
  [[nodiscard]] std::ptrdiff_t update_column(int column) const { return column_of_half(padded(below), column); }
  /// What `eliminate` and `invert` need beside the front, in doubles.
  [[nodiscard]] std::size_t workspace_size() const;
};

struct FrontKernels {
  const char* processor_class;
  /// Panel <- L (the *inverses* of the pivots on its diagonal), update <- update - B B^T with B the part of L beneath
  /// the triangle. False if a pivot is not positive.
  bool (*eliminate)(const FrontShape& shape, double* panel, double* update, double* workspace);
  /// L y = x: pivots <- the triangle's solution, below <- below - B pivots.
  void (*forward)(const FrontShape& shape, const double* panel, double* pivots, double* below);
  /// L^T y = x: pivots <- the triangle's solution of (pivots - B^T below).
  void (*backward)(const FrontShape& shape, const double* panel, double* pivots, const double* below);
  /// The front's part of the inverse (Takahashi, Fagan and Chin 1973; by supernodes Lin et al. 2011). `inverse` is
  /// column-major, leading x leading in the panel's rows; its lower right block, given and full, is the inverse of the
  /// rows below; the rest is filled in, both halves.
  void (*invert)(const FrontShape& shape, const double* panel, double* inverse, double* workspace);
};

/// The best of this processor.
[[nodiscard]] const FrontKernels& front_kernels();
/// The one that runs anywhere.
[[nodiscard]] const FrontKernels& portable_front_kernels();

}  // namespace helicoid
