// helicoid simulate: logs of robots in a world that is known, with the truth beside them.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/output_folder.hpp"
#include "apps/progress_bar.hpp"
#include "apps/simulated_recording.hpp"
#include "apps/simulated_run.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/io/relations_file.hpp"
#include "helicoid/simulation/tour.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

struct SimulateArguments {
  std::string world;
  std::string out;
  SimulationOptions simulation;
  double rate = 5;  ///< scans a second
  double laser_noise = 1;
  double odometry_noise = 1;
  bool no_sightings = false;
  bool same_way = false;
  bool force = false;
  bool json = false;
};

struct Recording {
  SimulatedRecording robots;
  double closest_approach = 0;  ///< of two robots, metres
};

Recording record(Simulator& simulator, const SimulateArguments& a) {
  Recording recording{{static_cast<std::size_t>(a.simulation.robots), "simulate"}, 0};
  ProgressBar bar;
  while (const std::optional<SimulatedEvent> event = simulator.next()) {
    recording.robots.note(event->event, event->T_world_robot);
    if (recording.robots.scans() % 64 == 0) bar.show(simulator.progress(), "simulating");
  }
  recording.closest_approach = simulator.closest_approach();
  return recording;
}

std::vector<TrueRelation> relations_of(const SimulatedRecording& recording, std::uint64_t seed) {
  std::vector<TrueRelation> relations;
  for (const EvaluatedRelation& r : true_relations(recording.tracks(), seed)) {
    relations.push_back({r.robot_a, r.stamp_a, r.robot_b, r.stamp_b, r.T_a_b});
  }
  return relations;
}

/// What was asked for and what came of it.
Json to_json(const SimulateArguments& a, const Recording& recording, std::size_t relations) {
  const SimulationOptions& s = a.simulation;
  return {{"format", "helicoid-simulation"},
          {"version", HELICOID_VERSION},
          {"options",
           {{"world", a.world},
            {"robots", s.robots},
            {"seed", s.seed},
            {"laps", s.laps},
            {"rate_hz", a.rate},
            {"people", s.people},
            {"alternate", s.alternate},
            {"laser_noise", a.laser_noise},
            {"odometry_noise", a.odometry_noise},
            {"speed_m_s", s.limits.speed},
            {"sightings", s.sightings},
            {"sighting_range_m", s.sighting_range},
            {"sighting_view_deg", degrees(s.sighting_view)}}},
          {"scans", recording.robots.scans()},
          {"odometry", recording.robots.odometry()},
          {"sightings", recording.robots.sightings()},
          {"seconds", std::round(1000 * recording.robots.seconds()) / 1000},
          {"metres", std::round(100 * recording.robots.metres()) / 100},
          {"closest_approach_m", s.robots > 1 ? Json(std::round(1000 * recording.closest_approach) / 1000) : Json()},
          {"relations", relations}};
}

Result<Json> write_recording(const World& world, const Recording& recording, const SimulateArguments& a) {
  if (auto done = recording.robots.write(world, a.out); !done) return tl::unexpected(done.error());
  const std::vector<TrueRelation> relations = relations_of(recording.robots, a.simulation.seed);
  const Json summary = to_json(a, recording, relations.size());
  const std::string text =
      recording.robots.tracks().size() > 1 ? to_relations_text(relations) : to_single_robot_relations_text(relations);
  if (auto done = write_whole_file(a.out + "/truth.relations", text); !done) return tl::unexpected(done.error());
  if (auto done = write_whole_file(a.out + "/simulation.json", summary.dump(1) + "\n"); !done) {
    return tl::unexpected(done.error());
  }
  return summary;
}

/// The world, with a tour of it if it brings no route.
Result<World> load_drivable_world(const std::string& name) {
  Result<World> world = load_world(name);
  if (!world || !world->routes.empty()) return world;
  Result<Route> tour = plan_tour(*world);
  if (!tour) return tl::unexpected(tour.error());
  world->routes.push_back(std::move(*tour));
  return world;
}

void print_report(const World& world, const SimulatedRecording& recording, const Json& summary,
                  const std::string& out) {
  fmt::print("world      {}: {} walls, {} routes\n", world.name, world.walls.size(), world.routes.size());
  fmt::print("drive      {} robots, {:.0f} m, {:.0f} s\n", recording.tracks().size(), recording.metres(),
             recording.seconds());
  fmt::print("events     {} scans, {} odometry, {} sightings\n", recording.scans(), recording.odometry(),
             recording.sightings());
  for (const TrueTrack& track : recording.tracks()) fmt::print("log        {}/{}.clf.gz\n", out, track.robot);
  fmt::print("truth      {0}/truth, {0}/truth.relations ({1})\npicture    {0}/world.svg\n", out,
             summary["relations"].get<std::size_t>());
}

