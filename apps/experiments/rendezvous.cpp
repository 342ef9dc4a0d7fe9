// Do robots that arrange to meet settle whether two places are one?
#include <algorithm>
#include <array>
#include <cmath>

#include "apps/experiments/list.hpp"
#include "apps/explore_quality.hpp"
#include "apps/explore_run.hpp"
#include "apps/map_outputs.hpp"
#include "apps/world_picture.hpp"
#include "helicoid/manifold/stated_confidence.hpp"

namespace helicoid {

namespace {

constexpr double kSame = 1.0;  // metres: places that far from where they were said to be are others

/// The wings' starts: a pair of robots in either wing, or both pairs in one.
constexpr std::array<std::size_t, 4> kEitherWing{0, 1, 2, 3};
constexpr std::array<std::size_t, 4> kOneWing{0, 1, 4, 5};

/// The second pair comes when the first has something to tell: in the other wing while that maps its own still, or they
/// see each other in the corridor before there is anything to ask,
constexpr double kWhenUnderWay = 30;  // seconds
/// in the same wing once the first has gone on, or they see each other at once.
constexpr double kWhenGone = 180;  // seconds

/// A team that believes what is false may go about in it for good.
constexpr double kLongest = 1200;  // seconds

/// What is done about places of two islands that look alike.
enum class Policy : std::uint8_t { meet, wait, believe };

/// An answer, in terms that outlive the map.
struct Answer {
  Settled settled;
  RobotAtStamp a, b;
  Pose2 T_a_b;
  double at_s = 0;
  Pose2 T_world_watcher, T_world_shown;  ///< where the two truly were then
};

struct MetRun {
  ExploreRun run;
  std::vector<Answer> answers;
  double joined_s = 0;  ///< when robots of both pairs were on one island; if never, when all was over
  std::size_t wrong_merges = 0;
};

/// True if the map has this robot elsewhere relative to the other, by more than a place's size and than it says itself.
bool is_misplaced(const LiveSimulation& simulation, const Map& map, const StatedConfidence& stated, std::size_t i,
                  std::size_t k) {
  const auto last = [&](std::size_t robot) {
    return StatedConfidence::TakenScan{make_id<RobotId>(robot), map.robots()[robot].trajectory.size() - 1};
  };
  const Pose2 T_true = simulation.T_world_robot(i).inverse() * simulation.T_world_robot(k);
  const UncertainPose2 said = stated.between(last(i), last(k));
  const bool is_far = (said.T_a_b.translation() - T_true.translation()).norm() > kSame;
  return is_far && is_beyond_said(said, T_true);
}

/// True if robots of one island are not where the map has them relative to one another.
bool has_misplaced(const LiveSimulation& simulation, const Map& map) {
  for (const Island& island : map.islands()) {
    std::vector<std::size_t> there;
    for (std::size_t i = 0; i < map.robots().size(); ++i) {
      const Trajectory& trajectory = map.robots()[i].trajectory;
      if (!trajectory.empty() && map.island_of(trajectory.back().pose.patch) == island.id) there.push_back(i);
    }
    const StatedConfidence stated(map, island);
    if (!stated.is_determined()) continue;
    for (const std::size_t i : there) {
      for (const std::size_t k : there) {
        if (i < k && is_misplaced(simulation, map, stated, i, k)) return true;
      }
    }
  }
  return false;
}

/// Follows a run: what was settled, when the pairs' maps became one, and which joins were wrong.
class Witness {
 public:
  bool look(double now, const LiveSimulation& simulation, const TeamPilot& pilot) {
    const Map& map = pilot.map();
    for (const Settled& settled : pilot.team_plan().settled) {
      const Hypothesis& h = pilot.mapper().ledger()[settled.doubt];
      answers_.push_back({settled, first_place(map, h), second_place(map, h), h.T_a_b.T_a_b, now,
                          simulation.T_world_robot(settled.watcher.index()),
                          simulation.T_world_robot(settled.shown.index())});
    }
    const std::size_t merges = map.island_count() - map.islands().size();
    if (merges > merges_ && has_misplaced(simulation, map)) ++wrong_merges_;
    merges_ = merges;
    const auto is_mapped = [](const RobotRecord& robot) { return !robot.trajectory.empty(); };
    const bool all_here = std::all_of(map.robots().begin(), map.robots().end(), is_mapped);
    if (joined_s_ == 0 && all_here && map.islands().size() == 1) joined_s_ = now;
    return true;
  }
  [[nodiscard]] MetRun report(ExploreRun run) && {
    const double joined_s = joined_s_ > 0 ? joined_s_ : run.sim_s;
    return {std::move(run), std::move(answers_), joined_s, wrong_merges_};
  }

