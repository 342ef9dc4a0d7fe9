#include "helicoid/simulation/svg_path.hpp"

#include <cctype>
#include <charconv>
#include <cmath>
#include <span>

namespace helicoid {

namespace {

bool is_separator(char c) {
  return c == ' ' || c == ',' || c == '\t' || c == '\n' || c == '\r';
}

/// The next number of a text, which is cut off in front; false if there is none.
bool take_number(std::string_view& text, double& value) {
  while (!text.empty() && is_separator(text.front())) text.remove_prefix(1);
  if (!text.empty() && text.front() == '+') text.remove_prefix(1);
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || !std::isfinite(value)) return false;
  text.remove_prefix(static_cast<std::size_t>(stop - text.data()));
  return true;
}

SvgTransform make_transform(double a, double b, double c, double d, double e, double f) {
  SvgTransform t;
  t.M << a, c, e, b, d, f;
  return t;
}

SvgTransform one_transform(std::string_view name, const std::vector<double>& v) {
  const auto at = [&](std::size_t i, double otherwise) { return i < v.size() ? v[i] : otherwise; };
  if (name == "translate") return make_transform(1, 0, 0, 1, at(0, 0), at(1, 0));
  if (name == "scale") return make_transform(at(0, 1), 0, 0, at(1, at(0, 1)), 0, 0);
  if (name == "matrix" && v.size() == 6) return make_transform(v[0], v[1], v[2], v[3], v[4], v[5]);
  if (name == "rotate") {
    const double c = std::cos(radians(at(0, 0)));
    const double s = std::sin(radians(at(0, 0)));
    const double x = at(1, 0);
    const double y = at(2, 0);
    return make_transform(c, s, -s, c, x - c * x + s * y, y - s * x - c * y);
  }
  return {};
}

/// How many numbers a command takes, and which of them are its end point's.
std::size_t arguments(char command) {
  switch (std::tolower(command)) {
    case 'm':
    case 'l':
    case 't': return 2;
    case 'h':
    case 'v': return 1;
    case 'q':
    case 's': return 4;
    case 'c': return 6;
    case 'a': return 7;
    default: return 0;
  }
}

/// Draws a path's commands.
struct PathPen {
  std::vector<SvgLine> lines;
  Vector2d at = Vector2d::Zero();

  void close() {
    if (lines.empty() || lines.back().points.empty()) return;
    lines.back().closed = true;
    at = lines.back().points.front();
  }
  /// The end points of curves stand for the curves.
  void draw(char command, std::span<const double> v) {
    const bool relative = std::islower(static_cast<unsigned char>(command)) != 0;
    const Vector2d base = relative ? at : Vector2d::Zero();
    const int kind = std::tolower(command);
    if (kind == 'h') {
      at.x() = base.x() + v[0];
    } else if (kind == 'v') {
      at.y() = base.y() + v[0];
    } else {
      at = base + Vector2d(v[v.size() - 2], v[v.size() - 1]);
    }
    if (kind == 'm' || lines.empty() || lines.back().closed) lines.emplace_back();
    lines.back().points.push_back(at);
  }
};

}  // namespace

SvgTransform SvgTransform::then_inner(const SvgTransform& inner) const {
  SvgTransform both;
  both.M.leftCols<2>() = M.leftCols<2>() * inner.M.leftCols<2>();
  both.M.col(2) = M.leftCols<2>() * inner.M.col(2) + M.col(2);
  return both;
}

std::vector<double> svg_numbers(std::string_view text) {
  std::vector<double> numbers;
  double value = 0;
  while (take_number(text, value)) numbers.push_back(value);
  return numbers;
}

SvgTransform svg_transform(std::string_view text) {
  SvgTransform all;
  while (true) {
    const std::size_t open = text.find('(');
    const std::size_t close = text.find(')');
    if (open == std::string_view::npos || close == std::string_view::npos || close < open) return all;
    std::string_view name = text.substr(0, open);
    while (!name.empty() && is_separator(name.front())) name.remove_prefix(1);
    all = all.then_inner(one_transform(name, svg_numbers(text.substr(open + 1, close - open - 1))));
    text.remove_prefix(close + 1);
  }
}

std::vector<SvgLine> svg_path(std::string_view text) {
  PathPen pen;
  char command = 0;
  while (!text.empty()) {
    if (is_separator(text.front())) {
      text.remove_prefix(1);
      continue;
    }
    if (std::isalpha(static_cast<unsigned char>(text.front())) != 0) {
      command = text.front();
      text.remove_prefix(1);
      if (command == 'Z' || command == 'z') {
        pen.close();
        continue;
      }
    }
    double v[7] = {};
    const std::size_t count = arguments(command);
    for (std::size_t i = 0; i < count; ++i) {
      if (!take_number(text, v[i])) return pen.lines;
    }
    if (count == 0) return pen.lines;
    pen.draw(command, {v, count});
    // More points after a move are lines.
    if (command == 'M') command = 'L';
    if (command == 'm') command = 'l';
  }
  return pen.lines;
}

}  // namespace helicoid
