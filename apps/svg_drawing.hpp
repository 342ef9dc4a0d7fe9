// A drawing that is written as SVG. Coordinates are pixels, y down.
#pragma once

#include <span>
#include <string>
#include <string_view>

#include "helicoid/charts/palette.hpp"
#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

struct Stroke {
  charts::Colour colour = charts::kText;
  double width = 1;       ///< pixels
  std::string_view dash;  ///< SVG's stroke-dasharray; empty: drawn through
};

struct TextStyle {
  double size = 12;                   ///< pixels
  std::string_view anchor = "start";  ///< start, middle or end
  charts::Colour colour = charts::kText;
  bool bold = false;
  double turn = 0;  ///< degrees, clockwise about the place
};

class SvgDrawing {
 public:
  SvgDrawing(double width, double height);

  void line(const Vector2d& from, const Vector2d& to, const Stroke& stroke);
  void polyline(std::span<const Vector2d> points, const Stroke& stroke, bool closed = false);
  void rectangle(const Vector2d& corner, const Vector2d& size, charts::Colour fill, double opacity = 1);
  /// What SVG's path data encloses.
  void area(std::string_view path, charts::Colour fill);
  void disc(const Vector2d& centre, double radius, charts::Colour fill, double opacity = 1);
  void text(const Vector2d& at, std::string_view words, const TextStyle& style = {});

  [[nodiscard]] std::string finish() const { return svg_ + "</svg>\n"; }

 private:
  std::string svg_;
};

}  // namespace helicoid
