// A building: walls that stop rays and robots, places to start from, routes to drive.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"
#include "helicoid/geometry/ray_casting.hpp"

namespace helicoid {

/// A line to drive along; a closed one is a circuit, an open one is driven out and back.
struct Route {
  std::vector<Vector2d> points;  ///< metres
  bool closed = false;
};

struct World {
  std::string name;
  std::vector<Segment> walls;
  std::vector<Pose2> starts;
  std::vector<Segment> doors;  ///< openings to the outside; they stop nothing
  std::vector<Route> routes;
};

/// A shipped world's name (shipped_worlds()), an SVG file, or an occupancy image's MAP.yaml.
[[nodiscard]] Result<World> load_world(const std::string& name_or_path);
[[nodiscard]] std::vector<std::string> shipped_worlds();

/// An SVG whose user units are metres; elements of class wall, start, door and route (line, polyline, polygon, rect,
/// path, circle; group transforms). The file's y points down; the world's points up: y = -y_svg. A wall with the
/// attribute data-thickness (metres) has two faces, half of it to each side of its line. A start is a circle; its
/// heading is the attribute data-yaw, in degrees anticlockwise in the world.
[[nodiscard]] Result<World> parse_svg_world(const std::string& svg, const std::string& name);

/// ROS map_server's MAP.yaml with a PGM or PNG image; what is not free is solid. Its start is where there is most room
/// in its largest space; it has no route (plan_tour makes one).
[[nodiscard]] Result<World> read_image_world(const std::string& yaml_path);
/// The same from the text of the YAML and the bytes of the image; `name` is what messages call it.
[[nodiscard]] Result<World> parse_image_world(const std::string& yaml, const std::string& image_bytes,
                                              const std::string& name);

/// Error: a world with coordinates that are not finite or that no building has.
[[nodiscard]] Result<void> check_size(const World& world);

/// The world as YAML, for whoever reads a simulation's folder.
[[nodiscard]] std::string to_yaml(const World& world);

}  // namespace helicoid
