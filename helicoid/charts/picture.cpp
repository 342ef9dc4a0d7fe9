#include "helicoid/charts/picture.hpp"

#include <cairo/cairo.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "helicoid/base/whole_file.hpp"
#include "helicoid/charts/palette.hpp"
#include "helicoid/charts/raster.hpp"

namespace helicoid {

namespace {

using charts::Colour;
using charts::Raster;

constexpr int kLegendHeight = 56;
constexpr int kSmallestWidth = 560;
constexpr double kFontSize = 17;
/// A stroke of many points that crosses itself is slow to draw in one.
constexpr std::size_t kStrokePoints = 120;

using Surface = std::unique_ptr<cairo_surface_t, decltype(&cairo_surface_destroy)>;
using Context = std::unique_ptr<cairo_t, decltype(&cairo_destroy)>;

void set_colour(cairo_t* cr, Colour colour) {
  cairo_set_source_rgb(cr, charts::channel(colour, 16) / 255.0, charts::channel(colour, 8) / 255.0,
                       charts::channel(colour, 0) / 255.0);
}

/// From the plane to pixels.
struct View {
  GridFrame frame;
  int scale = 1;
  double left = 0;
  [[nodiscard]] Vector2d to_pixels(const Vector2d& p_plane) const {
    const Vector2d cells = frame.to_cells(p_plane);
    return {left + scale * cells.x(), scale * (frame.height - cells.y())};
  }
};

void draw_dot(cairo_t* cr, const Vector2d& p, double radius, Colour colour) {
  cairo_new_path(cr);
  cairo_arc(cr, p.x(), p.y(), radius, 0, 2 * std::numbers::pi);
  set_colour(cr, charts::kFree);
  cairo_fill_preserve(cr);
  set_colour(cr, colour);
  cairo_set_line_width(cr, 2);
  cairo_stroke(cr);
}

void draw_way(cairo_t* cr, const View& view, const Way& way) {
  const Colour colour = charts::robot_colour(way.robot.index());
  set_colour(cr, colour);
  cairo_set_line_width(cr, 1.3);
  for (const auto& line : way.lines) {
    for (std::size_t i = 0; i < line.size(); ++i) {
      const Vector2d p = view.to_pixels(line[i]);
      cairo_line_to(cr, p.x(), p.y());
      if (i % kStrokePoints != kStrokePoints - 1) continue;
      cairo_stroke(cr);
      cairo_move_to(cr, p.x(), p.y());
    }
    cairo_stroke(cr);
  }
  // Where the robot started: a ring; where it is now: a disc.
  draw_dot(cr, view.to_pixels(way.lines.front().front()), 5, colour);
  const Vector2d end = view.to_pixels(way.lines.back().back());
  cairo_arc(cr, end.x(), end.y(), 4.5, 0, 2 * std::numbers::pi);
  cairo_fill(cr);
}

double text_width(cairo_t* cr, const std::string& text) {
  cairo_text_extents_t extents;
  cairo_text_extents(cr, text.c_str(), &extents);
  return extents.x_advance;
}

void draw_text(cairo_t* cr, double x, double y, const std::string& text) {
  cairo_move_to(cr, x, y);
  cairo_show_text(cr, text.c_str());
}

/// A round length that is about a fifth of the picture's width.
double bar_length(double metres) {
  double length = std::pow(10, std::floor(std::log10(metres)));
  for (const double factor : {5.0, 2.0}) {
    if (length * factor <= metres) return length * factor;
  }
  return length;
}

/// Draws the scale bar and returns where the next thing may stand.
double draw_scale(cairo_t* cr, double x, double middle, double pixels_a_metre, double width) {
  const double metres = bar_length(width / 5 / pixels_a_metre);
  const double length = metres * pixels_a_metre;
  set_colour(cr, charts::kText);
  cairo_set_line_width(cr, 2);
  cairo_move_to(cr, x, middle - 5);
  cairo_line_to(cr, x, middle + 5);
  cairo_move_to(cr, x, middle);
  cairo_line_to(cr, x + length, middle);
  cairo_move_to(cr, x + length, middle - 5);
  cairo_line_to(cr, x + length, middle + 5);
  cairo_stroke(cr);
  const std::string label = fmt::format("{:g} m", metres);
  draw_text(cr, x + length + 10, middle + 6, label);
  return x + length + 10 + text_width(cr, label) + 36;
}

void draw_legend(cairo_t* cr, const View& view, const SheetStack& sheets, std::span<const Way> ways,
                 const PictureOptions& options, double width, double top) {
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, kFontSize);
  const double middle = top + kLegendHeight / 2.0;
  double x = draw_scale(cr, 24, middle, view.scale / view.frame.resolution, width);
  const bool several = sheets.deepest > 1 && options.sheets != 1;
  std::string right = options.title;
  if (several) {
    right += fmt::format("{}{} sheets overlap here", options.title.empty() ? "" : " – ",
                         options.sheets > 0 ? options.sheets : sheets.deepest);
  }
  const double right_x = width - 24 - text_width(cr, right);
  for (std::size_t i = 0; i < ways.size(); ++i) {
    const double needed = 34 + text_width(cr, ways[i].name) + 24;
    const std::string more = fmt::format("and {} more", ways.size() - i);
    const bool last = i + 1 == ways.size();
    if (x + needed + (last ? 0 : text_width(cr, more) + 24) > right_x) {
      set_colour(cr, charts::kText);
      if (x + text_width(cr, more) + 24 < right_x) draw_text(cr, x, middle + 6, more);
      break;
    }
    set_colour(cr, charts::robot_colour(ways[i].robot.index()));
    cairo_set_line_width(cr, 3);
    cairo_move_to(cr, x, middle);
    cairo_line_to(cr, x + 26, middle);
    cairo_stroke(cr);
    set_colour(cr, charts::kText);
    draw_text(cr, x + 34, middle + 6, ways[i].name);
    x += needed;
  }
  if (several) {
    set_colour(cr, charts::kOverlap);
    cairo_rectangle(cr, right_x - 30, middle - 8, 20, 16);
    cairo_fill(cr);
  }
  set_colour(cr, charts::kText);
  draw_text(cr, right_x, middle + 6, right);
}

/// The pixels become the bytes of the file; they are packed in place, so that no second picture is held.
Result<std::string> encode_png(Raster raster) {
  auto* rgb = reinterpret_cast<unsigned char*>(raster.pixels.data());
  for (std::size_t i = 0; i < raster.pixels.size(); ++i) {
    const std::uint32_t pixel = raster.pixels[i];
    rgb[3 * i] = static_cast<unsigned char>(pixel >> 16U);
    rgb[3 * i + 1] = static_cast<unsigned char>(pixel >> 8U);
    rgb[3 * i + 2] = static_cast<unsigned char>(pixel);
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(raster.width);
  image.height = static_cast<png_uint_32>(raster.height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  char* bytes = nullptr;
  std::size_t size = 0;
  std::FILE* memory = ::open_memstream(&bytes, &size);
  if (memory == nullptr) return fail("there is no memory to encode the picture");
  const int encoded = png_image_write_to_stdio(&image, memory, 0, rgb, 0, nullptr);
  const bool closed = std::fclose(memory) == 0;
  const std::unique_ptr<char, decltype(&std::free)> owner(bytes, std::free);
  if (encoded == 0) return fail("the picture cannot be encoded: {}", std::string(image.message));
  if (!closed) return fail("there is no memory to encode the picture");
  return std::string(bytes, size);
}

void draw_over(cairo_t* cr, const View& view, const SheetStack& sheets, std::span<const Way> ways,
               const PictureOptions& options, const Raster& raster) {
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  for (const Way& way : ways) draw_way(cr, view, way);
  draw_legend(cr, view, sheets, ways, options, raster.width, raster.height - kLegendHeight);
}

}  // namespace

Result<void> write_picture(const SheetStack& sheets, std::span<const Way> ways, const std::string& path,
                           const PictureOptions& options) {
  const GridFrame& frame = sheets.grid.frame;
  const int longest = std::max({frame.width, frame.height, 1});
  Raster raster = charts::paint(sheets, std::clamp(options.longest_side / longest, 1, 8),
                                {.smallest_width = kSmallestWidth, .foot = kLegendHeight});
  {
    // Cairo draws straight into the raster's pixels.
    const Surface surface(
        cairo_image_surface_create_for_data(reinterpret_cast<unsigned char*>(raster.pixels.data()), CAIRO_FORMAT_RGB24,
                                            raster.width, raster.height, 4 * raster.width),
        cairo_surface_destroy);
    if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) {
      return fail("{}: a picture of {} x {} pixels is too large; draw with coarser cells", path, raster.width,
                  raster.height);
    }
    const Context context(cairo_create(surface.get()), cairo_destroy);
    draw_over(context.get(), {frame, raster.scale, static_cast<double>(raster.left)}, sheets, ways, options, raster);
    cairo_surface_flush(surface.get());
  }
  const Result<std::string> bytes = encode_png(std::move(raster));
  if (!bytes) return fail("{}: {}", path, bytes.error().message);
  return write_whole_file(path, *bytes);
}

}  // namespace helicoid
