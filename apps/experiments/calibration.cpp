// Does the truth lie where the map says that it may?
#include <cmath>

#include "apps/evaluated_relations.hpp"
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/experiments/scan_pairs.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/eval/coverage.hpp"
#include "helicoid/eval/relation_cycles.hpp"
#include "helicoid/eval/stamp_lookup.hpp"
#include "helicoid/fit/local_bound.hpp"
#include "helicoid/manifold/stated_confidence.hpp"

namespace helicoid {

namespace {

constexpr int kPairs = 60;  // of a run, at each separation
constexpr int kPeople = 4;
/// Pairs across closures: this far apart along the way at least, and this near in the plane; metres.
constexpr double kLongWay = 20;
constexpr double kNear = 10;
/// The noise of the recorded relations themselves as they are said to have it (Kuemmerle et al. 2009), an axis.
constexpr double kTruthPosition = 0.0075;  // metres
constexpr double kTruthHeading = 0.0023;   // radians

/// Where a simulated run's patches stand along the way of its only robot, metres.
std::vector<double> places_along(const SimulatedRun& run) {
  std::vector<double> along(1, 0);
  for (std::size_t i = 1; i < run.map().patch_count(); ++i) {
    const Pose2 step = run.T_world_patch(make_id<PatchId>(i - 1)).inverse() * run.T_world_patch(make_id<PatchId>(i));
    along.push_back(along.back() + step.distance());
  }
  return along;
}

/// A simulated run's patches, with what the map states of pairs of them and what is true.
class JudgedPatches {
 public:
  explicit JudgedPatches(const SimulatedRun& run)
      : run_(run), stated_(run.map(), run.map().islands().front()), along_(places_along(run)) {}

  /// Random pairs that lie about `separation` metres apart along the way.
  [[nodiscard]] Coverage apart(double separation, Random& random) const {
    Coverage coverage;
    for (int k = 0; k < kPairs; ++k) {
      const std::size_t a = random.below(along_.size());
      std::size_t b = a;
      while (b + 1 < along_.size() && along_[b] - along_[a] < separation) ++b;
      if (along_[b] - along_[a] < 0.7 * separation || a == b) continue;
      add(make_id<PatchId>(a), make_id<PatchId>(b), coverage);
    }
    return coverage;
  }

  /// Random pairs that are near one another, but far apart along the way.
  [[nodiscard]] Coverage across(Random& random) const {
    constexpr int kTries = 20000;
    Coverage coverage;
    for (int k = 0; k < kTries && coverage.count() < kPairs; ++k) {
      const std::size_t a = random.below(along_.size());
      const std::size_t b = random.below(along_.size());
      if (along_[b] - along_[a] < kLongWay) continue;
      const Pose2 T_a_b = run_.T_world_patch(make_id<PatchId>(a)).inverse() * run_.T_world_patch(make_id<PatchId>(b));
      if (T_a_b.distance() < kNear) add(make_id<PatchId>(a), make_id<PatchId>(b), coverage);
    }
    return coverage;
  }

 private:
  void add(PatchId a, PatchId b, Coverage& coverage) const {
    coverage.add(stated_.between(a, b), run_.T_world_patch(a).inverse() * run_.T_world_patch(b));
  }

