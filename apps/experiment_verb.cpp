// helicoid experiment: a question about the program, answered with numbers and judged by bars.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>

#include "apps/experiment_page.hpp"
#include "apps/progress_bar.hpp"
#include "apps/repository.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

struct ExperimentArguments {
  std::string name;
  ExperimentOptions options;
  std::string docs;
  std::string json;
};

void list_experiments() {
  for (const Experiment& e : experiments()) {
    fmt::print("{:<12} {}\n", e.name, e.question);
    for (const Bar& bar : e.bars) fmt::print("{:<12}   {}: {}\n", "", bar.metric, describe(&bar));
  }
}

std::string names() {
  std::string all;
  for (const Experiment& e : experiments()) all += (all.empty() ? "" : ", ") + e.name;
  return all;
}

/// A short or partial run does not replace the page of the whole one, unless it is told where to write.
int write_page(const Experiment& experiment, const ExperimentArguments& a, const ExperimentReport& report) {
  std::string folder = a.docs;
  if (folder.empty() && !a.options.quick && a.options.seeds == 0) {
    const std::string repository = find_repository();
    if (!repository.empty()) folder = repository + "/docs/experiments";
  }
  if (folder.empty()) return kDone;
  if (auto done = write_experiment_page(experiment, a.options, report, folder); !done) {
    return report_failure(done.error().message);
  }
  std::fflush(stdout);  // or this stands in the middle of the table where both go to one file
  fmt::print(stderr, "page: {}/{}.md\n", folder, experiment.name);
  return kDone;
}

int run_verb(ExperimentArguments a) {
  if (a.name == "list") {
    list_experiments();
    return kDone;
  }
  const auto found =
      std::find_if(experiments().begin(), experiments().end(), [&](const Experiment& e) { return e.name == a.name; });
  if (found == experiments().end()) {
    report_failure(fmt::format("{}: is no experiment; there are {} (and `experiment list`)", a.name, names()));
    return kUsage;
  }
  if (a.options.data.empty()) a.options.data = find_recorded_data();
  ProgressBar bar;
  const Result<ExperimentReport> report =
      run_experiment(*found, a.options, [&](double share) { bar.show(share, found->name.c_str()); });
  if (!report) return report_failure(report.error().message);
  for (const SkippedCase& s : report->skipped) report_warning(fmt::format("skipped: {}: {}", s.name, s.reason));
  if (a.json != "-") {
    fmt::print("{}\n{}{} runs, {} cases skipped: {}\n", found->question, to_table(*report), report->runs.size(),
               report->skipped.size(), report->passed ? "passed" : "FAILED");
  }
  if (!a.json.empty()) {
    const std::string json = to_json(*found, a.options, *report).dump(1) + "\n";
    if (a.json == "-") {
      fmt::print("{}", json);
    } else if (auto done = write_whole_file(a.json, json); !done) {
      return report_failure(done.error().message);
    }
  }
  if (const int code = write_page(*found, a, *report); code != kDone) return code;
  return report->passed ? kDone : kNotAsAsked;
}

}  // namespace

void add_experiment_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<ExperimentArguments>();
  CLI::App* verb = program.add_subcommand("experiment", "Answer a question about the program with numbers and bars");
  verb->add_option("NAME", a->name, fmt::format("list, or one of: {}", names()))->required();
  verb->add_option("--seeds", a->options.seeds, "seeds 1 to N of each simulated case; default: as the experiment asks")
      ->check(CLI::Range(1, 100000));
  verb->add_flag("--quick", a->options.quick, "a short form, under 20 s; what a clock measures is shown, not judged");
  verb->add_option("--data", a->options.data, "the folder of recorded data; cases that need it are skipped without it");
  verb->add_option("--threads", a->options.threads, "threads; the results do not depend on it")
      ->check(CLI::Range(1, 64))
      ->capture_default_str();
  verb->add_option("--docs", a->docs,
                   "where to write the page; default: docs/experiments of the source tree, if whole");
  verb->add_option("--json", a->json, "write the results into this file; - is stdout");
  verb->footer(
      "Examples:\n  helicoid experiment list\n  helicoid experiment laps\n"
      "  helicoid experiment crispness --quick --json crispness.json\n"
      "Exit code 3: a bar was failed.");
  verb->callback([a, &exit_code] { exit_code = run_verb(*a); });
}

}  // namespace helicoid
