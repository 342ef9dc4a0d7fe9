#include "apps/experiment_page.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "apps/svg_drawing.hpp"
#include "helicoid/base/whole_file.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

Json bar_json(const Bar* bar) {
  if (bar == nullptr) return nullptr;
  Json json;
  if (bar->at_least) json["at_least"] = *bar->at_least;
  if (bar->at_most) json["at_most"] = *bar->at_most;
  json["of"] = bar->of_mean ? "mean" : "every run";
  return json;
}

/// Four digits; whole numbers whole.
std::string number(double value) {
  const bool whole = std::abs(value) >= 1000 && std::abs(value) < 1e9;
  return whole ? fmt::format("{:.0f}", value) : fmt::format("{:.4g}", value);
}

const char* verdict(const MetricSummary& s) {
  return s.bar == nullptr ? "" : s.passed ? "passed" : "FAILED";
}

/// One row of the chart: every run of a case as a dot, on the metric's own scale, with its bar.
void draw_row(SvgDrawing& drawing, const MetricSummary& s, const ExperimentReport& report, double y) {
  constexpr double kLeft = 330;
  constexpr double kWidth = 420;
  double low = std::min(0.0, s.min);
  double high = std::max(s.max, low + 1e-9);
  if (s.bar != nullptr && s.bar->at_most) high = std::max(high, *s.bar->at_most);
  if (s.bar != nullptr && s.bar->at_least) high = std::max(high, *s.bar->at_least);
  high += 0.08 * (high - low);
  const auto x = [&](double value) { return kLeft + kWidth * (value - low) / (high - low); };
  const bool failed = !s.passed;
  drawing.line({kLeft, y}, {kLeft + kWidth, y}, {0xD5DBE1, 1, ""});
  for (const auto& limit :
       {s.bar != nullptr ? s.bar->at_least : std::nullopt, s.bar != nullptr ? s.bar->at_most : std::nullopt}) {
    if (!limit) continue;
    drawing.line({x(*limit), y - 11}, {x(*limit), y + 11}, {charts::kOverlap, 2.5, ""});
    drawing.text({x(*limit), y - 13}, number(*limit), {10, "middle", charts::kOverlap, false, 0});
  }
  for (const ExperimentRun& run : report.runs) {
    if (run.case_name != s.case_name) continue;
    for (const Metric& m : run.outcome.metrics) {
      if (m.name == s.metric) drawing.disc({x(m.value), y}, 4, failed ? 0xC0392B : 0x0072B2, 0.45);
    }
  }
  drawing.text({20, y + 4}, s.case_name, {12, "start", charts::kText, true, 0});
  drawing.text({kLeft - 12, y + 4}, s.metric, {12, "end"});
  drawing.text({kLeft + kWidth + 14, y + 4},
               fmt::format("{} [{} .. {}]", number(s.mean), number(s.min), number(s.max)));
}

std::string draw_chart(const Experiment& experiment, const ExperimentReport& report) {
  constexpr double kRow = 34;
  constexpr double kTop = 62;
  SvgDrawing drawing(1040, kTop + kRow * static_cast<double>(report.by_case.size()) + 20);
  drawing.text({20, 28}, experiment.question, {15, "start", charts::kText, true, 0});
  for (std::size_t i = 0; i < report.by_case.size(); ++i) {
    draw_row(drawing, report.by_case[i], report, kTop + kRow * (static_cast<double>(i) + 0.5));
  }
  return drawing.finish();
}

std::string to_markdown(const Experiment& experiment, const ExperimentOptions& options,
                        const ExperimentReport& report) {
  std::string page =
      fmt::format("# {}\n\n**{}** {}\n\n{}\n\n![every run](./{}.svg)\n\n", experiment.name, experiment.question,
                  report.passed ? "All bars are passed." : "**A bar is failed.**", experiment.method, experiment.name);
  page += "| case | metric | runs | mean | least | most | bar | |\n|---|---|---|---|---|---|---|---|\n";
  for (const MetricSummary& s : report.by_case) {
    page += fmt::format("| {} | {} | {} | {} | {} | {} | {} | {} |\n", s.case_name, s.metric, s.runs, number(s.mean),
                        number(s.min), number(s.max), describe(s.bar), verdict(s));
  }
  for (const SkippedCase& s : report.skipped) page += fmt::format("\nSkipped: {} ({}).\n", s.name, s.reason);
  for (const ExperimentRun& run : report.runs) {
    if (run.seed != 1) continue;
    for (const ExperimentPicture& p : run.outcome.pictures) {
      page += fmt::format("\n![{0}](./{1}-{0}.svg)\n", p.name, experiment.name);
    }
  }
  page += fmt::format("\nMade by `helicoid experiment {}{}` of Helicoid {}.\n", experiment.name,
                      options.quick       ? " --quick"
                      : options.seeds > 0 ? fmt::format(" --seeds {}", options.seeds)
                                          : "",
                      HELICOID_VERSION);
  return page;
}

}  // namespace

