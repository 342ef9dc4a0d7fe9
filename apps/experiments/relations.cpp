// Do the known relations of recorded logs fit the scans that they relate, and does the map?
#include <unordered_map>

#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "helicoid/align/match_pair.hpp"
#include "helicoid/io/relations_file.hpp"
#include "helicoid/manifold/seen_free.hpp"

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
  MatchPairOptions options;
  options.incidence_bias = b.laser.incidence_bias;
  const PairMatch match = match_pair({&a.points, &a.laser, a.scan.T_robot_laser}, b.points, T_a_b, options);
  return {match.correspondences,
          count_contradictions(a, b.points, T_a_b, kDeep) + count_contradictions(b, a.points, T_a_b.inverse(), kDeep)};
}

/// Of the log's only robot, by the stamp that a relation names.
class ScansByStamp {
 public:
  explicit ScansByStamp(MergedLogs& logs) : reader_(*logs.robots().front().reader) {
    while (const Event* event = logs.next()) {
      const auto* scan = std::get_if<Scan>(&event->body);
      if (scan == nullptr) continue;
      place_.emplace(key(event->stamp), scans_.size());
      scans_.push_back(*scan);
    }
  }
  [[nodiscard]] std::optional<std::size_t> find(double stamp) const {
    const auto at = place_.find(key(stamp));
    return at == place_.end() ? std::nullopt : std::optional(at->second);
  }
  [[nodiscard]] Patch view(std::size_t i) const {
    return make_patch(PatchId{0}, RobotId{0}, i, 0, scans_[i], reader_.lasers()[scans_[i].laser]);
  }

 private:
  static long long key(double stamp) { return std::llround(1e5 * stamp); }
  const CarmenReader& reader_;
  std::vector<Scan> scans_;
  std::unordered_map<long long, std::size_t> place_;  // looked up only, never walked through
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
  const ScansByStamp scans(*logs);
  const Map& map = run->mapper.map();
  const Trajectory& trajectory = map.robots().front().trajectory;
  Comparison comparison;
  for (const TrueRelation& relation : known->relations) {
    const std::optional<std::size_t> a = scans.find(relation.stamp_a);
    const std::optional<std::size_t> b = scans.find(relation.stamp_b);
    if (!a || !b) continue;
    const Pose2 T_a_b = map.project(trajectory[*a].pose).inverse() * map.project(trajectory[*b].pose);
    const Patch view_a = scans.view(*a);
    const Patch view_b = scans.view(*b);
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
