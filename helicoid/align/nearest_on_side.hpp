// The innermost loop of scan matching: the nearest of a run of points whose normal agrees, eight at a time.
#pragma once

#include <cstdint>

namespace helicoid {

/// Compiled once for each class of processors and chosen at run time; the same operations, so the same bits.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__)
#define HELICOID_WIDE_LANES __attribute__((target_clones("avx2", "default")))
#else
#define HELICOID_WIDE_LANES
#endif

/// Normals whose cosine is less belong to another side, or to another wall of a corner.
inline constexpr float kSameSide = 0.7F;

/// Points with unit normals: arrays of `size` floats, metres. A normal of zero agrees with none.
struct OrientedPoints {
  const float* x;
  const float* y;
  const float* nx;
  const float* ny;
  int size;
};

struct OrientedPoint {
  float x, y, nx, ny;
};

/// Finds the point nearest to p, within a gate (metres), of the runs that it is shown: of those at one distance the
/// one of the lowest index. A run may be read a few points beyond its end.
class NearestOnSide {
 public:
  [[gnu::always_inline]] NearestOnSide(const OrientedPoint& p, float gate) : p_(p), square_(Floats{} + gate * gate) {}

  [[gnu::always_inline]] void look(const OrientedPoints& points, int first, int last) {
    int at = first;
    for (; at < last && at + kLanes <= points.size; at += kLanes) {
      const Floats dx = load(points.x + at) - p_.x;
      const Floats dy = load(points.y + at) - p_.y;
      const Floats square = dx * dx + dy * dy;
      const Floats agreement = load(points.nx + at) * p_.nx + load(points.ny + at) * p_.ny;
      keep(square, agreement, Ints{0, 1, 2, 3, 4, 5, 6, 7} + at);
    }
    // The last few of all.
    for (; at < last; ++at) {
      const float dx = points.x[at] - p_.x;
      const float dy = points.y[at] - p_.y;
      keep(Floats{} + (dx * dx + dy * dy), Floats{} + (points.nx[at] * p_.nx + points.ny[at] * p_.ny), Ints{} + at);
    }
  }

  /// -1: none.
  [[nodiscard, gnu::always_inline]] int found() const {
    int best = 0;
    for (int lane = 1; lane < kLanes; ++lane) {
      const bool is_nearer = square_[lane] < square_[best];
      const bool is_before = square_[lane] == square_[best] && index_[lane] < index_[best];
      if (is_nearer || is_before) best = lane;
    }
    return index_[best];
  }

 private:
  static constexpr int kLanes = 8;
  using Floats = float __attribute__((vector_size(4 * kLanes)));
  using Ints = std::int32_t __attribute__((vector_size(4 * kLanes)));

  using FloatsAnywhere = float __attribute__((vector_size(4 * kLanes), aligned(4), may_alias));

  [[gnu::always_inline]] static const FloatsAnywhere& load(const float* from) {
    return *reinterpret_cast<const FloatsAnywhere*>(from);
  }
  [[gnu::always_inline]] void keep(const Floats& square, const Floats& agreement, const Ints& place) {
    const Ints nearer = (square < square_) & (agreement > kSameSide);
    square_ = nearer ? square : square_;
    index_ = nearer ? place : index_;
  }

  OrientedPoint p_;
  Floats square_;
  Ints index_ = Ints{} - 1;
};

}  // namespace helicoid
