#include "helicoid/fit/fit_graph.hpp"

#include <algorithm>
#include <cmath>
#include <memory>

#include "helicoid/fit/cpu_clock.hpp"
#include "helicoid/fit/first_order_fit.hpp"
#include "helicoid/fit/linear_system.hpp"

namespace helicoid {

namespace {

/// Long open chains have modes that are softer than the diagonal by nine orders of magnitude; damping that starts
/// higher freezes them.
constexpr double kLeastDamping = 1e-9;
constexpr double kMostDamping = 1e6;

double dot(std::span<const double> a, std::span<const double> b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

double largest(std::span<const double> step) {
  double most = 0;
  for (const double s : step) most = std::max(most, std::abs(s));
  return most;
}

/// Levenberg-Marquardt, one step at a time.
class LevenbergMarquardt {
 public:
  LevenbergMarquardt(LinearSystem& system, const FitOptions& options, FitResult& result)
      : system_(system), options_(options), result_(result) {}

  void run() {
    relinearise();
    result_.initial_cost = result_.final_cost;
    result_.status = FitStatus::iteration_limit;
    while (result_.iterations < options_.max_iterations && result_.status == FitStatus::iteration_limit) {
      iterate();
      if (options_.progress) options_.progress(result_.iterations, result_.final_cost);
    }
  }

 private:
  void relinearise() {
    const CpuTimer timer(result_.times.linearise_s);
    result_.final_cost = system_.linearise(result_.poses, options_.loss);
    result_.gradient_norm = std::sqrt(dot(system_.gradient(), system_.gradient()));
  }

  bool factorise() {
    const CpuTimer timer(result_.times.factorise_s);
    return system_.factorise(damping_);
  }

  std::vector<double> solve() {
    const CpuTimer timer(result_.times.solve_s);
    return system_.newton_step();
  }

  /// The step is expected to gain next to nothing, or to move next to nothing. -g.step / 2 is the gain of the
  /// quadratic model without damping.
  [[nodiscard]] bool is_small(std::span<const double> step) const {
    return -0.5 * dot(system_.gradient(), step) <= options_.relative_tolerance * result_.final_cost ||
           largest(step) < options_.step_tolerance;
  }

  /// What the quadratic model of this damping gains: -g.s/2 + damping/2 s^T diag(H) s.
  [[nodiscard]] double expected_gain(std::span<const double> step) const {
    double gain = -0.5 * dot(system_.gradient(), step);
    const std::vector<double>& diagonal = system_.information().diagonal;
    for (std::size_t i = 0; i < step.size() && damping_ > 0; ++i) {
      gain += 0.5 * damping_ * diagonal[9 * (i / 3) + 4 * (i % 3)] * step[i] * step[i];
    }
    return gain;
  }

  /// Ever faster, so that a bad start costs few factorisations (Nielsen 1999).
  void raise_damping() {
    damping_ = std::max(kLeastDamping, growth_ * damping_);
    growth_ *= 2;
  }

  /// Less, as the model proves right.
  void lower_damping(double gain_ratio) {
    growth_ = 10;
    if (gain_ratio > 0.5) damping_ *= gain_ratio > 0.9 ? 0.03 : 0.2;
    if (damping_ < kLeastDamping) damping_ = is_singular_ ? kLeastDamping : 0;
  }

  /// Takes the step if it lowers the cost; otherwise leaves the system as it was linearised before.
  bool try_step(std::span<const double> step) {
    std::vector<Pose2> next = system_.moved(result_.poses, step);
    const double before = result_.final_cost;
    std::swap(next, result_.poses);
    relinearise();
    if (result_.final_cost <= before * (1 + 1e-12)) return true;
    std::swap(next, result_.poses);
    relinearise();
    return false;
  }

  [[nodiscard]] FitStatus at_rest() const {
    return is_singular_ ? FitStatus::not_positive_definite : FitStatus::converged;
  }

  void iterate() {
    ++result_.iterations;
    if (!factorise()) {
      is_singular_ = is_singular_ || damping_ == 0;
      raise_damping();
      if (damping_ > kMostDamping) result_.status = FitStatus::not_positive_definite;
      return;
    }
    std::vector<double> step = solve();
    const bool small = (damping_ == 0 || is_singular_) && is_small(step);
    const double expected = expected_gain(step);
    const double before = result_.final_cost;
    if (!try_step(step)) {
      raise_damping();
      // No step however short lowers the cost: rounding is all that is left.
      if (small || damping_ > kMostDamping) {
        result_.status = at_rest();
      } else if (options_.gives_up_early && ++rises_ == 3) {
        result_.status = FitStatus::cost_rose;
      }
      return;
    }
    const bool undamped = damping_ == 0;
    lower_damping((before - result_.final_cost) / expected);
    if (small) result_.status = at_rest();
    // After a step from far away, which halves the cost, more is to be done than the factor at hand can do.
    if (small || !undamped || result_.final_cost < 0.5 * before) return;
    // It is nearly right for the next step too: where that is the last one, it need not be made anew.
    step = solve();
    if (is_small(step)) {
      try_step(step);
      result_.status = FitStatus::converged;
    }
  }

  LinearSystem& system_;
  const FitOptions& options_;
  FitResult& result_;
  double damping_ = 0;
  double growth_ = 10;
  int rises_ = 0;
  bool is_singular_ = false;  ///< some direction is open: damping alone holds it
};

}  // namespace

FitResult fit(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const FitOptions& options) {
  FitResult result;
  result.poses = graph.poses;
  if (graph.poses.empty() || graph.relations.empty()) return result;
  const CpuTimer total(result.times.total_s);
  std::unique_ptr<LinearSystem> system;
  {
    const CpuTimer timer(result.times.order_s);
    system = std::make_unique<LinearSystem>(graph, fixed, options.ordering);
  }
  if (options.method == FitMethod::levenberg_marquardt) {
    LevenbergMarquardt(*system, options, result).run();
  } else {
    descend(*system, options, result);
  }
  return result;
}

FitResult fit(const RelationGraph& graph, const FitOptions& options) {
  return fit(graph, default_gauge(graph), options);
}

RelationGraph make_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges) {
  RelationGraph graph;
  graph.poses.assign(start.begin(), start.end());
  graph.relations.reserve(edges.size());
  for (const GraphEdge& e : edges) graph.relations.push_back({e.a, e.b, Correspondences{e.form, e.scale, 0}, false});
  return graph;
}

FitResult fit_graph(std::span<const Pose2> start, std::span<const GraphEdge> edges, std::uint32_t fixed,
                    const FitOptions& options) {
  if (start.size() < 2 || edges.empty()) {
    FitResult result;
    result.poses.assign(start.begin(), start.end());
    return result;
  }
  const std::uint32_t gauge[] = {fixed};
  return fit(make_graph(start, edges), gauge, options);
}

}  // namespace helicoid
