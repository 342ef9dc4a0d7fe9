#include "helicoid/geometry/polysolid.hpp"

#include <geos_c.h>

#include <algorithm>
#include <memory>
#include <stdexcept>

namespace helicoid {

namespace {

/// Coordinates are rounded to this where exact overlay fails: with fixed precision it cannot. Metres.
constexpr double kFallbackGrid = 1e-7;

/// GEOS keeps its state in a context; one a thread, so that threads never meet in it.
GEOSContextHandle_t context() {
  struct Context {
    GEOSContextHandle_t handle = GEOS_init_r();
    ~Context() { GEOS_finish_r(handle); }
  };
  thread_local const Context context;
  return context.handle;
}

struct Destroy {
  void operator()(GEOSGeometry* geometry) const { GEOSGeom_destroy_r(context(), geometry); }
};
using Geometry = std::unique_ptr<GEOSGeometry, Destroy>;

Geometry collect(int type, std::vector<Geometry> parts) {
  std::vector<GEOSGeometry*> raw;
  for (Geometry& part : parts) raw.push_back(part.release());
  return Geometry(GEOSGeom_createCollection_r(context(), type, raw.data(), static_cast<unsigned>(raw.size())));
}

Geometry to_geos_ring(const Ring& ring) {
  if (ring.size() < 3) throw std::invalid_argument("a polysolid's rings have at least three vertices");
  std::vector<double> coordinates;
  coordinates.reserve(2 * ring.size() + 2);
  for (std::size_t i = 0; i <= ring.size(); ++i) {
    const Vector2d& p = ring[i % ring.size()];
    if (!p.allFinite()) throw std::invalid_argument("a polysolid's coordinates must be finite");
    coordinates.push_back(p.x());
    coordinates.push_back(p.y());
  }
  const auto count = static_cast<unsigned>(ring.size() + 1);
  return Geometry(GEOSGeom_createLinearRing_r(
      context(), GEOSCoordSeq_copyFromBuffer_r(context(), coordinates.data(), count, 0, 0)));
}

Geometry to_geos(const PolygonWithHoles& polygon) {
  Geometry outer = to_geos_ring(polygon.outer);
  std::vector<Geometry> rings;
  for (const Ring& hole : polygon.holes) rings.push_back(to_geos_ring(hole));
  std::vector<GEOSGeometry*> holes;
  for (Geometry& ring : rings) holes.push_back(ring.release());
  return Geometry(
      GEOSGeom_createPolygon_r(context(), outer.release(), holes.data(), static_cast<unsigned>(holes.size())));
}

Geometry to_geos(const Polysolid& solid) {
  std::vector<Geometry> polygons;
  for (const PolygonWithHoles& polygon : solid.polygons) polygons.push_back(to_geos(polygon));
  return collect(GEOS_MULTIPOLYGON, std::move(polygons));
}

double signed_area(const Ring& ring) {
  double twice = 0;
  for (std::size_t i = 1; i + 1 < ring.size(); ++i) {
    const Vector2d a = ring[i] - ring[0];
    const Vector2d b = ring[i + 1] - ring[0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return 0.5 * twice;
}

bool is_before(const Vector2d& a, const Vector2d& b) {
  return a.x() != b.x() ? a.x() < b.x() : a.y() < b.y();
}
bool starts_before(const Ring& a, const Ring& b) {
  return std::lexicographical_compare(a.begin(), a.end(), b.begin(), b.end(), is_before);
}

/// Turned the way that is asked for and begun at the first vertex by x, then y.
Ring from_geos_ring(const GEOSGeometry* geometry, bool anticlockwise) {
  const GEOSCoordSequence* sequence = GEOSGeom_getCoordSeq_r(context(), geometry);
  unsigned count = 0;
  GEOSCoordSeq_getSize_r(context(), sequence, &count);
  std::vector<double> coordinates(2 * std::size_t{count});
  GEOSCoordSeq_copyToBuffer_r(context(), sequence, coordinates.data(), 0, 0);
  Ring ring;
  for (std::size_t i = 0; i + 1 < count; ++i) ring.emplace_back(coordinates[2 * i], coordinates[2 * i + 1]);
  if ((signed_area(ring) > 0) != anticlockwise) std::reverse(ring.begin(), ring.end());
  std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), is_before), ring.end());
  return ring;
}

void append_areas(const GEOSGeometry* geometry, Polysolid& solid) {
  const int type = GEOSGeomTypeId_r(context(), geometry);
  if (type == GEOS_POLYGON) {
    if (GEOSisEmpty_r(context(), geometry) != 0) return;
    PolygonWithHoles polygon{from_geos_ring(GEOSGetExteriorRing_r(context(), geometry), true), {}};
    const int holes = GEOSGetNumInteriorRings_r(context(), geometry);
    for (int i = 0; i < holes; ++i) {
      polygon.holes.push_back(from_geos_ring(GEOSGetInteriorRingN_r(context(), geometry, i), false));
    }
    std::sort(polygon.holes.begin(), polygon.holes.end(), starts_before);
    solid.polygons.push_back(std::move(polygon));
  } else if (type == GEOS_MULTIPOLYGON || type == GEOS_GEOMETRYCOLLECTION) {
    const int parts = GEOSGetNumGeometries_r(context(), geometry);
    for (int i = 0; i < parts; ++i) append_areas(GEOSGetGeometryN_r(context(), geometry, i), solid);
  }
}

/// The areas of a geometry; lines and points are left out.
Polysolid from_geos(const Geometry& geometry) {
  if (!geometry) throw std::runtime_error("the polygon library could not make a result of finite input");
  Polysolid solid;
  append_areas(geometry.get(), solid);
  std::sort(solid.polygons.begin(), solid.polygons.end(),
            [](const PolygonWithHoles& a, const PolygonWithHoles& b) { return starts_before(a.outer, b.outer); });
  return solid;
}

bool is_valid(const Geometry& geometry) {
  return geometry && GEOSisValid_r(context(), geometry.get()) == 1;
}

Geometry repaired(Geometry geometry) {
  if (is_valid(geometry)) return geometry;
  return Geometry(GEOSMakeValid_r(context(), geometry.get()));
}

using Overlay = GEOSGeometry* (*)(GEOSContextHandle_t, const GEOSGeometry*, const GEOSGeometry*);
using RoundedOverlay = GEOSGeometry* (*)(GEOSContextHandle_t, const GEOSGeometry*, const GEOSGeometry*, double);

Polysolid overlay(const Polysolid& a, const Polysolid& b, Overlay exact, RoundedOverlay rounded) {
  const Geometry first = to_geos(a);
  const Geometry second = to_geos(b);
  Geometry result(exact(context(), first.get(), second.get()));
  if (!result) result.reset(rounded(context(), first.get(), second.get(), kFallbackGrid));
  return from_geos(result);
}

}  // namespace

