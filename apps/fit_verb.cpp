// helicoid fit: a graph of relations in, its most likely poses out.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>

#include "apps/progress_bar.hpp"
#include "apps/verb.hpp"
#include "helicoid/base/whole_file.hpp"
#include "helicoid/fit/fit_from_start.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/fit/relative_covariance.hpp"
#include "helicoid/io/graph_reader.hpp"

namespace helicoid {

namespace {

using Json = nlohmann::ordered_json;

struct FitArguments {
  std::string graph;
  std::string out;
  std::string init = "auto";
  std::string method = "lm";
  std::string loss = "none";
  double width = RobustLoss{}.width;
  int max_iterations = FitOptions{}.max_iterations;
  std::string confidence;
  std::int64_t relative_to = -1;
  bool json = false;
};

const std::map<std::string, FitStart> kStarts = {{"file", FitStart::given},
                                                 {"odometry", FitStart::odometry},
                                                 {"chordal", FitStart::chordal},
                                                 {"auto", FitStart::automatic}};
const std::map<std::string, FitMethod> kMethods = {
    {"lm", FitMethod::levenberg_marquardt}, {"fr", FitMethod::fletcher_reeves}, {"gd", FitMethod::gradient_descent}};
const std::map<std::string, LossKind> kLosses = {{"none", LossKind::quadratic},
                                                 {"huber", LossKind::huber},
                                                 {"cauchy", LossKind::cauchy},
                                                 {"truncated", LossKind::truncated}};

const char* name_of(FitStatus status) {
  switch (status) {
    case FitStatus::converged: return "converged";
    case FitStatus::iteration_limit: return "iteration limit";
    case FitStatus::not_positive_definite: return "not determined";
    default: return "nothing to fit";
  }
}

const char* name_of(FitStart start) {
  for (const auto& [name, value] : kStarts) {
    if (value == start) return name.c_str();
  }
  return "";
}

Json report_json(const GraphFile& file, const StartedFit& started) {
  const FitResult& r = started.result;
  Json skipped = Json::array();
  for (const Skipped& s : file.skipped)
    skipped.push_back({{"reason", s.reason}, {"count", s.count}, {"first", s.first}});
  return {{"format", "helicoid-fit"},
          {"version", HELICOID_VERSION},
          {"nodes", file.ids.size()},
          {"relations", file.graph.relations.size()},
          {"components", find_components(file.graph).size()},
          {"initial_cost", 2 * r.initial_cost},
          {"final_cost", 2 * r.final_cost},
          {"iterations", r.iterations},
          {"status", name_of(r.status)},
          {"gradient_norm", r.gradient_norm},
          {"start", name_of(started.start)},
          {"optimum", started.is_plausible ? "consistent with the stated noise" : "may be local"},
          {"degrees_of_freedom", started.degrees_of_freedom},
          {"wrong_relations", started.wrong_relations},
          {"order_s", r.times.order_s},
          {"linearise_s", r.times.linearise_s},
          {"factorise_s", r.times.factorise_s},
          {"solve_s", r.times.solve_s},
          {"total_s", r.times.total_s},
          {"skipped", skipped}};
}

void print_report(const GraphFile& file, const StartedFit& started) {
  const FitResult& r = started.result;
  fmt::print(
      "graph      {} nodes, {} relations\nstart      {}, cost {:.6f}\nfit        {} after {} iterations, cost {:.9g}, "
      "gradient {:.2g}\n",
      file.ids.size(), file.graph.relations.size(), name_of(started.start), 2 * r.initial_cost, name_of(r.status),
      r.iterations, 2 * r.final_cost, r.gradient_norm);
  fmt::print("optimum    {}: chi^2 {:.6g} of {} degrees of freedom\n",
             started.is_plausible ? "consistent with the stated noise"
                                  : "may be local, or the relations contradict each other",
             2 * r.final_cost, started.degrees_of_freedom);
  fmt::print("cpu        {:.4f} s: order {:.4f}, linearise {:.4f}, factorise {:.4f}, solve {:.4f}\n", r.times.total_s,
             r.times.order_s, r.times.linearise_s, r.times.factorise_s, r.times.solve_s);
}

/// Lines `id sx sy syaw`: eq. 10 with c = 1.96, in the reference's frame.
Result<std::string> confidence_text(const GraphFile& file, const std::vector<Pose2>& poses, std::int64_t id) {
  if (id < 0) id = file.ids.front();
  const auto at = std::lower_bound(file.ids.begin(), file.ids.end(), id);
  if (at == file.ids.end() || *at != id) return fail("{}: no node of the graph; name one with --relative-to", id);
  if (find_components(file.graph).size() > 1) {
    return fail("the graph falls apart into {} components: nothing is known between them",
                find_components(file.graph).size());
  }
  RelationGraph graph = file.graph;
  graph.poses = poses;
  RelativeCovariance covariance(std::move(graph));
  const auto all = covariance.relative_to(static_cast<std::uint32_t>(at - file.ids.begin()));
  if (!covariance.is_determined()) return fail("the relations leave a pose undetermined: no confidence can be stated");
  std::string text = "# id sx sy syaw: 1.96 sigma relative to " + std::to_string(id) + "; m, m, rad\n";
  for (std::size_t i = 0; i < all.size(); ++i) {
    const Matrix3d& C = all[i].covariance;
    text += fmt::format("{} {:.9g} {:.9g} {:.9g}\n", file.ids[i], 1.96 * std::sqrt(C(0, 0)), 1.96 * std::sqrt(C(1, 1)),
                        1.96 * std::sqrt(C(2, 2)));
  }
  return text;
}

void warn_of(const GraphFile& file, const std::string& name) {
  if (!file.warning.empty()) report_warning(file.warning);
  for (const Skipped& s : file.skipped) report_warning(fmt::format("{} x {}, first at {}", s.count, s.reason, s.first));
  const std::size_t components = find_components(file.graph).size();
  if (components > 1) {
    report_warning(
        fmt::format("{}: falls apart into {} components; each is fitted with its FIX nodes held, or else with "
                    "its own lowest pose",
                    name, components));
  }
}

FitOptions options_of(const FitArguments& a) {
  FitOptions options;
  options.method = kMethods.at(a.method);
  options.loss.kind = kLosses.at(a.loss);
  options.loss.width = a.width;
  options.max_iterations = a.max_iterations;
  return options;
}

StartedFit run_fit(const GraphFile& file, FitStart start, const FitArguments& a) {
  ProgressBar bar;
  bar.say(fmt::format("{} nodes, {} relations: ordering", file.ids.size(), file.graph.relations.size()));
  FitOptions options = options_of(a);
  options.progress = [&bar](int iteration, double cost) {
    bar.say(fmt::format("iteration {}, cost {:.9g}", iteration, 2 * cost));
  };
  return fit_from(file.graph, start, options, file.fixed);
}

int run_verb(const FitArguments& a) {
  Result<GraphFile> file = read_graph(a.graph);
  if (!file) return report_failure(file.error().message);
  warn_of(*file, a.graph);
  const bool all_placed = std::find(file->is_placed.begin(), file->is_placed.end(), false) == file->is_placed.end();
  FitStart start = kStarts.at(a.init);
  const bool none_placed = std::find(file->is_placed.begin(), file->is_placed.end(), true) == file->is_placed.end();
  if (none_placed && start == FitStart::given) {
    report_warning(fmt::format("{}: has no VERTEX lines; the fit starts from the odometry chain", a.graph));
  }
  if (!all_placed) file->graph.poses = odometry_start(file->graph, file->is_placed);
  StartedFit started = run_fit(*file, start, a);
  if (none_placed && started.start == FitStart::given) started.start = FitStart::odometry;
  if (!a.out.empty()) {
    if (auto done = write_whole_file(a.out, to_graph_text(*file, started.result.poses)); !done) {
      return report_failure(done.error().message);
    }
  }
  if (!a.confidence.empty()) {
    const Result<std::string> text = confidence_text(*file, started.result.poses, a.relative_to);
    if (!text) return report_failure(text.error().message);
    if (auto done = write_whole_file(a.confidence, *text); !done) return report_failure(done.error().message);
  }
  if (a.json) {
    fmt::print("{}\n", report_json(*file, started).dump(1));
  } else {
    print_report(*file, started);
  }
  return started.result.status == FitStatus::converged ? kDone : kNotAsAsked;
}

}  // namespace

void add_fit_verb(CLI::App& program, int& exit_code) {
  auto a = std::make_shared<FitArguments>();
  CLI::App* verb = program.add_subcommand("fit", "Fit a graph of relations (g2o or TORO)");
  verb->add_option("GRAPH", a->graph, "the graph, plain or .gz, - for stdin")->required();
  verb->add_option("--out", a->out, "write the fitted graph here");
  verb->add_option("--init", a->init, "where to start")
      ->check(CLI::IsMember({"file", "odometry", "chordal", "auto"}))
      ->capture_default_str();
  verb->add_option("--method", a->method, "Levenberg-Marquardt, Fletcher-Reeves or gradient descent")
      ->check(CLI::IsMember({"lm", "fr", "gd"}))
      ->capture_default_str();
  verb->add_option("--loss", a->loss, "robust loss on relations between nodes that are not consecutive")
      ->check(CLI::IsMember({"none", "huber", "cauchy", "truncated"}))
      ->capture_default_str();
  verb->add_option("--loss-width", a->width, "where the loss bends, in sigmas")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--max-iterations", a->max_iterations,
                   "second-order iterations at most; first-order methods take 1000 times as many")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  verb->add_option("--confidence", a->confidence, "write `id sx sy syaw` lines here (1.96 sigma; m, m, rad)");
  verb->add_option("--relative-to", a->relative_to, "the node that confidence is relative to; default: the lowest id");
  verb->add_flag("--json", a->json, "print one JSON object");
  verb->footer(
      "Examples:\n  helicoid fit manhattan.g2o.gz --out fitted.g2o\n"
      "  helicoid fit graph.g2o --loss truncated  (lets wrong relations go)\n"
      "  helicoid fit graph.g2o --confidence sigmas.txt --relative-to 0 --json\n"
      "Costs are sums of e^T Omega e. Nodes of FIX lines are held; in each component without one the lowest id is.");
  verb->callback([a, &exit_code] { exit_code = run_verb(*a); });
}

}  // namespace helicoid
