#include "apps/experiment.hpp"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <mutex>
#include <thread>

namespace helicoid {

namespace {

struct Job {
  const ExperimentCase* what = nullptr;
  std::uint64_t seed = 0;
};

std::vector<Job> list_jobs(const Experiment& experiment, const ExperimentOptions& options,
                           const std::vector<ExperimentCase>& cases) {
  const std::size_t seeds = options.seeds > 0 ? options.seeds
                            : options.quick   ? experiment.quick_seeds
                                              : experiment.seeds;
  std::vector<Job> jobs;
  for (const ExperimentCase& c : cases) {
    if (!c.missing.empty()) continue;
    for (std::uint64_t seed = 1; seed <= (c.seeded ? seeds : 1); ++seed) jobs.push_back({&c, seed});
  }
  return jobs;
}

/// Each job's result at the job's place: the order in which threads finish cannot show.
std::vector<Result<Outcome>> run_jobs(const std::vector<Job>& jobs, int threads,
                                      const std::function<void(double)>& progress) {
  std::vector<Result<Outcome>> results(jobs.size());
  std::atomic<std::size_t> next = 0;
  std::mutex telling;
  std::size_t done = 0;
  const auto work = [&] {
    for (std::size_t i = next++; i < jobs.size(); i = next++) {
      results[i] = jobs[i].what->run(jobs[i].seed);
      const std::lock_guard lock(telling);
      ++done;
      if (progress) progress(static_cast<double>(done) / static_cast<double>(jobs.size()));
    }
  };
  std::vector<std::jthread> helpers;
  for (int i = 1; i < threads; ++i) helpers.emplace_back(work);
  work();
  helpers.clear();
  return results;
}

/// The bar that judges a metric in this form of the experiment; null: none.
const Bar* find_bar(const Experiment& experiment, bool quick, const std::string& metric) {
  const auto bar = std::find_if(experiment.bars.begin(), experiment.bars.end(),
                                [&](const Bar& b) { return b.metric == metric && !(quick && b.of_whole); });
  return bar != experiment.bars.end() ? &*bar : nullptr;
}

bool passes(const Experiment& experiment, bool quick, const Outcome& outcome) {
  return std::all_of(outcome.metrics.begin(), outcome.metrics.end(), [&](const Metric& m) {
    const Bar* bar = find_bar(experiment, quick, m.name);
    return bar == nullptr || bar->of_mean || bar->holds(m.value);
  });
}

MetricSummary& entry(std::vector<MetricSummary>& list, const std::string& metric, const std::string& case_name) {
  const auto found = std::find_if(
      list.begin(), list.end(), [&](const MetricSummary& s) { return s.metric == metric && s.case_name == case_name; });
  return found != list.end() ? *found : list.emplace_back(MetricSummary{metric, case_name, 0, 0, 0, 0, nullptr, true});
}

void add(MetricSummary& summary, double value) {
  summary.min = summary.runs == 0 ? value : std::min(summary.min, value);
  summary.max = summary.runs == 0 ? value : std::max(summary.max, value);
  ++summary.runs;
  summary.mean += value;  // the sum, until all runs are in
}

void summarise(const Experiment& experiment, bool quick, ExperimentReport& report) {
  for (const ExperimentRun& run : report.runs) {
    for (const Metric& m : run.outcome.metrics) {
      for (const std::string& name : {run.case_name, std::string()}) {
        MetricSummary& summary = entry(name.empty() ? report.overall : report.by_case, m.name, name);
        summary.bar = find_bar(experiment, quick, m.name);
        add(summary, m.value);
        if (summary.bar != nullptr && !summary.bar->of_mean && !summary.bar->holds(m.value)) summary.passed = false;
      }
    }
  }
  for (auto* list : {&report.by_case, &report.overall}) {
    for (MetricSummary& s : *list) s.mean /= static_cast<double>(s.runs);
  }
  for (MetricSummary& s : report.by_case) {
    if (s.bar != nullptr && s.bar->of_mean) s.passed = s.bar->holds(s.mean);
    if (!s.passed) entry(report.overall, s.metric, "").passed = false;
  }
  report.passed = !report.runs.empty() && std::all_of(report.overall.begin(), report.overall.end(),
                                                      [](const MetricSummary& s) { return s.passed; });
}

}  // namespace

Result<ExperimentReport> run_experiment(const Experiment& experiment, const ExperimentOptions& options,
                                        const std::function<void(double)>& progress) {
  const std::vector<ExperimentCase> cases = experiment.cases(options);
  const std::vector<Job> jobs = list_jobs(experiment, options, cases);
  std::vector<Result<Outcome>> results = run_jobs(jobs, options.threads, progress);
  ExperimentReport report;
  for (const ExperimentCase& c : cases) {
    if (!c.missing.empty()) report.skipped.push_back({c.name, c.missing});
  }
  for (std::size_t i = 0; i < jobs.size(); ++i) {
    const std::string& name = jobs[i].what->name;
    if (!results[i]) return fail("{}, seed {}: {}", name, jobs[i].seed, results[i].error().message);
    const bool passed = passes(experiment, options.quick, *results[i]);
    report.runs.push_back({jobs[i].seed, name, std::move(*results[i]), passed});
  }
  summarise(experiment, options.quick, report);
  return report;
}

}  // namespace helicoid
