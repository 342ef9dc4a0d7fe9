// The part of the file that other programs read: OGC GeoPackage 1.3, vector features (OGC 12-128r17).
#pragma once

#include <span>
#include <string>

#include "helicoid/geometry/pose2.hpp"
#include "helicoid/store/blob.hpp"

namespace helicoid::store {

inline constexpr std::int64_t kApplicationId = 0x47504B47;  ///< "GPKG"
inline constexpr std::int64_t kUserVersion = 10300;
/// GeoPackage's "undefined Cartesian": metres in the island's plane, nowhere on Earth.
inline constexpr std::int32_t kPlaneSrs = -1;

/// The statements that make the tables which the standard asks for, and the four empty layers.
[[nodiscard]] std::string geopackage_schema();

/// What gpkg_contents says about a layer.
struct Extent {
  double min_x = 0, min_y = 0, max_x = 0, max_y = 0;
  bool empty = true;
  void add(const Vector2d& p);
};

/// Geometries in the standard's binary form, coordinates in the island's plane [m]. Each replaces what was in the blob.
void put_point(BlobWriter& blob, const Vector2d& p_plane);
void put_line(BlobWriter& blob, std::span<const Vector2d> points_plane);
/// The ring is open: its first vertex is repeated for it. Fewer than three vertices give an empty polygon.
void put_polygon(BlobWriter& blob, std::span<const Vector2d> ring_plane);

}  // namespace helicoid::store
