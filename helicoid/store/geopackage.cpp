#include "helicoid/store/geopackage.hpp"

#include <algorithm>
#include <limits>

namespace helicoid::store {

namespace {

constexpr std::uint8_t kLittleEndian = 0x01;
constexpr std::uint8_t kEnvelopeXY = 0x02;
constexpr std::uint8_t kEmpty = 0x10;
enum class WkbType : std::uint32_t { point = 1, line = 2, polygon = 3 };

void put_header(BlobWriter& blob, std::uint8_t flags) {
  blob.clear();
  blob.put('G');
  blob.put('P');
  blob.put(std::uint8_t{0});
  blob.put(static_cast<std::uint8_t>(kLittleEndian | flags));
  blob.put(kPlaneSrs);
}

void put_envelope(BlobWriter& blob, std::span<const Vector2d> points) {
  Extent extent;
  for (const Vector2d& p : points) extent.add(p);
  for (const double bound : {extent.min_x, extent.max_x, extent.min_y, extent.max_y}) blob.put(bound);
}

void put_type(BlobWriter& blob, WkbType type) {
  blob.put(std::uint8_t{1});
  blob.put(static_cast<std::uint32_t>(type));
}

void put_vertex(BlobWriter& blob, const Vector2d& p) {
  blob.put(p.x());
  blob.put(p.y());
}

constexpr const char* kStandardTables =
    R"(
CREATE TABLE gpkg_spatial_ref_sys (srs_name TEXT NOT NULL, srs_id INTEGER PRIMARY KEY, organization TEXT NOT NULL,
  organization_coordsys_id INTEGER NOT NULL, definition TEXT NOT NULL, description TEXT);
CREATE TABLE gpkg_contents (table_name TEXT NOT NULL PRIMARY KEY, data_type TEXT NOT NULL, identifier TEXT UNIQUE,
  description TEXT DEFAULT '', last_change DATETIME NOT NULL DEFAULT (strftime('%Y-%m-%dT%H:%M:%fZ','now')),
  min_x DOUBLE, min_y DOUBLE, max_x DOUBLE, max_y DOUBLE, srs_id INTEGER,
  CONSTRAINT fk_gc_r_srs_id FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys(srs_id));
CREATE TABLE gpkg_geometry_columns (table_name TEXT NOT NULL, column_name TEXT NOT NULL,
  geometry_type_name TEXT NOT NULL, srs_id INTEGER NOT NULL, z TINYINT NOT NULL, m TINYINT NOT NULL,
  CONSTRAINT pk_geom_cols PRIMARY KEY (table_name, column_name), CONSTRAINT uk_gc_table_name UNIQUE (table_name),
  CONSTRAINT fk_gc_tn FOREIGN KEY (table_name) REFERENCES gpkg_contents(table_name),
  CONSTRAINT fk_gc_srs FOREIGN KEY (srs_id) REFERENCES gpkg_spatial_ref_sys (srs_id));
INSERT INTO gpkg_spatial_ref_sys VALUES
  ('Undefined Cartesian SRS', -1, 'NONE', -1, 'undefined', 'undefined Cartesian coordinate reference system'),
  ('Undefined geographic SRS', 0, 'NONE', 0, 'undefined', 'undefined geographic coordinate reference system'),
  ('WGS 84 geodetic', 4326, 'EPSG', 4326, 'GEOGCS["WGS 84",DATUM["WGS_1984",SPHEROID["WGS 84",6378137,298.257223563,)"
    R"(AUTHORITY["EPSG","7030"]],AUTHORITY["EPSG","6326"]],PRIMEM["Greenwich",0,AUTHORITY["EPSG","8901"]],)"
    R"(UNIT["degree",0.0174532925199433,AUTHORITY["EPSG","9122"]],AUTHORITY["EPSG","4326"]]',
   'longitude/latitude coordinates in decimal degrees on the WGS 84 spheroid');
)";

constexpr const char* kLayers = R"(
CREATE TABLE patches (fid INTEGER PRIMARY KEY, geom POINT, robot TEXT, scan INTEGER, stamp DOUBLE, yaw_deg DOUBLE,
  island INTEGER, relations INTEGER);
CREATE TABLE free_space (fid INTEGER PRIMARY KEY, geom POLYGON, robot TEXT, island INTEGER);
CREATE TABLE relations (fid INTEGER PRIMARY KEY, geom LINESTRING, a INTEGER, b INTEGER, kind TEXT,
  correspondences INTEGER, island INTEGER);
CREATE TABLE trajectories (fid INTEGER PRIMARY KEY, geom LINESTRING, robot TEXT, island INTEGER, scans INTEGER);
)";

}  // namespace

std::string geopackage_schema() {
  return std::string(kStandardTables) + kLayers;
}

void Extent::add(const Vector2d& p) {
  if (empty) *this = {p.x(), p.y(), p.x(), p.y(), false};
  min_x = std::min(min_x, p.x());
  min_y = std::min(min_y, p.y());
  max_x = std::max(max_x, p.x());
  max_y = std::max(max_y, p.y());
}

void put_point(BlobWriter& blob, const Vector2d& p_plane) {
  put_header(blob, 0);
  put_type(blob, WkbType::point);
  put_vertex(blob, p_plane);
}

void put_line(BlobWriter& blob, std::span<const Vector2d> points_plane) {
  put_header(blob, kEnvelopeXY);
  put_envelope(blob, points_plane);
  put_type(blob, WkbType::line);
  blob.put(static_cast<std::uint32_t>(points_plane.size()));
  for (const Vector2d& p : points_plane) put_vertex(blob, p);
}

void put_polygon(BlobWriter& blob, std::span<const Vector2d> ring_plane) {
  if (ring_plane.size() < 3) {
    put_header(blob, kEmpty);
    put_type(blob, WkbType::polygon);
    blob.put(std::uint32_t{0});
    return;
  }
  put_header(blob, kEnvelopeXY);
  put_envelope(blob, ring_plane);
  put_type(blob, WkbType::polygon);
  blob.put(std::uint32_t{1});
  blob.put(static_cast<std::uint32_t>(ring_plane.size() + 1));
  for (const Vector2d& p : ring_plane) put_vertex(blob, p);
  put_vertex(blob, ring_plane.front());
}

}  // namespace helicoid::store
