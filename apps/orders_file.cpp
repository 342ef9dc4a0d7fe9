#include "apps/orders_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <sstream>

#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

struct Word {
  const char* name;
  OrderKind kind;
  std::size_t least_places, most_places;
};
constexpr std::size_t kAny = 1000;
constexpr std::array kWords{Word{"send", OrderKind::send, 1, 1}, Word{"pause", OrderKind::pause, 0, 0},
                            Word{"resume", OrderKind::resume, 0, 0}, Word{"home", OrderKind::home, 0, 0},
                            Word{"forbid", OrderKind::forbid, 3, kAny}};

std::optional<std::vector<Vector2d>> read_places(std::istringstream& words) {
  std::vector<Vector2d> places;
  for (std::string x; words >> x;) {
    std::string y;
    Vector2d place;
    if (!(words >> y)) return std::nullopt;
    try {
      std::size_t used_x = 0;
      std::size_t used_y = 0;
      place = {std::stod(x, &used_x), std::stod(y, &used_y)};
      if (used_x != x.size() || used_y != y.size() || !place.allFinite()) return std::nullopt;
    } catch (const std::exception&) {
      return std::nullopt;
    }
    places.push_back(place);
  }
  return places;
}

std::optional<TimedOrder> parse_line(const std::string& line) {
  std::istringstream words(line);
  TimedOrder order;
  std::string kind;
  if (!(words >> order.at >> order.robot >> kind) || !std::isfinite(order.at)) return std::nullopt;
  const auto* word = std::find_if(kWords.begin(), kWords.end(), [&](const Word& w) { return kind == w.name; });
  if (word == kWords.end()) return std::nullopt;
  order.kind = word->kind;
  if (order.robot == "all") order.robot.clear();
  std::optional<std::vector<Vector2d>> places = read_places(words);
  if (!places || places->size() < word->least_places || places->size() > word->most_places) return std::nullopt;
  order.places = std::move(*places);
  return order;
}

/// The patch of an island that lies nearest to a place of its plane.
PatchId nearest_patch(const Map& map, IslandId island, const Vector2d& p_plane) {
  PatchId nearest;
  double least = HUGE_VAL;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    const double away = (map.T_plane_patch(id).translation() - p_plane).squaredNorm();
    if (map.island_of(id) != island || away >= least) continue;
    least = away;
    nearest = id;
  }
  return nearest;
}

}  // namespace

Result<std::vector<TimedOrder>> parse_orders(const std::string& text, const std::string& name) {
  std::vector<TimedOrder> orders;
  std::istringstream lines(text);
  std::size_t number = 0;
  for (std::string line; std::getline(lines, line);) {
    ++number;
    line.resize(std::min(line.find('#'), line.size()));
    if (line.find_first_not_of(" \t\r") == std::string::npos) continue;
    std::optional<TimedOrder> order = parse_line(line);
    if (!order) {
      return fail(
          "{}:{}: is no order; write SECONDS ROBOT|all and send X Y, pause, resume, home or forbid X Y X Y X Y...",
          name, number);
    }
    orders.push_back(std::move(*order));
  }
  std::stable_sort(orders.begin(), orders.end(), [](const auto& a, const auto& b) { return a.at < b.at; });
  return orders;
}

Result<std::vector<TimedOrder>> read_orders(const std::string& path) {
  const Result<TextFile> file = read_text_file(path);
  if (!file) return tl::unexpected(file.error());
  return parse_orders(file->text, file->name);
}

std::optional<Order> place_order(const TimedOrder& timed, const Map& map) {
  Order order;
  order.kind = timed.kind;
  const auto robots = map.robots();
  const auto robot = std::find_if(robots.begin(), robots.end(), [&](const RobotRecord& r) {
    return !r.trajectory.empty() && (timed.robot.empty() || r.name == timed.robot);
  });
  if (robot == robots.end()) return std::nullopt;
  if (!timed.robot.empty()) order.robot = make_id<RobotId>(static_cast<std::size_t>(robot - robots.begin()));
  if (timed.places.empty()) return order;
  const IslandId island = map.island_of(robot->trajectory.back().pose.patch);
  const PatchId patch = nearest_patch(map, island, timed.places.front());
  const Pose2 T_patch_plane = map.T_plane_patch(patch).inverse();
  order.point = {patch, T_patch_plane * timed.places.front()};
  for (const Vector2d& p : timed.places) order.region_patch.push_back(T_patch_plane * p);
  return order;
}

}  // namespace helicoid
