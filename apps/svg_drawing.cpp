#include "apps/svg_drawing.hpp"

#include <fmt/format.h>

#include <iterator>

namespace helicoid {

namespace {

std::string escaped(std::string_view words) {
  std::string text;
  for (const char c : words) {
    switch (c) {
      case '<': text += "&lt;"; break;
      case '>': text += "&gt;"; break;
      case '&': text += "&amp;"; break;
      default: text += c;
    }
  }
  return text;
}

std::string stroke_attributes(const Stroke& stroke) {
  return fmt::format("fill=\"none\" stroke=\"#{:06x}\" stroke-width=\"{:.4g}\"{}", stroke.colour, stroke.width,
                     stroke.dash.empty() ? "" : fmt::format(" stroke-dasharray=\"{}\"", stroke.dash));
}

}  // namespace

SvgDrawing::SvgDrawing(double width, double height) {
  svg_ = fmt::format(
      "<svg xmlns=\"http://www.w3.org/2000/svg\" width=\"{0:.0f}\" height=\"{1:.0f}\" viewBox=\"0 0 {0:.0f} {1:.0f}\" "
      "font-family=\"Helvetica, Arial, sans-serif\" stroke-linejoin=\"round\" stroke-linecap=\"round\">\n"
      "<rect width=\"{0:.0f}\" height=\"{1:.0f}\" fill=\"#ffffff\"/>\n",
      width, height);
}

void SvgDrawing::line(const Vector2d& from, const Vector2d& to, const Stroke& stroke) {
  fmt::format_to(std::back_inserter(svg_), "<line x1=\"{:.2f}\" y1=\"{:.2f}\" x2=\"{:.2f}\" y2=\"{:.2f}\" {}/>\n",
                 from.x(), from.y(), to.x(), to.y(), stroke_attributes(stroke));
}

void SvgDrawing::polyline(std::span<const Vector2d> points, const Stroke& stroke, bool closed) {
  auto out = std::back_inserter(svg_);
  fmt::format_to(out, "<{} points=\"", closed ? "polygon" : "polyline");
  for (const Vector2d& p : points) fmt::format_to(out, "{:.1f},{:.1f} ", p.x(), p.y());
  fmt::format_to(out, "\" {}/>\n", stroke_attributes(stroke));
}

void SvgDrawing::rectangle(const Vector2d& corner, const Vector2d& size, charts::Colour fill, double opacity) {
  fmt::format_to(
      std::back_inserter(svg_),
      "<rect x=\"{:.2f}\" y=\"{:.2f}\" width=\"{:.2f}\" height=\"{:.2f}\" fill=\"#{:06x}\" opacity=\"{:.3g}\"/>\n",
      corner.x(), corner.y(), size.x(), size.y(), fill, opacity);
}

void SvgDrawing::area(std::string_view path, charts::Colour fill) {
  fmt::format_to(std::back_inserter(svg_), "<path d=\"{}\" fill=\"#{:06x}\" shape-rendering=\"crispEdges\"/>\n", path,
                 fill);
}

void SvgDrawing::disc(const Vector2d& centre, double radius, charts::Colour fill, double opacity) {
  fmt::format_to(std::back_inserter(svg_),
                 "<circle cx=\"{:.2f}\" cy=\"{:.2f}\" r=\"{:.2f}\" fill=\"#{:06x}\" opacity=\"{:.3g}\"/>\n", centre.x(),
                 centre.y(), radius, fill, opacity);
}

void SvgDrawing::text(const Vector2d& at, std::string_view words, const TextStyle& style) {
  const std::string turn =
      style.turn != 0 ? fmt::format(" transform=\"rotate({:.0f} {:.2f} {:.2f})\"", style.turn, at.x(), at.y()) : "";
  fmt::format_to(
      std::back_inserter(svg_),
      "<text x=\"{:.2f}\" y=\"{:.2f}\" font-size=\"{:.3g}\" text-anchor=\"{}\" fill=\"#{:06x}\"{}{}>{}</text>\n",
      at.x(), at.y(), style.size, style.anchor, style.colour, style.bold ? " font-weight=\"bold\"" : "", turn,
      escaped(words));
}

}  // namespace helicoid
