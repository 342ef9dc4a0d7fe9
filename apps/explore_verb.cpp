// helicoid explore: a team maps a simulated building on its own.
#include <CLI/CLI.hpp>
#include <cmath>
#include <memory>

#include "apps/explore_outputs.hpp"
#include "apps/explore_run.hpp"
#include "apps/orders_file.hpp"
#include "apps/output_folder.hpp"
#include "apps/progress_bar.hpp"
#include "apps/verb.hpp"
#include "helicoid/simulation/starts.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

struct ExploreArguments {
  std::string world;
  std::string out;
  std::size_t robots = 2;
  std::string starts;
  std::uint64_t seed = 1;
  int people = 0;
  double longest = 3600;
  double charge = 0;
  std::string join = "sightings";
  std::string orders;
  int threads = 1;
  bool no_charts = false;
  bool force = false;
  bool json = false;
};

Json options_json(const ExploreArguments& a) {
  return {{"world", a.world},   {"robots", a.robots},     {"starts", a.starts},   {"seed", a.seed},
          {"people", a.people}, {"longest_s", a.longest}, {"charge_m", a.charge}, {"join", a.join},
          {"orders", a.orders}, {"charts", !a.no_charts}};
}

/// Hands out orders when their time has come.
std::function<std::vector<Order>(double, const Map&)> order_giver(std::vector<TimedOrder> orders) {
  auto left = std::make_shared<std::vector<TimedOrder>>(std::move(orders));
  return [left](double now, const Map& map) {
    std::vector<Order> due;
    while (!left->empty() && left->front().at <= now) {
      const std::optional<Order> order = place_order(left->front(), map);
      if (order) {
        due.push_back(*order);
      } else {
        report_warning(fmt::format("the order for {} at {} s is lost: there is no such robot with a map",
                                   left->front().robot.empty() ? "all" : left->front().robot, left->front().at));
      }
      left->erase(left->begin());
    }
    return due;
  };
}

void print_report(const ExploreRun& run, const Json& summary, const ExploreArguments& a,
                  const std::vector<std::string>& files) {
  fmt::print("end        {}: {}\n", run.end_state, summary["reason"].get<std::string>());
  fmt::print("mapped     {:.2f} % of the floor that robots can reach\n",
             100 * summary["mapped_fraction"].get<double>());
  fmt::print("walls      {:.3f} m RMS, {:.1f} % of those in view\n", summary["wall_rms_m"].get<double>(),
             100 * summary["wall_recall"].get<double>());
  fmt::print("islands    {} at the end, {} merges; {} collisions\n", summary["island_count"].get<std::size_t>(),
             run.merges, run.contacts.size());
  fmt::print("time       {:.0f} s in the building, {:.1f} s of CPU ({:.0f} times real time)\n", run.sim_s, run.cpu_s,
             run.realtime_factor());
  fmt::print("logs       {0}/robot1.clf.gz...; truth {0}/truth; what happened {0}/events.json\n", a.out);
  for (const std::string& file : files) fmt::print("picture    {}\n", file);
}

int finish(ExploreRun& run, const ExploreJob& job, const ExploreArguments& a) {
  const Result<ExploreFiles> written = write_exploration(run, job, {a.out, options_json(a), !a.no_charts, a.threads});
  if (!written) return report_failure(written.error().message);
  for (const Skipped& s : run.map.skipped) report_warning(fmt::format("{} x {}", s.count, s.reason));
  if (a.json) {
    fmt::print("{}\n", written->summary.dump(1));
  } else {
    print_report(run, written->summary, a, written->pictures);
  }
  return run.last_plan.finished && run.last_plan.end_state == EndState::explored ? kDone : kNotAsAsked;
}

