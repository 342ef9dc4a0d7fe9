// What an operator says to a team that explores, as a file of timed lines (docs/formats.md, *Orders*).
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/exploration/team.hpp"

namespace helicoid {

struct TimedOrder {
  double at = 0;  ///< seconds since the exploration began
  OrderKind kind = OrderKind::resume;
  std::string robot;             ///< empty: all
  std::vector<Vector2d> places;  ///< in the plane of the robot's island, metres: the goal, or the region's corners
};

/// Lines `SECONDS ROBOT|all send X Y`, `... pause`, `... resume`, `... home` and `... forbid X Y X Y X Y...`; `#`
/// begins a comment. In the order of their times. Error: a line that says nothing of this, with its number.
[[nodiscard]] Result<std::vector<TimedOrder>> parse_orders(const std::string& text, const std::string& name);
/// `-` is stdin. Errors: as parse_orders, or the file cannot be read.
[[nodiscard]] Result<std::vector<TimedOrder>> read_orders(const std::string& path);

/// The order on the map as it is now: on the robot's island, or the first one for all. Nothing if there is no robot of
/// this name, or none that has a map yet.
[[nodiscard]] std::optional<Order> place_order(const TimedOrder& order, const Map& map);

}  // namespace helicoid