 private:
  std::vector<Answer> answers_;
  double joined_s_ = 0;
  std::size_t merges_ = 0, wrong_merges_ = 0;
};

Result<MetRun> explore(const World& world, std::span<const std::size_t> starts, Policy policy, std::uint64_t seed) {
  ExploreJob job;
  job.world = world;
  job.simulation.seed = seed;
  for (const std::size_t start : starts) job.robots.push_back({world.starts[start]});
  const bool is_one_wing = starts[2] == kOneWing[2];
  job.robots[2].joins_at = job.robots[3].joins_at = is_one_wing ? kWhenGone : kWhenUnderWay;
  job.pilot.explorer.meet = policy == Policy::meet;
  job.pilot.greedy = policy == Policy::believe;
  job.longest = kLongest;
  Witness witness;
  job.observer = [&](double now, const LiveSimulation& simulation, const TeamPilot& pilot, const SimulatedRecording&) {
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
    return is_one != (answer.settled.outcome == MeetingOutcome::met);
  }));
}

/// By meetings: not what others learned by chance while two were on their way.
double answers_of(const MetRun& met, MeetingOutcome outcome) {
  return static_cast<double>(std::count_if(met.answers.begin(), met.answers.end(), [&](const Answer& answer) {
    return answer.settled.outcome == outcome && !answer.settled.by_chance;
  }));
}

/// How likely a sighting was where absence was counted least surely, percent.
double least_chance(const MetRun& met) {
  double least = 1;
  for (const Answer& answer : met.answers) least = std::min(least, answer.settled.chance);
  return 100 * least;
}

/// What is asked of each policy.
void report(std::vector<Metric>& metrics, const std::string& prefix, const MetRun& met, const MapQuality& quality) {
  metrics.push_back({prefix + "joined_s", met.joined_s});
  metrics.push_back({prefix + "explored_s", met.run.sim_s});
  metrics.push_back({prefix + "wrong_merges_count", static_cast<double>(met.wrong_merges)});
  metrics.push_back({prefix + "islands_count", static_cast<double>(met.run.map.mapper.map().islands().size())});
  metrics.push_back({prefix + "mapped_percent", 100 * quality.mapped_fraction});
  metrics.push_back({prefix + "collisions_count", static_cast<double>(met.run.contacts.size())});
}

/// Where the two of each meeting truly were when it was settled, and how all had got there.
ExperimentPicture draw_meetings(const World& world, const MetRun& met, const std::string& name) {
  std::vector<WorldNote> notes;
  double last = 0;
  for (const Answer& answer : met.answers) {
    const bool is_one = answer.settled.outcome == MeetingOutcome::met;
    notes.push_back({answer.T_world_watcher.translation(), answer.T_world_shown.translation(),
                     fmt::format("{} at {:.0f} s", is_one ? "met" : "distinct", answer.at_s)});
    last = answer.at_s;
  }
  std::vector<TrueTrack> until = met.run.recording.tracks();
  for (TrueTrack& track : until) {
    const auto end = std::upper_bound(track.stamps.begin(), track.stamps.end(), LiveSimulation::kFirstStamp + last);
    track.T_world_robot.resize(static_cast<std::size_t>(end - track.stamps.begin()));
  }
  return {name, draw_world(world, until, notes)};
}

ExperimentPicture draw_map(const MetRun& met, const std::string& name) {
  const Map& map = met.run.map.mapper.map();
  const MapReport islands = report_on(map, true);
  return {name, to_svg(draw_sketch(map, islands, islands.islands.front(), 1))};
}

