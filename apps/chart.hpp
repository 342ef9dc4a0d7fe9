// A chart with axes, as SVG: lines, dots and bars over numbers.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "apps/svg_drawing.hpp"

namespace helicoid {

struct Series {
  enum class Look { line, dots, bars };
  std::string name;  ///< empty: not in the legend
  std::vector<Vector2d> points;
  charts::Colour colour = 0x0072B2;
  Look look = Look::line;
};

struct Chart {
  std::string title;
  std::string x_label;  ///< with its unit
  std::string y_label;
  std::vector<Series> series;
  std::vector<std::string> x_names;  ///< of the places 1, 2, ... on the x axis, in place of numbers
  bool same_scale = false;           ///< a metre is as long to the right as up: for maps
  std::optional<double> y_from;      ///< where the axis begins; else by the data
  double width = 900, height = 420;  ///< pixels
};

/// Draws the chart with its upper left corner here.
void draw_chart(SvgDrawing& drawing, const Vector2d& corner, const Chart& chart);
/// Charts below one another, as one SVG.
[[nodiscard]] std::string draw_charts(const std::vector<Chart>& charts);
/// Round numbers that divide a range into about `count` steps.
[[nodiscard]] std::vector<double> round_ticks(double low, double high, int count);

}  // namespace helicoid
