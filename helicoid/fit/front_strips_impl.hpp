// Products of matrices in strips of rows: what the dense kernels of a front are made of. Compiled once for each class
// of processors by the files that include front_kernels_impl.hpp, and used by nothing else.
#pragma once

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

typedef double Vector __attribute__((vector_size(kLanes * sizeof(double)), aligned(8), may_alias));

inline Vector load(const double* p) {
  return *reinterpret_cast<const Vector*>(p);
}
inline void store(double* p, Vector v) {
  *reinterpret_cast<Vector*>(p) = v;
}
inline Vector spread(double value) {
  return value - Vector{};
}

/// Strips of eight rows, `between` doubles apart; each holds its columns `column` doubles apart.
struct Strips {
  const double* first;
  std::ptrdiff_t column;
  std::ptrdiff_t between;
};

/// C -= A B^T for a tile of N strips x M columns; B's rows are lanes of one of its strips.
template <int N, int M>
void subtract_tile(double* c, std::ptrdiff_t c_column, const double* a, std::ptrdiff_t a_column,
                   std::ptrdiff_t a_between, const double* b, std::ptrdiff_t b_column, int depth) {
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
constexpr Tile kTiles[3][8] = {{subtract_tile<1, 1>, subtract_tile<1, 2>, subtract_tile<1, 3>, subtract_tile<1, 4>,
                                subtract_tile<1, 5>, subtract_tile<1, 6>, subtract_tile<1, 7>, subtract_tile<1, 8>},
                               {subtract_tile<2, 1>, subtract_tile<2, 2>, subtract_tile<2, 3>, subtract_tile<2, 4>,
                                subtract_tile<2, 5>, subtract_tile<2, 6>, subtract_tile<2, 7>, subtract_tile<2, 8>},
                               {subtract_tile<3, 1>, subtract_tile<3, 2>, subtract_tile<3, 3>, subtract_tile<3, 4>,
                                subtract_tile<3, 5>, subtract_tile<3, 6>, subtract_tile<3, 7>, subtract_tile<3, 8>}};

inline int least(int a, int b) {
  return a < b ? a : b;
}

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

}  // namespace

}  // namespace helicoid
