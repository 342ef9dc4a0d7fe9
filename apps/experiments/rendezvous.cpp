// Do robots that arrange to meet settle whether two places are one?
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/experiments/list.hpp"
#include "apps/explore_quality.hpp"
#include "apps/explore_run.hpp"

namespace helicoid {

namespace {

constexpr double kSame = 1.0;  // metres: places that far from where they were said to be are others

/// The wings' starts: a pair of robots in either wing, or both pairs in one.
constexpr std::array<std::size_t, 4> kEitherWing{0, 1, 2, 3};
constexpr std::array<std::size_t, 4> kOneWing{0, 1, 4, 5};

/// Who begins where somebody else began must come when those have gone on: else they see each other at once.
constexpr double kLater = 120;  // seconds

/// What is done about places of two islands that look alike.
enum class Policy : std::uint8_t { meet, wait, believe };

/// An answer, in terms that outlive the map.
struct Answer {
  MeetingOutcome outcome;
  RobotAtStamp a, b;
  Pose2 T_a_b;
};

struct MetRun {
  ExploreRun run;
  std::vector<Answer> answers;
  double first_answer_s = 0;
  std::size_t wrong_merges = 0;
};

/// How far robots of one island are at most from where the map has them relative to one another, metres.
double farthest_off(const LiveSimulation& simulation, const Map& map) {
  double farthest = 0;
  std::vector<std::size_t> there;
  for (std::size_t i = 0; i < map.robots().size(); ++i) {
    if (!map.robots()[i].trajectory.empty()) there.push_back(i);
  }
  const auto pose = [&](std::size_t robot) { return map.robots()[robot].trajectory.back().pose; };
  for (const std::size_t i : there) {
    for (const std::size_t k : there) {
      if (map.island_of(pose(i).patch) != map.island_of(pose(k).patch)) continue;
      const Pose2 T_true = simulation.T_world_robot(i).inverse() * simulation.T_world_robot(k);
      const Pose2 T_map = map.project(pose(i)).inverse() * map.project(pose(k));
      farthest = std::max(farthest, (T_true.translation() - T_map.translation()).norm());
    }
  }
  return farthest;
}

/// Follows a run: what was settled, and which joins were wrong.
class Witness {
 public:
  bool look(double now, const LiveSimulation& simulation, const TeamPilot& pilot) {
    const Map& map = pilot.map();
    for (const Settled& settled : pilot.team_plan().settled) {
      const Hypothesis& h = pilot.mapper().ledger()[settled.doubt];
      if (answers_.empty()) first_answer_s_ = now;
      answers_.push_back({settled.outcome, first_place(map, h), second_place(map, h), h.T_a_b.T_a_b});
    }
    const std::size_t merges = map.island_count() - map.islands().size();
    if (merges > merges_ && farthest_off(simulation, map) > kSame) ++wrong_merges_;
    merges_ = merges;
    return true;
  }
  [[nodiscard]] MetRun report(ExploreRun run) && {
    return {std::move(run), std::move(answers_), first_answer_s_, wrong_merges_};
  }

