#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <map>
#include <sstream>

#include "helicoid/simulation/grey_image.hpp"
#include "helicoid/simulation/world.hpp"

namespace helicoid {

namespace {

std::string read_bytes(const std::string& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::string trimmed(const std::string& text) {
  constexpr const char* kAround = " \t\r\"'";
  const std::size_t begin = text.find_first_not_of(kAround);
  if (begin == std::string::npos) return {};
  return text.substr(begin, text.find_last_not_of(kAround) + 1 - begin);
}

/// The `key: value` lines of a MAP.yaml; a list that stands below its key, a line an item, becomes `[a, b, ...]`.
std::map<std::string, std::string> read_keys(const std::string& text) {
  std::map<std::string, std::string> keys;
  std::istringstream stream(text);
  std::string line;
  std::string last;
  while (std::getline(stream, line)) {
    line = trimmed(line.substr(0, line.find(" #")));
    if (line.starts_with("- ") && !last.empty()) {
      std::string& list = keys[last];
      list = (list.empty() ? "[" : list.substr(0, list.size() - 1) + ", ") + trimmed(line.substr(2)) + "]";
      continue;
    }
    const std::size_t colon = line.find(':');
    if (colon == std::string::npos || line[0] == '#') continue;
    last = trimmed(line.substr(0, colon));
    keys[last] = trimmed(line.substr(colon + 1));
  }
  return keys;
}

double number_or(const std::map<std::string, std::string>& keys, const std::string& key, double otherwise) {
  return keys.contains(key) ? std::atof(keys.at(key).c_str()) : otherwise;
}

/// 1 where the image shows free floor; row 0 at the bottom. What map_server writes for unknown is solid even where
/// free_thresh says that it is not (programs disagree about its default).
std::vector<std::uint8_t> free_cells(const GreyImage& image, double free_below, bool negate) {
  std::vector<std::uint8_t> free(image.pixels.size());
  for (int row = 0; row < image.height; ++row) {
    for (int column = 0; column < image.width; ++column) {
      const std::uint8_t grey = image.pixels[static_cast<std::size_t>(row) * image.width + column];
      const double occupied = negate ? grey / 255.0 : 1 - grey / 255.0;
      const bool is_free = occupied < free_below && grey != kUnknownGrey;
      free[static_cast<std::size_t>(image.height - 1 - row) * image.width + column] = is_free ? 1 : 0;
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

/// By free cell, how far it is from all others (by city blocks), in cells.
std::vector<int> measure_depth(const std::vector<std::uint8_t>& free, int width, int height) {
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
  return depth;
}

/// The cells at least so deep that hang together with this one.
std::vector<int> flood(const std::vector<int>& depth, int width, int height, int from, int at_least,
                       std::vector<std::uint8_t>& seen) {
  std::vector<int> cells{from};
  seen[from] = 1;
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const int column = cells[k] % width;
    const int row = cells[k] / width;
    const std::pair<bool, int> sides[] = {{column > 0, cells[k] - 1},
                                          {column + 1 < width, cells[k] + 1},
                                          {row > 0, cells[k] - width},
                                          {row + 1 < height, cells[k] + width}};
    for (const auto& [inside, next] : sides) {
      if (!inside || seen[next] != 0 || depth[next] < at_least) continue;
      seen[next] = 1;
      cells.push_back(next);
    }
  }
  return cells;
}

/// The deepest cell of the largest space that a robot can get about in: inside the building, in the open.
int roomiest_cell(const std::vector<std::uint8_t>& free, int width, int height, double resolution) {
  constexpr double kDoor = 0.6;  // a narrower one does not make one space of two, metres
  const std::vector<int> depth = measure_depth(free, width, height);
  const int deepest = *std::max_element(depth.begin(), depth.end());
  const int passable = std::clamp(static_cast<int>(std::ceil(0.5 * kDoor / resolution)), 1, deepest);
  std::vector<std::uint8_t> seen(depth.size(), 0);
  std::vector<int> largest;
  for (int i = 0; i < width * height; ++i) {
    if (seen[i] != 0 || depth[i] < passable) continue;
    std::vector<int> space = flood(depth, width, height, i, passable, seen);
    if (space.size() > largest.size()) largest = std::move(space);
  }
  return *std::max_element(largest.begin(), largest.end(),
                           [&](int a, int b) { return std::pair(depth[a], -a) < std::pair(depth[b], -b); });
}

}  // namespace

Result<World> parse_image_world(const std::string& yaml, const std::string& image_bytes, const std::string& name) {
  const auto keys = read_keys(yaml);
  const double resolution = number_or(keys, "resolution", 0);
  if (!(resolution > 0)) return fail("{}: needs the key `resolution`, metres a pixel", name);
  const Result<GreyImage> image = read_grey_image(image_bytes, name);
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
  const int open = roomiest_cell(free, image->width, image->height, resolution);
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
