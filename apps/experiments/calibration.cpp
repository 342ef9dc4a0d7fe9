// Does the truth lie where the map says that it may?
#include <Eigen/Cholesky>
#include <cmath>

#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/eval/stamp_lookup.hpp"
#include "helicoid/fit/relative_covariance.hpp"
#include "helicoid/io/relations_file.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

constexpr double kChiSquare95 = 7.815;  // three degrees of freedom
constexpr double kTwoSided95 = 1.96;
constexpr int kPairs = 60;  // of a run, at each separation
constexpr int kPeople = 4;
// The noise of the recorded relations themselves (Kuemmerle et al. 2009), an axis.
constexpr double kTruthPosition = 0.0075;  // metres
constexpr double kTruthHeading = 0.0023;   // radians

/// How errors compare with what was stated, over many relative poses.
class Tally {
 public:
  void add(const UncertainPose2& stated, const Pose2& T_a_b_true) {
    const Vector3d error(T_a_b_true.x - stated.T_a_b.x, T_a_b_true.y - stated.T_a_b.y,
                         wrap_angle(T_a_b_true.yaw - stated.T_a_b.yaw));
    const double square = error.dot(stated.covariance.ldlt().solve(error));
    nees_ += square;
    inside_region_ += square < kChiSquare95 ? 1 : 0;
    for (int k = 0; k < 3; ++k) {
      inside_[k] += std::abs(error[k]) < kTwoSided95 * std::sqrt(stated.covariance(k, k)) ? 1 : 0;
    }
    ++count_;
  }
  /// The normalised error squared over its degrees of freedom: 1 is honest.
  [[nodiscard]] double nees_per_freedom() const { return nees_ / (3 * count_); }
  [[nodiscard]] double inside_percent(int component) const { return 100 * inside_[component] / count_; }
  [[nodiscard]] double region_percent() const { return 100 * inside_region_ / count_; }
  [[nodiscard]] double count() const { return count_; }

 private:
  double nees_ = 0, inside_region_ = 0, count_ = 0;
  double inside_[3] = {};
};

/// The exact confidences of a map's only island, the noise floors of both ends' scans included.
class StatedConfidence {
 public:
  explicit StatedConfidence(const Map& map) : map_(map), exact_(map.poses(), graph_edges(map, map.islands().front())) {}

  [[nodiscard]] UncertainPose2 between(PatchId a, PatchId b) const {
    UncertainPose2 stated = exact_.of(a.value, b.value);
    stated.covariance = with_noise_floor(stated, floor_of(a), floor_of(b));
    return stated;
  }
  [[nodiscard]] UncertainPose2 between(const TrackedScan& a, const TrackedScan& b) const {
    const UncertainPose2 patches = exact_.of(a.pose.patch.value, b.pose.patch.value);
    const UncertainPose2 in_a{a.pose.T_patch_robot, a.covariance};
    const UncertainPose2 in_b{b.pose.T_patch_robot, b.covariance};
    UncertainPose2 stated = compound(compound(invert(in_a), patches), in_b);
    stated.covariance = with_noise_floor(stated, floor_of(a.pose.patch), floor_of(b.pose.patch));
    return stated;
  }

 private:
  [[nodiscard]] Matrix3d floor_of(PatchId id) const {
    const LaserModel& laser = map_.patch(id).laser;
    return noise_floor(laser.floor_position, laser.floor_heading);
  }
  const Map& map_;
  RelativeCovariance exact_;
};

/// Random pairs of patches that lie about `separation` metres apart along the way.
Tally tally_pairs(const SimulatedRun& run, const StatedConfidence& stated, double separation, Random& random) {
  const std::size_t patches = run.map().patch_count();
  std::vector<double> along(1, 0);
  for (std::size_t i = 1; i < patches; ++i) {
    const Pose2 step = run.T_world_patch(make_id<PatchId>(i - 1)).inverse() * run.T_world_patch(make_id<PatchId>(i));
    along.push_back(along.back() + step.distance());
  }
  Tally tally;
  for (int k = 0; k < kPairs; ++k) {
    const std::size_t a = random.below(patches);
    std::size_t b = a;
    while (b + 1 < patches && along[b] - along[a] < separation) ++b;
    if (along[b] - along[a] < 0.7 * separation || a == b) continue;
    const PatchId id_a = make_id<PatchId>(a);
    const PatchId id_b = make_id<PatchId>(b);
    tally.add(stated.between(id_a, id_b), run.T_world_patch(id_a).inverse() * run.T_world_patch(id_b));
  }
  return tally;
}

