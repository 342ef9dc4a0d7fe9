#include "helicoid/store/map_file.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sqlite3.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "helicoid/manifold/content_hash.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;

/// A folder of its own for every test.
class MapFile : public testing::Test {
 protected:
  void SetUp() override {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    folder_ = fs::temp_directory_path() / fmt::format("helicoid_map_file_{}_{}", info->name(), ::getpid());
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  [[nodiscard]] std::string path(const std::string& name = "map.gpkg") const { return (folder_ / name).string(); }
  static std::string bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  static void put(const std::string& path, const std::string& content) {
    std::ofstream(path, std::ios::binary) << content;
  }
  static void run_sql(const std::string& path, const char* sql) {
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(path.c_str(), &db), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(db, sql, nullptr, nullptr, nullptr), SQLITE_OK) << sqlite3_errmsg(db);
    sqlite3_close(db);
  }
  static std::string reason(const std::string& path) {
    const Result<Map> map = read_map(path);
    return map ? "it was read" : map.error().message;
  }
  static Map sample() { return synthetic::random_map(3, 30, 400, 60); }

  fs::path folder_;
};

TEST_F(MapFile, IsReadBackEqualToTheBit) {
  for (const std::uint64_t seed : {1, 2, 3, 4, 5}) {
    const Map map = synthetic::random_map(seed, 5 + seed * 7, 100 * seed, 20 * seed);
    ASSERT_TRUE(write_map(map, path()));
    const Result<Map> again = read_map(path());
    ASSERT_TRUE(again) << again.error().message;
    EXPECT_EQ(content_hash(*again), content_hash(map));
  }
}

TEST_F(MapFile, BringsBackWhatIsDerivedFromScans) {
  const Map map = synthetic::pillar_map().map;
  ASSERT_TRUE(write_map(map, path()));
  const Result<Map> again = read_map(path());
  ASSERT_TRUE(again) << again.error().message;
  const Patch& before = map.patch(PatchId{3});
  const Patch& after = again->patch(PatchId{3});
  EXPECT_EQ(after.free_space, before.free_space);
  EXPECT_EQ(after.points.x, before.points.x);
  EXPECT_EQ(after.points.nx, before.points.nx);
  EXPECT_EQ(after.reach, before.reach);
}

TEST_F(MapFile, HoldsAnEmptyMap) {
  ASSERT_TRUE(write_map(Map{}, path()));
  const Result<Map> again = read_map(path());
  ASSERT_TRUE(again) << again.error().message;
  EXPECT_EQ(again->patch_count(), 0U);
}

TEST_F(MapFile, HasTheSameBytesForTheSameMap) {
  ASSERT_TRUE(write_map(sample(), path("a.gpkg")));
  ASSERT_TRUE(write_map(sample(), path("b.gpkg")));
  EXPECT_TRUE(bytes(path("a.gpkg")) == bytes(path("b.gpkg")));
}

TEST_F(MapFile, ReplacesAnOlderFileAndLeavesNothingBeside) {
  put(path(), "something old");
  ASSERT_TRUE(write_map(sample(), path()));
  EXPECT_EQ(std::distance(fs::directory_iterator(folder_), {}), 1);
  EXPECT_TRUE(read_map(path()));
}

TEST_F(MapFile, LeavesTheOldFileWhenTheNewOneCannotBeWritten) {
  ASSERT_TRUE(write_map(sample(), path()));
  const std::string before = bytes(path());
  // A folder in the place where the new file would be written beside.
  fs::create_directories(path() + ".part/occupied");
  const Result<void> written = write_map(Map{}, path());
  ASSERT_FALSE(written);
  EXPECT_THAT(written.error().message, HasSubstr("cannot be written"));
  EXPECT_TRUE(bytes(path()) == before);
}

TEST_F(MapFile, SaysWhyItCannotBeWritten) {
  EXPECT_THAT(write_map(Map{}, path("no/such/folder/map.gpkg")).error().message, HasSubstr("cannot be written"));
  EXPECT_THAT(write_map(Map{}, folder_.string()).error().message, HasSubstr("is a directory"));
}

