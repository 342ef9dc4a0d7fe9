// What every file of the project keeps to.
#include <fmt/format.h>
#include <gmock/gmock.h>

#include <algorithm>
#include <map>
#include <regex>
#include <sstream>

#include "tests/source_tree.hpp"

namespace helicoid::source_tree {

namespace {

using testing::ElementsAre;
using testing::IsEmpty;

std::vector<std::string> all_sources() {
  std::vector<std::string> all;
  for (const char* folder : {"helicoid", "apps", "tests", "bench", "examples", "fuzz"}) {
    for (const std::string& path : files_below(folder, {".hpp", ".cpp"})) all.push_back(path);
  }
  return all;
}

/// The places where a pattern stands in the code (comments and literals left out) of the library itself.
std::vector<std::string> in_the_library(const std::regex& pattern) {
  std::vector<std::string> places;
  for (const std::string& path : files_below("helicoid", {".hpp", ".cpp"})) {
    if (path.ends_with("_test.cpp") || path.ends_with("_bench.cpp") || path.ends_with("_fuzz.cpp")) continue;
    std::istringstream lines(code_only(text_of(path)));
    int number = 0;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      if (std::regex_search(line, pattern)) places.push_back(fmt::format("{}:{}: {}", path, number, line));
    }
  }
  return places;
}

}  // namespace

TEST(HouseRules, AFileHasAtMost300Lines) {
  std::vector<std::string> wrong;
  for (const std::string& path : all_sources()) {
    const std::string text = text_of(path);
    const auto lines = std::count(text.begin(), text.end(), '\n');
    if (lines > 300) wrong.push_back(fmt::format("{}: {} lines", path, lines));
  }
  EXPECT_THAT(wrong, IsEmpty());
}

/// By the layout that clang-format gives: a function begins at the margin and ends with a brace that stands there
/// alone.
// All rooms share one namespace: two types of one name would be one to the linker.
TEST(HouseRules, ATypeOfAHeaderHasANameOfItsOwn) {
  const std::regex type("^(?:struct|class) ([A-Za-z0-9]+)(?: final)?(?: :[^:].*)? \\{");
  std::map<std::string, std::vector<std::string>> places;
  for (const char* folder : {"helicoid", "apps"}) {
    for (const std::string& path : files_below(folder, {".hpp"})) {
      std::istringstream lines(code_only(text_of(path)));
      for (std::string line; std::getline(lines, line);) {
        std::smatch found;
        if (std::regex_search(line, found, type)) places[found[1]].push_back(path);
      }
    }
  }
  ASSERT_GT(places.size(), 100U);
  std::vector<std::string> wrong;
  for (const auto& [name, files] : places) {
    if (files.size() > 1) wrong.push_back(fmt::format("{}: {}", name, fmt::join(files, ", ")));
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(HouseRules, AFunctionHasAtMost40Lines) {
  const std::regex other("^(namespace|class|struct|enum|union|extern)\\b");
  std::vector<std::string> wrong;
  std::size_t functions = 0;
  for (const std::string& path : all_sources()) {
    std::istringstream lines(code_only(text_of(path)));
    int number = 0;
    int began = 0;
    std::string head;
    for (std::string line; std::getline(lines, line);) {
      ++number;
      if (line == "}" && !head.empty()) {
        ++functions;
        if (number - began - 1 > 40) wrong.push_back(fmt::format("{}:{}: {} lines", path, began, number - began - 1));
      }
      if (line.empty() || line[0] == ' ' || line[0] == '#') continue;
      head = line[0] == '}' || std::regex_search(line, other) ? "" : line;
      began = number;
    }
  }
  EXPECT_THAT(wrong, IsEmpty());
  EXPECT_GT(functions, 500U);
}

TEST(HouseRules, TheLibraryNeverPrints) {
  EXPECT_THAT(in_the_library(std::regex(R"(std::(cout|cerr|clog)|\b(printf|fprintf|puts|perror)\s*\(|fmt::print)")),
              IsEmpty());
}

TEST(HouseRules, TheLibraryNeverEndsTheProgram) {
  EXPECT_THAT(in_the_library(std::regex(R"(\b(exit|_Exit|quick_exit|abort|terminate)\s*\()")), IsEmpty());
}

TEST(HouseRules, TheLibraryNeverReadsTheEnvironment) {
  EXPECT_THAT(in_the_library(std::regex(R"(\b(getenv|secure_getenv|environ|setlocale)\b)")), IsEmpty());
}

TEST(HouseRules, ChanceAndTheTimeOfDayAreArguments) {
  EXPECT_THAT(in_the_library(std::regex(R"(random_device|\bs?rand\s*\(|mt19937|system_clock|\btime\s*\()")), IsEmpty());
}

TEST(HouseRules, AHeaderSaysWhatItIsForAndIsReadOnce) {
  std::vector<std::string> wrong;
  for (const std::string& path : all_sources()) {
    if (!path.ends_with(".hpp")) continue;
    const std::string text = text_of(path);
    if (!text.starts_with("// ") || text.find("#pragma once") == std::string::npos) wrong.push_back(path);
  }
  EXPECT_THAT(wrong, IsEmpty());
}

TEST(HouseRules, NoFileIsADrawerForEverything) {
  const std::regex drawer(R"((^|[/_])(utils?|common|misc|helpers?|manager)(_|\.|/))");
  std::vector<std::string> wrong;
  for (const std::string& path : all_sources()) {
    if (std::regex_search(path, drawer)) wrong.push_back(path);
  }
  EXPECT_THAT(wrong, IsEmpty());
}

// The counter of lines must itself be able to fail.
TEST(HouseRules, FunctionsAreFoundWhereTheyStand) {
  const std::string source =
      "namespace n {\nconstexpr int table[] = {1,\n2};\nstruct S : public B {\n  S() : a_{1}, b_(2) {\n    f();\n  }\n"
      "  int get() const { return a_; }\n  int a_{0};\n};\ntemplate <class T = int>\nbool operator==(T a, T b) {\n"
      "  const char* s = \"}\";  // }\n  if (a) {\n  }\n  return s;\n}\nconst auto f = [](int x) {\n  return x;\n};\n"
      "enum class E : int {\n  one\n};\n}\n";
  std::vector<std::string> found;
  for (const FunctionSpan& f : functions_of(source)) found.push_back(fmt::format("{}-{}", f.first_line, f.last_line));
  EXPECT_THAT(found, ElementsAre("5-7", "8-8", "11-17"));
}

}  // namespace helicoid::source_tree