Result<Outcome> run_simulated(const std::string& world_name, std::uint64_t seed) {
  const Result<World> world = load_world(world_name);
  if (!world) return tl::unexpected(world.error());
  SimulationOptions options;
  options.seed = seed;
  options.people = kPeople;
  MapperOptions mapper;
  mapper.closures = false;
  const Result<SimulatedRun> run = map_simulation(*world, options, mapper);
  if (!run) return tl::unexpected(run.error());
  const StatedConfidence stated(run->map());
  Random random(seed);
  Outcome outcome;
  for (const int separation : {1, 10, 100}) {
    const Tally tally = tally_pairs(*run, stated, separation, random);
    if (tally.count() == 0) continue;
    outcome.metrics.push_back({fmt::format("nees_{}m_ratio", separation), tally.nees_per_freedom()});
    constexpr const char* kComponents[] = {"x", "y", "yaw"};
    for (int c = 0; c < 3; ++c) {
      outcome.metrics.push_back(
          {fmt::format("inside_{}_{}m_percent", kComponents[c], separation), tally.inside_percent(c)});
    }
  }
  return outcome;
}

Result<Outcome> run_recorded(const std::string& name, const std::string& folder) {
  MapJob job;
  job.robots = {{name, {fmt::format("{}/{}.clf.gz", folder, name)}}};
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const Result<RelationsFile> truth = read_relations(fmt::format("{}/{}.relations.gz", folder, name));
  if (!truth) return tl::unexpected(truth.error());
  const Map& map = run->mapper.map();
  const StatedConfidence stated(map);
  const Trajectory& scans = map.robots().front().trajectory;
  const StampLookup by_stamp(final_trajectories(map).front().stamps);
  const double tolerance = RelationErrorOptions{}.stamp_tolerance;
  const Matrix3d truth_noise = noise_floor(kTruthPosition, kTruthHeading);
  Tally all;
  Tally local;
  for (const TrueRelation& relation : truth->relations) {
    const std::optional<std::size_t> a = by_stamp.nearest(relation.stamp_a, tolerance);
    const std::optional<std::size_t> b = by_stamp.nearest(relation.stamp_b, tolerance);
    if (!a || !b) continue;
    UncertainPose2 pose = stated.between(scans[*a], scans[*b]);
    pose.covariance += truth_noise;
    all.add(pose, relation.T_a_b);
    if (std::abs(relation.stamp_b - relation.stamp_a) <= 5) local.add(pose, relation.T_a_b);
  }
  return Outcome{{{"inside_relations_percent", all.region_percent()},
                  {"inside_local_relations_percent", local.region_percent()},
                  {"nees_relations_ratio", all.nees_per_freedom()},
                  {"scored_relations_count", all.count()}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const char* world : {"office", "branch"}) {
    cases.push_back({world, true, "", [world](std::uint64_t seed) { return run_simulated(world, seed); }});
  }
  for (const char* name : {"intel", "fr079"}) {
    const std::string folder = fmt::format("{}/{}", options.data, name);
    cases.push_back(
        {name, false, missing_data(options, name), [=](std::uint64_t) { return run_recorded(name, folder); }});
  }
  return cases;
}

}  // namespace

Experiment calibration_experiment() {
  Experiment e;
  e.name = "calibration";
  e.question = "Does the truth lie where the map says that it may?";
  e.method =
      "Simulated drives with rounded ranges, mixed pixels, dark and bright walls, a sweep that takes time, jittery "
      "clocks "
      "and four people walking about. Random pairs of patches about 1, 10 and 100 m apart along the way: the "
      "normalised "
      "error squared (NEES) of their relative pose over its three degrees of freedom, and how often each component "
      "lies "
      "inside its 95 % interval. Recorded logs: how many of the known relations lie inside the stated 95 % region, the "
      "relations' own noise (7.5 mm an axis, 0.13 deg) added. The constants are the laser's and the same for every "
      "log.";
  for (const char* separation : {"1m", "10m", "100m"}) {
    e.bars.push_back({fmt::format("nees_{}_ratio", separation), 0.5, 2.0, true});
    for (const char* component : {"x", "y", "yaw"}) {
      e.bars.push_back({fmt::format("inside_{}_{}_percent", component, separation), 90.0, 99.0, true});
    }
  }
  e.bars.push_back({"inside_relations_percent", 90.0, std::nullopt, true});
  e.seeds = 50;
  e.quick_seeds = 4;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
