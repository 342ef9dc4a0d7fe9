// The kernels' text, included once by the source file of each class of processors, which is compiled for it alone. It
// uses no library: an inline function of a library, compiled here for a newer processor, could be linked for all.
#include "helicoid/fit/front_kernels.hpp"

namespace helicoid {

namespace {

#if defined(__AVX512F__)
constexpr int kLanes = 8;
constexpr int kMostStrips = 3;
constexpr int kTileColumns = 8;
#elif defined(__AVX__)
constexpr int kLanes = 4;
constexpr int kMostStrips = 1;
constexpr int kTileColumns = 4;
#else
constexpr int kLanes = 2;
constexpr int kMostStrips = 1;
constexpr int kTileColumns = 2;
#endif
constexpr int kVectors = kStrip / kLanes;
/// Pivots that are eliminated before the rest of a front is touched: a panel of them stays in the cache.
constexpr int kPanel = 192;
/// Fronts from this height on are packed, so that a tile's operands lie side by side.
constexpr int kPackedHeight = 384;

typedef double Vector __attribute__((vector_size(kLanes * sizeof(double)), aligned(8), may_alias));

inline Vector load(const double* p) { return *reinterpret_cast<const Vector*>(p); }
inline void store(double* p, Vector v) { *reinterpret_cast<Vector*>(p) = v; }
inline Vector spread(double value) { return value - Vector{}; }

/// Strips of eight rows, `between` doubles apart; each holds its columns `column` doubles apart.
struct Strips {
  const double* first;
  std::ptrdiff_t column;
  std::ptrdiff_t between;
};

/// C -= A B^T for a tile of N strips x M columns; B's rows are lanes of one of its strips.
template <int N, int M>
void subtract_tile(double* c, std::ptrdiff_t c_column, const double* a, std::ptrdiff_t a_column, std::ptrdiff_t a_between,
                   const double* b, std::ptrdiff_t b_column, int depth) {
  Vector sum[M][N * kVectors] = {};
  for (int p = 0; p < depth; ++p) {
    Vector rows[N * kVectors];
#pragma GCC unroll 8
    for (int s = 0; s < N; ++s) {
#pragma GCC unroll 8
      for (int v = 0; v < kVectors; ++v) rows[s * kVectors + v] = load(a + s * a_between + v * kLanes);
    }
#pragma GCC unroll 8
    for (int j = 0; j < M; ++j) {
      const Vector factor = spread(b[j]);
#pragma GCC unroll 32
      for (int i = 0; i < N * kVectors; ++i) sum[j][i] += rows[i] * factor;
    }
    a += a_column;
    b += b_column;
  }
#pragma GCC unroll 8
  for (int j = 0; j < M; ++j) {
#pragma GCC unroll 32
    for (int i = 0; i < N * kVectors; ++i) {
      double* place = c + j * c_column + i * kLanes;
      store(place, load(place) - sum[j][i]);
    }
  }
}

using Tile = void (*)(double*, std::ptrdiff_t, const double*, std::ptrdiff_t, std::ptrdiff_t, const double*,
                      std::ptrdiff_t, int);
constexpr Tile kTiles[3][8] = {
    {subtract_tile<1, 1>, subtract_tile<1, 2>, subtract_tile<1, 3>, subtract_tile<1, 4>, subtract_tile<1, 5>,
     subtract_tile<1, 6>, subtract_tile<1, 7>, subtract_tile<1, 8>},
    {subtract_tile<2, 1>, subtract_tile<2, 2>, subtract_tile<2, 3>, subtract_tile<2, 4>, subtract_tile<2, 5>,
     subtract_tile<2, 6>, subtract_tile<2, 7>, subtract_tile<2, 8>},
    {subtract_tile<3, 1>, subtract_tile<3, 2>, subtract_tile<3, 3>, subtract_tile<3, 4>, subtract_tile<3, 5>,
     subtract_tile<3, 6>, subtract_tile<3, 7>, subtract_tile<3, 8>}};

inline int least(int a, int b) { return a < b ? a : b; }

/// C[rows x columns] -= A B^T. `lower`: only from the strip of the diagonal on.
void subtract_product(double* c, std::ptrdiff_t c_column, int rows, int columns, Strips a, Strips b, int depth,
                      bool lower) {
  for (int j = 0; j < columns; j += kTileColumns) {
    const int width = least(kTileColumns, columns - j);
    const double* b_rows = b.first + (j / kStrip) * b.between + j % kStrip;
    for (int i = lower ? j / kStrip * kStrip : 0; i < rows;) {
      const int strips = least(kMostStrips, (rows - i) / kStrip);
      kTiles[strips - 1][width - 1](c + i + j * c_column, c_column, a.first + (i / kStrip) * a.between, a.column,
                                    a.between, b_rows, b.column, depth);
      i += strips * kStrip;
    }
  }
}

/// Columns of `from` (rows x columns) as strips of rows that lie side by side.
Strips pack(const double* from, std::ptrdiff_t leading, int rows, int columns, double* to) {
  const Strips strips{to, kStrip, static_cast<std::ptrdiff_t>(kStrip) * columns};
  for (int i = 0; i < rows; i += kStrip) {
    for (int p = 0; p < columns; ++p, to += kStrip) {
      const double* source = from + i + p * leading;
      for (int v = 0; v < kVectors; ++v) store(to + v * kLanes, load(source + v * kLanes));
    }
  }
  return strips;
}

/// The same of the transpose: strips of `from`'s columns, with its rows as their columns. The last strip is filled up
/// with zeros.
Strips pack_transposed(const double* from, std::ptrdiff_t leading, int rows, int columns, double* to) {
  const Strips strips{to, kStrip, static_cast<std::ptrdiff_t>(kStrip) * rows};
  for (int j = 0; j < columns; j += kStrip) {
    for (int p = 0; p < rows; ++p, to += kStrip) {
      for (int l = 0; l < kStrip; ++l) to[l] = j + l < columns ? from[p + (j + l) * leading] : 0;
    }
  }
  return strips;
}

/// Factorises the triangle of up to eight pivots at `diagonal` and solves the strips beneath it.
template <int M>
bool eliminate_few(double* diagonal, std::ptrdiff_t leading, int strips_below) {
  double L[M][kStrip];
  for (int j = 0; j < M; ++j) {
    for (int i = 0; i < kStrip; ++i) L[j][i] = diagonal[i + j * leading];
  }
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

bool eliminate(const FrontShape& shape, double* panel, double* update, double* workspace) {
  const std::ptrdiff_t leading = shape.leading();
  const int height = shape.leading();
  const int first_below = shape.first_below();
  for (int begin = 0; begin < shape.pivots; begin += kPanel) {
    const int end = least(shape.pivots, begin + kPanel);
    for (int j = begin; j < end; j += kStrip) {
      const int width = least(kStrip, end - j);
      double* diagonal = panel + j + j * leading;
      const Strips rows{panel + j + begin * leading, leading, kStrip};
      if (j > begin) subtract_product(diagonal, leading, height - j, width, rows, rows, j - begin, false);
      if (!eliminate_up_to_eight(width, diagonal, leading, (height - j) / kStrip - 1)) return false;
    }
    if (end == shape.pivots && shape.below == 0) break;
    // What remains: the later pivots' columns, and the update.
    const int top = end < shape.pivots ? end : first_below;
    const double* beneath = panel + top + begin * leading;
    const int depth = end - begin;
    const Strips rows = height - top > kPackedHeight ? pack(beneath, leading, height - top, depth, workspace)
                                                     : Strips{beneath, leading, kStrip};
    if (end < shape.pivots) {
      subtract_product(panel + end + end * leading, leading, height - end, shape.pivots - end, rows, rows, depth, true);
    }
    const Strips below{rows.first + (first_below - top) / kStrip * rows.between, rows.column, rows.between};
    subtract_product(update, padded(shape.below), padded(shape.below), shape.below, below, below, depth, true);
  }
  return true;
}

void forward(const FrontShape& shape, const double* panel, double* pivots, double* below) {
  const std::ptrdiff_t leading = shape.leading();
  const double* L = panel;
  for (int j = 0; j < shape.pivots; ++j, L += leading) {
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
  const std::ptrdiff_t leading = shape.leading();
  for (int j = shape.pivots - 1; j >= 0; --j) {
    const double* L = panel + j * leading;
    double x = pivots[j] - dot_padded(L + shape.first_below(), below, padded(shape.below));
    for (int i = j + 1; i < shape.pivots; ++i) x -= L[i] * pivots[i];
    pivots[j] = x * L[j];
  }
}

/// X <- X T^-1 for X (rows x pivots) and the panel's triangle T, from the last column to the first.
void solve_from_right(double* X, std::ptrdiff_t x_leading, int rows, const FrontShape& shape, const double* panel,
                      double* workspace) {
  const std::ptrdiff_t leading = shape.leading();
  for (int j = (shape.pivots - 1) / kStrip * kStrip; j >= 0; j -= kStrip) {
    const int width = least(kStrip, shape.pivots - j);
    const int later = shape.pivots - j - width;
    if (later > 0) {
      const Strips T = pack_transposed(panel + (j + width) + j * leading, leading, later, width, workspace);
      const Strips rows_of_x{X + (j + width) * x_leading, x_leading, kStrip};
      subtract_product(X + j * x_leading, x_leading, rows, width, rows_of_x, T, later, false);
    }
    for (int l = width - 1; l >= 0; --l) {
      double* column = X + (j + l) * x_leading;
      const double* T = panel + j + (j + l) * leading;
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
    for (int i = 0; i < rows; ++i) X[i + j * leading] = panel[first_below + i + j * leading];
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
