// The project's own files, as text, for the tests that read them.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

namespace helicoid::source_tree {

/// Paths relative to the project's root, sorted, of the files below `folder` whose names end in one of `endings`.
[[nodiscard]] std::vector<std::string> files_below(const std::string& folder, const std::vector<std::string>& endings);

/// The text of a file named relative to the root; empty if there is none.
[[nodiscard]] std::string text_of(const std::string& path);

/// The text between "## title" and the next heading of that level; empty if there is none.
[[nodiscard]] std::string section_of(const std::string& document, const std::string& title);

/// C++ with every comment, and the inside of every literal, turned into blanks; lines stay where they are.
[[nodiscard]] std::string code_only(const std::string& source);

/// One #include: what stands between its quotes or angles.
struct Include {
  std::string header;
  bool quoted = false;
  int line = 0;
};
[[nodiscard]] std::vector<Include> includes_of(const std::string& source);

/// A function's body with its head, in lines.
struct FunctionSpan {
  std::string head;
  int first_line = 0;
  int last_line = 0;
  [[nodiscard]] int lines() const { return last_line - first_line + 1; }
};
/// The functions that stand in namespaces and classes. It counts braces; it does not parse C++.
[[nodiscard]] std::vector<FunctionSpan> functions_of(const std::string& source);

/// What a room declares in CMakeLists.txt: rooms and third parties, by their CMake targets.
struct Room {
  std::string name;
  std::set<std::string> uses;    ///< seen by those who use the room
  std::set<std::string> hidden;  ///< its .cpp files alone
};
/// In the order of their lines.
[[nodiscard]] std::vector<Room> declared_rooms();

}  // namespace helicoid::source_tree
