// Is a closure that is taken back as though it had never been?
#include <map>

#include "apps/experiments/list.hpp"
#include "apps/experiments/recorded_data.hpp"
#include "apps/map_run.hpp"
#include "apps/operator_decisions.hpp"
#include "apps/simulated_run.hpp"
#include "helicoid/manifold/content_hash.hpp"

namespace helicoid {

namespace {

/// What one run of a log came to.
struct Mapped {
  ContentHash hash;
  std::vector<RecordedEntry> ledger;
};

Result<Mapped> mapped(const Mapper& mapper) {
  Result<std::vector<RecordedEntry>> ledger = parse_ledger(ledger_json(mapper.map(), mapper.ledger()), "ledger");
  if (!ledger) return tl::unexpected(ledger.error());
  return Mapped{content_hash(mapper.map()), std::move(*ledger)};
}

/// Maps the same events under these decisions.
using Replay = std::function<Result<Mapped>(const std::vector<Decision>&)>;

struct Counts {
  double tried = 0, changed = 0, not_restored = 0, not_repeated = 0;
};

/// An operator acts on an entry, and takes it back by its number in the new ledger.
Result<void> act_and_undo(const Replay& replay, const Mapped& base, LedgerAction action, std::size_t id,
                          Counts& counts) {
  const Result<OperatorDecisions> acted = decide(base.ledger, {}, action, id);
  if (!acted) return tl::unexpected(acted.error());
  const Result<Mapped> after = replay(acted->decisions);
  if (!after) return tl::unexpected(after.error());
  const Result<Mapped> again = replay(acted->decisions);
  if (!again) return tl::unexpected(again.error());
  const RecordedEntry& meant = base.ledger[id];
  std::size_t now = 0;
  while (now < after->ledger.size() &&
         (after->ledger[now].a.stamp != meant.a.stamp || after->ledger[now].b.stamp != meant.b.stamp)) {
    ++now;
  }
  const Result<OperatorDecisions> undone = decide(after->ledger, acted->decisions, LedgerAction::undo, now);
  if (!undone) return tl::unexpected(undone.error());
  const Result<Mapped> restored = replay(undone->decisions);
  if (!restored) return tl::unexpected(restored.error());
  ++counts.tried;
  counts.changed += after->hash != base.hash ? 1 : 0;
  counts.not_repeated += again->hash != after->hash ? 1 : 0;
  counts.not_restored += restored->hash != base.hash ? 1 : 0;
  return {};
}

/// Every set that the run accepted by itself is taken back and that is undone; every entry that it left open is
/// accepted and that is undone: as many as `most` of each, spread over the ledger.
Result<Outcome> act_on_all(const Replay& replay, std::size_t most) {
  const double began = thread_cpu_seconds();
  const Result<Mapped> base = replay({});
  if (!base) return tl::unexpected(base.error());
  std::map<std::size_t, std::size_t> sets;  // its entries by what completed it
  std::vector<std::size_t> closures;
  std::vector<std::size_t> open;
  for (std::size_t i = 0; i < base->ledger.size(); ++i) {
    const Hypothesis& h = base->ledger[i].hypothesis;
    if (h.state == HypothesisState::open) open.push_back(i);
    if (h.state == HypothesisState::accepted && sets.emplace(h.decided_with.value_or(i), i).second)
      closures.push_back(i);
  }
  Counts counts;
  const auto act = [&](const std::vector<std::size_t>& ids, LedgerAction action) -> Result<void> {
    const std::size_t stride = ids.size() / (most + 1) + 1;
    for (std::size_t k = 0; k < ids.size(); k += stride) {
      if (auto done = act_and_undo(replay, *base, action, ids[k], counts); !done) return done;
    }
    return {};
  };
  if (auto done = act(closures, LedgerAction::reject); !done) return tl::unexpected(done.error());
  if (auto done = act(open, LedgerAction::accept); !done) return tl::unexpected(done.error());
  return Outcome{{{"closures_count", static_cast<double>(closures.size())},
                  {"tried_count", counts.tried},
                  {"changed_the_map_count", counts.changed},
                  {"not_repeated_count", counts.not_repeated},
                  {"not_restored_count", counts.not_restored},
                  {"cpu_s", thread_cpu_seconds() - began}},
                 {}};
}

Result<Outcome> undo_in_simulation(const std::string& world_name, std::uint64_t seed, std::size_t most) {
  const Result<World> world = load_world(world_name);
  if (!world) return tl::unexpected(world.error());
  SimulationOptions options;
  options.laps = 2;
  options.seed = seed;
  return act_on_all(
      [&](const std::vector<Decision>& decisions) -> Result<Mapped> {
        MapperOptions mapper;
        mapper.decisions = decisions;
        const Result<SimulatedRun> run = map_simulation(*world, options, mapper);
        if (!run) return tl::unexpected(run.error());
        return mapped(run->mapper);
      },
      most);
}

Result<Outcome> undo_in_log(const std::string& log, std::size_t most) {
  return act_on_all(
      [&](const std::vector<Decision>& decisions) -> Result<Mapped> {
        MapJob job;
        job.robots = {{"robot1", {log}}};
        job.mapper.decisions = decisions;
        const Result<MapRun> run = run_map(job);
        if (!run) return tl::unexpected(run.error());
        return mapped(run->mapper);
      },
      most);
}

std::vector<ExperimentCase> list_cases(const ExperimentOptions& options) {
  const std::size_t most = options.quick ? 1 : 100;
  std::vector<ExperimentCase> cases;
  for (const std::string log : {"intel", "fr079"}) {
    const std::string path = fmt::format("{}/{}/{}.clf.gz", options.data, log, log);
    cases.push_back({log, false, missing_data(options, log), [=](std::uint64_t) { return undo_in_log(path, most); }});
  }
  for (const std::string world : {"loop", "office"}) {
    cases.push_back({world, true, "", [=](std::uint64_t seed) { return undo_in_simulation(world, seed, most); }});
  }
  return cases;
}

}  // namespace

Experiment undo_experiment() {
  Experiment e;
  e.name = "undo";
  e.question = "Is a closure that is taken back as though it had never been?";
  e.method =
      "Every set of entries that the program accepted by itself is rejected by an operator, every entry that it left "
      "open is accepted, and then that word is taken back: each step is a replay of the same events under the "
      "decisions "
      "that then stand. Maps are compared to the bit: the map under a decision with that of a second run that was "
      "given "
      "it from the start, and the map after taking it back with one about which nobody ever decided.";
  e.bars = {{"not_repeated_count", std::nullopt, 0.0, false}, {"not_restored_count", std::nullopt, 0.0, false}};
  e.seeds = 3;
  e.quick_seeds = 1;
  e.cases = list_cases;
  return e;
}

}  // namespace helicoid