 private:
  std::vector<Answer> answers_;
  double first_answer_s_ = 0;
  std::size_t merges_ = 0, wrong_merges_ = 0;
};

Result<MetRun> explore(const World& world, std::span<const std::size_t> starts, Policy policy, std::uint64_t seed) {
  ExploreJob job;
  job.world = world;
  job.simulation.seed = seed;
  for (const std::size_t start : starts) job.robots.push_back({world.starts[start]});
  if (starts[2] == kOneWing[2]) job.robots[2].joins_at = job.robots[3].joins_at = kLater;
  job.pilot.explorer.meet = policy == Policy::meet;
  job.pilot.greedy = policy == Policy::believe;
  Witness witness;
  job.observer = [&](double now, const LiveSimulation& simulation, const TeamPilot& pilot) {
    return witness.look(now, simulation, pilot);
  };
  Result<ExploreRun> run = run_exploration(job);
  if (!run) return tl::unexpected(run.error());
  return std::move(witness).report(std::move(*run));
}

/// Where a robot truly was at the scan of this stamp.
Pose2 true_pose(const ExploreRun& run, const RobotAtStamp& place) {
  const auto& tracks = run.recording.tracks();
  const TrueTrack& track =
      *std::find_if(tracks.begin(), tracks.end(), [&](const TrueTrack& t) { return t.robot == place.robot; });
  const auto after = std::lower_bound(track.stamps.begin(), track.stamps.end(), place.stamp - 1e-5);
  return track.T_world_robot[static_cast<std::size_t>(after - track.stamps.begin())];
}

std::size_t wrong_answers(const MetRun& met) {
  return static_cast<std::size_t>(std::count_if(met.answers.begin(), met.answers.end(), [&](const Answer& answer) {
    const Pose2 T_true = true_pose(met.run, answer.a).inverse() * true_pose(met.run, answer.b);
    const bool is_one = (T_true.translation() - answer.T_a_b.translation()).norm() < kSame;
    return is_one != (answer.outcome == MeetingOutcome::met);
  }));
}

double answers_of(const MetRun& met, MeetingOutcome outcome) {
  return static_cast<double>(std::count_if(met.answers.begin(), met.answers.end(),
                                           [&](const Answer& answer) { return answer.outcome == outcome; }));
}

/// What is asked of each policy.
void report(std::vector<Metric>& metrics, const std::string& prefix, const MetRun& met, const MapQuality& quality) {
  metrics.push_back({prefix + "explored_s", met.run.sim_s});
  metrics.push_back({prefix + "wrong_merges_count", static_cast<double>(met.wrong_merges)});
  metrics.push_back({prefix + "islands_count", static_cast<double>(met.run.map.mapper.map().islands().size())});
  metrics.push_back({prefix + "mapped_percent", 100 * quality.mapped_fraction});
  metrics.push_back({prefix + "collisions_count", static_cast<double>(met.run.contacts.size())});
}

Result<Outcome> settle_doubts(std::span<const std::size_t> starts, bool compare, std::uint64_t seed) {
  const Result<World> world = load_world("wings");
  if (!world) return tl::unexpected(world.error());
  std::vector<Pose2> places;
  for (const std::size_t start : starts) places.push_back(world->starts[start]);
  const Result<BuildingTruth> truth = BuildingTruth::of(*world, places, LiveOptions{}.radius);
  if (!truth) return tl::unexpected(truth.error());
  const auto judged = [&](const MetRun& met) {
    return truth->judge(met.run.map.mapper.map(), met.run.recording.tracks());
  };
  const Result<MetRun> met = explore(*world, starts, Policy::meet, seed);
  if (!met) return tl::unexpected(met.error());
  const double ones = answers_of(*met, MeetingOutcome::met);
  const double distinct = answers_of(*met, MeetingOutcome::absent);
  Outcome outcome;
  // Of which kind there should be any follows from where the robots begin.
  outcome.metrics = {starts[2] == kOneWing[2] ? Metric{"met_runs_ratio", ones > 0 ? 1.0 : 0.0}
                                              : Metric{"distinct_runs_ratio", distinct > 0 ? 1.0 : 0.0},
                     {"met_count", ones},
                     {"distinct_count", distinct},
                     {"settled_wrongly_count", static_cast<double>(wrong_answers(*met))},
                     {"first_settled_s", met->answers.empty() ? met->run.sim_s : met->first_answer_s}};
  report(outcome.metrics, "", *met, judged(*met));
  if (!compare) return outcome;
  for (const auto& [policy, prefix] : {std::pair{Policy::wait, "waiting_"}, std::pair{Policy::believe, "greedy_"}}) {
    const Result<MetRun> other = explore(*world, starts, policy, seed);
    if (!other) return tl::unexpected(other.error());
    report(outcome.metrics, prefix, *other, judged(*other));
  }
  return outcome;
}

}  // namespace

Experiment rendezvous_experiment() {
  Experiment e;
  e.name = "rendezvous";
  e.question = "Do robots that arrange to meet settle whether two places are one?";
  e.method =
      "A building with two wings that are alike to the millimetre; two pairs of robots that know nothing of one "
      "another begin one in either wing; or the second, two minutes later, in the wing in which the first began. "
      "Where places of the two maps look alike a robot of either is sent: if the places were one they would see each "
      "other. Settled wrongly: accepted, though the places are more than a metre from where that has them, or "
      "recorded as distinct though they are not. A merge is wrong if robots that it joins are more than a metre from "
      "where the map has them relative to one another. The same beside without rendezvous (waiting: islands are "
      "joined when robots happen to see each other) and with greedy closure (what looks alike is believed at once). "
      "Time: until everything is explored and everybody home. Each answer is to occur in half of the runs at least in"
      " which it is the right one.";
  e.bars = {{"met_runs_ratio", 0.5, std::nullopt, true},
            {"distinct_runs_ratio", 0.5, std::nullopt, true},
            {"settled_wrongly_count", std::nullopt, 0.0, false},
            {"wrong_merges_count", std::nullopt, 0.0, false},
            {"collisions_count", std::nullopt, 0.0, false}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    const bool compare = !options.quick;
    std::vector<ExperimentCase> cases{
        {"either-wing", true, "", [=](std::uint64_t seed) { return settle_doubts(kEitherWing, compare, seed); }}};
    if (options.quick) return cases;
    cases.push_back({"one-wing", true, "", [](std::uint64_t seed) { return settle_doubts(kOneWing, true, seed); }});
    return cases;
  };
  return e;
}

}  // namespace helicoid
