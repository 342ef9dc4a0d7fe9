#include "helicoid/fit/fit_from_start.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/fit/cpu_clock.hpp"
#include "helicoid/fit/initial_guess.hpp"
#include "helicoid/fit/robust_fit.hpp"

namespace helicoid {

namespace {

/// The 99.9 % quantile of chi^2 (Wilson and Hilferty 1931).
double chi_square_bound(std::int64_t degrees) {
  const auto k = static_cast<double>(degrees);
  const double a = 2 / (9 * k);
  const double root = 1 - a + 3.0902 * std::sqrt(a);
  return k * root * root * root;
}

StartedFit fit_once(const RelationGraph& graph, FitStart start, const FitOptions& options,
                    std::span<const std::uint32_t> held) {
  const std::vector<std::uint32_t> gauge = gauge_with(graph, held);
  StartedFit started;
  started.start = start;
  RobustFit robust = fit_robustly(graph, gauge, options);
  started.result = std::move(robust.result);
  started.wrong_relations = robust.wrong.size();
  started.degrees_of_freedom = degrees_of_freedom(graph, gauge);
  const double chi2 = 2 * (started.result.final_cost - least_cost(graph));
  started.is_plausible =
      started.result.status == FitStatus::converged &&
      (started.degrees_of_freedom > 0 ? chi2 <= chi_square_bound(started.degrees_of_freedom)
                                      : chi2 <= 1e-6 * std::max(1.0, 2 * started.result.initial_cost));
  return started;
}

StartedFit fit_at(const RelationGraph& given, FitStart start, const FitOptions& options,
                  std::span<const std::uint32_t> held) {
  if (start == FitStart::given) return fit_once(given, start, options, held);
  RelationGraph graph = given;
  double seconds = 0;
  {
    const CpuTimer timer(seconds);
    graph.poses = start == FitStart::chordal ? chordal_start(graph, held) : reckon_from(graph, held);
  }
  StartedFit started = fit_once(graph, start, options, held);
  started.result.times.total_s += seconds;
  return started;
}

}  // namespace

StartedFit fit_from(const RelationGraph& graph, FitStart start, const FitOptions& options,
                    std::span<const std::uint32_t> held) {
  if (start != FitStart::automatic) return fit_at(graph, start, options, held);
  // As long as undamped steps lead downhill the start lies in a good basin, as a rule.
  FitOptions brisk = options;
  brisk.gives_up_early = true;
  StartedFit first = fit_at(graph, FitStart::given, brisk, held);
  if (first.is_plausible) return first;
  StartedFit second = fit_at(graph, FitStart::chordal, options, held);
  double spent = first.result.times.total_s + second.result.times.total_s;
  if (!second.is_plausible && first.result.status == FitStatus::cost_rose) {
    first = fit_at(graph, FitStart::given, options, held);
    spent += first.result.times.total_s;
  }
  StartedFit& best = second.result.final_cost < first.result.final_cost ? second : first;
  best.result.times.total_s = spent;
  return best;
}

}  // namespace helicoid
