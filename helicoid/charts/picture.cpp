#include "helicoid/charts/picture.hpp"

#include <cairo/cairo.h>
#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>

#include "helicoid/charts/palette.hpp"
#include "helicoid/charts/raster.hpp"
#include "helicoid/charts/whole_file.hpp"

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
                 const std::string& title, double width, double top) {
  cairo_select_font_face(cr, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
  cairo_set_font_size(cr, kFontSize);
  const double middle = top + kLegendHeight / 2.0;
  double x = draw_scale(cr, 24, middle, view.scale / view.frame.resolution, width);
  std::string right = title;
  if (sheets.deepest > 1) {
    right += fmt::format("{}{} sheets overlap here", title.empty() ? "" : " – ", sheets.deepest);
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
  if (sheets.deepest > 1) {
    set_colour(cr, charts::kOverlap);
    cairo_rectangle(cr, right_x - 30, middle - 8, 20, 16);
    cairo_fill(cr);
  }
  set_colour(cr, charts::kText);
  draw_text(cr, right_x, middle + 6, right);
}

Result<std::string> encode_png(cairo_surface_t* surface) {
  cairo_surface_flush(surface);
  const int width = cairo_image_surface_get_width(surface);
  const int height = cairo_image_surface_get_height(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  const unsigned char* data = cairo_image_surface_get_data(surface);
  std::string rgb;
  rgb.reserve(static_cast<std::size_t>(width) * static_cast<std::size_t>(height) * 3);
  for (int y = 0; y < height; ++y) {
    const unsigned char* row = data + static_cast<std::ptrdiff_t>(y) * stride;
    for (int x = 0; x < width; ++x) {
      std::uint32_t pixel = 0;
      std::memcpy(&pixel, row + 4 * x, 4);
      for (const unsigned shift : {16U, 8U, 0U}) rgb.push_back(static_cast<char>(pixel >> shift & 0xFFU));
    }
  }
  png_image image{};
  image.version = PNG_IMAGE_VERSION;
  image.width = static_cast<png_uint_32>(width);
  image.height = static_cast<png_uint_32>(height);
  image.format = PNG_FORMAT_RGB;
  image.flags = PNG_IMAGE_FLAG_FAST;
  std::string bytes(PNG_IMAGE_PNG_SIZE_MAX(image), '\0');
  png_alloc_size_t size = bytes.size();
  if (png_image_write_to_memory(&image, bytes.data(), &size, 0, rgb.data(), 0, nullptr) == 0) {
    return fail("the picture cannot be encoded: {}", image.message);
  }
  bytes.resize(size);
  return bytes;
}

void copy_raster(const Raster& raster, cairo_surface_t* surface, int left) {
  cairo_surface_flush(surface);
  unsigned char* data = cairo_image_surface_get_data(surface);
  const int stride = cairo_image_surface_get_stride(surface);
  for (int y = 0; y < raster.height; ++y) {
    const std::size_t first = static_cast<std::size_t>(y) * static_cast<std::size_t>(raster.width);
    std::memcpy(data + static_cast<std::ptrdiff_t>(y) * stride + static_cast<std::ptrdiff_t>(4) * left,
                raster.pixels.data() + first, static_cast<std::size_t>(raster.width) * 4);
  }
  cairo_surface_mark_dirty(surface);
}

}  // namespace

Result<void> write_picture(const SheetStack& sheets, std::span<const Way> ways, const std::string& path,
                           const PictureOptions& options) {
  const GridFrame& frame = sheets.grid.frame;
  const int longest = std::max({frame.width, frame.height, 1});
  const Raster raster = charts::paint(sheets, std::clamp(options.longest_side / longest, 1, 8));
  const int width = std::max(raster.width, kSmallestWidth);
  const View view{frame, raster.scale, static_cast<double>((width - raster.width) / 2)};
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, width, raster.height + kLegendHeight),
                        cairo_surface_destroy);
  if (cairo_surface_status(surface.get()) != CAIRO_STATUS_SUCCESS) {
    return fail("{}: a picture of {} x {} pixels is too large; draw with coarser cells", path, width, raster.height);
  }
  const Context context(cairo_create(surface.get()), cairo_destroy);
  cairo_t* cr = context.get();
  set_colour(cr, charts::kUnknown);
  cairo_paint(cr);
  copy_raster(raster, surface.get(), static_cast<int>(view.left));
  cairo_set_line_join(cr, CAIRO_LINE_JOIN_ROUND);
  for (const Way& way : ways) draw_way(cr, view, way);
  draw_legend(cr, view, sheets, ways, options.title, width, raster.height);
  Result<std::string> bytes = encode_png(surface.get());
  if (!bytes) return fail("{}: {}", path, bytes.error().message);
  return charts::write_whole_file(path, *bytes);
}

}  // namespace helicoid
