#include <png.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "helicoid/simulation/world.hpp"

namespace helicoid {

namespace {

/// Grey values, row 0 at the top.
struct GreyImage {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> pixels;
};

constexpr int kLargestSide = 20000;

Result<GreyImage> read_pgm(const std::string& bytes, const std::string& path) {
  std::istringstream stream(bytes);
  std::string magic;
  stream >> magic;
  int values[3] = {};
  for (int& value : values) {
    stream >> std::ws;
    while (stream.peek() == '#') {
      std::string comment;
      std::getline(stream, comment);
      stream >> std::ws;
    }
    if (!(stream >> value)) return fail("{}: is no PGM: its header is cut off", path);
  }
  stream.get();
  GreyImage image{values[0], values[1], {}};
  if (magic != "P5" || image.width < 1 || image.height < 1 || image.width > kLargestSide ||
      image.height > kLargestSide || values[2] != 255) {
    return fail("{}: must be a binary PGM (P5) with 255 grey levels and sides up to {} pixels", path, kLargestSide);
  }
  const auto begin = static_cast<std::size_t>(std::max<std::streamoff>(0, stream.tellg()));
  const auto count = static_cast<std::size_t>(image.width) * image.height;
  if (begin + count > bytes.size()) return fail("{}: is cut off", path);
  image.pixels.assign(bytes.begin() + static_cast<std::ptrdiff_t>(begin),
                      bytes.begin() + static_cast<std::ptrdiff_t>(begin + count));
  return image;
}

Result<GreyImage> read_png(const std::string& bytes, const std::string& path) {
  png_image png{};
  png.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&png, bytes.data(), bytes.size()) == 0) return fail("{}: {}", path, png.message);
  png.format = PNG_FORMAT_GRAY;
  GreyImage image{static_cast<int>(png.width), static_cast<int>(png.height), {}};
  const auto count = static_cast<std::size_t>(png.width) * png.height;
  // Deflate cannot do better than about 1 : 1032, nor a pixel with less than a bit: what claims more is damaged.
  if (png.width > kLargestSide || png.height > kLargestSide || count / 9000 > bytes.size()) {
    png_image_free(&png);
    return fail("{}: is damaged, or larger than {} pixels a side", path, kLargestSide);
  }
  image.pixels.resize(count);
  const png_color white{255, 255, 255};
  if (png_image_finish_read(&png, &white, image.pixels.data(), 0, nullptr) == 0)
    return fail("{}: {}", path, png.message);
  return image;
}

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

/// The `key: value` lines of a MAP.yaml.
std::map<std::string, std::string> read_keys(const std::string& text) {
  std::map<std::string, std::string> keys;
  std::istringstream stream(text);
  std::string line;
  while (std::getline(stream, line)) {
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line[0] == '#') continue;
    std::string value = line.substr(colon + 1);
    value.erase(0, value.find_first_not_of(" \t\""));
    value.erase(value.find_last_not_of(" \t\r\"") + 1);
    keys[line.substr(0, colon)] = value;
  }
  return keys;
}

double number_or(const std::map<std::string, std::string>& keys, const std::string& key, double otherwise) {
  return keys.contains(key) ? std::atof(keys.at(key).c_str()) : otherwise;
}

/// 1 where the image shows free floor; row 0 at the bottom.
std::vector<std::uint8_t> free_cells(const GreyImage& image, double free_below, bool negate) {
  std::vector<std::uint8_t> free(image.pixels.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const double grey = image.pixels[static_cast<std::size_t>(row) * image.width + column] / 255.0;
      const double occupied = negate ? grey : 1 - grey;
      free[static_cast<std::size_t>(image.height - 1 - row) * image.width + column] = occupied < free_below ? 1 : 0;
    }
  }
  return free;
}

