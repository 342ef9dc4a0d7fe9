// Is a building that looks the same all round left open until something tells where one is?
#include <cmath>

#include "apps/experiments/false_closures.hpp"
#include "apps/experiments/list.hpp"
#include "apps/world_picture.hpp"
#include "helicoid/simulation/buildings.hpp"

namespace helicoid {

namespace {

constexpr int kLaps = 2;
/// Something is seen when so many beams of a scan end on it.
constexpr int kBeams = 10;

/// When, on the last lap, a beam first ended on what breaks the symmetry, and when kBeams of one scan first did.
class Watch {
 public:
  explicit Watch(std::span<const Segment> breaker) : breaker_(breaker) {}
  void look(const SimulatedEvent& simulated) {
    const auto* scan = std::get_if<Scan>(&simulated.event.body);
    if (scan == nullptr || simulated.lap < kLaps - 1 || seen_ < HUGE_VAL) return;
    const LaserModel laser = simulated_lms200();
    int beams = 0;
    for (std::size_t i = 0; i < scan->ranges.size(); ++i) {
      const double bearing = laser.bearing(static_cast<int>(i));
      const double range = static_cast<double>(scan->ranges[i]);
      if (range >= laser.max_range) continue;
      const Pose2 T_world_laser = simulated.T_world_robot * scan->T_robot_laser;
      const Vector2d end = T_world_laser * Vector2d(range * std::cos(bearing), range * std::sin(bearing));
      beams += is_on_breaker(end) ? 1 : 0;
    }
    if (beams > 0) glimpsed_ = std::min(glimpsed_, simulated.event.stamp);
    if (beams >= kBeams) seen_ = simulated.event.stamp;
  }
  [[nodiscard]] double glimpsed() const { return glimpsed_; }
  [[nodiscard]] double seen() const { return seen_; }

 private:
  [[nodiscard]] bool is_on_breaker(const Vector2d& p) const {
    const auto near = [&](const Segment& s) {
      const Vector2d along = s.to - s.from;
      const double share = std::clamp((p - s.from).dot(along) / along.squaredNorm(), 0.0, 1.0);
      return (s.from + share * along - p).norm() < 0.1;
    };
    return std::any_of(breaker_.begin(), breaker_.end(), near);
  }
  std::span<const Segment> breaker_;
  double glimpsed_ = HUGE_VAL, seen_ = HUGE_VAL;
};

/// An accepted entry between two laps.
bool is_closure(const Map& map, const Hypothesis& h) {
  constexpr double kHalfLap = 80;  // seconds
  return h.state == HypothesisState::accepted && map.patch(h.b).stamp - map.patch(h.a).stamp > kHalfLap;
}

/// What the mapper had accepted, and when it first did.
struct Closing {
  double before = 0;        ///< entries accepted before anything broke the symmetry
  double stamp = HUGE_VAL;  ///< when the first was accepted
};

struct Observed {
  SimulatedRun run;
  Closing closing;
  double seen = HUGE_VAL;
};

Result<Observed> drive(const World& world, std::span<const Segment> breaker, std::uint64_t seed) {
  Watch watch(breaker);
  Closing closing;
  const auto observe = [&](const SimulatedEvent& simulated, const Step& step, const Mapper& mapper) {
    watch.look(simulated);
    if (!step.new_patch.valid()) return;
    double accepted = 0;
    for (const Hypothesis& h : mapper.ledger()) accepted += is_closure(mapper.map(), h) ? 1 : 0;
    if (accepted > 0 && std::isinf(closing.stamp)) closing.stamp = simulated.event.stamp;
    if (std::isinf(watch.glimpsed())) closing.before = accepted;
  };
  SimulationOptions options;
  options.seed = seed;
  options.laps = kLaps;
  Result<SimulatedRun> run = map_simulation(world, options, {}, observe);
  if (!run) return tl::unexpected(run.error());
  return Observed{std::move(*run), closing, watch.seen()};
}

/// Accepted entries that are off by more than they say themselves, and those that name what told the place from others.
struct Judged {
  double accepted = 0, wrong = 0, naming = 0;
};
Judged judge(const SimulatedRun& run) {
  Judged judged;
  for (const Hypothesis& h : run.mapper.ledger()) {
    if (!is_closure(run.map(), h)) continue;
    ++judged.accepted;
    judged.wrong += is_false(run, h) ? 1 : 0;
    judged.naming += h.reason.find("tells it from places that look alike") != std::string::npos ? 1 : 0;
  }
  return judged;
}

Result<Outcome> without_breaker(std::uint64_t seed) {
  const Result<Observed> o = drive(make_smooth_ring(), {}, seed);
  if (!o) return tl::unexpected(o.error());
  const Judged judged = judge(o->run);
  return Outcome{{{"closures_while_symmetric_count", judged.accepted},
                  {"open_entries_count", static_cast<double>(o->run.mapper.ledger().size()) - judged.accepted}},
                 {}};
}

Result<Outcome> with_breaker(std::uint64_t seed) {
  Random random(seed);
  World world = make_smooth_ring();
  const std::vector<Segment> breaker = cupboard_in_ring(random.uniform(2.0, 4.5));
  world.walls.insert(world.walls.end(), breaker.begin(), breaker.end());
  const Result<Observed> o = drive(world, breaker, seed);
  if (!o) return tl::unexpected(o.error());
  const Judged judged = judge(o->run);
  Outcome outcome{{{"closures_while_symmetric_count", o->closing.before},
                   {"closed_after_s", o->closing.stamp - o->seen},
                   {"closures_count", judged.accepted},
                   {"false_closures_count", judged.wrong},
                   {"named_count", judged.naming},
                   {"error_max_m", relation_error(o->run, seed).translation_m.max}},
                  {}};
  if (seed == 1) outcome.pictures.push_back({"ring", draw_world(world, o->run.tracks)});
  return outcome;
}

}  // namespace

Experiment symmetry_experiment() {
  Experiment e;
  e.name = "symmetry";
  e.question = "Is a building that looks the same all round left open until something tells where one is?";
  e.method = fmt::format(
      "A round corridor with smooth walls looks the same from everywhere: all that tells how far round a robot is is "
      "its odometry. Two laps. Alone it must never be closed. With one cupboard somewhere beyond the first third, it "
      "must not be closed on the second lap before a beam has ended on that, and at the latest 5 s after {} beams of "
      "one scan did. No accepted entry may be off by more than {} m and more than it says itself (99 %), and their "
      "reasons must name what told the place from those that look alike.",
      kBeams, kFalseBy);
  e.bars = {{"closures_while_symmetric_count", std::nullopt, 0.0, false},
            {"closed_after_s", std::nullopt, 5.0, false},
            {"false_closures_count", std::nullopt, 0.0, false},
            {"named_count", 1.0, std::nullopt, false}};
  e.seeds = 10;
  e.quick_seeds = 2;
  e.cases = [](const ExperimentOptions&) {
    return std::vector<ExperimentCase>{{"ring", true, "", without_breaker},
                                       {"ring-with-cupboard", true, "", with_breaker}};
  };
  return e;
}

}  // namespace helicoid
