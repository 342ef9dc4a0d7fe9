#include "tests/source_tree.hpp"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <sstream>

namespace helicoid::source_tree {

namespace fs = std::filesystem;

namespace {

const fs::path kRoot = HELICOID_SOURCE_DIR;

int line_at(const std::string& text, std::size_t position) {
  return 1 + static_cast<int>(std::count(text.begin(), text.begin() + static_cast<std::ptrdiff_t>(position), '\n'));
}

/// Where the literal or comment that begins at `at` ends (one past); `at` itself if none begins there.
std::size_t end_of_blank(const std::string& s, std::size_t at) {
  const auto after = [&](const std::string& mark, std::size_t from) {
    const std::size_t found = s.find(mark, from);
    return found == std::string::npos ? s.size() : found + mark.size();
  };
  if (s.compare(at, 2, "//") == 0) return after("\n", at) - 1;
  if (s.compare(at, 2, "/*") == 0) return after("*/", at + 2);
  if (s.compare(at, 2, "R\"") == 0) {
    const std::size_t open = s.find('(', at);
    return after(")" + s.substr(at + 2, open - at - 2) + "\"", open);
  }
  const bool digit_separator = s[at] == '\'' && at > 0 && std::isalnum(static_cast<unsigned char>(s[at - 1])) != 0;
  if ((s[at] != '"' && s[at] != '\'') || digit_separator) return at;
  std::size_t end = at + 1;
  while (end < s.size() && s[end] != s[at]) end += s[end] == '\\' ? 2 : 1;
  return std::min(end + 1, s.size());
}

enum class Scope { open, function, initialiser };

std::string trimmed(const std::string& s) {
  const std::size_t first = s.find_first_not_of(" \n\t");
  return first == std::string::npos ? "" : s.substr(first, s.find_last_not_of(" \n\t") - first + 1);
}

/// What a brace after `head` opens, where functions may stand.
Scope scope_after(const std::string& head) {
  static const std::regex kOpen(R"(\b(namespace|class|struct|union|enum|extern)\b[^()=]*$)");
  static const std::regex kConstructor(R"(\)\s*(noexcept\s*)?:[^:])");
  if (std::regex_search(head, kOpen)) return Scope::open;
  const bool may_be_function = head.find('(') != std::string::npos;
  if (!may_be_function) return Scope::initialiser;
  // A member of a constructor's list that is initialised by braces: the body is still to come.
  const char last = head.back();
  if (std::regex_search(head, kConstructor) && (std::isalnum(static_cast<unsigned char>(last)) != 0 || last == '_')) {
    return Scope::initialiser;
  }
  static const std::regex kAssigned(R"(^[^(]*[^=!<>(]=[^=])");
  const bool assigned = head.find("operator") == std::string::npos && std::regex_search(head, kAssigned) &&
                        head.rfind("template", 0) != 0;
  return assigned ? Scope::initialiser : Scope::function;
}

/// One past the brace that closes the one at `open`.
std::size_t past_closing_brace(const std::string& code, std::size_t open) {
  int depth = 0;
  for (std::size_t i = open; i < code.size(); ++i) {
    if (code[i] == '{') ++depth;
    if (code[i] == '}' && --depth == 0) return i + 1;
  }
  return code.size();
}

std::string without_directives(std::string code) {
  bool directive = false;
  for (std::size_t i = 0; i < code.size(); ++i) {
    const bool at_line = i == 0 || code[i - 1] == '\n';
    if (at_line) directive = (directive && i > 1 && code[i - 2] == '\\') || code[i] == '#';
    if (directive && code[i] != '\n' && code[i] != '\\') code[i] = ' ';
  }
  std::replace(code.begin(), code.end(), '\\', ' ');
  return code;
}

}  // namespace

std::vector<std::string> files_below(const std::string& folder, const std::vector<std::string>& endings) {
  std::vector<std::string> found;
  if (!fs::exists(kRoot / folder)) return found;
  for (const auto& entry : fs::recursive_directory_iterator(kRoot / folder)) {
    const std::string path = fs::relative(entry.path(), kRoot).generic_string();
    const auto ends = [&](const std::string& ending) { return path.ends_with(ending); };
    if (entry.is_regular_file() && std::any_of(endings.begin(), endings.end(), ends)) found.push_back(path);
  }
  std::sort(found.begin(), found.end());
  return found;
}

std::string text_of(const std::string& path) {
  std::ifstream file(kRoot / path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string section_of(const std::string& document, const std::string& title) {
  const std::size_t heading = ("\n" + document).find("\n## " + title + "\n");
  if (heading == std::string::npos) return "";
  const std::size_t next = document.find("\n## ", heading + 1);
  return document.substr(heading, next == std::string::npos ? next : next - heading);
}

std::string code_only(const std::string& source) {
  std::string code = source;
  for (std::size_t i = 0; i < code.size();) {
    const std::size_t end = end_of_blank(source, i);
    for (std::size_t k = i; k < end; ++k) {
      if (code[k] != '\n') code[k] = ' ';
    }
    i = std::max(end, i + 1);
  }
  return code;
}

std::vector<Include> includes_of(const std::string& source) {
  static const std::regex kInclude(R"re(^\s*#\s*include\s*([<"])([^>"]+)[>"])re");
  std::vector<Include> includes;
  std::istringstream lines(source);
  int number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    std::smatch match;
    if (std::regex_search(line, match, kInclude)) includes.push_back({match[2], match[1] == "\"", number});
  }
  return includes;
}

std::vector<FunctionSpan> functions_of(const std::string& source) {
  const std::string code = without_directives(code_only(source));
  std::vector<FunctionSpan> functions;
  std::size_t head_begin = 0;
  for (std::size_t i = 0; i < code.size(); ++i) {
    if (code[i] == ';' || code[i] == '}') head_begin = i + 1;
    if (code[i] != '{') continue;
    const std::string head = trimmed(code.substr(head_begin, i - head_begin));
    const Scope scope = scope_after(head);
    if (scope == Scope::open) {
      head_begin = i + 1;
      continue;
    }
    const std::size_t end = past_closing_brace(code, i);
    if (scope == Scope::function) {
      const std::size_t first = code.find_first_not_of(" \n\t", head_begin);
      functions.push_back({head, line_at(code, first), line_at(code, end - 1)});
      head_begin = end;
    }
    i = end - 1;
  }
  return functions;
}

std::vector<Room> declared_rooms() {
  static const std::regex kRoom(R"(helicoid_room\(([^)]*)\))");
  const std::string text = text_of("CMakeLists.txt");
  std::vector<Room> rooms;
  for (std::sregex_iterator it(text.begin(), text.end(), kRoom), end; it != end; ++it) {
    std::istringstream words((*it)[1].str());
    Room room;
    words >> room.name;
    std::set<std::string>* to = &room.uses;
    for (std::string word; words >> word;) {
      if (word == "USES" || word == "PRIVATE") {
        to = word == "USES" ? &room.uses : &room.hidden;
      } else {
        to->insert(word);
      }
    }
    rooms.push_back(room);
  }
  return rooms;
}

}  // namespace helicoid::source_tree