TEST_F(MapFile, SaysWhyAFileIsNoMap) {
  EXPECT_THAT(reason(path("missing.gpkg")), HasSubstr("cannot be opened"));
  EXPECT_THAT(reason(folder_.string()), HasSubstr("is a directory"));
  put(path("text.gpkg"), "FLASER 180 1.0 and so on, a laser log rather than a map");
  EXPECT_THAT(reason(path("text.gpkg")), HasSubstr("not an SQLite file"));
  put(path("empty.gpkg"), "");
  EXPECT_THAT(reason(path("empty.gpkg")), HasSubstr("not an SQLite file"));
  run_sql(path("other.db"), "CREATE TABLE t (x); INSERT INTO t VALUES (1)");
  EXPECT_THAT(reason(path("other.db")), HasSubstr("not a GeoPackage"));
  run_sql(path("other.gpkg"), "PRAGMA application_id=1196444487; CREATE TABLE t (x); INSERT INTO t VALUES (1)");
  EXPECT_THAT(reason(path("other.gpkg")), HasSubstr("Helicoid did not write it"));
}

TEST_F(MapFile, RefusesANewerSchema) {
  ASSERT_TRUE(write_map(sample(), path()));
  run_sql(path(), "UPDATE helicoid_map SET value='99' WHERE key='schema_version'");
  EXPECT_THAT(reason(path()), HasSubstr("use a newer Helicoid"));
}

TEST_F(MapFile, RefusesContentThatWasChanged) {
  ASSERT_TRUE(write_map(sample(), path()));
  run_sql(path(), "UPDATE helicoid_patches SET content=zeroblob(length(content)) WHERE id=4");
  EXPECT_THAT(reason(path()), HasSubstr("is damaged"));
}

TEST_F(MapFile, RefusesMissingRows) {
  for (const char* sql : {"DELETE FROM helicoid_patches WHERE id=4", "DELETE FROM helicoid_relations WHERE id=1",
                          "DELETE FROM helicoid_lasers", "DELETE FROM helicoid_robots WHERE id=0",
                          "UPDATE helicoid_relations SET b=1000000", "UPDATE helicoid_patches SET robot=-1",
                          "UPDATE helicoid_map SET value='many' WHERE key='islands'", "DROP TABLE helicoid_patches"}) {
    ASSERT_TRUE(write_map(sample(), path()));
    run_sql(path(), sql);
    EXPECT_THAT(reason(path()), HasSubstr("is damaged")) << sql;
  }
}

TEST_F(MapFile, NeverAcceptsATruncatedOrScratchedFile) {
  ASSERT_TRUE(write_map(sample(), path()));
  const std::string whole = bytes(path());
  Random random(11);
  for (int i = 0; i < 60; ++i) {
    std::string broken = whole;
    if (i % 2 == 0) {
      broken.resize(16 + random.below(whole.size() - 16));
    } else {
      for (int scratch = 0; scratch < 200; ++scratch) {
        broken[100 + random.below(broken.size() - 100)] = static_cast<char>(random.bits());
      }
    }
    put(path("broken.gpkg"), broken);
    const Result<Map> map = read_map(path("broken.gpkg"));
    // Scratches may have hit nothing but the layers for other programs; what is read is right or refused.
    if (map) {
      EXPECT_EQ(content_hash(*map), content_hash(sample()));
    }
  }
}

TEST_F(MapFile, IsAGeoPackageThatGdalOpens) {
  if (std::system("ogrinfo --version > /dev/null 2>&1") != 0) {
    GTEST_SKIP() << "ogrinfo is not installed (Debian: gdal-bin), so that the file was NOT checked as a GeoPackage";
  }
  const Map map = synthetic::pillar_map().map;
  ASSERT_TRUE(write_map(map, path()));
  const std::string command = fmt::format("ogrinfo -al -so -ro '{}' > '{}' 2>&1", path(), path("out.txt"));
  EXPECT_EQ(std::system(command.c_str()), 0);
  const std::string out = bytes(path("out.txt"));
  EXPECT_THAT(out, HasSubstr("using driver `GPKG' successful"));
  for (const char* layer :
       {"Layer name: patches", "Layer name: free_space", "Layer name: relations", "Layer name: trajectories",
        "Geometry: Point\nFeature Count: 16", "Geometry: Polygon\nFeature Count: 16",
        "Geometry: Line String\nFeature Count: 15", "Geometry: Line String\nFeature Count: 1\n"}) {
    EXPECT_TRUE(out.find(layer) != std::string::npos) << layer;
  }
  EXPECT_EQ(out.find("ERROR"), std::string::npos);
  EXPECT_EQ(out.find("Warning"), std::string::npos);
}

}  // namespace
}  // namespace helicoid
