#include "helicoid/store/schema.hpp"

#include <cmath>
#include <vector>

#include "helicoid/store/geopackage.hpp"

namespace helicoid::store {

namespace {

/// The free-space layer leaves out vertices that lie this near to the line between others; metres. Only the picture
/// in a GIS is made from it, and it would be most of the file.
constexpr double kRingTolerance = 0.01;

/// Time of the newest scan as the standard writes times; the file must not depend on when it was written.
std::string last_change(const Map& map) {
  double newest = 0;
  for (const RobotRecord& robot : map.robots()) {
    for (const TrackedScan& scan : robot.trajectory) newest = std::max(newest, scan.stamp);
  }
  constexpr double kYear3000 = 32503680000.0;
  if (!(newest < kYear3000)) newest = 0;
  const auto seconds = static_cast<std::int64_t>(newest);
  // Days to a date of the Gregorian calendar, counted in eras of 400 years that begin on the first of March.
  const std::int64_t days = seconds / 86400 + 719468;
  const std::int64_t era = days / 146097;
  const std::int64_t day_of_era = days % 146097;
  const std::int64_t year_of_era = (day_of_era - day_of_era / 1460 + day_of_era / 36524 - day_of_era / 146096) / 365;
  const std::int64_t day_of_year = day_of_era - (365 * year_of_era + year_of_era / 4 - year_of_era / 100);
  const std::int64_t month_from_march = (5 * day_of_year + 2) / 153;
  const std::int64_t day = day_of_year - (153 * month_from_march + 2) / 5 + 1;
  const std::int64_t month = month_from_march < 10 ? month_from_march + 3 : month_from_march - 9;
  const std::int64_t year = year_of_era + era * 400 + (month <= 2 ? 1 : 0);
  const std::int64_t second = seconds % 86400;
  return fmt::format("{:04}-{:02}-{:02}T{:02}:{:02}:{:02}.000Z", year, month, day, second / 3600, second / 60 % 60,
                     second % 60);
}

Extent write_patch_layer(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO patches VALUES (?, ?, ?, ?, ?, ?, ?, ?)");
  BlobWriter geometry;
  Extent extent;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    const Patch& patch = map.patch(id);
    const Pose2& T_plane_patch = map.T_plane_patch(id);
    extent.add(T_plane_patch.translation());
    put_point(geometry, T_plane_patch.translation());
    insert.bind(0, static_cast<std::int64_t>(i)).bind_blob(1, geometry.bytes());
    insert.bind(2, std::string_view(map.robot(patch.robot).name)).bind(3, static_cast<std::int64_t>(patch.scan_index));
    insert.bind(4, patch.stamp).bind(5, degrees(T_plane_patch.yaw));
    insert.bind(6, std::int64_t{map.island_of(id).value});
    insert.bind(7, static_cast<std::int64_t>(map.relations_of(id).size())).execute();
  }
  return extent;
}

/// The ring in the plane without the vertices that lie on the line between the last kept and the next.
void to_plane(const std::vector<Eigen::Vector2f>& ring, const Pose2& T_plane_patch, std::vector<Vector2d>& out) {
  out.clear();
  const Matrix2d R = T_plane_patch.rotation();
  const Vector2d t = T_plane_patch.translation();
  std::size_t kept = 0;
  for (std::size_t i = 0; i < ring.size(); ++i) {
    if (i > 0 && i + 1 < ring.size()) {
      const Eigen::Vector2f along = ring[i + 1] - ring[kept];
      const Eigen::Vector2f to = ring[i] - ring[kept];
      const float cross = along.x() * to.y() - along.y() * to.x();
      const auto limit = static_cast<float>(kRingTolerance) * along.norm();
      // At most half of a straight wall's vertices go in a row, so that small bends cannot add up to a large one.
      if (std::abs(cross) < limit && along.dot(to) > 0 && along.norm() > to.norm() && i - kept < 8) continue;
    }
    kept = i;
    out.push_back(R * ring[i].cast<double>() + t);
  }
}

Extent write_free_space_layer(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO free_space VALUES (?, ?, ?, ?)");
  BlobWriter geometry;
  Extent extent;
  std::vector<Vector2d> ring;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    const Patch& patch = map.patch(id);
    to_plane(patch.free_space, map.T_plane_patch(id), ring);
    for (const Vector2d& p : ring) extent.add(p);
    put_polygon(geometry, ring);
    insert.bind(0, static_cast<std::int64_t>(i)).bind_blob(1, geometry.bytes());
    insert.bind(2, std::string_view(map.robot(patch.robot).name));
    insert.bind(3, std::int64_t{map.island_of(id).value}).execute();
  }
  return extent;
}

