// Polysolids: polygons with holes, closed under union, intersection and difference (paper III-A: the free space of
// patches, and of several patches together). Exact to the rounding of coordinates. Lengths in metres.
// All operations are regularised: what has no area (touching edges, single points) is left out of every result.
#pragma once

#include <span>
#include <vector>

#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

/// A closed line, the first vertex not repeated at the end.
using Ring = std::vector<Vector2d>;

/// One connected area.
struct PolygonWithHoles {
  Ring outer;               ///< anticlockwise
  std::vector<Ring> holes;  ///< clockwise, inside the outer ring
  friend bool operator==(const PolygonWithHoles&, const PolygonWithHoles&) = default;
};

/// Areas that share no more than single points. The results of the operations below are valid and in a canonical
/// order: the same set of areas from the same numbers compares equal.
struct Polysolid {
  std::vector<PolygonWithHoles> polygons;
  [[nodiscard]] bool empty() const { return polygons.empty(); }
  friend bool operator==(const Polysolid&, const Polysolid&) = default;
};

/// The area inside a ring, by the even-odd rule where it crosses itself; orientation does not matter. Coordinates must
/// be finite, here and below, and rings of solids made by hand have three vertices: std::invalid_argument otherwise.
[[nodiscard]] Polysolid make_polysolid(std::span<const Vector2d> ring);
[[nodiscard]] Polysolid make_rectangle(const Vector2d& low, const Vector2d& high);

[[nodiscard]] Polysolid union_of(const Polysolid& a, const Polysolid& b);
/// All at once: far cheaper than one after the other.
[[nodiscard]] Polysolid union_of(std::span<const Polysolid> solids);
[[nodiscard]] Polysolid intersection(const Polysolid& a, const Polysolid& b);
/// What of a is not in b.
[[nodiscard]] Polysolid difference(const Polysolid& a, const Polysolid& b);

/// The solid grown by a distance, or shrunk if it is negative; arcs are drawn as chords, `segments_per_quarter` a right
/// angle, and lie inside the true arc.
[[nodiscard]] Polysolid offset(const Polysolid& solid, double distance, int segments_per_quarter = 8);
/// Fewer vertices: none of those left out lay farther than `tolerance` from its edge. The result is valid.
[[nodiscard]] Polysolid simplify(const Polysolid& solid, double tolerance);
/// The same solid in another frame.
[[nodiscard]] Polysolid transformed(const Pose2& T_a_b, const Polysolid& solid_b);

/// Square metres.
[[nodiscard]] double area(const Polysolid& solid);
/// True if the point lies in the solid or on its boundary.
[[nodiscard]] bool contains(const Polysolid& solid, const Vector2d& point);
/// True if no point of b lies outside a.
[[nodiscard]] bool contains(const Polysolid& a, const Polysolid& b);
/// True if rings do not cross, holes lie inside and areas do not overlap (the OGC's rules of simple features).
[[nodiscard]] bool is_valid(const Polysolid& solid);

}  // namespace helicoid
