#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "helicoid/manifold/content_hash.hpp"
#include "helicoid/store/database.hpp"
#include "helicoid/store/encoding.hpp"
#include "helicoid/store/geopackage.hpp"
#include "helicoid/store/map_file.hpp"
#include "helicoid/store/schema.hpp"

namespace helicoid {

namespace {

using store::BlobWriter;
using store::Database;
using store::Statement;

void write_facts(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO helicoid_map VALUES (?, ?)");
  const auto put = [&](std::string_view key, const std::string& value) {
    insert.bind(0, key).bind(1, std::string_view(value)).execute();
  };
  put("schema_version", std::to_string(kMapSchemaVersion));
  put("islands", std::to_string(map.island_count()));
  put("content_hash", content_hash(map).hex());
}

void write_robots(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO helicoid_robots VALUES (?, ?, ?, ?, ?)");
  BlobWriter lasers;
  BlobWriter trajectory;
  for (std::size_t i = 0; i < map.robots().size(); ++i) {
    const RobotRecord& robot = map.robots()[i];
    lasers.clear();
    trajectory.clear();
    for (const LaserModel& laser : robot.lasers) encode(lasers, laser);
    for (const TrackedScan& scan : robot.trajectory) encode(trajectory, scan);
    insert.bind(0, static_cast<std::int64_t>(i)).bind(1, std::string_view(robot.name));
    insert.bind_blob(2, lasers.bytes()).bind(3, static_cast<std::int64_t>(robot.trajectory.size()));
    insert.bind_blob(4, trajectory.bytes()).execute();
  }
}

/// Lasers are few and repeated by every patch: each is stored once.
std::size_t index_of(std::vector<LaserModel>& lasers, const LaserModel& laser) {
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    if (lasers[i] == laser) return i;
  }
  lasers.push_back(laser);
  return lasers.size() - 1;
}

void write_patches(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO helicoid_patches VALUES (?, ?, ?, ?, ?, ?)");
  std::vector<LaserModel> lasers;
  BlobWriter content;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    const Patch& patch = map.patch(id);
    content.clear();
    content.put(patch.stamp);
    content.put(map.T_plane_patch(id));
    encode(content, patch.scan);
    insert.bind(0, static_cast<std::int64_t>(i)).bind(1, std::int64_t{patch.robot.value});
    insert.bind(2, static_cast<std::int64_t>(patch.scan_index)).bind(3, std::int64_t{map.island_of(id).value});
    insert.bind(4, static_cast<std::int64_t>(index_of(lasers, patch.laser))).bind_blob(5, content.bytes()).execute();
  }
  Statement insert_laser(db, "INSERT INTO helicoid_lasers VALUES (?, ?, ?)");
  for (std::size_t i = 0; i < lasers.size(); ++i) {
    content.clear();
    encode(content, lasers[i]);
    insert_laser.bind(0, static_cast<std::int64_t>(i)).bind(1, std::string_view(lasers[i].name));
    insert_laser.bind_blob(2, content.bytes()).execute();
  }
}

void write_relations(Database& db, const Map& map) {
  Statement insert(db, "INSERT INTO helicoid_relations VALUES (?, ?, ?, ?, ?)");
  BlobWriter content;
  for (std::size_t i = 0; i < map.relations().size(); ++i) {
    const Relation& relation = map.relations()[i];
    content.clear();
    encode(content, relation);
    insert.bind(0, static_cast<std::int64_t>(i)).bind(1, std::int64_t{relation.a.value});
    insert.bind(2, std::int64_t{relation.b.value}).bind(3, static_cast<std::int64_t>(relation.kind));
    insert.bind_blob(4, content.bytes()).execute();
  }
}

Result<void> write_file(const Map& map, const std::string& path) {
  Database db(path, Database::Mode::create);
  // The file is not yet anybody's: if we fall over while writing, it is thrown away whole.
  db.run("PRAGMA page_size=8192; PRAGMA journal_mode=OFF; PRAGMA synchronous=OFF; PRAGMA locking_mode=EXCLUSIVE;");
  db.run(fmt::format("PRAGMA application_id={}; PRAGMA user_version={}; BEGIN", store::kApplicationId,
                     store::kUserVersion));
  db.run(store::geopackage_schema());
  db.run(store::own_schema());
  write_facts(db, map);
  write_robots(db, map);
  write_patches(db, map);
  write_relations(db, map);
  store::write_layers(db, map);
  db.run("COMMIT");
  db.close();
  if (db.error()) return fail("{}: cannot be written: {}", path, *db.error());
  return {};
}

/// Makes sure that a file's or folder's content is on the disc.
bool flush(const std::string& path) {
  const int descriptor = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (descriptor < 0) return false;
  const bool flushed = ::fsync(descriptor) == 0;
  ::close(descriptor);
  return flushed;
}

}  // namespace

Result<void> write_map(const Map& map, const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  if (fs::is_directory(path, error)) return fail("{}: is a directory; name a file, such as map.gpkg", path);
  const std::string beside = path + ".part";
  fs::remove(beside, error);
  Result<void> written = write_file(map, beside);
  if (written && !flush(beside)) {
    written = fail("{}: could not be flushed to the disc: {}", beside, std::system_category().message(errno));
  }
  if (written) {
    fs::rename(beside, path, error);
    if (error) written = fail("{}: cannot be replaced: {}", path, error.message());
  }
  if (!written) {
    fs::remove(beside, error);
    return written;
  }
  // A folder that cannot be flushed (some file systems refuse) costs durability, not the map.
  const fs::path folder = fs::path(path).parent_path();
  static_cast<void>(flush(folder.empty() ? "." : folder.string()));
  return {};
}

}  // namespace helicoid
