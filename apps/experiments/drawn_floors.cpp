#include "apps/experiments/drawn_floors.hpp"

#include <fmt/format.h>

#include <cmath>

namespace helicoid {

namespace {

constexpr double kPixel = 0.05;  // metres
constexpr char kSolid = 0;
constexpr char kFree = static_cast<char>(254);

/// An image that is all wall at first.
class FloorImage {
 public:
  FloorImage(double width, double height)
      : columns_(pixel(width)), rows_(pixel(height)), grey_(static_cast<std::size_t>(columns_ * rows_), kSolid) {}

  /// From the lower left corner, metres.
  void clear(double x0, double y0, double x1, double y1) { paint(x0, y0, x1, y1, kFree); }
  void block(double x0, double y0, double x1, double y1) { paint(x0, y0, x1, y1, kSolid); }

  [[nodiscard]] Result<World> world(const std::string& name) const {
    const std::string yaml = fmt::format(
        "image: {}.pgm\nresolution: {}\norigin: [0, 0, 0]\nnegate: 0\noccupied_thresh: 0.65\nfree_thresh: 0.196\n",
        name, kPixel);
    return parse_image_world(yaml, fmt::format("P5\n{} {}\n255\n", columns_, rows_) + grey_, name);
  }

 private:
  static int pixel(double metres) { return static_cast<int>(std::lround(metres / kPixel)); }
  void paint(double x0, double y0, double x1, double y1, char grey) {
    for (int y = pixel(y0); y < pixel(y1); ++y) {
      const auto row = static_cast<std::size_t>(rows_ - 1 - y) * static_cast<std::size_t>(columns_);  // from the top
      for (int x = pixel(x0); x < pixel(x1); ++x) grey_[row + static_cast<std::size_t>(x)] = grey;
    }
  }

  int columns_, rows_;
  std::string grey_;
};

}  // namespace

Result<World> drawn_school() {
  FloorImage image(40, 24);
  image.clear(1, 11, 39, 13.2);  // the corridor
  image.clear(24, 1, 26.2, 23);  // and one across it
  const double rooms[] = {1, 7.4, 13.6, 26.4, 32.6};
  for (const double x : rooms) {
    const double width = x > 30 ? 6.4 : 6.0;
    image.clear(x, 13.4, x + width, 22.5);
    image.clear(x + 1.2, 13.1, x + 2.2, 13.5);
    image.block(x + 3, 17, x + 5, 18.2);
    image.clear(x, 2, x + width, 10.8);
    image.clear(x + 3.6, 10.7, x + 4.6, 11.1);
    image.block(x + 0.8, 5, x + 2.2, 6.4);
  }
  return image.world("school");
}

Result<World> drawn_store() {
  FloorImage image(36, 22);
  image.clear(1, 1, 35, 21);
  for (double x = 4; x < 30; x += 3.4) {
    image.block(x, 3.4, x + 1.2, 9.6);
    image.block(x, 12, x + 1.2, 18.4);
  }
  image.block(30.5, 1, 30.7, 15);  // the storeroom's wall, open at its end
  return image.world("store");
}

}  // namespace helicoid
