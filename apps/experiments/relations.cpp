// Do the known relations of recorded logs fit the scans that they relate, and does the map?
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/eval/stamp_lookup.hpp"
#include "helicoid/io/relations_file.hpp"
#include "helicoid/manifold/seen_free.hpp"
#include "helicoid/mapping/relate.hpp"

namespace helicoid {

namespace {

/// A point this far within what the other scan saw as free contradicts it, metres.
constexpr double kDeep = 0.15;
/// A pose explains clearly less than another if it finds less than this part of the other's correspondences.
constexpr double kClearly = 0.9;

/// What two scans say of a pose of one relative to the other.
struct Agreement {
  int correspondences = 0;
  int contradictions = 0;
};

Agreement agreement(const Patch& a, const Patch& b, const Pose2& T_a_b) {
  return {match_patches(a, b, T_a_b).correspondences, count_contradictions(a, b, T_a_b, kDeep)};
}

/// The scans of a log's only robot, in order, each seen as a patch.
class Views {
 public:
  explicit Views(MergedLogs& logs) : reader_(*logs.robots().front().reader) {
    while (const Event* event = logs.next()) {
      if (const auto* scan = std::get_if<Scan>(&event->body)) scans_.push_back(*scan);
    }
  }
  [[nodiscard]] Patch at(std::size_t i) const {
    return make_patch(PatchId{0}, RobotId{0}, i, 0, scans_[i], reader_.lasers()[scans_[i].laser]);
  }

 private:
  const CarmenReader& reader_;
  std::vector<Scan> scans_;
};

/// Counts over all relations.
class Comparison {
 public:
  void add(const Agreement& known, const Agreement& mapped, double error_m) {
    ++count_;
    error_ += error_m;
    known_contradicted_ += known.contradictions > known.correspondences ? 1 : 0;
    mapped_contradicted_ += mapped.contradictions > mapped.correspondences ? 1 : 0;
    const bool map_better = known.correspondences < kClearly * mapped.correspondences;
    const bool known_better = mapped.correspondences < kClearly * known.correspondences;
    map_better_ += map_better ? 1 : 0;
    known_better_ += known_better ? 1 : 0;
    if (map_better || known_better) return;
    ++alike_;
    error_alike_ += error_m;
  }
  [[nodiscard]] Outcome outcome() const {
    const auto percent = [&](double count) { return count_ > 0 ? 100 * count / count_ : 0; };
    return {{{"relations_count", count_},
             {"map_fits_better_percent", percent(map_better_)},
             {"known_fits_better_percent", percent(known_better_)},
             {"known_contradicted_percent", percent(known_contradicted_)},
             {"map_contradicted_percent", percent(mapped_contradicted_)},
             {"error_mean_m", error_ / std::max(1.0, count_)},
             {"error_where_alike_mean_m", error_alike_ / std::max(1.0, alike_)}},
            {}};
  }

 private:
  double count_ = 0, alike_ = 0, map_better_ = 0, known_better_ = 0;
  double known_contradicted_ = 0, mapped_contradicted_ = 0;
  double error_ = 0, error_alike_ = 0;
};

Result<Outcome> compare(const std::string& name, const std::string& folder) {
  const std::vector<RobotLogs> robots{{name, {fmt::format("{}/{}.clf.gz", folder, name)}}};
  MapJob job;
  job.robots = robots;
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const Result<RelationsFile> known = read_relations(fmt::format("{}/{}.relations.gz", folder, name));
  if (!known) return tl::unexpected(known.error());
  Result<MergedLogs> logs = MergedLogs::open(robots);
  if (!logs) return tl::unexpected(logs.error());
  const Views views(*logs);
  const EvaluatedTrajectory mapped = final_trajectories(run->mapper.map()).front();
  const StampLookup by_stamp(mapped.stamps);
  const double tolerance = RelationErrorOptions{}.stamp_tolerance;
  Comparison comparison;
  for (const TrueRelation& relation : known->relations) {
    const std::optional<std::size_t> a = by_stamp.nearest(relation.stamp_a, tolerance);
    const std::optional<std::size_t> b = by_stamp.nearest(relation.stamp_b, tolerance);
    if (!a || !b) continue;
    const Pose2 T_a_b = mapped.poses[*a].inverse() * mapped.poses[*b];
    const Patch view_a = views.at(*a);
    const Patch view_b = views.at(*b);
    comparison.add(agreement(view_a, view_b, relation.T_a_b), agreement(view_a, view_b, T_a_b),
                   (T_a_b.translation() - relation.T_a_b.translation()).norm());
  }
  return comparison.outcome();
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  std::vector<ExperimentCase> cases;
  for (const char* name : {"intel", "fr079"}) {
    const std::string folder = fmt::format("{}/{}", options.data, name);
    cases.push_back({name, false, missing_data(options, name), [=](std::uint64_t) { return compare(name, folder); }});
  }
  return cases;
}

}  // namespace

Experiment relations_experiment() {
  Experiment e;
  e.name = "relations";
  e.question = "Do the known relations of recorded logs fit the scans that they relate, and does the map?";
  e.method =
      "Every known relation names two scans. At the pose that the relation states, and at the pose that the map gives, "
      "the scans' points are paired: correspondences, and contradictions, which are points of either scan that lie "
      "more "
      "than 15 cm within what the other saw as free. One pose fits better if the other finds less than 90 % of its "
      "correspondences. Where the map's pose fits better, the map's error against the relation is no error of the map. "
      "The last figure is the mean error where both fit alike.";
  e.bars = {{"known_fits_better_percent", std::nullopt, 1.0, false},
            {"map_contradicted_percent", std::nullopt, 1.0, false}};
  e.seeds = 1;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
