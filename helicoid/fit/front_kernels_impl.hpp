// The kernels' text, included by the source file of each class of processors, which is compiled for it alone. It uses
// no library: an inline function of a library, compiled here for a newer processor, could be linked for all.
#pragma once

#include "helicoid/fit/front_strips_impl.hpp"

namespace helicoid {

namespace {

/// Fronts from this height on are packed, so that a tile's operands lie side by side.
constexpr int kPackedHeight = 384;

/// Factorises the strip of up to eight pivots; the inverses of its diagonal stand in their places. False: a pivot is
/// not positive.
template <int M>
bool factorise_few(double (&L)[M][kStrip]) {
  for (int j = 0; j < M; ++j) {
    if (!(L[j][j] > 0)) return false;
    const double inverse = 1 / __builtin_sqrt(L[j][j]);
    for (int i = 0; i < kStrip; ++i) L[j][i] *= inverse;
    for (int l = j + 1; l < M; ++l) {
      const double factor = L[j][l];
      for (int i = 0; i < kStrip; ++i) L[l][i] -= L[j][i] * factor;
    }
    L[j][j] = inverse;
  }
  return true;
}

/// Factorises the triangle of up to eight pivots at `diagonal` and solves the strips beneath it.
template <int M>
bool eliminate_few(double* diagonal, std::ptrdiff_t leading, int strips_below) {
  double L[M][kStrip];
  for (int j = 0; j < M; ++j) {
    for (int i = 0; i < kStrip; ++i) L[j][i] = diagonal[i + j * leading];
  }
  if (!factorise_few<M>(L)) return false;
  for (int j = 0; j < M; ++j) {
    // Above the diagonal is nothing, and beneath the last pivot are pads.
    for (int i = 0; i < M; ++i) diagonal[i + j * leading] = i < j ? 0 : L[j][i];
  }
  double* strip = diagonal + kStrip;
  for (int s = 0; s < strips_below; ++s, strip += kStrip) {
    Vector x[M][kVectors];
#pragma GCC unroll 8
    for (int j = 0; j < M; ++j) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) x[j][v] = load(strip + j * leading + v * kLanes);
    }
#pragma GCC unroll 8
    for (int j = 0; j < M; ++j) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) {
        x[j][v] *= spread(L[j][j]);
        store(strip + j * leading + v * kLanes, x[j][v]);
      }
#pragma GCC unroll 8
      for (int l = j + 1; l < M; ++l) {
#pragma GCC unroll 8
        for (int v = 0; v < kVectors; ++v) x[l][v] -= x[j][v] * spread(L[j][l]);
      }
    }
  }
  return true;
}

bool eliminate_up_to_eight(int pivots, double* diagonal, std::ptrdiff_t leading, int strips_below) {
  switch (pivots) {
    case 1: return eliminate_few<1>(diagonal, leading, strips_below);
    case 2: return eliminate_few<2>(diagonal, leading, strips_below);
    case 3: return eliminate_few<3>(diagonal, leading, strips_below);
    case 4: return eliminate_few<4>(diagonal, leading, strips_below);
    case 5: return eliminate_few<5>(diagonal, leading, strips_below);
    case 6: return eliminate_few<6>(diagonal, leading, strips_below);
    case 7: return eliminate_few<7>(diagonal, leading, strips_below);
    default: return eliminate_few<8>(diagonal, leading, strips_below);
  }
}

/// A lower half's columns from `begin` on, less a product: C -= A A^T; A's strips begin at row `begin`.
void subtract_square(double* half, int height, int begin, int columns, Strips a, int depth) {
  for (int j = begin; j < columns; j = (j / kBand + 1) * kBand) {
    const Strips rows{a.first + (j - begin) / kStrip * a.between, a.column, a.between};
    const int width = least(columns, (j / kBand + 1) * kBand) - j;
    subtract_product(half + column_of_half(height, j) + j, between_columns(height, j), height - j, width, rows, rows,
                     depth, true);
  }
}

/// Band by band: its pivots are eliminated before the rest of the front is touched, while they stay in the cache.
bool eliminate(const FrontShape& shape, double* panel, double* update, double* workspace) {
  const int height = shape.leading();
  const int first_below = shape.first_below();
  for (int begin = 0; begin < shape.pivots; begin += kBand) {
    const int end = least(shape.pivots, begin + kBand);
    const std::ptrdiff_t leading = between_columns(height, begin);
    double* band = panel + shape.panel_column(begin);
    for (int j = begin; j < end; j += kStrip) {
      const int width = least(kStrip, end - j);
      double* diagonal = band + j + (j - begin) * leading;
      const Strips rows{band + j, leading, kStrip};
      if (j > begin) subtract_product(diagonal, leading, height - j, width, rows, rows, j - begin, false);
      if (!eliminate_up_to_eight(width, diagonal, leading, (height - j) / kStrip - 1)) return false;
    }
    if (end == shape.pivots && shape.below == 0) break;
    // What remains: the later pivots' columns, and the update.
    const int top = end < shape.pivots ? end : first_below;
    const double* beneath = band + top;
    const int depth = end - begin;
    const Strips rows = height - top > kPackedHeight ? pack(beneath, leading, height - top, depth, workspace)
                                                     : Strips{beneath, leading, kStrip};
    subtract_square(panel, height, end, shape.pivots, rows, depth);
    const Strips below{rows.first + (first_below - top) / kStrip * rows.between, rows.column, rows.between};
    subtract_square(update, padded(shape.below), 0, shape.below, below, depth);
  }
  return true;
}

