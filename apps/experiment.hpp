// Experiments: a question, cases that answer it with numbers, and bars that the numbers must pass. One file below
// experiments/ is one experiment; running, tables, JSON and pages are the same for all.
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "helicoid/base/result.hpp"

namespace helicoid {

struct ExperimentOptions {
  std::size_t seeds = 0;  ///< 0: as many as the experiment asks for
  bool quick = false;     ///< a short form of the same, for every change
  std::string data;       ///< the folder of recorded data; empty: there is none
  int threads = 2;        ///< the results do not depend on it
};

/// A number with its name, which ends in its unit: "translation_m", "twins_percent", "patches_count".
struct Metric {
  std::string name;
  double value = 0;
};

/// A picture for the experiment's page; `name` is its file's, without ".svg".
struct ExperimentPicture {
  std::string name;
  std::string svg;
};

struct Outcome {
  std::vector<Metric> metrics;
  std::vector<ExperimentPicture> pictures;  ///< wanted of a case's first seed only
};

struct ExperimentCase {
  std::string name;
  bool seeded = true;   ///< false: recorded data, which is run once
  std::string missing;  ///< why the case cannot be run here; it is skipped aloud. Empty: it can
  std::function<Result<Outcome>(std::uint64_t seed)> run;
};

/// What a metric must keep to: in every run, or in the mean of each case's runs.
struct Bar {
  std::string metric;
  std::optional<double> at_least;
  std::optional<double> at_most;
  bool of_mean = false;
  /// A short run's clock, or a share of few runs, judges nothing: shown in the short form, judged in the whole.
  bool of_whole = false;
  [[nodiscard]] bool holds(double value) const {
    return (!at_least || value >= *at_least) && (!at_most || value <= *at_most);  // NaN holds nowhere
  }
};

struct Experiment {
  std::string name;
  std::string question;  ///< one line
  std::string method;    ///< how the numbers come about: a paragraph for the page
  std::vector<Bar> bars;
  std::size_t seeds = 20;
  std::size_t quick_seeds = 2;
  std::function<std::vector<ExperimentCase>(const ExperimentOptions&)> cases;
};

struct ExperimentRun {
  std::uint64_t seed = 0;
  std::string case_name;
  Outcome outcome;
  bool passed = true;  ///< all bars on every run
};

/// A metric over the runs of a case.
struct MetricSummary {
  std::string metric;
  std::string case_name;  ///< empty: over all cases
  std::size_t runs = 0;
  double mean = 0, min = 0, max = 0;
  const Bar* bar = nullptr;  ///< of the experiment; null: reported, not judged
  bool passed = true;
};

struct SkippedCase {
  std::string name;
  std::string reason;
};

struct ExperimentReport {
  std::vector<ExperimentRun> runs;  ///< by case, then by seed, whatever the threads did
  std::vector<MetricSummary> by_case;
  std::vector<MetricSummary> overall;
  std::vector<SkippedCase> skipped;
  bool passed = false;  ///< every bar, of at least one run
};

/// Every experiment, by name.
[[nodiscard]] const std::vector<Experiment>& experiments();

/// Runs all cases and seeds 1, 2, ...; `progress` is told the share that is done. Error: a case that could not be run.
[[nodiscard]] Result<ExperimentReport> run_experiment(const Experiment& experiment, const ExperimentOptions& options,
                                                      const std::function<void(double)>& progress = {});

}  // namespace helicoid
