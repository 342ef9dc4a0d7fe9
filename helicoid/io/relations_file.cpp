#include "helicoid/io/relations_file.hpp"

#include <cmath>
#include <iterator>
#include <optional>

#include "helicoid/io/number.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

std::vector<std::string_view> split(std::string_view line) {
  std::vector<std::string_view> words;
  for (std::size_t at = 0; at < line.size();) {
    const std::size_t begin = line.find_first_not_of(" \t\r", at);
    if (begin == std::string_view::npos) break;
    at = std::min(line.find_first_of(" \t\r", begin), line.size());
    words.push_back(line.substr(begin, at - begin));
  }
  return words;
}

/// All words from `first` on as numbers.
bool read_numbers(const std::vector<std::string_view>& words, std::span<const std::size_t> places,
                  std::span<double> values) {
  for (std::size_t i = 0; i < places.size(); ++i) {
    TextCursor cursor{words[places[i]].data(), words[places[i]].data() + words[places[i]].size()};
    const ReadNumber number = read_number(cursor);
    if (!number.ok || !std::isfinite(number.value)) return false;
    values[i] = number.value;
  }
  return true;
}

std::optional<TrueRelation> parse_line(const std::vector<std::string_view>& words) {
  double v[5] = {};
  if (words.size() == 8) {
    constexpr std::size_t kPlaces[] = {0, 1, 2, 3, 7};
    if (!read_numbers(words, kPlaces, v)) return std::nullopt;
    return TrueRelation{"", v[0], "", v[1], {v[2], v[3], wrap_angle(v[4])}};
  }
  if (words.size() == 7) {
    constexpr std::size_t kPlaces[] = {1, 3, 4, 5, 6};
    if (!read_numbers(words, kPlaces, v)) return std::nullopt;
    return TrueRelation{std::string(words[0]), v[0], std::string(words[2]), v[1], {v[2], v[3], wrap_angle(v[4])}};
  }
  return std::nullopt;
}

}  // namespace

RelationsFile parse_relations(const std::string& text, const std::string& name) {
  RelationsFile file;
  SkipCounter skipped;
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    const std::vector<std::string_view> words = split({text.data() + begin, end - begin});
    begin = end + 1;
    if (words.empty() || words[0][0] == '#') continue;
    if (const auto relation = parse_line(words)) {
      file.relations.push_back(*relation);
    } else {
      skipped.add("line that is no relation", [&] { return fmt::format("{}:{}", name, line_number); });
    }
  }
  file.skipped = skipped.all();
  return file;
}

Result<RelationsFile> read_relations(const std::string& path) {
  const Result<TextFile> text = read_text_file(path);
  if (!text) return tl::unexpected(text.error());
  RelationsFile file = parse_relations(text->text, text->name);
  if (file.relations.empty()) {
    return fail(
        "{}: holds no relation; lines are `t1 t2 x y z roll pitch yaw` or "
        "`robot_a t_a robot_b t_b x y yaw`",
        path);
  }
  return file;
}

std::string to_relations_text(std::span<const TrueRelation> relations) {
  std::string text = "# robot_a t_a robot_b t_b x y yaw\n";
  for (const TrueRelation& r : relations) {
    fmt::format_to(std::back_inserter(text), "{} {:.6f} {} {:.6f} {:.6f} {:.6f} {:.6f}\n", r.robot_a, r.stamp_a,
                   r.robot_b, r.stamp_b, r.T_a_b.x, r.T_a_b.y, r.T_a_b.yaw);
  }
  return text;
}

std::string to_single_robot_relations_text(std::span<const TrueRelation> relations) {
  std::string text;
  for (const TrueRelation& r : relations) {
    fmt::format_to(std::back_inserter(text), "{:.6f} {:.6f} {:.6f} {:.6f} 0 0 0 {:.6f}\n", r.stamp_a, r.stamp_b,
                   r.T_a_b.x, r.T_a_b.y, r.T_a_b.yaw);
  }
  return text;
}

}  // namespace helicoid