  const SimulatedRun& run_;
  StatedConfidence stated_;
  std::vector<double> along_;
};

void report(const std::string& what, const Coverage& coverage, Outcome& outcome) {
  if (coverage.count() == 0) return;
  outcome.metrics.push_back({fmt::format("nees_{}_ratio", what), coverage.nees_per_freedom()});
  constexpr const char* kComponents[] = {"x", "y", "yaw"};
  for (int c = 0; c < 3; ++c) {
    outcome.metrics.push_back({fmt::format("inside_{}_{}_percent", kComponents[c], what), coverage.inside_percent(c)});
  }
}

/// A world to drive through. Where nothing was calibrated is reported, not judged.
struct SimulatedCase {
  std::string world;
  bool closures = false;
  bool judged = true;
};

Result<Outcome> run_simulated(const SimulatedCase& simulated, std::uint64_t seed) {
  const Result<World> world = load_world(simulated.world);
  if (!world) return tl::unexpected(world.error());
  SimulationOptions options;
  options.seed = seed;
  options.people = kPeople;
  MapperOptions mapper;
  mapper.closures = simulated.closures;
  const Result<SimulatedRun> run = map_simulation(*world, options, mapper);
  if (!run) return tl::unexpected(run.error());
  const JudgedPatches patches(*run);
  Random random(seed);
  Outcome outcome;
  for (const int separation : {1, 10, 100}) {
    report(fmt::format("{}m{}", separation, simulated.judged ? "" : "_elsewhere"), patches.apart(separation, random),
           outcome);
  }
  if (simulated.closures) report("across", patches.across(random), outcome);
  return outcome;
}

/// A known relation beside what the map states of the same two scans.
struct JudgedRelation {
  UncertainPose2 stated;
  Pose2 T_a_b_known;
  bool is_local = false;
  bool scans_agree = false;  ///< they do not contradict it, and it explains about as much of them as the map's pose
};

/// Known relations, what the map states of each, and how far each is from what its two scans say by themselves.
struct JudgedRelations {
  std::vector<JudgedRelation> all;
  PoseSpread known_off_scans;
  PoseSpread halves_apart;