Extent write_relation_layer(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO relations VALUES (?, ?, ?, ?, ?, ?, ?)");
  BlobWriter geometry;
  Extent extent;
  for (std::size_t i = 0; i < map.relations().size(); ++i) {
    const Relation& relation = map.relations()[i];
    const Vector2d ends[] = {map.T_plane_patch(relation.a).translation(), map.T_plane_patch(relation.b).translation()};
    extent.add(ends[0]);
    extent.add(ends[1]);
    put_line(geometry, ends);
    insert.bind(0, static_cast<std::int64_t>(i)).bind_blob(1, geometry.bytes());
    insert.bind(2, std::int64_t{relation.a.value}).bind(3, std::int64_t{relation.b.value});
    insert.bind(4, std::string_view(name_of(relation.kind))).bind(5, std::int64_t{relation.correspondences});
    insert.bind(6, std::int64_t{map.island_of(relation.a).value}).execute();
  }
  return extent;
}

/// A robot's way, a line for each run of scans on one island.
Extent write_trajectory_layer(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO trajectories VALUES (?, ?, ?, ?, ?)");
  BlobWriter geometry;
  Extent extent;
  std::int64_t fid = 0;
  std::vector<Vector2d> line;
  for (const RobotRecord& robot : map.robots()) {
    for (std::size_t first = 0; first < robot.trajectory.size();) {
      const IslandId island = map.island_of(robot.trajectory[first].pose.patch);
      line.clear();
      std::size_t next = first;
      for (; next < robot.trajectory.size(); ++next) {
        const ManifoldPose& pose = robot.trajectory[next].pose;
        if (map.island_of(pose.patch) != island) break;
        line.push_back(map.T_plane_patch(pose.patch) * pose.T_patch_robot.translation());
        extent.add(line.back());
      }
      // A line string has two points at least.
      if (line.size() == 1) line.push_back(line.front());
      put_line(geometry, line);
      insert.bind(0, fid++).bind_blob(1, geometry.bytes()).bind(2, std::string_view(robot.name));
      insert.bind(3, std::int64_t{island.value}).bind(4, static_cast<std::int64_t>(next - first)).execute();
      first = next;
    }
  }
  return extent;
}

struct Layer {
  const char* name;
  const char* geometry_type;
  const char* description;
  Extent extent;
};

}  // namespace

std::string own_schema() {
  return R"(
CREATE TABLE helicoid_map (key TEXT PRIMARY KEY, value TEXT NOT NULL);
CREATE TABLE helicoid_robots (id INTEGER PRIMARY KEY, name TEXT NOT NULL, lasers BLOB NOT NULL, scans INTEGER NOT NULL,
  trajectory BLOB NOT NULL);
CREATE TABLE helicoid_lasers (id INTEGER PRIMARY KEY, name TEXT NOT NULL, model BLOB NOT NULL);
CREATE TABLE helicoid_patches (id INTEGER PRIMARY KEY, robot INTEGER NOT NULL, scan INTEGER NOT NULL,
  island INTEGER NOT NULL, laser INTEGER NOT NULL, content BLOB NOT NULL);
CREATE TABLE helicoid_relations (id INTEGER PRIMARY KEY, a INTEGER NOT NULL, b INTEGER NOT NULL, kind INTEGER NOT NULL,
  content BLOB NOT NULL);
CREATE TABLE helicoid_ledger (id INTEGER PRIMARY KEY, state TEXT NOT NULL, entry TEXT NOT NULL);
)";
}

void write_layers(Database& db, const Map& map) {
  const Layer layers[] = {
      {"patches", "POINT", "Where each patch stands in its island's plane [m]", write_patch_layer(db, map)},
      {"free_space", "POLYGON", "What each patch saw to be free", write_free_space_layer(db, map)},
      {"relations", "LINESTRING", "Which pairs of patches were matched", write_relation_layer(db, map)},
      {"trajectories", "LINESTRING", "The way of each robot", write_trajectory_layer(db, map)}};
  const std::string changed = last_change(map);
  Statement contents(db, "INSERT INTO gpkg_contents VALUES (?, 'features', ?, ?, ?, ?, ?, ?, ?, -1)");
  Statement columns(db, "INSERT INTO gpkg_geometry_columns VALUES (?, 'geom', ?, -1, 0, 0)");
  for (const Layer& layer : layers) {
    contents.bind(0, std::string_view(layer.name)).bind(1, std::string_view(layer.name));
    contents.bind(2, std::string_view(layer.description)).bind(3, std::string_view(changed));
    contents.bind(4, layer.extent.min_x).bind(5, layer.extent.min_y);
    contents.bind(6, layer.extent.max_x).bind(7, layer.extent.max_y).execute();
    columns.bind(0, std::string_view(layer.name)).bind(1, std::string_view(layer.geometry_type)).execute();
  }
}

}  // namespace helicoid::store
