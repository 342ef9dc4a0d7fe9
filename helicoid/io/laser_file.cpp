#include "helicoid/io/laser_file.hpp"

#include <fmt/ranges.h>

#include <cmath>
#include <string_view>
#include <utility>

#include "helicoid/io/laser_recognition.hpp"
#include "helicoid/io/number.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

using Key = std::pair<std::string_view, double LaserModel::*>;
constexpr Key kKeys[] = {
    {"max_range", &LaserModel::max_range},           {"min_range", &LaserModel::min_range},
    {"range_sigma", &LaserModel::range_sigma},       {"kappa", &LaserModel::kappa},
    {"incidence_bias", &LaserModel::incidence_bias}, {"floor_position", &LaserModel::floor_position},
    {"floor_heading", &LaserModel::floor_heading},   {"largest_gap", &LaserModel::largest_gap},
    {"scan_duration", &LaserModel::scan_duration}};

std::string key_names() {
  std::string names;
  for (const Key& key : kKeys) names += fmt::format("{}{}", names.empty() ? "" : ", ", key.first);
  return names;
}

/// One line; the error lacks the place.
Result<void> read_line(std::string_view line, LaserModel& laser) {
  const std::size_t colon = line.find(':');
  for (const auto& [key, member] : kKeys) {
    if (colon == std::string_view::npos || line.substr(0, colon) != key) continue;
    TextCursor cursor{line.data() + colon + 1, line.data() + line.size()};
    const ReadNumber number = read_number(cursor);
    cursor.skip_blanks();
    if (!number.ok || cursor.at != cursor.end || !(number.value > 0) || !std::isfinite(number.value)) {
      return fail("{} needs a number above 0", key);
    }
    laser.*member = number.value;
    return {};
  }
  return fail("\"{}\" is no key of a laser; keys are {}", line, key_names());
}

}  // namespace

Result<LaserModel> parse_laser(const std::string& text, const std::string& name, const LaserModel& recognised) {
  LaserModel laser = recognised;
  laser.name = name;
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    std::string_view line(text.data() + begin, end - begin);
    if (line.ends_with('\r')) line.remove_suffix(1);
    begin = end + 1;
    if (line.empty() || line[0] == '#') continue;
    if (const Result<void> read = read_line(line, laser); !read) {
      return fail("{}:{}: {}", name, line_number, read.error().message);
    }
  }
  if (laser.min_range >= laser.max_range) {
    return fail("{}: min_range {} is not below max_range {}", name, laser.min_range, laser.max_range);
  }
  return laser;
}

Result<LaserModel> load_laser(const std::string& name_or_file, const LaserModel& recognised) {
  if (is_shipped_laser(name_or_file)) return shipped_laser(name_or_file, recognised);
  const Result<TextFile> file = read_text_file(name_or_file);
  if (!file) {
    return fail("{}: is no shipped laser ({}) and no file that can be read", name_or_file,
                fmt::join(shipped_lasers(), ", "));
  }
  return parse_laser(file->text, name_or_file, recognised);
}

}  // namespace helicoid
