#include "helicoid/simulation/starts.hpp"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <iterator>
#include <limits>
#include <optional>
#include <sstream>

#include "helicoid/base/random.hpp"
#include "helicoid/simulation/drivable_grid.hpp"
#include "helicoid/simulation/reachable_floor.hpp"

namespace helicoid {

namespace {

constexpr float kFar = std::numeric_limits<float>::infinity();

/// Cells in the order of their ways from one of them, with the ways' lengths.
struct Ways {
  std::vector<std::size_t> cells;
  std::vector<float> length;  ///< by cell of the raster; infinity where no way leads, metres
};

/// All cells that hang together with one, in the order of their ways from it; their ways' lengths are put down.
std::vector<std::size_t> spread(const ReachableFloor& floor, std::size_t from, std::vector<float>& length) {
  std::vector<std::size_t> cells{from};
  length[from] = 0;
  const auto width = static_cast<std::size_t>(floor.width);
  for (std::size_t k = 0; k < cells.size(); ++k) {
    const std::size_t cell = cells[k];
    for (const std::size_t next : {cell - 1, cell + 1, cell - width, cell + width}) {
      if (next >= floor.room.size() || floor.room[next] <= 0 || length[next] < kFar) continue;
      length[next] = length[cell] + static_cast<float>(floor.cell);
      cells.push_back(next);
    }
  }
  return cells;
}

Ways ways_from(const ReachableFloor& floor, std::size_t from) {
  Ways ways{{}, std::vector<float>(floor.room.size(), kFar)};
  ways.cells = spread(floor, from, ways.length);
  return ways;
}

/// The floor that starts are looked for on. A world without starts is entered in its largest closed space.
Result<ReachableFloor> find_floor(const World& world, double radius) {
  FloorOptions options;
  options.radius = radius;
  if (!world.starts.empty()) return find_reachable_floor(world, world.starts, options);
  const Result<DrivableGrid> grid = make_drivable_grid(world, 2 * options.cell, radius, 1.0, options.most_cells / 4);
  if (!grid) return tl::unexpected(grid.error());
  const auto roomiest = std::max_element(grid->clearance.begin(), grid->clearance.end());
  if (roomiest == grid->clearance.end() || *roomiest <= 0) {
    return fail("{}: has no closed space in which a robot could begin; give it a start", world.name);
  }
  const Vector2d at = grid->centre(static_cast<std::size_t>(roomiest - grid->clearance.begin()));
  return find_reachable_floor(world, std::vector<Pose2>{{at.x(), at.y(), 0}}, options);
}

/// The largest part of the floor that hangs together without squeezing by a wall; the rest is no floor. The rays that
/// an occupancy image shows free between obstacles are just wide enough here and there: who begins in one stays there,
/// and so does who begins in a room with a speck in its door.
ReachableFloor without_squeezes(ReachableFloor floor, double radius) {
  constexpr float kEase = 1.25F;  // of the radius: a passage of half a metre for a robot of 0.4 m
  for (float& room : floor.room) room = room < kEase * static_cast<float>(radius) ? 0 : room;
  std::vector<float> length(floor.room.size(), kFar);
  std::vector<std::size_t> largest;
  for (std::size_t i = 0; i < floor.room.size(); ++i) {
    if (floor.room[i] <= 0 || length[i] < kFar) continue;
    std::vector<std::size_t> part = spread(floor, i, length);
    if (part.size() > largest.size()) largest = std::move(part);
  }
  std::vector<float> room(floor.room.size(), 0);
  for (const std::size_t cell : largest) room[cell] = floor.room[cell];
  floor.room = std::move(room);
  return floor;
}

/// Cells as far from walls as is comfortable; where there are none, nearer to them.
std::vector<std::size_t> roomy_cells(const ReachableFloor& floor, const StartOptions& options) {
  for (const double room : {options.comfortable, 0.5 * (options.comfortable + options.radius), options.radius}) {
    std::vector<std::size_t> cells;
    for (std::size_t i = 0; i < floor.room.size(); ++i) {
      if (floor.room[i] > 0 && static_cast<double>(floor.room[i]) >= room) cells.push_back(i);
    }
    if (!cells.empty()) return cells;
  }
  return {};
}

/// Where groups begin: the first anywhere, each other one far from those before it.
std::vector<std::size_t> choose_anchors(const ReachableFloor& floor, std::size_t groups, const StartOptions& options,
                                        Random& random) {
  std::vector<std::size_t> candidates = roomy_cells(floor, options);
  std::vector<std::size_t> anchors;
  if (candidates.empty()) return anchors;
  std::vector<float> gap(floor.room.size(), kFar);
  while (true) {
    anchors.push_back(candidates[random.below(candidates.size())]);
    if (anchors.size() == groups) return anchors;
    const Ways ways = ways_from(floor, anchors.back());
    float widest = 0;
    for (const std::size_t cell : ways.cells) {
      gap[cell] = std::min(gap[cell], ways.length[cell]);
      widest = std::max(widest, gap[cell]);
    }
    const auto far = static_cast<float>(options.farthest_share) * widest;
    std::vector<std::size_t> next;
    for (const std::size_t cell : candidates) {
      if (gap[cell] < kFar && gap[cell] >= far) next.push_back(cell);
    }
    // Where all that is far is narrow, the groups begin nearer to one another.
    if (!next.empty()) candidates = std::move(next);
  }
}

/// The next place of a group: nearest to its first, in sight of it and apart from all that are taken.
std::optional<std::size_t> next_place(const ReachableFloor& floor, const RayCaster& walls, const Ways& ways,
                                      const std::vector<Vector2d>& taken, double spacing, double room) {
  const Vector2d anchor = floor.centre(ways.cells.front());
  for (const std::size_t cell : ways.cells) {
    if (static_cast<double>(floor.room[cell]) < room) continue;
    const Vector2d at = floor.centre(cell);
    const auto is_near = [&](const Vector2d& other) { return (other - at).norm() < spacing; };
    if (std::any_of(taken.begin(), taken.end(), is_near)) continue;
    const Vector2d way = at - anchor;
    if (walls.cast(anchor, way.normalized(), way.norm()).segment < 0) return cell;
  }
  return std::nullopt;
}

Result<double> number_of(const std::string& word, const std::string& name, int line) {
  char* end = nullptr;
  const double value = std::strtod(word.c_str(), &end);
  if (end == word.c_str() || *end != '\0' || !std::isfinite(value)) {
    return fail("{}:{}: '{}' is no number; a start is `x y yaw_deg`", name, line, word);
  }
  return value;
}

/// As many as there is room for.
std::vector<Pose2> place_on(const ReachableFloor& floor, const World& world, const StartOptions& options) {
  Random random(options.seed);
  const std::size_t groups = options.robots >= 2 * options.group ? 2 : 1;
  const RayCaster walls(world.walls);
  std::vector<Vector2d> taken;
  std::vector<Pose2> starts;
  const std::vector<std::size_t> anchors = choose_anchors(floor, groups, options, random);
  for (std::size_t g = 0; g < anchors.size(); ++g) {
    const Ways ways = ways_from(floor, anchors[g]);
    // The last group takes what is left of an odd number.
    const std::size_t until = g + 1 == groups ? options.robots : options.robots / groups;
    double spacing = options.spacing;
    double room = std::min(options.comfortable, static_cast<double>(floor.room[anchors[g]]));
    while (starts.size() < until && spacing > 2.5 * options.radius) {
      const std::optional<std::size_t> cell = next_place(floor, walls, ways, taken, spacing, room);
      if (!cell) {
        spacing *= 0.8;
        room = std::max(options.radius, 0.8 * room);
        continue;
      }
      taken.push_back(floor.centre(*cell));
      starts.push_back({taken.back().x(), taken.back().y(), random.uniform(-std::numbers::pi, std::numbers::pi)});
    }
  }
  return starts;
}

}  // namespace

Result<std::vector<Pose2>> place_starts(const World& world, const StartOptions& options) {
  if (options.robots == 0) return fail("a team needs at least one robot");
  const Result<ReachableFloor> floor = find_floor(world, options.radius);
  if (!floor) return tl::unexpected(floor.error());
  std::vector<Pose2> starts = place_on(without_squeezes(*floor, options.radius), world, options);
  if (starts.size() < options.robots) starts = place_on(*floor, world, options);
  if (starts.size() == options.robots) return starts;
  return fail("{}: has no room for {} robots to begin: {} fit on {:.1f} m^2 of floor", world.name, options.robots,
              starts.size(), floor->area());
}

Result<std::vector<Pose2>> parse_starts(const std::string& text, const std::string& name) {
  std::vector<Pose2> starts;
  std::istringstream lines(text);
  std::string line;
  for (int number = 1; std::getline(lines, line); ++number) {
    std::istringstream words(line.substr(0, line.find('#')));
    std::vector<double> values;
    for (std::string word; words >> word;) {
      const Result<double> value = number_of(word, name, number);
      if (!value) return tl::unexpected(value.error());
      values.push_back(*value);
    }
    if (values.empty()) continue;
    if (values.size() != 3) return fail("{}:{}: a start is `x y yaw_deg`, not {} numbers", name, number, values.size());
    starts.push_back({values[0], values[1], wrap_angle(radians(values[2]))});
  }
  if (starts.empty()) return fail("{}: names no start; a line is `x y yaw_deg`", name);
  return starts;
}

Result<std::vector<Pose2>> choose_starts(const World& world, const std::string& choice, const StartOptions& options) {
  if (choice.empty() && world.starts.size() >= options.robots) {
    return std::vector<Pose2>(world.starts.begin(), world.starts.begin() + static_cast<std::ptrdiff_t>(options.robots));
  }
  if (choice.empty() || choice == "auto") return place_starts(world, options);
  std::ifstream file(choice, std::ios::binary);
  if (!file) return fail("{}: cannot be read; --starts takes `auto` or a file of `x y yaw_deg` lines", choice);
  Result<std::vector<Pose2>> starts = parse_starts({std::istreambuf_iterator<char>(file), {}}, choice);
  if (!starts) return starts;
  if (starts->size() < options.robots) {
    return fail("{}: names {} starts for {} robots", choice, starts->size(), options.robots);
  }
  starts->resize(options.robots);
  return starts;
}

}  // namespace helicoid