/// Borders between free and solid cells, collinear neighbours as one segment. `across`: rows (horizontal borders) or
/// columns.
void add_borders(const std::vector<std::uint8_t>& free, int width, int height, bool horizontal, double resolution,
                 const Vector2d& origin, std::vector<Segment>& walls) {
  const int lines = horizontal ? height : width;
  const int length = horizontal ? width : height;
  const auto is_free = [&](int line, int at) {
    if (line < 0 || line >= lines) return false;
    const int row = horizontal ? line : at;
    const int column = horizontal ? at : line;
    return free[static_cast<std::size_t>(row) * width + column] != 0;
  };
  for (int line = 0; line <= lines; ++line) {
    for (int at = 0; at < length; ++at) {
      if (is_free(line - 1, at) == is_free(line, at)) continue;
      int end = at + 1;
      while (end < length && is_free(line - 1, end) != is_free(line, end)) ++end;
      const Vector2d a = horizontal ? Vector2d(at, line) : Vector2d(line, at);
      const Vector2d b = horizontal ? Vector2d(end, line) : Vector2d(line, end);
      walls.push_back({origin + resolution * a, origin + resolution * b});
      at = end;
    }
  }
}

/// The free cell that is farthest from all others (by city blocks): inside the building, in the open.
int most_open_cell(const std::vector<std::uint8_t>& free, int width, int height) {
  std::vector<int> depth(free.size());
  const auto at = [&](int column, int row) {
    const bool inside = column >= 0 && row >= 0 && column < width && row < height;
    return inside ? depth[static_cast<std::size_t>(row) * width + column] : 0;
  };
  const int count = width * height;
  for (int i = 0; i < count; ++i) {
    if (free[i] != 0) depth[i] = 1 + std::min(at(i % width - 1, i / width), at(i % width, i / width - 1));
  }
  for (int i = count - 1; i >= 0; --i) {
    if (free[i] != 0)
      depth[i] = std::min(depth[i], 1 + std::min(at(i % width + 1, i / width), at(i % width, i / width + 1)));
  }
  return static_cast<int>(std::max_element(depth.begin(), depth.end()) - depth.begin());
}

}  // namespace

Result<World> parse_image_world(const std::string& yaml, const std::string& image_bytes, const std::string& name) {
  const auto keys = read_keys(yaml);
  const double resolution = number_or(keys, "resolution", 0);
  if (!(resolution > 0)) return fail("{}: needs the key `resolution`, metres a pixel", name);
  const bool png = image_bytes.size() > 4 && std::memcmp(image_bytes.data() + 1, "PNG", 3) == 0;
  const Result<GreyImage> image = png ? read_png(image_bytes, name) : read_pgm(image_bytes, name);
  if (!image) return tl::unexpected(image.error());
  double origin[3] = {};
  if (keys.contains("origin") &&
      std::sscanf(keys.at("origin").c_str(), "[%lf , %lf , %lf", &origin[0], &origin[1], &origin[2]) < 2) {
    return fail("{}: its origin must be [x, y, yaw]", name);
  }
  const std::vector<std::uint8_t> free =
      free_cells(*image, number_or(keys, "free_thresh", 0.196), number_or(keys, "negate", 0) != 0);
  World world;
  world.name = name;
  const Vector2d lower_left(origin[0], origin[1]);
  add_borders(free, image->width, image->height, true, resolution, lower_left, world.walls);
  add_borders(free, image->width, image->height, false, resolution, lower_left, world.walls);
  if (world.walls.empty()) return fail("{}: the image holds no free cell beside a solid one", name);
  if (const Result<void> checked = check_size(world); !checked) return tl::unexpected(checked.error());
  const int open = most_open_cell(free, image->width, image->height);
  const int column = open % image->width;
  const int row = open / image->width;
  const Vector2d start = lower_left + resolution * Vector2d(column + 0.5, row + 0.5);
  world.starts.push_back({start.x(), start.y(), 0});
  return world;
}

Result<World> read_image_world(const std::string& yaml_path) {
  const std::string yaml = read_bytes(yaml_path);
  const auto keys = read_keys(yaml);
  if (!keys.contains("image") || keys.at("image").empty()) {
    return fail("{}: needs the keys `image` and `resolution`, as ROS map_server writes them", yaml_path);
  }
  const std::string& image = keys.at("image");
  const std::string image_path = image[0] == '/' ? image : yaml_path.substr(0, yaml_path.find_last_of('/') + 1) + image;
  const std::string bytes = read_bytes(image_path);
  if (bytes.empty()) return fail("{}: the image {} cannot be read", yaml_path, image_path);
  return parse_image_world(yaml, bytes, yaml_path);
}

}  // namespace helicoid
