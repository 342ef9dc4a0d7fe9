// What does it cost to map in a map of a hundred thousand patches?
#include <algorithm>
#include <cmath>

#include "apps/chart.hpp"
#include "apps/experiments/campus_map.hpp"
#include "apps/experiments/list.hpp"
#include "apps/map_run.hpp"
#include "apps/process_memory.hpp"
#include "helicoid/base/random.hpp"
#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

constexpr int kScans = 1500;  ///< that are timed
/// A patch that goes farther was moved by a closure, metres.
constexpr double kMoved = 1e-3;

const CampusSize kWhole{34, {40, 70, 120, 210, 370, 640}, {1000, 3000, 10000, 30000, 100000}};
const CampusSize kQuick{2, {40, 70, 120}, {1000, 8000}};

RobotId robot_named(const Map& map, const std::string& name) {
  std::size_t i = 0;
  while (map.robots()[i].name != name) ++i;
  return make_id<RobotId>(i);
}

std::size_t count_accepted(const Mapper& mapper) {
  return static_cast<std::size_t>(
      std::count_if(mapper.ledger().begin(), mapper.ledger().end(),
                    [](const Hypothesis& h) { return h.state == HypothesisState::accepted; }));
}

/// CPU microseconds of a scan of the first building's robot on its second lap that closes no loop.
struct ScanCost {
  double small_us = 0;   ///< the building alone
  double campus_us = 0;  ///< the campus about it
  double worst_us = 0;   ///< of any scan in the campus, closures and all
};

double microseconds_of(Mapper& mapper, const Event& event) {
  const double began = thread_cpu_seconds();
  mapper.process(event);
  return 1e6 * (thread_cpu_seconds() - began);
}

/// Either map is told of each event in turn, so that whatever else the machine does meets both.
ScanCost time_scans(const Campus& campus, Mapper& large) {
  const MappedBuilding& building = campus.buildings[0];
  Mapper small(MapperOptions{}, building.map);
  const RobotId there = robot_named(large.map(), building_robot(0));
  Simulator simulator = building.simulator;
  std::optional<SimulatedEvent> event = building.next;
  ScanCost sum;
  int scans = 0;
  const std::size_t before = large.map().patch_count();
  std::size_t grown = 0;
  for (; event && scans < kScans; event = simulator.next()) {
    if (!std::holds_alternative<Scan>(event->event.body)) continue;
    const std::size_t accepted = count_accepted(small) + count_accepted(large);
    Event in_campus = event->event;
    in_campus.robot = there;
    // Who comes first finds the simulator's data in the caches and not its own.
    const bool is_small_first = scans % 2 == 0;
    double small_us = is_small_first ? microseconds_of(small, event->event) : 0;
    const double campus_us = microseconds_of(large, in_campus);
    if (!is_small_first) small_us = microseconds_of(small, event->event);
    // A list that is full moves once and has room for as much again: the first patches that are kept pay for it.
    sum.worst_us = std::max(sum.worst_us, campus_us);
    grown = std::max(grown, large.map().patch_count() - before);
    if (grown < 2 || count_accepted(small) + count_accepted(large) != accepted) continue;
    sum.campus_us += campus_us;
    sum.small_us += small_us;
    ++scans;
  }
  return {sum.small_us / scans, sum.campus_us / scans, sum.worst_us};
}

struct ClosureCost {
  double moved = 0;  ///< patches
  double cpu_s = 0;
};

/// The robot of a ring drives on until its loop is closed: what that one event cost, and what it moved.
ClosureCost close_ring(const MappedBuilding& ring, const std::string& name, Mapper& mapper) {
  const RobotId there = robot_named(mapper.map(), name);
  const std::size_t accepted = count_accepted(mapper);
  Simulator simulator = ring.simulator;
  for (std::optional<SimulatedEvent> event = ring.next; event; event = simulator.next()) {
    event->event.robot = there;
    const std::vector<Pose2> before(mapper.map().poses().begin(), mapper.map().poses().end());
    const double began = thread_cpu_seconds();
    mapper.process(event->event);
    const double cpu_s = thread_cpu_seconds() - began;
    if (count_accepted(mapper) == accepted) continue;
    ClosureCost cost{0, cpu_s};
    for (std::size_t i = 0; i < before.size(); ++i) {
      const Vector2d apart = mapper.map().poses()[i].translation() - before[i].translation();
      cost.moved += apart.norm() > kMoved ? 1 : 0;
    }
    return cost;
  }
  return {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};
}

/// Of log(cost) over log(moved), by least squares.
double log_log_slope(const std::vector<ClosureCost>& costs) {
  Vector2d mean = Vector2d::Zero();
  for (const ClosureCost& c : costs) mean += Vector2d(std::log(c.moved), std::log(c.cpu_s)) / costs.size();
  double both = 0;
  double square = 0;
  for (const ClosureCost& c : costs) {
    both += (std::log(c.moved) - mean.x()) * (std::log(c.cpu_s) - mean.y());
    square += (std::log(c.moved) - mean.x()) * (std::log(c.moved) - mean.x());
  }
  return both / square;
}

/// CPU seconds of a fit of everything from poses that are off by some centimetres.
double time_full_fit(const Map& map) {
  Random random(1);
  const Island island = map.islands().front();
  std::vector<Pose2> start = island_poses(map, island);
  for (Pose2& T : start) T = T * Pose2{0.02 * random.normal(), 0.02 * random.normal(), 0.002 * random.normal()};
  const double began = thread_cpu_seconds();
  const FitResult fitted = fit_graph(start, graph_edges(map, island), 0);
  const double cpu_s = thread_cpu_seconds() - began;
  return fitted.status == FitStatus::converged ? cpu_s : std::numeric_limits<double>::quiet_NaN();
}