std::string describe(const Bar* bar) {
  if (bar == nullptr) return "";
  std::string text = bar->at_least && bar->at_most ? fmt::format("{:g} to {:g}", *bar->at_least, *bar->at_most)
                     : bar->at_most                ? fmt::format("at most {:g}", *bar->at_most)
                     : bar->at_least               ? fmt::format("at least {:g}", *bar->at_least)
                                                   : "";
  if (bar->of_mean) text += ", the mean";
  return bar->of_whole ? text + ", judged in whole runs" : text;
}

Json to_json(const Experiment& experiment, const ExperimentOptions& options, const ExperimentReport& report) {
  Json json = {{"experiment", experiment.name},
               {"version", HELICOID_VERSION},
               {"options",
                {{"seeds", options.seeds > 0 ? Json(options.seeds) : Json()},
                 {"quick", options.quick},
                 {"data", options.data}}}};
  json["runs"] = Json::array();
  for (const ExperimentRun& run : report.runs) {
    Json metrics = Json::object();
    for (const Metric& m : run.outcome.metrics) metrics[m.name] = m.value;
    json["runs"].push_back({{"seed", run.seed}, {"case", run.case_name}, {"metrics", metrics}, {"passed", run.passed}});
  }
  json["metrics"] = Json::object();
  for (const MetricSummary& s : report.overall) {
    json["metrics"][s.metric] = {
        {"mean", s.mean}, {"min", s.min}, {"max", s.max}, {"bar", bar_json(s.bar)}, {"passed", s.passed}};
  }
  json["skipped"] = Json::array();
  for (const SkippedCase& s : report.skipped) json["skipped"].push_back({{"case", s.name}, {"reason", s.reason}});
  json["passed"] = report.passed;
  return json;
}

std::string to_table(const ExperimentReport& report) {
  std::size_t case_width = 4;
  std::size_t metric_width = 6;
  for (const MetricSummary& s : report.by_case) {
    case_width = std::max(case_width, s.case_name.size());
    metric_width = std::max(metric_width, s.metric.size());
  }
  std::string table = fmt::format("{:<{}}  {:<{}}  {:>4}  {:>9}  {:>9}  {:>9}  {}\n", "case", case_width, "metric",
                                  metric_width, "runs", "mean", "least", "most", "bar");
  for (const MetricSummary& s : report.by_case) {
    table += fmt::format("{:<{}}  {:<{}}  {:>4}  {:>9}  {:>9}  {:>9}  {}{}{}\n", s.case_name, case_width, s.metric,
                         metric_width, s.runs, number(s.mean), number(s.min), number(s.max), describe(s.bar),
                         s.bar != nullptr ? ": " : "", verdict(s));
  }
  return table;
}

Result<void> write_experiment_page(const Experiment& experiment, const ExperimentOptions& options,
                                   const ExperimentReport& report, const std::string& folder) {
  std::error_code error;
  std::filesystem::create_directories(folder, error);
  const std::string base = folder + "/" + experiment.name;
  if (auto done = write_whole_file(base + ".svg", draw_chart(experiment, report)); !done) return done;
  for (const ExperimentRun& run : report.runs) {
    if (run.seed != 1) continue;
    for (const ExperimentPicture& p : run.outcome.pictures) {
      if (auto done = write_whole_file(base + "-" + p.name + ".svg", p.svg); !done) return done;
    }
  }
  return write_whole_file(base + ".md", to_markdown(experiment, options, report));
}

}  // namespace helicoid
