#include <cmath>
#include <pugixml.hpp>

#include "helicoid/simulation/svg_path.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

namespace {

constexpr int kCircleCorners = 12;

std::vector<SvgLine> lines_of(const pugi::xml_node& element) {
  const std::string kind = element.name();
  const auto number = [&](const char* key) { return element.attribute(key).as_double(); };
  if (kind == "line") return {{{{number("x1"), number("y1")}, {number("x2"), number("y2")}}, false}};
  if (kind == "rect") {
    const double x = number("x");
    const double y = number("y");
    const double w = number("width");
    const double h = number("height");
    return {{{{x, y}, {x + w, y}, {x + w, y + h}, {x, y + h}}, true}};
  }
  if (kind == "polyline" || kind == "polygon") {
    const std::vector<double> v = svg_numbers(element.attribute("points").as_string());
    SvgLine line{{}, kind == "polygon"};
    for (std::size_t i = 0; i + 1 < v.size(); i += 2) line.points.emplace_back(v[i], v[i + 1]);
    return {line};
  }
  if (kind == "path") return svg_path(element.attribute("d").as_string());
  if (kind == "circle") {
    SvgLine line{{}, true};
    for (int i = 0; i < kCircleCorners; ++i) {
      const double angle = 2 * std::numbers::pi * i / kCircleCorners;
      line.points.emplace_back(number("cx") + number("r") * std::cos(angle),
                               number("cy") + number("r") * std::sin(angle));
    }
    return {line};
  }
  return {};
}

/// From the file's axes, y down, to the world's, y up.
Vector2d to_world(const SvgTransform& transform, const Vector2d& p) {
  const Vector2d q = transform(p);
  return {q.x(), -q.y()};
}

bool has_class(const pugi::xml_node& element, std::string_view wanted) {
  const std::string classes = std::string(" ") + element.attribute("class").as_string() + " ";
  return classes.find(" " + std::string(wanted) + " ") != std::string::npos;
}

/// The outline of a straight piece of wall, square at its ends so that pieces join.
void add_thick(const Vector2d& a, const Vector2d& b, double thickness, std::vector<Segment>& segments) {
  const Vector2d along = 0.5 * thickness * (b - a).normalized();
  const Vector2d across(-along.y(), along.x());
  const Vector2d corners[] = {a - along - across, b + along - across, b + along + across, a - along + across};
  for (std::size_t i = 0; i < 4; ++i) segments.push_back({corners[i], corners[(i + 1) % 4]});
}

void add_lines(const std::vector<Vector2d>& points, bool closed, double thickness, std::vector<Segment>& segments) {
  const std::size_t count = points.size() - (closed && points.size() > 2 ? 0 : 1);
  for (std::size_t i = 0; i < count; ++i) {
    const Vector2d& a = points[i];
    const Vector2d& b = points[(i + 1) % points.size()];
    if (a == b) continue;
    if (thickness > 0) {
      add_thick(a, b, thickness, segments);
    } else {
      segments.push_back({a, b});
    }
  }
}

void add_element(const pugi::xml_node& element, const SvgTransform& transform, World& world) {
  if (has_class(element, "start")) {
    const Vector2d at = to_world(transform, {element.attribute("cx").as_double(), element.attribute("cy").as_double()});
    world.starts.push_back({at.x(), at.y(), wrap_angle(radians(element.attribute("data-yaw").as_double()))});
    return;
  }
  const bool wall = has_class(element, "wall");
  const bool door = has_class(element, "door");
  const bool route = has_class(element, "route");
  if (!wall && !door && !route) return;
  for (const SvgLine& line : lines_of(element)) {
    std::vector<Vector2d> points;
    for (const Vector2d& p : line.points) points.push_back(to_world(transform, p));
    if (points.size() < 2) continue;
    if (route) {
      world.routes.push_back({points, line.closed});
    } else {
      const double thickness = wall ? element.attribute("data-thickness").as_double() : 0;
      add_lines(points, line.closed, thickness, wall ? world.walls : world.doors);
    }
  }
}

/// No drawing nests deeper; a file made to exhaust the stack does.
constexpr int kDeepest = 200;

/// False if the elements nest too deep.
bool walk(const pugi::xml_node& node, const SvgTransform& outer, int depth, World& world) {
  if (depth > kDeepest) return false;
  for (const pugi::xml_node& child : node.children()) {
    const SvgTransform transform = outer.then_inner(svg_transform(child.attribute("transform").as_string()));
    add_element(child, transform, world);
    if (!walk(child, transform, depth + 1, world)) return false;
  }
  return true;
}

}  // namespace

Result<World> parse_svg_world(const std::string& svg, const std::string& name) {
  pugi::xml_document document;
  const pugi::xml_parse_result parsed = document.load_buffer(svg.data(), svg.size());
  if (!parsed) return fail("{}: is no SVG: {} at byte {}", name, parsed.description(), parsed.offset);
  World world;
  world.name = name;
  if (!walk(document, {}, 0, world)) return fail("{}: has more than {} groups inside one another", name, kDeepest);
  if (world.walls.empty()) {
    return fail("{}: has no element of class \"wall\"; mark what stops a robot with class=\"wall\"", name);
  }
  if (const Result<void> checked = check_size(world); !checked) return tl::unexpected(checked.error());
  return world;
}

}  // namespace helicoid
