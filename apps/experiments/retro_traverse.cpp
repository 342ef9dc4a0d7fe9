// Does a robot get back to wherever it was before, whatever sheets its map has?
#include <algorithm>
#include <array>
#include <optional>

#include "apps/chauffeur.hpp"
#include "apps/experiments/list.hpp"
#include "apps/simulated_run.hpp"
#include "apps/traverse.hpp"
#include "apps/world_picture.hpp"

namespace helicoid {

namespace {

constexpr std::size_t kTraversesInARow = 3;
constexpr double kShortestStretch = 5;  // of exploring between them, seconds
constexpr double kLongestStretch = 60;
constexpr double kSearchForSheets = 240;  // at most, seconds
constexpr int kStandStill = 8;            // ticks after which a robot has stopped

struct Course {
  std::string world;
  double first_s = 30;  ///< explored before the first traverse: at least and at most
  double last_s = 400;
  std::size_t traverses = 50;
};

/// How the traverses of one planner ended.
struct Tally {
  std::array<std::size_t, 5> ends{};
  std::vector<Traverse> all;

  void add(Traverse traverse) {
    ++ends[static_cast<std::size_t>(traverse.end)];
    all.push_back(std::move(traverse));
  }
  [[nodiscard]] double count(TraverseEnd end) const { return static_cast<double>(ends[static_cast<std::size_t>(end)]); }
  [[nodiscard]] double arrived_percent() const {
    return 100 * count(TraverseEnd::arrived) / static_cast<double>(std::max<std::size_t>(1, all.size()));
  }
};

/// One that the manifold served and the plane did not.
struct Showpiece {
  std::vector<Pose2> by_manifold, by_plane;
};

struct CourseResult {
  Tally manifold, planar;
  std::size_t with_sheets = 0;  ///< drawn while the map had more than one
  std::size_t lost_returns = 0;
  std::optional<Showpiece> showpiece;
};

/// Explores along the world's route and drives back to places drawn at random, in turn.
class Run {
 public:
  Run(const Course& course, Chauffeur chauffeur, LiveMapping mapping, std::uint64_t seed)
      : course_(course),
        chauffeur_(std::move(chauffeur)),
        mapping_(std::move(mapping)),
        planner_(manifold_planner()),
        random_(seed) {}

  CourseResult drive() {
    mapping_.tick();
    explore(random_.uniform(course_.first_s, course_.last_s));
    while (result_.manifold.all.size() < course_.traverses) {
      explore(random_.uniform(kShortestStretch, kLongestStretch));
      if (2 * result_.with_sheets <= result_.manifold.all.size()) search_for_sheets();
      stand_still();
      const std::size_t edge = mapping_.truth(0).size() - 1;
      for (std::size_t k = 0; k < kTraversesInARow; ++k) traverse_to(random_.below(mapping_.truth(0).size()));
      // Back to the edge of what is explored.
      if (retro_traverse(mapping_, planner_, place(edge), p_world(edge)).end != TraverseEnd::arrived) {
        ++result_.lost_returns;
        break;
      }
    }
    return std::move(result_);
  }

 private:
  void explore_a_tick() {
    mapping_.command(0, chauffeur_.command(mapping_.simulation().T_world_robot(0)));
    mapping_.tick();
  }
  void explore(double seconds) {
    for (const double end = mapping_.simulation().now() + seconds; mapping_.simulation().now() < end;) explore_a_tick();
  }
  void search_for_sheets() {
    for (double left = kSearchForSheets; left > 0 && !has_sheets(); left -= 5) explore(5);
  }
  void stand_still() {
    mapping_.command(0, {});
    for (int k = 0; k < kStandStill; ++k) mapping_.tick();
  }
  [[nodiscard]] bool has_sheets() const {
    const std::vector<int> sheets = count_sheets(mapping_.map());
    return std::any_of(sheets.begin(), sheets.end(), [](int count) { return count > 1; });
  }
  [[nodiscard]] ManifoldPoint place(std::size_t scan) const {
    return point_of(mapping_.map().robot(make_id<RobotId>(0)).trajectory[scan].pose);
  }
  [[nodiscard]] Vector2d p_world(std::size_t scan) const { return mapping_.truth(0)[scan].translation(); }

  void traverse_to(std::size_t scan) {
    result_.with_sheets += has_sheets() ? 1 : 0;
    LiveMapping twin = mapping_.again();
    Traverse planar = retro_traverse(twin, planar_planner(), place(scan), p_world(scan));
    Traverse traverse = retro_traverse(mapping_, planner_, place(scan), p_world(scan));
    stand_still();
    if (!result_.showpiece && traverse.end == TraverseEnd::arrived && planar.end != TraverseEnd::arrived &&
        !planar.way.empty()) {
      result_.showpiece = {traverse.way, planar.way};
    }
    result_.manifold.add(std::move(traverse));
    result_.planar.add(std::move(planar));
  }

