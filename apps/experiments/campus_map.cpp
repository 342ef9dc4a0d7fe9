#include "apps/experiments/campus_map.hpp"

#include <cmath>

#include "helicoid/base/random.hpp"
#include "helicoid/io/laser_file.hpp"
#include "helicoid/mapping/lay_out.hpp"

namespace helicoid {

namespace {

constexpr double kApart = 120;        ///< buildings on their lattice, metres
constexpr std::size_t kAbreast = 20;  ///< buildings in a row
constexpr double kBesideLattice = 400;
constexpr const char* kRobot = "robot";

std::string name_of(const char* kind, std::size_t i) {
  return fmt::format("{}{}", kind, i + 1);
}

void add_rectangle(World& world, double x0, double y0, double x1, double y1) {
  const Vector2d corners[] = {{x0, y0}, {x1, y0}, {x1, y1}, {x0, y1}};
  for (std::size_t i = 0; i < 4; ++i) world.walls.push_back({corners[i], corners[(i + 1) % 4]});
}

/// Pilasters at uneven distances, so that no stretch of the corridor looks like another.
void add_pilasters(World& world, Random& random, double x0, double y0, double x1, double y1, double depth) {
  for (const double y : {y0, y1}) {
    for (double x = x0 + random.uniform(1, 4); x < x1 - 1; x += random.uniform(2.5, 6)) {
      add_rectangle(world, x, y, x + random.uniform(0.3, 0.8), y == y0 ? y + depth : y - depth);
    }
  }
  for (const double x : {x0, x1}) {
    for (double y = y0 + random.uniform(1, 4); y < y1 - 1; y += random.uniform(2.5, 6)) {
      add_rectangle(world, x, y, x == x0 ? x + depth : x - depth, y + random.uniform(0.3, 0.8));
    }
  }
}

/// A corridor that leads back to where it began, 2.2 m wide.
World ring_world(double perimeter, std::uint64_t seed) {
  constexpr double kHalf = 1.1;
  constexpr double kCorner = 0.7;
  constexpr double kDepth = 0.3;
  const double width = 0.3 * perimeter;
  const double height = 0.2 * perimeter;
  World world;
  world.name = "ring";
  Random random(seed);
  add_rectangle(world, -kHalf, -kHalf, width + kHalf, height + kHalf);
  add_rectangle(world, kHalf, kHalf, width - kHalf, height - kHalf);
  add_pilasters(world, random, -kHalf, -kHalf, width + kHalf, height + kHalf, kDepth);
  add_pilasters(world, random, kHalf, kHalf, width - kHalf, height - kHalf, -kDepth);
  const double x = 0.3 * width;
  world.starts.push_back({x, 0, 0});
  world.routes.push_back({{{x, 0},
                           {width - kCorner, 0},
                           {width, kCorner},
                           {width, height - kCorner},
                           {width - kCorner, height},
                           {kCorner, height},
                           {0, height - kCorner},
                           {0, kCorner},
                           {kCorner, 0}},
                          true});
  return world;
}

Result<MappedBuilding> map_first_lap(const World& world, std::uint64_t seed, bool closures) {
  SimulationOptions options;
  options.seed = seed;
  options.laps = 2;
  Result<Simulator> simulator = Simulator::make(world, options);
  if (!simulator) return tl::unexpected(simulator.error());
  const Result<LaserModel> laser = load_laser("sick-lms200", simulator->laser());
  if (!laser) return tl::unexpected(laser.error());
  MapperOptions mapping;
  mapping.closures = closures;
  Mapper mapper(mapping);
  mapper.add_robot(kRobot, {*laser});
  while (std::optional<SimulatedEvent> event = simulator->next()) {
    if (event->lap > 0) {
      mapper.finish();
      return MappedBuilding{std::move(*simulator), std::move(*event), mapper.map()};
    }
    mapper.process(event->event);
  }
  return fail("a lap of {} does not end", world.name);
}

}  // namespace

Result<Campus> map_campus(const CampusSize& size) {
  Campus campus;
  const Result<World> office = load_world("office");
  if (!office) return tl::unexpected(office.error());
  for (std::size_t i = 0; i < size.buildings; ++i) {
    Result<MappedBuilding> building = map_first_lap(*office, 1 + i, true);
    if (!building) return tl::unexpected(building.error());
    campus.buildings.push_back(std::move(*building));
  }
  for (std::size_t i = 0; i < size.rings.size(); ++i) {
    Result<MappedBuilding> ring = map_first_lap(ring_world(size.rings[i], 1 + i), 1 + i, false);
    if (!ring) return tl::unexpected(ring.error());
    campus.rings.push_back(std::move(*ring));
  }
  return campus;
}

Map build_campus(const Campus& campus, std::size_t patches) {
  std::vector<PlacedMap> placed;
  std::vector<Passage> passages;
  const Matrix3d known = Vector3d(1e4, 1e4, 1e4).asDiagonal();
  std::size_t count = 0;
  double below = -kBesideLattice;
  for (std::size_t i = 0; i < campus.rings.size(); ++i) {
    placed.push_back({&campus.rings[i].map, name_of("ring", i), {0, below, 0}});
    if (i > 0) passages.push_back({i - 1, i, PatchId{0}, PatchId{0}, known});
    count += campus.rings[i].map.patch_count();
    below -= kBesideLattice;
  }
  const std::size_t first = placed.size();
  for (std::size_t i = 0; count < patches || i < campus.buildings.size(); ++i) {
    const std::size_t of = i % campus.buildings.size();
    const Pose2 at{kApart * static_cast<double>(i % kAbreast), kApart * static_cast<double>(i / kAbreast), 0};
    placed.push_back({&campus.buildings[of].map, name_of("building", of), at});
    const std::size_t self = placed.size() - 1;
    if (self > 0) passages.push_back({self - 1, self, PatchId{0}, PatchId{0}, known});
    if (self >= first + kAbreast) passages.push_back({self - kAbreast, self, PatchId{0}, PatchId{0}, known});
    count += campus.buildings[of].map.patch_count();
  }
  return lay_out(placed, passages);
}

std::string ring_robot(std::size_t i) {
  return name_of("ring", i) + "-" + kRobot;
}
std::string building_robot(std::size_t i) {
  return name_of("building", i) + "-" + kRobot;
}

}  // namespace helicoid