/// What came of the meetings themselves.
std::vector<Metric> metrics_of(const MetRun& met, bool one_wing) {
  const double ones = answers_of(met, MeetingOutcome::met);
  const double distinct = answers_of(met, MeetingOutcome::absent);
  const double by_chance = static_cast<double>(met.answers.size()) - ones - distinct;
  // Of which kind there should be any follows from where the robots begin.
  return {one_wing ? Metric{"met_runs_ratio", ones > 0 ? 1.0 : 0.0}
                   : Metric{"distinct_runs_ratio", distinct > 0 ? 1.0 : 0.0},
          {"met_count", ones},
          {"distinct_count", distinct},
          {"joined_meanwhile_count", by_chance},
          {"settled_wrongly_count", static_cast<double>(wrong_answers(met))},
          {"least_chance_percent", least_chance(met)},
          {"first_settled_s", met.answers.empty() ? met.run.sim_s : met.answers.front().at_s}};
}

Result<Outcome> settle_doubts(const std::string& name, std::span<const std::size_t> starts, bool compare,
                              std::uint64_t seed) {
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
  Outcome outcome{metrics_of(*met, starts[2] == kOneWing[2]), {}};
  report(outcome.metrics, "", *met, judged(*met));
  if (!compare) return outcome;
  if (seed == 1) outcome.pictures = {draw_meetings(*world, *met, name), draw_map(*met, name + "-map")};
  for (const auto& [policy, prefix] : {std::pair{Policy::wait, "waiting"}, std::pair{Policy::believe, "greedy"}}) {
    const Result<MetRun> other = explore(*world, starts, policy, seed);
    if (!other) return tl::unexpected(other.error());
    report(outcome.metrics, prefix + std::string("_"), *other, judged(*other));
    if (seed == 1 && policy == Policy::believe) outcome.pictures.push_back(draw_map(*other, name + "-greedy"));
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
      "another begin one in either wing, the second half a minute later; or the second, three minutes later, "
      "elsewhere in the wing in which the first began. Where places of the two maps look alike and it is worth the "
      "way, a robot of either is sent: if the places were one they would see each other. Met: they did, at the two "
      "places or one of them on the way there; distinct: both stood there and did not, though a sighting would have "
      "been as likely as given (least chance); joined meanwhile: other robots saw each other by chance before. "
      "Settled wrongly: accepted, though the places are more than a metre from where that has them, or recorded as "
      "distinct though they are not. A merge is wrong if robots that it joins are more than a metre, and more than "
      "the map itself says (99 %), from where the map has them relative to one another. The same beside without "
      "rendezvous (waiting: islands are joined when robots happen to see each other) and with greedy closure (what "
      "looks alike is believed at once). Joined: both pairs are on one map. Explored: nothing is left to look at, "
      "and everybody is home, or 20 minutes are over. Each answer is to occur in half of the runs at least of the "
      "case in which it is asked for: a pair that begins where another has been must be met, though it is also told "
      "that it is not in the other wing. The pictures show the first run of each case: the building with the two of "
      "each meeting where they were when it was settled, and the map with meetings and with greedy closure.";
  e.bars = {{"met_runs_ratio", 0.5, std::nullopt, true, true},   {"distinct_runs_ratio", 0.5, std::nullopt, true, true},
            {"settled_wrongly_count", std::nullopt, 0.0, false}, {"least_chance_percent", 95.0, std::nullopt, false},
            {"wrong_merges_count", std::nullopt, 0.0, false},    {"collisions_count", std::nullopt, 0.0, false}};
  e.seeds = 10;
  e.quick_seeds = 1;
  e.cases = [](const ExperimentOptions& options) {
    const bool compare = !options.quick;
    const auto from = [compare](const std::string& name, std::span<const std::size_t> starts) {
      return ExperimentCase{name, true, "",
                            [=](std::uint64_t seed) { return settle_doubts(name, starts, compare, seed); }};
    };
    return std::vector<ExperimentCase>{from("either-wing", kEitherWing), from("one-wing", kOneWing)};
  };
  return e;
}

}  // namespace helicoid