  Course course_;
  Chauffeur chauffeur_;
  LiveMapping mapping_;
  Planner planner_;
  Random random_;
  CourseResult result_;
};

double worst_off(const Tally& tally) {
  double worst = 0;
  for (const Traverse& t : tally.all) {
    if (t.end == TraverseEnd::arrived || t.end == TraverseEnd::wrong_place) worst = std::max(worst, t.off_m);
  }
  return worst;
}

void add(CourseResult& all, CourseResult result) {
  for (Traverse& t : result.manifold.all) all.manifold.add(std::move(t));
  for (Traverse& t : result.planar.all) all.planar.add(std::move(t));
  all.with_sheets += result.with_sheets;
  all.lost_returns += result.lost_returns;
}

Outcome summary(const CourseResult& result) {
  const Tally& m = result.manifold;
  const Tally& p = result.planar;
  const auto count = static_cast<double>(m.all.size());
  double length = 0;
  double plan_cpu = 0;
  for (const Traverse& t : m.all) {
    length += t.length_m / count;
    plan_cpu = std::max(plan_cpu, t.plan_cpu_s);
  }
  Outcome outcome{{{"arrived_percent", result.lost_returns == 0 ? m.arrived_percent() : 0.0},
                   {"with_sheets_percent", 100 * static_cast<double>(result.with_sheets) / count},
                   {"traverses_count", count},
                   {"collisions_count", m.count(TraverseEnd::collision)},
                   {"wrong_places_count", m.count(TraverseEnd::wrong_place)},
                   {"without_plan_count", m.count(TraverseEnd::no_plan)},
                   {"late_count", m.count(TraverseEnd::late)},
                   {"farthest_off_m", worst_off(m)},
                   {"mean_route_m", length},
                   {"slowest_plan_cpu_ms", 1e3 * plan_cpu},
                   {"planar_arrived_percent", p.arrived_percent()},
                   {"planar_collisions_count", p.count(TraverseEnd::collision)},
                   {"planar_wrong_places_count", p.count(TraverseEnd::wrong_place)},
                   {"planar_without_plan_count", p.count(TraverseEnd::no_plan)},
                   {"planar_late_count", p.count(TraverseEnd::late)}},
                  {}};
  return outcome;
}

ExperimentPicture draw(const World& world, const Showpiece& showpiece) {
  const std::array<TrueTrack, 2> tracks{TrueTrack{"on the manifold", {}, showpiece.by_manifold},
                                        TrueTrack{"on a planar grid", {}, showpiece.by_plane}};
  return {world.name, draw_world(world, tracks)};
}

Result<CourseResult> run_course(const World& world, const Course& course, std::uint64_t seed) {
  Chauffeur chauffeur(world.routes.front());
  LiveOptions live;
  live.seed = seed;
  Result<LiveMapping> mapping = LiveMapping::make(world, {LiveRobot{chauffeur.T_world_start()}}, live, {});
  if (!mapping) return tl::unexpected(mapping.error());
  return Run(course, std::move(chauffeur), std::move(*mapping), seed).drive();
}

Result<Outcome> run_courses(const std::vector<Course>& courses, std::uint64_t seed) {
  CourseResult all;
  std::vector<ExperimentPicture> pictures;
  for (const Course& course : courses) {
    const Result<World> world = load_world(course.world);
    if (!world) return tl::unexpected(world.error());
    Result<CourseResult> result = run_course(*world, course, seed);
    if (!result) return tl::unexpected(result.error());
    if (result->showpiece) pictures.push_back(draw(*world, *result->showpiece));
    add(all, std::move(*result));
  }
  Outcome outcome = summary(all);
  outcome.pictures = std::move(pictures);
  return outcome;
}

/// Where nothing but odometry tells how far along a robot is, nobody can ask that it arrives within 0.30 m.
Result<Outcome> run_bare_corridor(std::uint64_t seed) {
  Result<Outcome> outcome = run_courses({{"corridor", 30, 400, 6}}, seed);
  if (!outcome) return outcome;
  for (Metric& metric : outcome->metrics) {
    if (metric.name == "arrived_percent" || metric.name == "with_sheets_percent") metric.name = "bare_" + metric.name;
  }
  return outcome;
}

}  // namespace

Experiment retro_traverse_experiment() {
  Experiment e;
  e.name = "retro-traverse";
  e.question = "Does a robot get back to wherever it was before, whatever sheets its map has?";
  e.method =
      "A robot explores a building along a route (the office, the clinic and the loop corridor in turn, each "
      "with a map of its own); at random times it breaks off, is sent to three places in turn, each drawn uniformly "
      "from the scans that it has taken so far, and goes back to where it broke off. The map grows and closes loops "
      "all the while. Arrived: the robot says so, truly stands within 0.30 m of where that scan was taken and has "
      "touched nothing, within three times the time that its limits let it take for the first route (its length at "
      "top speed and its bends at top turn rate). The moments are stratified: while no more than half of a course's "
      "traverses so far had more than one sheet, it explores on before the next row, four minutes at most, until the "
      "map has. Planar: the same from the same state, on one occupancy grid "
      "of 5 cm of all patches at the same poses: the shortest way that keeps the same clearance (A*), pulled "
      "taut, with the same follower and avoidance, turning about on arrival as on the manifold, and planned again "
      "whenever the robot is blocked. In a bare corridor nothing but odometry tells how far along a robot is: what "
      "arrives there is "
      "reported, and not asked for.";
  e.bars = {{"arrived_percent", 100.0, std::nullopt, false},
            {"with_sheets_percent", 33.3, std::nullopt, true},
            {"collisions_count", std::nullopt, 0.0, false}};
  e.seeds = 20;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    const std::vector<Course> quick{{"office", 60, 400, 3}, {"loop", 30, 150, 3}};
    const std::vector<Course> whole{{"office", 60, 400, 24}, {"clinic", 60, 400, 18}, {"loop", 30, 150, 9}};
    const std::vector<Course>& courses = options.quick ? quick : whole;
    std::vector<ExperimentCase> cases{
        {"traverses", true, "", [=](std::uint64_t seed) { return run_courses(courses, seed); }}};
    if (!options.quick) cases.push_back({"bare-corridor", true, "", run_bare_corridor});
    return cases;
  };
  return e;
}

}  // namespace helicoid