  template <class Which>
  [[nodiscard]] Coverage coverage(const Matrix3d& noise_of_known, Which&& which) const {
    Coverage coverage;
    for (const JudgedRelation& r : all) {
      if (which(r)) coverage.add({r.stated.T_a_b, r.stated.covariance + noise_of_known}, r.T_a_b_known);
    }
    return coverage;
  }
  [[nodiscard]] double inside_percent(const Matrix3d& noise_of_known) const {
    return coverage(noise_of_known, [](const JudgedRelation&) { return true; }).region_percent();
  }
  /// The known relations' noise as their scans have it; what the scans themselves leave open is taken out: either half
  /// of the beams has twice the variance of all.
  [[nodiscard]] Matrix3d noise_by_scans() const {
    const auto without = [](double known, double halves) {
      return std::sqrt(std::max(0.0, known * known - 0.25 * halves * halves));
    };
    return noise_floor(without(known_off_scans.position_m(), halves_apart.position_m()),
                       radians(without(known_off_scans.heading_deg(), halves_apart.heading_deg())));
  }
};

JudgedRelations judge(const Map& map, const ScanViews& views, std::span<const EvaluatedRelation> known) {
  const StatedConfidence stated(map, map.islands().front());
  const StampLookup by_stamp(final_trajectories(map).front().stamps);
  const double tolerance = RelationErrorOptions{}.stamp_tolerance;
  const RobotId robot{0};
  JudgedRelations judged;
  for (const EvaluatedRelation& relation : known) {
    const std::optional<std::size_t> a = by_stamp.nearest(relation.stamp_a, tolerance);
    const std::optional<std::size_t> b = by_stamp.nearest(relation.stamp_b, tolerance);
    if (!a || !b) continue;
    JudgedRelation r{stated.between({robot, *a}, {robot, *b}), relation.T_a_b};
    r.is_local = std::abs(relation.stamp_b - relation.stamp_a) <= 5;
    const Patch view_a = views.at(*a);
    const Patch view_b = views.at(*b);
    const Agreement known_says = agreement(view_a, view_b, r.T_a_b_known);
    const Agreement map_says = agreement(view_a, view_b, r.stated.T_a_b);
    r.scans_agree = !known_says.is_contradicted() && !known_says.is_clearly_worse_than(map_says);
    if (const auto scans = match_scans(view_a, view_b, r.T_a_b_known)) {
      judged.known_off_scans.add(scans->T_a_b.inverse() * r.T_a_b_known);
      judged.halves_apart.add(scans->halves_apart);
    }
    judged.all.push_back(r);
  }
  return judged;
}

Result<Outcome> run_recorded(const std::string& name, const std::string& folder) {
  MapJob job;
  job.robots = {{name, {fmt::format("{}/{}.clf.gz", folder, name)}}};
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const auto known = read_evaluated(fmt::format("{}/{}.relations.gz", folder, name));
  if (!known) return tl::unexpected(known.error());
  const Result<ScanViews> views = ScanViews::read(job.robots);
  if (!views) return tl::unexpected(views.error());
  const JudgedRelations relations = judge(run->mapper.map(), *views, *known);
  const Matrix3d said = noise_floor(kTruthPosition, kTruthHeading);
  const CycleClosure cycles = close_cycles(*known, said);
  const Matrix3d by_cycles = cycles.noise_factor * cycles.noise_factor * said;
  const Matrix3d by_scans = relations.noise_by_scans();
  const Coverage all = relations.coverage(said, [](const JudgedRelation&) { return true; });
  const Coverage local = relations.coverage(said, [](const JudgedRelation& r) { return r.is_local; });
  const Coverage agreed = relations.coverage(said, [](const JudgedRelation& r) { return r.scans_agree; });
  return Outcome{{{"inside_relations_percent", all.region_percent()},
                  {"inside_local_relations_percent", local.region_percent()},
                  {"inside_where_scans_agree_percent", agreed.region_percent()},
                  {"nees_relations_ratio", all.nees_per_freedom()},
                  {"scored_relations_count", static_cast<double>(all.count())},
                  {"known_cycles_count", static_cast<double>(cycles.coverage.count())},
                  {"known_cycles_inside_percent", cycles.coverage.region_percent()},
                  {"noise_by_cycles_m", std::sqrt(by_cycles(0, 0))},
                  {"noise_by_cycles_deg", degrees(std::sqrt(by_cycles(2, 2)))},
                  {"inside_with_noise_by_cycles_percent", relations.inside_percent(by_cycles)},
                  {"noise_by_scans_m", std::sqrt(by_scans(0, 0))},
                  {"noise_by_scans_deg", degrees(std::sqrt(by_scans(2, 2)))},
                  {"inside_with_noise_by_scans_percent", relations.inside_percent(by_scans)}},
                 {}};
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const bool closures : {false, true}) {
    for (const char* world : {"office", "branch"}) {
      const SimulatedCase simulated{world, closures};
      cases.push_back({fmt::format("{}{}", world, closures ? "_closed" : ""), true, "",
                       [simulated](std::uint64_t seed) { return run_simulated(simulated, seed); }});
    }
  }
  for (const char* world : {"hall", "corridor"}) {
    const SimulatedCase simulated{world, false, false};
    cases.push_back({world, true, "", [simulated](std::uint64_t seed) { return run_simulated(simulated, seed); }});
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
      "clocks and four people walking about. Random pairs of patches about 1, 10 and 100 m apart along the way: the "
      "normalised error squared (NEES) of their relative pose over its three degrees of freedom, and how often each "
      "component lies inside its 95 % interval. *closed*: with loops closed. *across*: pairs within 10 m that lie at "
      "least 20 m apart along the way. *elsewhere*: worlds on which nothing was calibrated, a hall whose walls are far "
      "and a corridor; reported, not judged. Recorded logs: how many of the known relations lie inside the stated 95 % "
      "region, the relations' own noise as it is said to be (7.5 mm an axis, 0.13 deg) added. The constants are the "
      "same for every log. The other figures of recorded logs ask how large the relations' own noise is; the map has "
      "no part in it. *By cycles*: how often three known relations a-b, b-c, c-a lead back to where they began within "
      "the 95 % region of the said noise, and which noise would explain how far they miss. *By scans*: how far a known "
      "relation is from what its two scans say when they are matched with one another alone, where either half of "
      "their beams tells the whole pose (see `experiment relations`). With either noise in place of the said one the "
      "relations are counted once more; and with the said one, where the two scans agree with the known relation: they "
      "do not contradict it, and it explains nine tenths of what the map's pose explains.";
  for (const char* what : {"1m", "10m", "100m", "across"}) {
    e.bars.push_back({fmt::format("nees_{}_ratio", what), 0.5, 2.0, true});
    for (const char* component : {"x", "y", "yaw"}) {
      e.bars.push_back({fmt::format("inside_{}_{}_percent", component, what), 90.0, 99.0, true});
    }
  }
  e.bars.push_back({"inside_relations_percent", 90.0, std::nullopt, true});
  e.seeds = 50;
  e.quick_seeds = 4;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