int run_verb(const ExploreArguments& a) {
  Result<World> world = load_world(a.world);
  if (!world) return report_failure(world.error().message);
  ExploreJob job;
  job.world = *world;
  job.simulation.seed = a.seed;
  job.simulation.people = a.people;
  job.longest = a.longest;
  if (a.charge > 0) job.simulation.metres_per_charge = job.pilot.explorer.metres_per_charge = a.charge;
  job.pilot.mapper.join_on_evidence = a.join == "evidence";
  StartOptions start_options;
  start_options.robots = a.robots;
  start_options.seed = a.seed;
  start_options.radius = job.simulation.radius;
  const Result<std::vector<Pose2>> starts = choose_starts(*world, a.starts, start_options);
  if (!starts) return report_failure(starts.error().message);
  for (const Pose2& start : *starts) job.robots.push_back({start});
  if (!a.orders.empty()) {
    Result<std::vector<TimedOrder>> orders = read_orders(a.orders);
    if (!orders) return report_failure(orders.error().message);
    job.orders = order_giver(std::move(*orders));
  }
  const Result<OutputFolder> folder = OutputFolder::open(a.out, "summary.json", a.force);
  if (!folder) return report_failure(folder.error().message);
  ProgressBar bar;
  job.observer = [&bar](double now, const LiveSimulation&, const TeamPilot& pilot, const SimulatedRecording&) {
    bar.say(fmt::format("exploring: {:.0f} s, {} patches, {} frontiers", now, pilot.map().patch_count(),
                        pilot.team_plan().frontiers.size()));
    return true;
  };
  Result<ExploreRun> run = run_exploration(job);
  if (!run) return report_failure(run.error().message);
  folder->clear_old_results();
  return finish(*run, job, a);
}

void add_options(CLI::App& verb, ExploreArguments& a) {
  verb.add_option("WORLD", a.world,
                  fmt::format("a shipped world ({}), an SVG in metres (classes wall, start, door), or an occupancy "
                              "image's MAP.yaml",
                              fmt::join(shipped_worlds(), ", ")))
      ->required();
  verb.add_option("--out", a.out, "the folder to write into")->required();
  verb.add_option("--robots", a.robots, "how many robots")->check(CLI::Range(1, 64))->capture_default_str();
  verb.add_option(
      "--starts", a.starts,
      "a file of lines `x y yaw_deg`, or auto: two groups far from one another; default: the world's own, if there are "
      "enough");
  verb.add_option("--seed", a.seed, "the same seed gives the same bytes")->capture_default_str();
  verb.add_option("--people", a.people, "people who walk about")->check(CLI::Range(0, 1000))->capture_default_str();
  verb.add_option("--longest", a.longest, "seconds in the building after which it is over")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb.add_option("--charge", a.charge, "metres that a battery drives: a robot goes home in time; 0: it never runs low")
      ->check(CLI::NonNegativeNumber)
      ->capture_default_str();
  verb.add_option("--join", a.join, "what may join islands")
      ->check(CLI::IsMember({"sightings", "evidence"}))
      ->capture_default_str();
  verb.add_option("--orders", a.orders, "an operator's orders: a file of timed lines, or - for stdin");
  verb.add_option("--threads", a.threads, "threads that draw")->check(CLI::Range(1, 64))->capture_default_str();
  verb.add_flag("--no-charts", a.no_charts, "write no pictures");
  verb.add_flag("--force", a.force, "write into a folder that something else made");
  verb.add_flag("--json", a.json, "print summary.json");
}

}  // namespace

void add_explore_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<ExploreArguments>();
  CLI::App* verb = program.add_subcommand("explore", "Let a team explore a simulated building on its own");
  add_options(*verb, *a);
  verb->footer(
      "Examples:\n  helicoid explore office --robots 4 --out site\n"
      "  helicoid explore site/map.yaml --robots 2 --starts auto --seed 3 --out again\n"
      "  echo '60 robot1 send 3 4' | helicoid explore office --orders - --out sent\n"
      "Nobody tells the robots where they start; robots that see each other join their maps. Then:\n"
      "  helicoid map site/robot*.clf.gz --out offline");
  verb->callback([a, &exit_code] { exit_code = run_verb(*a); });
}

}  // namespace helicoid