int run_verb(SimulateArguments a) {
  const Result<World> world = load_drivable_world(a.world);
  if (!world) return report_failure(world.error().message);
  a.simulation.scan_period = 1 / a.rate;
  a.simulation.laser_noise = scaled(a.simulation.laser_noise, a.laser_noise);
  a.simulation.odometry_noise = scaled(a.simulation.odometry_noise, a.odometry_noise);
  a.simulation.alternate = !a.same_way;
  a.simulation.sightings = a.simulation.robots > 1 && !a.no_sightings;
  Result<Simulator> simulator = Simulator::make(*world, a.simulation);
  if (!simulator) return report_failure(simulator.error().message);
  const Result<OutputFolder> folder = OutputFolder::open(a.out, "simulation.json", a.force);
  if (!folder) return report_failure(folder.error().message);
  folder->clear_old_results();
  const Recording recording = record(*simulator, a);
  const Result<Json> summary = write_recording(*world, recording, a);
  if (!summary) return report_failure(summary.error().message);
  if (a.json) {
    fmt::print("{}\n", summary->dump(1));
  } else {
    print_report(*world, recording.robots, *summary, a.out);
  }
  return kDone;
}

void add_options(CLI::App& verb, SimulateArguments& a) {
  SimulationOptions& s = a.simulation;
  verb.add_option(
          "WORLD", a.world,
          fmt::format("a shipped world ({}), an SVG in metres (classes wall, start, door, route), or an occupancy "
                      "image's MAP.yaml",
                      fmt::join(shipped_worlds(), ", ")))
      ->required();
  verb.add_option("--out", a.out, "the folder to write into")->required();
  verb.add_option("--robots", s.robots, "how many robots, spread over the routes")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb.add_option("--seed", s.seed, "the same seed gives the same bytes")->capture_default_str();
  verb.add_option("--laps", s.laps, "how often each drives its route; out and back is one lap of an open route")
      ->check(CLI::Range(1, 100000))
      ->capture_default_str();
  verb.add_option("--rate", a.rate, "scans a second; the period is rounded to 0.05 s")
      ->check(CLI::Range(0.1, 20.0))
      ->capture_default_str();
  verb.add_option("--people", s.people, "people who walk about")->check(CLI::Range(0, 1000))->capture_default_str();
  verb.add_option("--laser-noise", a.laser_noise, "times what an LMS200 has; 0: exact ranges")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb.add_option("--odometry-noise", a.odometry_noise, "times what a good base has; 0: exact odometry")
      ->check(CLI::Range(0.0, 100.0))
      ->capture_default_str();
  verb.add_option("--speed", s.limits.speed, "metres a second")->check(CLI::Range(0.05, 3.0))->capture_default_str();
  verb.add_flag("--same-way", a.same_way,
                "all robots drive a closed route the same way; default: every second the other");
  verb.add_flag("--no-sightings", a.no_sightings, "robots do not report one another (a single one never does)");
  verb.add_option("--sighting-range", s.sighting_range, "how far a robot recognises another, metres")
      ->check(CLI::Range(0.5, 80.0))
      ->capture_default_str();
  verb.add_flag("--force", a.force, "write into a folder that something else made");
  verb.add_flag("--json", a.json, "print what was simulated as one JSON object");
}

}  // namespace

void add_simulate_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<SimulateArguments>();
  CLI::App* verb = program.add_subcommand("simulate", "Drive robots through a known world: logs, and the truth");
  add_options(*verb, *a);
  verb->footer(
      "Examples:\n  helicoid simulate office --out sim\n"
      "  helicoid simulate loop --laps 10 --seed 7 --out laps\n"
      "  helicoid simulate office --robots 3 --people 5 --out team\n"
      "  helicoid simulate site/map.yaml --odometry-noise 2 --out again\n"
      "Then: helicoid map sim/robot1.clf.gz --out site && helicoid eval site --relations sim/truth.relations");
  verb->callback([a, &exit_code] { exit_code = run_verb(*a); });
}

}  // namespace helicoid
