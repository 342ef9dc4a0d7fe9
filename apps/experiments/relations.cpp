// Do the known relations of recorded logs fit the scans that they relate, and does the map?
#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/experiments/scan_pairs.hpp"
#include "apps/map_run.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/eval/stamp_lookup.hpp"
#include "helicoid/io/relations_file.hpp"

namespace helicoid {

namespace {

/// Counts over all relations.
class Comparison {
 public:
  void add(const Agreement& known, const Agreement& mapped, double error_m) {
    ++count_;
    error_ += error_m;
    known_contradicted_ += known.is_contradicted() ? 1 : 0;
    mapped_contradicted_ += mapped.is_contradicted() ? 1 : 0;
    const bool map_better = known.is_clearly_worse_than(mapped);
    const bool known_better = mapped.is_clearly_worse_than(known);
    map_better_ += map_better ? 1 : 0;
    known_better_ += known_better ? 1 : 0;
    if (map_better || known_better) return;
    ++alike_;
    error_alike_ += error_m;
  }
  /// What the two scans say by themselves, where they say enough.
  void add_scans(const ScanMatch& scans, const Pose2& T_a_b_known, const Pose2& T_a_b_mapped) {
    known_off_.add(scans.T_a_b.inverse() * T_a_b_known);
    mapped_off_.add(scans.T_a_b.inverse() * T_a_b_mapped);
    halves_apart_.add(scans.halves_apart);
  }
  [[nodiscard]] Outcome outcome() const {
    const auto percent = [&](double count) { return count_ > 0 ? 100 * count / count_ : 0; };
    return {{{"relations_count", count_},
             {"map_fits_better_percent", percent(map_better_)},
             {"known_fits_better_percent", percent(known_better_)},
             {"known_contradicted_percent", percent(known_contradicted_)},
             {"map_contradicted_percent", percent(mapped_contradicted_)},
             {"error_mean_m", error_ / std::max(1.0, count_)},
             {"error_where_alike_mean_m", error_alike_ / std::max(1.0, alike_)},
             {"scans_tell_count", static_cast<double>(known_off_.count())},
             {"known_off_scans_m", known_off_.position_m()},
             {"map_off_scans_m", mapped_off_.position_m()},
             {"halves_of_scans_apart_m", halves_apart_.position_m()},
             {"known_off_scans_deg", known_off_.heading_deg()},
             {"map_off_scans_deg", mapped_off_.heading_deg()},
             {"halves_of_scans_apart_deg", halves_apart_.heading_deg()}},
            {}};
  }

 private:
  double count_ = 0, alike_ = 0, map_better_ = 0, known_better_ = 0;
  double known_contradicted_ = 0, mapped_contradicted_ = 0;
  double error_ = 0, error_alike_ = 0;
  PoseSpread known_off_, mapped_off_, halves_apart_;
};

Result<Outcome> compare(const std::string& name, const std::string& folder) {
  const std::vector<RobotLogs> robots{{name, {fmt::format("{}/{}.clf.gz", folder, name)}}};
  MapJob job;
  job.robots = robots;
  const Result<MapRun> run = run_map(job);
  if (!run) return tl::unexpected(run.error());
  const Result<RelationsFile> known = read_relations(fmt::format("{}/{}.relations.gz", folder, name));
  if (!known) return tl::unexpected(known.error());
  const Result<ScanViews> views = ScanViews::read(robots);
  if (!views) return tl::unexpected(views.error());
  const EvaluatedTrajectory mapped = final_trajectories(run->mapper.map()).front();
  const StampLookup by_stamp(mapped.stamps);
  const double tolerance = RelationErrorOptions{}.stamp_tolerance;
  Comparison comparison;
  for (const TrueRelation& relation : known->relations) {
    const std::optional<std::size_t> a = by_stamp.nearest(relation.stamp_a, tolerance);
    const std::optional<std::size_t> b = by_stamp.nearest(relation.stamp_b, tolerance);
    if (!a || !b) continue;
    const Pose2 T_a_b = mapped.poses[*a].inverse() * mapped.poses[*b];
    const Patch view_a = views->at(*a);
    const Patch view_b = views->at(*b);
    comparison.add(agreement(view_a, view_b, relation.T_a_b), agreement(view_a, view_b, T_a_b),
                   (T_a_b.translation() - relation.T_a_b.translation()).norm());
    if (const auto scans = match_scans(view_a, view_b, relation.T_a_b)) {
      comparison.add_scans(*scans, relation.T_a_b, T_a_b);
    }
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
      "Then the mean error where both fit alike. The last figures are of the relations whose two scans tell all of "
      "their "
      "pose by themselves: they are matched with one another alone, from the known pose on, and once more with either "
      "half of the second scan's beams. How far the known pose, the map's, and the two halves' are from one another: "
      "root mean squares, metres an axis.";
  e.bars = {{"known_fits_better_percent", std::nullopt, 1.0, false},
            {"map_contradicted_percent", std::nullopt, 1.0, false}};
  e.seeds = 1;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
