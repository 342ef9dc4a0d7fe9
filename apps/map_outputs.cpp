#include "apps/map_outputs.hpp"

#include <algorithm>
#include <filesystem>

#include "apps/ledger_json.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/charts/picture.hpp"
#include "helicoid/charts/ros_map.hpp"
#include "helicoid/charts/sketch_svg.hpp"
#include "helicoid/charts/topology.hpp"
#include "helicoid/io/graph_file.hpp"
#include "helicoid/io/trajectory.hpp"
#include "helicoid/manifold/coverage_sweep.hpp"
#include "helicoid/navigation/driven_neighbours.hpp"
#include "helicoid/store/map_file.hpp"

namespace helicoid {

namespace fs = std::filesystem;

namespace {

double covered_area(const Map& map, const Island& island) {
  constexpr double kCell = 0.10;
  double cells = 0;
  sweep_coverage(covered_cells(map, island.patches, kCell), 1,
                 [&](const CoveredRun& run) { cells += run.last - run.first + 1; });
  return cells * kCell * kCell;
}

/// The robots whose scans stand on an island, alphabetically.
std::vector<std::string> robots_of(const Map& map, const Island& island) {
  std::vector<std::string> robots;
  for (const RobotRecord& robot : map.robots()) {
    if (!robot.trajectory.empty() && map.island_of(robot.trajectory.front().pose.patch) == island.id) {
      robots.push_back(robot.name);
    }
  }
  std::sort(robots.begin(), robots.end());
  return robots;
}

Result<void> write_trajectories(const Map& map, const std::string& folder, bool online_only) {
  std::error_code error;
  fs::create_directories(fs::path(folder) / "trajectories" / "online", error);
  for (const RobotRecord& robot : map.robots()) {
    if (robot.trajectory.empty()) continue;
    std::vector<StampedPose> final_poses;
    std::vector<StampedPose> online;
    for (const TrackedScan& scan : robot.trajectory) {
      final_poses.push_back({scan.stamp, map.project(scan.pose)});
      online.push_back({scan.stamp, scan.T_island_robot_online()});
    }
    const std::string base = folder + "/trajectories/";
    if (auto done = write_whole_file(base + robot.name + ".tum", to_tum(online_only ? online : final_poses)); !done)
      return done;
    if (auto done = write_whole_file(base + "online/" + robot.name + ".tum", to_tum(online)); !done) return done;
  }
  return {};
}

struct Pictures {
  std::vector<std::string> paths;
  Result<void> status;
  void add(const std::string& path, const Result<void>& written) {
    if (status && !written) status = written;
    if (written) paths.push_back(path);
  }
};

/// One picture a sheet, each in a frame of its own.
void write_sheets(const Map& map, const IslandReport& report, const std::string& folder, int threads,
                  Pictures& pictures) {
  std::error_code error;
  fs::create_directories(folder + "/sheets", error);
  const int drawn = 1 + *std::max_element(report.sheets.sheet_of.begin(), report.sheets.sheet_of.end());
  for (int sheet = 0; sheet < drawn; ++sheet) {
    std::vector<PatchId> patches;
    for (const PatchId id : report.island.patches) {
      if (report.sheets.sheet_of[id.index()] == sheet) patches.push_back(id);
    }
    const std::vector<OccupancyGrid> grid{draw_occupancy(map, patches, frame_around(map, patches), threads)};
    const std::string path = fmt::format("{}/sheets/{}.png", folder, sheet);
    PictureOptions options;
    options.longest_side = 700;
    options.sheets = 1;
    options.title = fmt::format("sheet {}", sheet);
    pictures.add(path, write_picture(stack(grid), ways_over(map, patches), path, options));
  }
}

SketchDrawing sketch_of(const Map& map, const MapReport& report, const IslandReport& island,
                        const SheetStack& stacked) {
  SketchDrawing drawing;
  drawing.layers.push_back({"free space", make_sketch(stacked.grid)});
  drawing.ways = ways_over(map, island.island.patches);
  drawing.topology = make_topology(map, island.island.patches, report.driven_neighbours, island.sheets);
  return drawing;
}

void write_island(const Map& map, const MapReport& report, const IslandReport& island, const std::string& folder,
                  int threads, Pictures& pictures) {
  std::error_code error;
  fs::create_directories(folder, error);
  const GridFrame frame = frame_around(map, island.island.patches);
  const SheetStack stacked = draw_stack(map, island.island.patches, island.sheets, frame, threads);
  const SketchDrawing sketch = sketch_of(map, report, island, stacked);
  PictureOptions options;
  options.sheets = island.sheets.count;
  options.title = fmt::format("{}", fmt::join(island.robots, ", "));
  pictures.add(folder + "/map.png", write_picture(stacked, sketch.ways, folder + "/map.png", options));
  pictures.add(folder + "/map.pgm", write_ros_map(stacked.grid, folder + "/map"));
  pictures.add(folder + "/sketch.svg", write_sketch(sketch, folder + "/sketch.svg"));
  pictures.add(folder + "/topology.geojson", write_topology(*sketch.topology, folder + "/topology.geojson"));
  if (island.sheets.count > 1) write_sheets(map, island, folder, threads, pictures);
}

}  // namespace

SketchDrawing draw_sketch(const Map& map, const MapReport& report, const IslandReport& island, int threads) {
  const GridFrame frame = frame_around(map, island.island.patches);
  return sketch_of(map, report, island, draw_stack(map, island.island.patches, island.sheets, frame, threads));
}

MapReport report_on(const Map& map, bool drawn) {
  MapReport report{find_neighbours(map), {}, {}};
  if (drawn) report.driven_neighbours = DrivenNeighbours().add_to(map, report.neighbours);
  for (Island& island : map.islands()) {
    IslandReport entry{std::move(island), {}, {}, 0};
    entry.sheets = drawn ? find_sheets(map, report.neighbours, entry.island)
                         : Sheets{count_sheets(map, report.neighbours, entry.island), {}};
    entry.area_m2 = covered_area(map, entry.island);
    entry.robots = robots_of(map, entry.island);
    report.islands.push_back(std::move(entry));
  }
  std::stable_sort(report.islands.begin(), report.islands.end(), [](const IslandReport& a, const IslandReport& b) {
    return a.island.patches.size() > b.island.patches.size();
  });
  return report;
}

Result<void> write_records(const MapRun& run, const std::string& folder, bool online_only) {
  const Map& map = run.mapper.map();
  if (auto done = write_trajectories(map, folder, online_only); !done) return done;
  if (auto done = write_whole_file(folder + "/graph.g2o", to_g2o(map)); !done) return done;
  if (auto done = write_whole_file(folder + "/ledger.json", ledger_json(map, run.mapper.ledger())); !done) {
    return done;
  }
  return write_map(map, folder + "/map.gpkg");
}

Result<std::vector<std::string>> write_charts(const Map& map, const MapReport& report, const std::string& folder,
                                              int threads) {
  Pictures pictures;
  for (std::size_t i = 0; i < report.islands.size(); ++i) {
    const IslandReport& island = report.islands[i];
    const std::string place = i == 0 ? folder : fmt::format("{}/islands/{}", folder, island.island.id.value);
    write_island(map, report, island, place, threads, pictures);
  }
  if (!pictures.status) return tl::unexpected(pictures.status.error());
  return pictures.paths;
}

}  // namespace helicoid
