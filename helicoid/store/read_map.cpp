#include <array>
#include <charconv>
#include <filesystem>
#include <fstream>

#include "helicoid/manifold/content_hash.hpp"
#include "helicoid/manifold/map_editor.hpp"
#include "helicoid/store/database.hpp"
#include "helicoid/store/encoding.hpp"
#include "helicoid/store/geopackage.hpp"
#include "helicoid/store/map_file.hpp"

namespace helicoid {

namespace {

using store::BlobReader;
using store::Database;
using store::Statement;

/// No file of ours holds more islands than this; a larger number is damage and must not ask for memory.
constexpr std::int64_t kMostIslands = 100'000'000;

Result<void> check_magic(const std::string& path) {
  std::error_code error;
  if (std::filesystem::is_directory(path, error)) return fail("{}: is a directory; name a map.gpkg in it", path);
  std::ifstream file(path, std::ios::binary);
  if (!file) return fail("{}: cannot be opened; does it exist, and may you read it?", path);
  std::array<char, 16> magic{};
  file.read(magic.data(), magic.size());
  if (std::string_view(magic.data(), magic.size()) != std::string_view("SQLite format 3\0", 16)) {
    return fail("{}: is not an SQLite file; name a map.gpkg that Helicoid wrote", path);
  }
  return {};
}

/// The text of one fact; empty if there is none.
std::string fact(Database& db, std::string_view key) {
  Statement select(db, "SELECT value FROM helicoid_map WHERE key = ?");
  select.bind(0, key);
  return select.step() ? select.text(0) : std::string();
}

std::optional<std::int64_t> number(const std::string& text) {
  std::int64_t value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return {};
  return value;
}

/// Refuses what is not a map of ours, or of a later version.
Result<void> check_kind(Database& db, const std::string& path) {
  Statement application(db, "PRAGMA application_id");
  if (!application.step()) return fail("{}: is damaged: {}", path, db.error().value_or("it has no header"));
  if (application.integer(0) != store::kApplicationId) {
    return fail("{}: is an SQLite file but not a GeoPackage; name a map.gpkg that Helicoid wrote", path);
  }
  Statement own(db, "SELECT count(*) FROM sqlite_master WHERE type = 'table' AND name = 'helicoid_map'");
  if (!own.step()) return fail("{}: is damaged: {}", path, db.error().value_or("it has no tables"));
  if (own.integer(0) != 1) return fail("{}: is a GeoPackage, but Helicoid did not write it", path);
  const auto version = number(fact(db, "schema_version"));
  if (!version || *version < 1) return fail("{}: is damaged: it does not say its schema_version", path);
  if (*version > kMapSchemaVersion) {
    return fail("{}: has schema_version {}, this Helicoid reads {}; use a newer Helicoid", path, *version,
                kMapSchemaVersion);
  }
  if (*version < kMapSchemaVersion) {
    return fail("{}: has schema_version {}, this Helicoid reads {}; map the logs again", path, *version,
                kMapSchemaVersion);
  }
  return {};
}

Result<void> read_robots(Database& db, MapEditor& editor, std::vector<std::vector<TrackedScan>>& trajectories) {
  Statement select(db, "SELECT id, name, lasers, scans, trajectory FROM helicoid_robots ORDER BY id");
  while (select.step()) {
    if (select.integer(0) != static_cast<std::int64_t>(trajectories.size()))
      return fail("robot {} is missing", trajectories.size());
    std::vector<LaserModel> lasers;
    BlobReader laser_blob(select.blob(2));
    while (laser_blob.ok() && laser_blob.left() > 0) lasers.push_back(store::decode_laser(laser_blob));
    std::vector<TrackedScan>& trajectory = trajectories.emplace_back();
    BlobReader blob(select.blob(4));
    while (blob.ok() && blob.left() > 0) trajectory.push_back(store::decode_tracked_scan(blob));
    if (!laser_blob.finished() || !blob.finished() ||
        static_cast<std::int64_t>(trajectory.size()) != select.integer(3)) {
      return fail("the record of robot '{}' is broken", select.text(1));
    }
    editor.add_robot(select.text(1), std::move(lasers));
  }
  return {};
}

Result<std::vector<LaserModel>> read_lasers(Database& db) {
  std::vector<LaserModel> lasers;
  Statement select(db, "SELECT model FROM helicoid_lasers ORDER BY id");
  while (select.step()) {
    BlobReader blob(select.blob(0));
    lasers.push_back(store::decode_laser(blob));
    // A laser sizes tables: what no laser has is damage.
    if (!blob.finished() || lasers.back().beams < 0 || lasers.back().beams > 1'000'000) {
      return fail("laser {} is broken", lasers.size() - 1);
    }
  }
  return lasers;
}

Result<void> read_patches(Database& db, const Map& map, MapEditor& editor) {
  const Result<std::vector<LaserModel>> lasers = read_lasers(db);
  if (!lasers) return tl::unexpected(lasers.error());
  Statement select(db, "SELECT id, robot, scan, island, laser, content FROM helicoid_patches ORDER BY id");
  while (select.step()) {
    const std::size_t next = map.patch_count();
    if (select.integer(0) != static_cast<std::int64_t>(next)) return fail("patch {} is missing", next);
    BlobReader blob(select.blob(5));
    const auto stamp = blob.get<double>();
    const Pose2 T_plane_patch = blob.get_pose();
    Scan scan = store::decode_scan(blob);
    const auto robot = static_cast<std::size_t>(select.integer(1));
    const auto island = static_cast<std::size_t>(select.integer(3));
    const auto laser = static_cast<std::size_t>(select.integer(4));
    const bool known = robot < map.robots().size() && island < map.island_count() && laser < lasers->size();
    if (!blob.finished() || !known) return fail("patch {} is broken", next);
    editor.add_patch(make_patch(make_id<PatchId>(next), make_id<RobotId>(robot),
                                static_cast<std::size_t>(select.integer(2)), stamp, std::move(scan), (*lasers)[laser]),
                     T_plane_patch, make_id<IslandId>(island));
  }
  return {};
}

Result<void> read_relations(Database& db, const Map& map, MapEditor& editor) {
  Statement select(db, "SELECT id, a, b, kind, content FROM helicoid_relations ORDER BY id");
  while (select.step()) {
    const std::size_t next = map.relations().size();
    if (select.integer(0) != static_cast<std::int64_t>(next)) return fail("relation {} is missing", next);
    BlobReader blob(select.blob(4));
    Relation relation = store::decode_relation(blob);
    const auto patches = static_cast<std::int64_t>(map.patch_count());
    const std::int64_t a = select.integer(1);
    const std::int64_t b = select.integer(2);
    const std::int64_t kind = select.integer(3);
    const bool known =
        0 <= a && a < b && b < patches && 0 <= kind && kind <= static_cast<std::int64_t>(RelationKind::sighting);
    if (!blob.finished() || !known) return fail("relation {} is broken", next);
    relation.a = PatchId{static_cast<std::uint32_t>(a)};
    relation.b = PatchId{static_cast<std::uint32_t>(b)};
    relation.kind = static_cast<RelationKind>(kind);
    editor.add_relation(relation);
  }
  return {};
}

Result<Map> read_content(Database& db) {
  Map map;
  MapEditor editor(map);
  const auto islands = number(fact(db, "islands"));
  if (!islands || *islands < 0 || *islands > kMostIslands) return fail("the number of islands is missing");
  for (std::int64_t i = 0; i < *islands; ++i) editor.add_island();
  std::vector<std::vector<TrackedScan>> trajectories;
  Result<void> read = read_robots(db, editor, trajectories);
  if (read) read = read_patches(db, map, editor);
  if (read) read = read_relations(db, map, editor);
  if (!read) return tl::unexpected(read.error());
  for (std::size_t robot = 0; robot < trajectories.size(); ++robot) {
    for (const TrackedScan& scan : trajectories[robot]) {
      if (scan.pose.patch.index() >= map.patch_count()) return fail("a scan stands on a patch that is missing");
      editor.append_scan(make_id<RobotId>(robot), scan);
    }
  }
  if (content_hash(map).hex() != fact(db, "content_hash")) return fail("its content does not match its content_hash");
  return map;
}

}  // namespace

Result<Map> read_map(const std::string& path) {
  if (const Result<void> checked = check_magic(path); !checked) return tl::unexpected(checked.error());
  Database db(path, Database::Mode::read);
  if (const Result<void> checked = check_kind(db, path); !checked) return tl::unexpected(checked.error());
  Result<Map> map = read_content(db);
  // What SQLite says about a broken file comes before what we miss in it.
  if (db.error()) return fail("{}: is damaged: {}; restore it from a copy or map the logs again", path, *db.error());
  if (!map) return fail("{}: is damaged: {}; restore it from a copy or map the logs again", path, map.error().message);
  return map;
}

}  // namespace helicoid
