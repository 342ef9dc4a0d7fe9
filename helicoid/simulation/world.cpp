#include "helicoid/simulation/world.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "helicoid/simulation/shipped_worlds.hpp"

namespace helicoid {

std::vector<std::string> shipped_worlds() {
  std::vector<std::string> names;
  for (const ShippedWorld& world : kShippedWorlds) names.emplace_back(world.name);
  return names;
}

Result<World> load_world(const std::string& name_or_path) {
  for (const ShippedWorld& world : kShippedWorlds) {
    if (name_or_path == world.name) return parse_svg_world(world.svg, world.name);
  }
  std::error_code error;
  if (!std::filesystem::is_regular_file(name_or_path, error)) {
    return fail("{}: is no shipped world ({}) and no file", name_or_path, fmt::join(shipped_worlds(), ", "));
  }
  if (name_or_path.ends_with(".yaml") || name_or_path.ends_with(".yml")) return read_image_world(name_or_path);
  std::ifstream file(name_or_path, std::ios::binary);
  return parse_svg_world({std::istreambuf_iterator<char>(file), {}}, name_or_path);
}

Result<void> check_size(const World& world) {
  constexpr double kLargest = 1e5;  // metres from the origin
  const auto near = [](const Vector2d& p) { return p.allFinite() && p.lpNorm<Eigen::Infinity>() <= kLargest; };
  const auto is_near = [&](const Segment& s) { return near(s.from) && near(s.to); };
  bool all = std::all_of(world.walls.begin(), world.walls.end(), is_near) &&
             std::all_of(world.doors.begin(), world.doors.end(), is_near) &&
             std::all_of(world.starts.begin(), world.starts.end(),
                         [&](const Pose2& T) { return near(T.translation()) && std::isfinite(T.yaw); });
  for (const Route& route : world.routes) all = all && std::all_of(route.points.begin(), route.points.end(), near);
  if (!all) return fail("{}: has coordinates beyond {} m; units must be metres", world.name, kLargest);
  return {};
}

std::string to_yaml(const World& world) {
  std::string text = fmt::format("name: {}\nunit: metre\n", world.name);
  auto out = std::back_inserter(text);
  text += "starts:  # x, y, yaw\n";
  for (const Pose2& s : world.starts) fmt::format_to(out, "  - [{:.4f}, {:.4f}, {:.6f}]\n", s.x, s.y, s.yaw);
  text += "walls:  # x1, y1, x2, y2\n";
  for (const Segment& w : world.walls) {
    fmt::format_to(out, "  - [{:.4f}, {:.4f}, {:.4f}, {:.4f}]\n", w.from.x(), w.from.y(), w.to.x(), w.to.y());
  }
  text += "doors:\n";
  for (const Segment& d : world.doors) {
    fmt::format_to(out, "  - [{:.4f}, {:.4f}, {:.4f}, {:.4f}]\n", d.from.x(), d.from.y(), d.to.x(), d.to.y());
  }
  text += "routes:\n";
  for (const Route& r : world.routes) {
    fmt::format_to(out, "  - closed: {}\n    points:\n", r.closed);
    for (const Vector2d& p : r.points) fmt::format_to(out, "      - [{:.4f}, {:.4f}]\n", p.x(), p.y());
  }
  return text;
}

}  // namespace helicoid
