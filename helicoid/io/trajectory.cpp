#include "helicoid/io/trajectory.hpp"

#include <fmt/compile.h>

#include <cmath>
#include <iterator>
#include <optional>

#include "helicoid/io/number.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

/// A number in units of 1e-6 as a decimal, without the cost of general formatting.
void append_micro(std::string& text, double value) {
  // Beyond that a 64-bit integer holds no microns; NaN comes this way too.
  if (!(std::abs(value) < 9e12)) {
    fmt::format_to(std::back_inserter(text), FMT_COMPILE("{:.6f}"), value);
    return;
  }
  const auto micro = static_cast<std::int64_t>(std::llround(value * 1e6));
  const auto magnitude = static_cast<std::uint64_t>(micro < 0 ? -micro : micro);
  if (micro < 0) text += '-';
  fmt::format_to(std::back_inserter(text), FMT_COMPILE("{}"), magnitude / 1000000);
  char decimals[7] = {'.'};
  for (std::uint64_t rest = magnitude % 1000000, i = 6; i > 0; --i, rest /= 10) {
    decimals[i] = static_cast<char>('0' + rest % 10);
  }
  text.append(decimals, 7);
}

/// The yaw of a quaternion of any length; none if it is so long or short that it has no direction.
std::optional<double> yaw_of(double qx, double qy, double qz, double qw) {
  const double square = qx * qx + qy * qy + qz * qz + qw * qw;
  if (!(square > 1e-12 && square < 1e12)) return std::nullopt;
  return wrap_angle(std::atan2(2 * (qw * qz + qx * qy), square - 2 * (qy * qy + qz * qz)));
}

}  // namespace

std::string to_tum(std::span<const StampedPose> trajectory) {
  std::string text;
  text.reserve(64 * trajectory.size());
  for (const StampedPose& p : trajectory) {
    append_micro(text, p.stamp);
    text += ' ';
    append_micro(text, p.pose.x);
    text += ' ';
    append_micro(text, p.pose.y);
    text += " 0 0 0 ";
    append_micro(text, std::sin(0.5 * p.pose.yaw));
    text += ' ';
    append_micro(text, std::cos(0.5 * p.pose.yaw));
    text += '\n';
  }
  return text;
}

TumFile parse_tum(const std::string& text, const std::string& name) {
  TumFile file;
  SkipCounter skipped;
  std::size_t line_number = 0;
  for (std::size_t begin = 0; begin < text.size();) {
    ++line_number;
    const std::size_t end = std::min(text.find('\n', begin), text.size());
    TextCursor cursor{text.data() + begin, text.data() + end};
    const bool passed_over = begin == end || text[begin] == '#' || text[begin] == '\r';
    begin = end + 1;
    if (passed_over) continue;
    double values[8] = {};
    bool ok = true;
    for (double& value : values) {
      const ReadNumber number = read_number(cursor);
      ok = ok && number.ok && std::isfinite(number.value);
      value = number.value;
    }
    const std::optional<double> yaw = yaw_of(values[4], values[5], values[6], values[7]);
    if (!ok || !yaw) {
      skipped.add("line without the eight numbers of a pose", [&] { return fmt::format("{}:{}", name, line_number); });
      continue;
    }
    file.poses.push_back({values[0], {values[1], values[2], *yaw}});
  }
  file.skipped = skipped.all();
  return file;
}

Result<TumFile> read_tum(const std::string& path) {
  const Result<TextFile> text = read_text_file(path);
  if (!text) return tl::unexpected(text.error());
  TumFile file = parse_tum(text->text, text->name);
  if (file.poses.empty()) return fail("{}: holds no pose; a TUM trajectory has lines of t x y z qx qy qz qw", path);
  return file;
}

}  // namespace helicoid
