// helicoid ledger: what a map believes to be the same place, and an operator's word on it.
#include <CLI/CLI.hpp>
#include <filesystem>
#include <memory>

#include "apps/decisions_file.hpp"
#include "apps/map_command.hpp"
#include "apps/map_folder.hpp"
#include "apps/operator_decisions.hpp"
#include "apps/verb.hpp"
#include "helicoid/io/text_file.hpp"

namespace helicoid {

namespace {

struct LedgerArguments {
  std::string map;
  std::string action;
  std::size_t id = 0;
  std::vector<std::string> named;
  std::string out;
  bool no_charts = false;
  bool force = false;
  bool json = false;
};

int list_entries(const LedgerArguments& a) {
  const std::string path = map_folder(a.map) + "/ledger.json";
  const Result<std::vector<RecordedEntry>> ledger = read_ledger(path);
  if (!ledger) return report_failure(ledger.error().message);
  if (a.json) {
    fmt::print("{}", read_text_file(path)->text);
    return kDone;
  }
  fmt::print("{:>5} {:<9} {:<10} {:<26} {:<26} {:>6} {:>10}  {}\n", "id", "state", "source", "a", "b", "score",
             "ambiguity", "reason");
  for (std::size_t i = 0; i < ledger->size(); ++i) {
    const RecordedEntry& entry = (*ledger)[i];
    const Hypothesis& h = entry.hypothesis;
    fmt::print("{:>5} {:<9} {:<10} {:<26} {:<26} {:>6.2f} {:>10.2f}  {}\n", i, name_of(h.state), name_of(h.source),
               fmt::format("{}@{:.2f}", entry.a.robot, entry.a.stamp),
               fmt::format("{}@{:.2f}", entry.b.robot, entry.b.stamp), h.score, h.ambiguity, h.reason);
  }
  if (ledger->empty()) fmt::print("the ledger is empty: no two places of this map looked alike\n");
  return kDone;
}

LedgerAction action_of(const std::string& name) {
  if (name == "accept") return LedgerAction::accept;
  return name == "reject" ? LedgerAction::reject : LedgerAction::undo;
}

/// The decisions that a map was made with; none if it has no file of them.
Result<std::vector<Decision>> earlier_decisions(const std::string& folder) {
  const std::string path = folder + "/decisions.json";
  std::error_code error;
  if (!std::filesystem::exists(path, error)) return std::vector<Decision>{};
  return read_decisions(path);
}

int map_anew(const LedgerArguments& a) {
  const std::string folder = map_folder(a.map);
  const Result<std::vector<RecordedEntry>> ledger = read_ledger(folder + "/ledger.json");
  if (!ledger) return report_failure(ledger.error().message);
  Result<std::vector<Decision>> earlier = earlier_decisions(folder);
  if (!earlier) return report_failure(earlier.error().message);
  Result<OperatorDecisions> decided = decide(*ledger, std::move(*earlier), action_of(a.action), a.id);
  if (!decided) return report_failure(fmt::format("{}: {}", folder, decided.error().message));
  Result<MapArguments> again = arguments_of_map(folder, a.named);
  if (!again) return report_failure(again.error().message);
  fmt::print(stderr, "{} {}{}: mapping the logs again with it\n", a.action, fmt::join(decided->concerns, ", "),
             decided->concerns.size() > 1 ? " (they say the same)" : "");
  again->decisions = std::move(decided->decisions);
  again->out = a.out;
  again->no_charts = again->no_charts || a.no_charts;
  again->force = a.force;
  again->json = a.json;
  return run_map_command(*again);
}

}  // namespace

void add_ledger_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<LedgerArguments>();
  CLI::App* verb =
      program.add_subcommand("ledger", "List what a map believes to be the same place, or decide about it");
  verb->add_option("MAP", a->map, "a map's folder or its map.gpkg")->required();
  CLI::Option* action =
      verb->add_option("ACTION", a->action, "accept, reject or undo; without it the entries are listed")
          ->check(CLI::IsMember({"accept", "reject", "undo"}));
  CLI::Option* id = verb->add_option("ID", a->id, "the entry's id");
  CLI::Option* out = verb->add_option("--out", a->out, "the folder to write the map with that decision into");
  action->needs(id, out);
  verb->add_option("--robot", a->named, "NAME=LOG[,LOG...]: where a robot's logs are now, if they were moved")
      ->take_all();
  verb->add_flag("--no-charts", a->no_charts, "write no pictures");
  verb->add_flag("--force", a->force, "write into a folder that something else made");
  verb->add_flag("--json", a->json, "print one JSON object: the ledger, or the new map's summary");
  verb->footer(
      "Examples:\n  helicoid ledger site\n  helicoid ledger site reject 17 --out site2\n"
      "  helicoid ledger site2 undo 17 --out site3\n"
      "The logs are mapped again with the decision in force from the start: the same bytes as `helicoid map` with\n"
      "`--decisions site2/decisions.json`. What says the same as a rejected entry goes with it; undo takes the\n"
      "operator's word back, or leaves open what the program had accepted by itself.");
  verb->callback([a, &exit_code] { exit_code = a->action.empty() ? list_entries(*a) : map_anew(*a); });
}

}  // namespace helicoid
