// helicoid corrupt: the same logs with lies in them.
#include <CLI/CLI.hpp>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/corruption.hpp"
#include "apps/output_folder.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

struct CorruptArguments {
  std::vector<std::string> logs;
  std::vector<std::string> named;
  std::string out;
  CorruptionOptions options;
  bool force = false;
  bool json = false;
};

Json to_json(const CorruptArguments& a, const Corruption& corruption) {
  Json lies = Json::array();
  for (const Lie& lie : corruption.lies) {
    lies.push_back({{"robot", lie.robot}, {"stamp", lie.stamp}, {"message", lie.line}});
  }
  Json logs = Json::array();
  for (const RobotLogs& robot : corruption.robots) logs.push_back(robot.paths.front());
  return {{"format", "helicoid-lies"},
          {"version", HELICOID_VERSION},
          {"options",
           {{"false_sightings", a.options.false_sightings},
            {"false_lookalikes", a.options.false_lookalikes},
            {"unidentified", a.options.unidentified},
            {"seed", a.options.seed}}},
          {"logs", logs},
          {"true_sightings", corruption.true_sightings},
          {"lies", lies}};
}

int run_verb(const CorruptArguments& a) {
  const Result<std::vector<RobotLogs>> robots = name_robots(a.logs, a.named);
  if (!robots) return report_failure(robots.error().message);
  const Result<OutputFolder> folder = OutputFolder::open(a.out, "lies.json", a.force);
  if (!folder) return report_failure(folder.error().message);
  const Result<Corruption> corruption = corrupt_logs(*robots, a.options, a.out);
  if (!corruption) return report_failure(corruption.error().message);
  const Json json = to_json(a, *corruption);
  if (auto done = write_whole_file(a.out + "/lies.json", json.dump(1) + "\n"); !done) {
    return report_failure(done.error().message);
  }
  if (a.json) {
    fmt::print("{}\n", json.dump(1));
  } else {
    fmt::print("lies       {} beside {} true sightings\n", corruption->lies.size(), corruption->true_sightings);
    for (const RobotLogs& robot : corruption->robots) fmt::print("log        {}\n", robot.paths.front());
    fmt::print("which      {}/lies.json\n", a.out);
  }
  return kDone;
}

}  // namespace

void add_corrupt_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<CorruptArguments>();
  CLI::App* verb = program.add_subcommand("corrupt", "Copy logs with false sightings and look-alikes put into them");
  verb->add_option("LOG", a->logs, "CARMEN logs, plain or .gz; each is a robot named by its base name");
  verb->add_option("--robot", a->named, "NAME=LOG[,LOG...]: a robot with a name and one or more logs")->take_all();
  verb->add_option("--out", a->out, "the folder to write into")->required();
  verb->add_option("--false-sightings", a->options.false_sightings, "sightings of robots that are not there");
  verb->add_option("--false-lookalikes", a->options.false_lookalikes,
                   "places that are said to be the same and are not");
  verb->add_option("--unidentified", a->options.unidentified, "share of the false sightings that name nobody, 0 to 1")
      ->check(CLI::Range(0.0, 1.0));
  verb->add_option("--seed", a->options.seed, "the same seed gives the same bytes")->capture_default_str();
  verb->add_flag("--force", a->force, "write into a folder that something else made");
  verb->add_flag("--json", a->json, "print lies.json");
  verb->footer(
      "Example:\n  helicoid corrupt team/robot1.clf.gz team/robot2.clf.gz --false-sightings 20 --unidentified 0.5 \\\n"
      "      --out lies\n"
      "A map of the result should be that of the originals; `helicoid ledger` tells what it believed.");
  verb->callback([a, &exit_code] {
    if (a->logs.empty() && a->named.empty()) throw CLI::RequiredError("LOG or --robot");
    exit_code = run_verb(*a);
  });
}

}  // namespace helicoid
