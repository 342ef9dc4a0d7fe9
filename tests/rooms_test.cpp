// One folder is one room, and a room knows only rooms above its own line.
#include <gmock/gmock.h>

#include <algorithm>
#include <map>

#include "tests/source_tree.hpp"

namespace helicoid::source_tree {

namespace {

using testing::IsEmpty;

/// A third party: how its headers begin, its CMake target and the rooms that may link it.
struct ThirdParty {
  const char* headers;
  const char* target;
  std::set<std::string> rooms;
  bool in_public_headers = false;
};

const std::vector<ThirdParty>& third_parties() {
  static const std::vector<ThirdParty> all = {
      {"Eigen/", "Eigen3::Eigen", {"geometry"}, true},
      {"fmt/", "fmt::fmt", {"base"}, true},
      {"tl/expected.hpp", "tl::expected", {"base"}, true},
      {"amd.h", "AMD::amd", {"fit"}},
      {"metis.h", "METIS::metis", {"fit"}},
      {"geos_c.h", "GEOS::geos_c", {"geometry"}},
      {"cairo/", "Cairo::cairo", {"charts"}},
      {"png.h", "PNG::PNG", {"charts", "simulation"}},
      {"pugixml.hpp", "pugixml::pugixml", {"simulation"}},
      {"libdeflate.h", "libdeflate::libdeflate", {"io"}},
      {"zlib.h", "ZLIB::ZLIB", {"io"}},
      {"sqlite3.h", "SQLite::SQLite3", {"store"}},
      {"pthread.h", "Threads::Threads", {"charts"}},
  };
  return all;
}

bool starts_with_any(const std::string& text, const std::vector<std::string>& beginnings) {
  return std::any_of(beginnings.begin(), beginnings.end(), [&](const std::string& b) { return text.starts_with(b); });
}

/// Tests, benchmarks and fuzz targets stand beside the code but are no part of the room's library.
bool is_beside(const std::string& path) {
  return path.ends_with("_test.cpp") || path.ends_with("_bench.cpp") || path.ends_with("_fuzz.cpp");
}

/// The rooms and third parties that a file of a room sees: what it declares, and what those show.
std::set<std::string> seen_from(const std::string& name, bool with_hidden) {
  std::map<std::string, Room> by_target;
  for (const Room& room : declared_rooms()) by_target["helicoid::" + room.name] = room;
  const Room& self = by_target["helicoid::" + name];
  std::vector<std::string> open(self.uses.begin(), self.uses.end());
  if (with_hidden) open.insert(open.end(), self.hidden.begin(), self.hidden.end());
  std::set<std::string> seen{"helicoid::" + name};
  while (!open.empty()) {
    const std::string target = open.back();
    open.pop_back();
    if (!seen.insert(target).second) continue;
    const auto room = by_target.find(target);
    if (room != by_target.end()) open.insert(open.end(), room->second.uses.begin(), room->second.uses.end());
  }
  return seen;
}

std::string room_of(const std::string& path) {
  const std::size_t begin = std::string("helicoid/").size();
  return path.substr(begin, path.find('/', begin) - begin);
}

/// The CMake target that a header belongs to; "" if it is the language's or the system's, "?" if nobody's.
std::string target_of(const Include& include, const std::string& path) {
  if (include.quoted) {
    if (include.header.starts_with("helicoid/")) return "helicoid::" + room_of(include.header);
    return is_beside(path) && include.header.starts_with("tests/") ? "" : "?";
  }
  for (const ThirdParty& third : third_parties()) {
    if (include.header.starts_with(third.headers)) return third.target;
  }
  if (include.header.find_first_of("./") == std::string::npos) return "";
  static const std::vector<std::string> kTools = {"gtest/",     "gmock/",    "rapidcheck",
                                                  "benchmark/", "nlohmann/", "sqlite3.h"};
  if (is_beside(path) && starts_with_any(include.header, kTools)) return "";
  static const std::vector<std::string> kSystem = {"fcntl.h", "malloc.h", "unistd.h", "sys/", "immintrin.h"};
  return path.ends_with(".cpp") && starts_with_any(include.header, kSystem) ? "" : "?";
}

const std::vector<std::string>& library_files() {
  static const std::vector<std::string> files = files_below("helicoid", {".hpp", ".cpp"});
  return files;
}

}  // namespace

TEST(Rooms, UseOnlyRoomsAboveTheirOwnLine) {
  std::set<std::string> above;
  std::vector<std::string> wrong;
  for (const Room& room : declared_rooms()) {
    for (const auto* uses : {&room.uses, &room.hidden}) {
      for (const std::string& target : *uses) {
        if (target.starts_with("helicoid::") && !above.contains(target)) wrong.push_back(room.name + " -> " + target);
      }
    }
    above.insert("helicoid::" + room.name);
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(Rooms, AreTheFoldersOfTheLibrary) {
  std::set<std::string> folders;
  for (const std::string& path : library_files()) folders.insert(room_of(path));
  std::set<std::string> declared;
  for (const Room& room : declared_rooms()) declared.insert(room.name);
  EXPECT_EQ(folders, declared);
}

TEST(Rooms, IncludeOnlyWhatTheyDeclare) {
  std::vector<std::string> wrong;
  for (const std::string& path : library_files()) {
    const std::set<std::string> seen = seen_from(room_of(path), path.ends_with(".cpp"));
    for (const Include& include : includes_of(text_of(path))) {
      const std::string target = target_of(include, path);
      const bool tests_the_store = is_beside(path) && target == "SQLite::SQLite3";
      if (!target.empty() && !seen.contains(target) && !tests_the_store) {
        wrong.push_back(path + ":" + std::to_string(include.line) + " includes " + include.header);
      }
    }
  }
  EXPECT_THAT(wrong, IsEmpty()) << "declare the room in CMakeLists.txt, if it stands above; else move the code";
}

TEST(Rooms, KeepThirdPartiesWhereTheyBelong) {
  std::map<std::string, ThirdParty> by_target;
  for (const ThirdParty& third : third_parties()) by_target[third.target] = third;
  std::vector<std::string> wrong;
  for (const Room& room : declared_rooms()) {
    for (const bool shown : {true, false}) {
      for (const std::string& target : shown ? room.uses : room.hidden) {
        if (target.starts_with("helicoid::")) continue;
        const auto third = by_target.find(target);
        const bool allowed = third != by_target.end() && third->second.rooms.contains(room.name) &&
                             (!shown || third->second.in_public_headers);
        if (!allowed) wrong.push_back(room.name + " links " + target);
      }
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(Rooms, LeaveTheCommandLineToTheEdge) {
  std::vector<std::string> wrong;
  for (const std::string& path : library_files()) {
    for (const Include& include : includes_of(text_of(path))) {
      if (include.header.starts_with("CLI/") || include.header.starts_with("apps/")) wrong.push_back(path);
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

/// CHOLMOD's supernodal part is under the GPL, and what is installed is not.
TEST(Rooms, LeaveTheJudgesOfTheFitToBenchmarks) {
  std::vector<std::string> wrong;
  for (const char* folder : {"helicoid", "apps", "tests", "examples"}) {
    for (const std::string& path : files_below(folder, {".hpp", ".cpp"})) {
      for (const Include& include : includes_of(text_of(path))) {
        if (include.header.starts_with("ceres/") || include.header.starts_with("cholmod")) wrong.push_back(path);
      }
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
  EXPECT_EQ(text_of("bench/CMakeLists.txt").find("install("), std::string::npos);
}

TEST(Rooms, OnlyMappingAndStoreChangeAMap) {
  const std::set<std::string> writers = {"mapping", "store", "manifold"};
  std::vector<std::string> wrong;
  std::vector<std::string> files = library_files();
  for (const std::string& path : files_below("apps", {".hpp", ".cpp"})) files.push_back(path);
  for (const std::string& path : files) {
    if (is_beside(path) || (path.starts_with("helicoid/") && writers.contains(room_of(path)))) continue;
    for (const Include& include : includes_of(text_of(path))) {
      if (include.header.ends_with("/map_editor.hpp")) wrong.push_back(path);
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
}

}  // namespace helicoid::source_tree