Polysolid make_polysolid(std::span<const Vector2d> ring) {
  // Three vertices make an area; the library refuses fewer.
  if (ring.size() < 3) return {};
  return from_geos(repaired(to_geos(PolygonWithHoles{{ring.begin(), ring.end()}, {}})));
}

Polysolid make_rectangle(const Vector2d& low, const Vector2d& high) {
  const Vector2d corners[] = {low, {high.x(), low.y()}, high, {low.x(), high.y()}};
  return make_polysolid(corners);
}

Polysolid union_of(const Polysolid& a, const Polysolid& b) {
  return overlay(a, b, GEOSUnion_r, GEOSUnionPrec_r);
}

Polysolid union_of(std::span<const Polysolid> solids) {
  std::vector<Geometry> parts;
  for (const Polysolid& solid : solids) {
    for (const PolygonWithHoles& polygon : solid.polygons) parts.push_back(to_geos(polygon));
  }
  const Geometry all = collect(GEOS_GEOMETRYCOLLECTION, std::move(parts));
  Geometry result(GEOSUnaryUnion_r(context(), all.get()));
  if (!result) result.reset(GEOSUnaryUnionPrec_r(context(), all.get(), kFallbackGrid));
  return from_geos(result);
}

Polysolid intersection(const Polysolid& a, const Polysolid& b) {
  return overlay(a, b, GEOSIntersection_r, GEOSIntersectionPrec_r);
}

Polysolid difference(const Polysolid& a, const Polysolid& b) {
  return overlay(a, b, GEOSDifference_r, GEOSDifferencePrec_r);
}

Polysolid offset(const Polysolid& solid, double distance, int segments_per_quarter) {
  const Geometry geometry = to_geos(solid);
  return from_geos(repaired(Geometry(GEOSBuffer_r(context(), geometry.get(), distance, segments_per_quarter))));
}

Polysolid simplify(const Polysolid& solid, double tolerance) {
  const Geometry geometry = to_geos(solid);
  // The library's result can be invalid in spite of its name: rings of different polygons may come to cross.
  return from_geos(repaired(Geometry(GEOSTopologyPreserveSimplify_r(context(), geometry.get(), tolerance))));
}

Polysolid transformed(const Pose2& T_a_b, const Polysolid& solid_b) {
  Polysolid solid_a = solid_b;
  const auto move = [&T_a_b](Ring& ring) {
    for (Vector2d& p : ring) p = T_a_b * p;
    std::rotate(ring.begin(), std::min_element(ring.begin(), ring.end(), is_before), ring.end());
  };
  for (PolygonWithHoles& polygon : solid_a.polygons) {
    move(polygon.outer);
    for (Ring& hole : polygon.holes) move(hole);
    std::sort(polygon.holes.begin(), polygon.holes.end(), starts_before);
  }
  std::sort(solid_a.polygons.begin(), solid_a.polygons.end(),
            [](const PolygonWithHoles& a, const PolygonWithHoles& b) { return starts_before(a.outer, b.outer); });
  return solid_a;
}

double area(const Polysolid& solid) {
  double sum = 0;
  for (const PolygonWithHoles& polygon : solid.polygons) {
    sum += std::abs(signed_area(polygon.outer));
    for (const Ring& hole : polygon.holes) sum -= std::abs(signed_area(hole));
  }
  return sum;
}

bool contains(const Polysolid& solid, const Vector2d& point) {
  if (!point.allFinite()) throw std::invalid_argument("a point's coordinates must be finite");
  const Geometry geometry = to_geos(solid);
  const Geometry at(GEOSGeom_createPointFromXY_r(context(), point.x(), point.y()));
  return GEOSCovers_r(context(), geometry.get(), at.get()) == 1;
}

bool contains(const Polysolid& a, const Polysolid& b) {
  if (b.empty()) return true;
  return GEOSCovers_r(context(), to_geos(a).get(), to_geos(b).get()) == 1;
}

bool is_valid(const Polysolid& solid) {
  const auto is_ring = [](const Ring& ring) {
    return ring.size() >= 3 && std::all_of(ring.begin(), ring.end(), [](const Vector2d& p) { return p.allFinite(); });
  };
  const bool made_of_rings = std::all_of(solid.polygons.begin(), solid.polygons.end(), [&](const PolygonWithHoles& p) {
    return is_ring(p.outer) && std::all_of(p.holes.begin(), p.holes.end(), is_ring);
  });
  return made_of_rings && is_valid(to_geos(solid));
}

}  // namespace helicoid
