// helicoid map: logs in, a map out.
#include <CLI/CLI.hpp>
#include <memory>

#include "apps/map_command.hpp"
#include "apps/verb.hpp"

namespace helicoid {

void add_map_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<MapArguments>();
  CLI::App* verb = program.add_subcommand("map", "Map the logs of one or more robots");
  verb->add_option(
      "LOG", a->logs,
      "CARMEN logs, plain or .gz, - for stdin; each is a robot named by its base name; or one MRCLAM folder");
  verb->add_option("--robot", a->named, "NAME=LOG[,LOG...]: a robot with a name and one or more logs")->take_all();
  verb->add_option("--out", a->out, "the folder to write into")->required();
  verb->add_option("--laser", a->laser, "a laser's name (sick-lms200, hokuyo-urg, ...) or a file; default: recognised");
  verb->add_option("--join", a->join, "what may join islands")
      ->check(CLI::IsMember({"sightings", "evidence"}))
      ->capture_default_str();
  verb->add_option("--decisions", a->decisions_file,
                   "what an operator decided about the ledger's entries (decisions.json, written by `ledger`)");
  verb->add_option("--every", a->every, "map only every N-th scan")->check(CLI::PositiveNumber)->capture_default_str();
  verb->add_option("--from", a->from, "start this many seconds after a robot's first scan");
  verb->add_option("--to", a->to, "stop this many seconds after a robot's first scan");
  verb->add_option("--threads", a->threads, "threads that draw; the result does not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_flag("--no-charts", a->no_charts, "write no pictures");
  verb->add_flag("--no-closures", a->no_closures, "close no loops: a loop stays a spiral");
  verb->add_flag("--online", a->online,
                 "trajectories: each pose as the robot would have had it then, not as it is known now");
  verb->add_flag("--force", a->force, "write into a folder that something else made");
  verb->add_flag("--json", a->json, "print the summary as one JSON object");
  verb->footer(
      "Examples:\n  helicoid map robot1.log.gz --out site\n"
      "  helicoid map a.log b.log --out team --threads 2\n"
      "  helicoid map mrclam6 --out five-robots\n"
      "  helicoid map --robot r2=monday.log,tuesday.log --out site --no-charts --json");
  verb->callback([a, &exit_code] {
    if (a->logs.empty() && a->named.empty()) throw CLI::RequiredError("LOG or --robot");
    exit_code = run_map_command(*a);
  });
}

}  // namespace helicoid
