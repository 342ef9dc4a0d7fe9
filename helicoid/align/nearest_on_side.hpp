// The innermost loop of scan matching: the nearest of a run of points whose normal agrees, eight at a time.
#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>

namespace helicoid {

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
    Floats least = square_;
    Floats other = __builtin_shufflevector(least, least, 4, 5, 6, 7, 0, 1, 2, 3);
    least = other < least ? other : least;
    other = __builtin_shufflevector(least, least, 2, 3, 0, 1, 6, 7, 4, 5);
    least = other < least ? other : least;
    other = __builtin_shufflevector(least, least, 1, 0, 3, 2, 5, 4, 7, 6);
    least = other < least ? other : least;
    // A lane that found nothing still holds the gate: it is least only if none did.
    Ints first = square_ == least ? index_ : Ints{} + std::numeric_limits<std::int32_t>::max();
    Ints next = __builtin_shufflevector(first, first, 4, 5, 6, 7, 0, 1, 2, 3);
    first = next < first ? next : first;
    next = __builtin_shufflevector(first, first, 2, 3, 0, 1, 6, 7, 4, 5);
    first = next < first ? next : first;
    return std::min(first[0], first[1]);
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
