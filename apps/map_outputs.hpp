// What `map` writes (contract: *helicoid map*).
#pragma once

#include <string>
#include <vector>

#include "apps/map_run.hpp"
#include "helicoid/charts/sketch_svg.hpp"
#include "helicoid/manifold/neighbours.hpp"
#include "helicoid/manifold/sheets.hpp"

namespace helicoid {

/// An island with what its pictures and its line in the summary need.
struct IslandReport {
  Island island;
  std::vector<std::string> robots;  ///< alphabetically
  Sheets sheets;
  double area_m2 = 0;  ///< of the union of its free space, on the 10 cm raster
};

/// The islands, the largest (most patches) first, and the neighbours that their sheets follow from. `drawn`: work out
/// which patch is on which sheet too.
struct MapReport {
  Neighbours neighbours;
  Neighbours driven_neighbours;  ///< and what robots drove between; empty unless `drawn`
  std::vector<IslandReport> islands;
};
[[nodiscard]] MapReport report_on(const Map& map, bool drawn);

/// map.gpkg, graph.g2o, ledger.json and the trajectories; `online_only`: every pose as it was first reported.
[[nodiscard]] Result<void> write_records(const MapRun& run, const std::string& folder, bool online_only);
/// Free space, ways and topology of one island (the paper's fig. 6c) of a report that is to be drawn.
[[nodiscard]] SketchDrawing draw_sketch(const Map& map, const MapReport& report, const IslandReport& island,
                                        int threads);
/// map.png, map.pgm, map.yaml, sketch.svg, topology.geojson; further islands and sheets in folders of their own.
/// Returns the pictures' paths.
[[nodiscard]] Result<std::vector<std::string>> write_charts(const Map& map, const MapReport& report,
                                                            const std::string& folder, int threads);

}  // namespace helicoid