Chart chart_of(const char* title, const char* x, const char* y, const std::vector<Vector2d>& points) {
  Chart chart;
  chart.title = title;
  chart.x_label = x;
  chart.y_label = y;
  chart.y_from = 0.0;
  chart.series = {{"", points, charts::robot_colour(0), Series::Look::line},
                  {"", points, charts::robot_colour(0), Series::Look::dots}};
  chart.height = 300;
  return chart;
}

/// What mapping costs in a map of one size.
struct Costs {
  double patches = 0;
  ScanCost scan;
  std::vector<ClosureCost> closures;
  double fit_s = 0;
  double gib = 0;
};

Costs measure(const Campus& campus, std::size_t around) {
  Mapper mapper(MapperOptions{}, build_campus(campus, around));
  Costs costs;
  costs.patches = static_cast<double>(mapper.map().patch_count());
  costs.scan = time_scans(campus, mapper);
  for (std::size_t i = 0; i < campus.rings.size(); ++i) {
    costs.closures.push_back(close_ring(campus.rings[i], ring_robot(i), mapper));
  }
  costs.fit_s = time_full_fit(mapper.map());
  costs.gib = static_cast<double>(resident_bytes()) / (1024.0 * 1024 * 1024);
  return costs;
}

ExperimentPicture draw(const std::vector<Costs>& by_size) {
  constexpr const char* kPatches = "thousands of patches of the map";
  std::vector<Vector2d> scans;
  std::vector<Vector2d> closures;
  std::vector<Vector2d> fits;
  std::vector<Vector2d> by_moved;
  by_moved.reserve(by_size.back().closures.size());
  for (const Costs& c : by_size) {
    const double thousands = 1e-3 * c.patches;
    scans.emplace_back(thousands, c.scan.campus_us / c.scan.small_us);
    closures.emplace_back(thousands, 1e3 * c.closures[c.closures.size() / 2].cpu_s);
    fits.emplace_back(thousands, c.fit_s);
  }
  for (const ClosureCost& c : by_size.back().closures) by_moved.emplace_back(c.moved, 1e3 * c.cpu_s);
  return {"cost", draw_charts({chart_of("a scan, beside the same in its building alone", kPatches, "ratio", scans),
                               chart_of("one and the same closure", kPatches, "CPU milliseconds", closures),
                               chart_of("a fit of everything", kPatches, "CPU seconds", fits),
                               chart_of("closures in the largest map, by what they move", "patches that are moved",
                                        "CPU milliseconds", by_moved)})};
}

Result<Outcome> run_campus(const CampusSize& size) {
  const Result<Campus> campus = map_campus(size);
  if (!campus) return tl::unexpected(campus.error());
  std::size_t whole = 0;
  for (const auto* all : {&campus->buildings, &campus->rings}) {
    for (const MappedBuilding& b : *all) whole += b.map.patch_count();
  }
  std::vector<Costs> by_size;
  for (const std::size_t around : size.around) {
    by_size.push_back(measure(*campus, around));
  }
  const Costs& last = by_size.back();
  return Outcome{{{"patches_count", last.patches},
                  {"whole_scan_patches_count", static_cast<double>(whole)},
                  {"robots_count", static_cast<double>(size.buildings + size.rings.size())},
                  {"memory_gib", last.gib},
                  {"scan_us", last.scan.campus_us},
                  {"worst_scan_us", last.scan.worst_us},
                  {"scan_cost_ratio", last.scan.campus_us / last.scan.small_us},
                  {"least_moved_count", last.closures.front().moved},
                  {"most_moved_count", last.closures.back().moved},
                  {"longest_closure_s", last.closures.back().cpu_s},
                  {"closure_cost_slope", log_log_slope(last.closures)},
                  {"full_fit_s", last.fit_s}},
                 {draw(by_size)}};
}

}  // namespace

Experiment campus_experiment() {
  Experiment e;
  e.name = "campus";
  e.question = "What does it cost to map in a map of a hundred thousand patches?";
  e.method =
      "Forty robots map a building or a loop corridor each, every scan of them simulated and mapped; copies of those "
      "buildings, patch by patch and relation by relation, stand on a lattice about them until the map has its size. "
      "Then the mapper goes on from that map. A robot's second lap is timed event by event in the campus and, beside "
      "it, in its building alone (scans that close a loop apart: those cost what they change; and from the second "
      "patch on that it adds: a list that is full is moved once and then has room for as much again. The worst scan "
      "shows "
      "what either costs). The robots of the loop corridors, 40 m to 640 m, "
      "drive on until their loops are closed, and the event that closes one is timed (thread CPU, everything that the "
      "mapper does in it) and held against the patches that it moved by more than a millimetre. The full fit begins "
      "with poses that are off by 2 cm and 2 mrad. Memory is the process's, at the end. A scan may cost a tenth more "
      "than alone: caches are shared with a larger map.";
  e.bars = {{"memory_gib", std::nullopt, 6.0, false},
            {"scan_cost_ratio", std::nullopt, 1.1, false, true},
            {"closure_cost_slope", std::nullopt, 1.2, false, true},
            {"full_fit_s", std::nullopt, 10.0, false, true}};
  e.seeds = 1;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    const CampusSize& size = options.quick ? kQuick : kWhole;
    return std::vector<ExperimentCase>{{"campus", false, "", [&size](std::uint64_t) { return run_campus(size); }}};
  };
  return e;
}

}  // namespace helicoid
