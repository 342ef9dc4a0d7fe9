#include "helicoid/charts/sketch_svg.hpp"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>

#include "helicoid/base/whole_file.hpp"
#include "helicoid/charts/palette.hpp"

namespace helicoid {

namespace {

constexpr double kCentimetres = 100;
constexpr long kMargin = 60;

struct Cell2 {
  long x, y;
};
Cell2 rounded(const Vector2d& p) {
  return {std::lround(p.x() * kCentimetres), std::lround(p.y() * kCentimetres)};
}

/// Appends an SVG path through whole centimetres, with relative steps: half the size of absolute ones.
class PathWriter {
 public:
  void move(const Vector2d& p) {
    at_ = rounded(p);
    fmt::format_to(std::back_inserter(text_), "M{} {}l", at_.x, at_.y);
    first_ = true;
  }
  void line(const Vector2d& p) {
    const Cell2 to = rounded(p);
    const long dx = to.x - at_.x;
    const long dy = to.y - at_.y;
    at_ = to;
    fmt::format_to(std::back_inserter(text_), "{}{}{}{}", first_ || dx < 0 ? "" : " ", dx, dy < 0 ? "" : " ", dy);
    first_ = false;
  }
  void close() { text_ += 'z'; }
  [[nodiscard]] const std::string& text() const { return text_; }

 private:
  std::string text_;
  Cell2 at_{};
  bool first_ = true;
};

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (static_cast<unsigned char>(c) >= 0x20)
      safe += c;
  }
  return safe;
}

std::string fill_path(const Sketch& sketch) {
  PathWriter path;
  for (const SketchRing& ring : sketch.rings) {
    path.move(ring.points.front());
    for (std::size_t i = 1; i < ring.points.size(); ++i) path.line(ring.points[i]);
    path.close();
  }
  return path.text();
}

/// The runs of one kind of border, as open lines.
std::string border_path(const Sketch& sketch, Border border) {
  PathWriter path;
  for (const SketchRing& ring : sketch.rings) {
    bool drawing = false;
    for (std::size_t i = 0; i < ring.points.size(); ++i) {
      if (ring.borders[i] != border) {
        drawing = false;
        continue;
      }
      if (!drawing) path.move(ring.points[i]);
      path.line(ring.points[i + 1 < ring.points.size() ? i + 1 : 0]);
      drawing = true;
    }
  }
  return path.text();
}

struct Box {
  long left = std::numeric_limits<long>::max(), bottom = left;
  long right = std::numeric_limits<long>::min(), top = right;
  void add(const Vector2d& p) {
    const Cell2 at = rounded(p);
    left = std::min(left, at.x);
    right = std::max(right, at.x);
    bottom = std::min(bottom, at.y);
    top = std::max(top, at.y);
  }
};

Box box_around(const SketchDrawing& drawing) {
  Box box;
  for (const SketchLayer& layer : drawing.layers) {
    for (const SketchRing& ring : layer.sketch.rings) {
      for (const Vector2d& p : ring.points) box.add(p);
    }
  }
  for (const Way& way : drawing.ways) {
    for (const auto& line : way.lines) {
      for (const Vector2d& p : line) box.add(p);
    }
  }
  if (drawing.topology) {
    for (const TopologyNode& node : drawing.topology->nodes) box.add(node.p_plane);
  }
  if (box.left > box.right) box.add(Vector2d::Zero());
  return box;
}

void add_layer(std::string& svg, const SketchLayer& layer, std::size_t number, bool see_through) {
  fmt::format_to(std::back_inserter(svg),
                 "<g id=\"{}\">\n<path fill=\"#{:06x}\" fill-opacity=\"{}\" fill-rule=\"evenodd\" d=\"{}\"/>\n"
                 "<path class=\"frontier\" d=\"{}\"/>\n<path class=\"wall\" d=\"{}\"/>\n</g>\n",
                 escaped(layer.name), charts::floor_colour(number), see_through ? "0.75" : "1", fill_path(layer.sketch),
                 border_path(layer.sketch, Border::frontier), border_path(layer.sketch, Border::wall));
}

void add_way(std::string& svg, const Way& way) {
  PathWriter path;
  for (const auto& line : way.lines) {
    path.move(line.front());
    for (std::size_t i = 1; i < line.size(); ++i) path.line(line[i]);
  }
  fmt::format_to(std::back_inserter(svg), "<path class=\"way\" stroke=\"#{:06x}\" d=\"{}\"><title>{}</title></path>\n",
                 charts::robot_colour(way.robot.index()), path.text(), escaped(way.name));
}

void add_topology(std::string& svg, const Topology& topology) {
  PathWriter edges;
  for (const TopologyEdge& edge : topology.edges) {
    edges.move(topology.nodes[edge.a].p_plane);
    edges.line(topology.nodes[edge.b].p_plane);
  }
  fmt::format_to(std::back_inserter(svg), "<g id=\"topology\">\n<path class=\"edge\" d=\"{}\"/>\n", edges.text());
  for (const TopologyNode& node : topology.nodes) {
    const Cell2 at = rounded(node.p_plane);
    fmt::format_to(std::back_inserter(svg), "<circle class=\"node\" cx=\"{}\" cy=\"{}\" r=\"12\"/>\n", at.x, at.y);
  }
  svg += "</g>\n";
}

}  // namespace

std::string to_svg(const SketchDrawing& drawing) {
  const Box box = box_around(drawing);
  const long left = box.left - kMargin;
  const long top = -(box.top + kMargin);
  const long width = box.right - box.left + 2 * kMargin;
  const long height = box.top - box.bottom + 2 * kMargin;
  // Ten metres take about 400 pixels on a screen, and any map at least 400.
  const double pixels = std::clamp(0.4 * static_cast<double>(width), 400.0, 1600.0);
  std::string svg = fmt::format(
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<svg xmlns=\"http://www.w3.org/2000/svg\" version=\"1.1\" "
      "width=\"{:.0f}\" height=\"{:.0f}\" viewBox=\"{} {} {} {}\">\n<title>{}</title>\n"
      "<desc>1 unit = 1 cm in the island's plane</desc>\n<style>.wall,.frontier,.way,.edge{{fill:none;"
      "stroke-linejoin:round;stroke-linecap:round}}.wall{{stroke:#{:06x};stroke-width:6}}"
      ".frontier{{stroke:#2a8fbd;stroke-width:4;stroke-dasharray:14 12}}.way{{stroke-width:3;stroke-opacity:0.85}}"
      ".edge{{stroke:#7a8794;stroke-width:4}}.node{{fill:#fff;stroke:#3c4856;stroke-width:4}}</style>\n"
      "<rect x=\"{}\" y=\"{}\" width=\"{}\" height=\"{}\" fill=\"#{:06x}\"/>\n<g transform=\"scale(1,-1)\">\n",
      pixels, pixels * static_cast<double>(height) / static_cast<double>(width), left, top, width, height,
      escaped(drawing.title), charts::kWall, left, top, width, height, charts::kUnknown);
  for (std::size_t i = 0; i < drawing.layers.size(); ++i) add_layer(svg, drawing.layers[i], i, i > 0);
  for (const Way& way : drawing.ways) add_way(svg, way);
  if (drawing.topology) add_topology(svg, *drawing.topology);
  return svg + "</g>\n</svg>\n";
}

Result<void> write_sketch(const SketchDrawing& drawing, const std::string& path) {
  return write_whole_file(path, to_svg(drawing));
}

}  // namespace helicoid