void forward(const FrontShape& shape, const double* panel, double* pivots, double* below) {
  const double* L = panel;
  for (int j = 0; j < shape.pivots; L += between_columns(shape.leading(), ++j)) {
    const double x = pivots[j] * L[j];
    pivots[j] = x;
    for (int i = j + 1; i < shape.pivots; ++i) pivots[i] -= L[i] * x;
    const double* B = L + shape.first_below();
    for (int i = 0; i < padded(shape.below); i += kLanes) store(below + i, load(below + i) - load(B + i) * spread(x));
  }
}

double dot_padded(const double* a, const double* b, int rows) {
  Vector sum{};
  for (int i = 0; i < rows; i += kLanes) sum += load(a + i) * load(b + i);
  double total = 0;
  for (int l = 0; l < kLanes; ++l) total += sum[l];
  return total;
}

void backward(const FrontShape& shape, const double* panel, double* pivots, const double* below) {
  for (int j = shape.pivots - 1; j >= 0; --j) {
    const double* L = panel + shape.panel_column(j);
    double x = pivots[j] - dot_padded(L + shape.first_below(), below, padded(shape.below));
    for (int i = j + 1; i < shape.pivots; ++i) x -= L[i] * pivots[i];
    pivots[j] = x * L[j];
  }
}

/// X <- X T^-1 for X (rows x pivots) and the panel's triangle T, from the last column to the first.
void solve_from_right(double* X, std::ptrdiff_t x_leading, int rows, const FrontShape& shape, const double* panel,
                      double* workspace) {
  for (int j = (shape.pivots - 1) / kStrip * kStrip; j >= 0; j -= kStrip) {
    const std::ptrdiff_t leading = between_columns(shape.leading(), j);
    const double* triangle = panel + shape.panel_column(j);
    const int width = least(kStrip, shape.pivots - j);
    const int later = shape.pivots - j - width;
    if (later > 0) {
      const Strips T = pack_transposed(triangle + j + width, leading, later, width, workspace);
      const Strips rows_of_x{X + (j + width) * x_leading, x_leading, kStrip};
      subtract_product(X + j * x_leading, x_leading, rows, width, rows_of_x, T, later, false);
    }
    for (int l = width - 1; l >= 0; --l) {
      double* column = X + (j + l) * x_leading;
      const double* T = triangle + j + l * leading;
      for (int i = 0; i < rows; i += kLanes) {
        Vector x = load(column + i);
        for (int q = l + 1; q < width; ++q) x -= load(X + i + (j + q) * x_leading) * spread(T[q]);
        store(column + i, x * spread(T[l]));
      }
    }
  }
}

void invert(const FrontShape& shape, const double* panel, double* inverse, double* workspace) {
  const std::ptrdiff_t leading = shape.leading();
  const int first_below = shape.first_below();
  const int rows = padded(shape.below);
  double* corner = inverse + first_below + first_below * leading;
  double* beneath = inverse + first_below;
  // X = B T^-1, and with it both factors of the inverse.
  double* X = workspace;
  double* scratch = X + static_cast<std::ptrdiff_t>(leading) * padded(shape.pivots);
  for (int j = 0; j < shape.pivots; ++j) {
    const double* L = panel + shape.panel_column(j);
    for (int i = 0; i < rows; ++i) X[i + j * leading] = L[first_below + i];
    for (int i = 0; i < padded(shape.pivots); ++i) X[rows + i + j * leading] = i == j ? 1 : 0;
  }
  // Its lower rows become T^-1.
  solve_from_right(X, leading, static_cast<int>(leading), shape, panel, scratch);
  for (int j = 0; j < shape.pivots; ++j) {
    for (int i = 0; i < leading; ++i) inverse[i + j * leading] = 0;
  }
  // Z_bp = -Z_bb X.
  if (rows > 0) {
    const Strips XT = pack_transposed(X, leading, rows, shape.pivots, scratch);
    subtract_product(beneath, leading, rows, shape.pivots, Strips{corner, leading, kStrip}, XT, rows, false);
    // Z_pp = T^-T T^-1 - X^T Z_bp: the first term after the second, both as rows of a transpose.
    double* second = scratch + static_cast<std::ptrdiff_t>(rows) * padded(shape.pivots);
    const Strips ZT = pack_transposed(beneath, leading, rows, shape.pivots, second);
    subtract_product(inverse, leading, padded(shape.pivots), shape.pivots, XT, ZT, rows, false);
  }
  const Strips YT = pack_transposed(X + rows, leading, padded(shape.pivots), shape.pivots, scratch);
  double* negative = scratch + static_cast<std::ptrdiff_t>(padded(shape.pivots)) * padded(shape.pivots);
  const std::ptrdiff_t count = static_cast<std::ptrdiff_t>(padded(shape.pivots)) * padded(shape.pivots);
  for (std::ptrdiff_t i = 0; i < count; ++i) negative[i] = -scratch[i];
  subtract_product(inverse, leading, padded(shape.pivots), shape.pivots, Strips{negative, YT.column, YT.between}, YT,
                   padded(shape.pivots), false);
  // To the bit symmetric, and the other half.
  for (int j = 0; j < shape.pivots; ++j) {
    for (int i = 0; i < j; ++i) inverse[i + j * leading] = inverse[j + i * leading];
    for (int i = 0; i < rows; ++i) inverse[j + (first_below + i) * leading] = beneath[i + j * leading];
  }
}

constexpr FrontKernels kKernels{HELICOID_PROCESSOR_CLASS, eliminate, forward, backward, invert};

}  // namespace

}  // namespace helicoid
