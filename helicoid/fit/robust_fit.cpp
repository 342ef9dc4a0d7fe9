#include "helicoid/fit/robust_fit.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/fit/consistent_start.hpp"

namespace helicoid {

namespace {

double excess(const GraphRelation& r, std::span<const Pose2> poses) {
  const Pose2 T_a_b = r.a == kWorld ? poses[r.b] : poses[r.a].inverse() * poses[r.b];
  const auto* form = std::get_if<Correspondences>(&r.measurement);
  const double least = form != nullptr ? form->scale * form->least_cost : 0;
  return 2 * std::max(0.0, cost(r.measurement, RelativePose::of(T_a_b)) - least);
}

void add(const FitTimes& times, FitTimes& sum) {
  sum.order_s += times.order_s;
  sum.linearise_s += times.linearise_s;
  sum.factorise_s += times.factorise_s;
  sum.solve_s += times.solve_s;
  sum.total_s += times.total_s;
}

/// The fit with the truncated loss from these poses on, through softened losses while `softness` is more than nothing.
class Hardening {
 public:
  Hardening(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const FitOptions& options)
      : moving_(graph), fixed_(fixed), options_(options) {}

  FitResult run(std::vector<Pose2> start, double softness) {
    constexpr double kHardening = 1.4;
    moving_.poses = std::move(start);
    FitOptions soft = options_;
    soft.max_iterations = 5;
    for (soft.loss.softness = softness; soft.loss.softness > 0.01; soft.loss.softness /= kHardening) step(soft);
    step(options_);
    last_.iterations = iterations_;
    last_.times = times_;
    return std::move(last_);
  }

 private:
  void step(const FitOptions& options) {
    last_ = fit(moving_, fixed_, options);
    moving_.poses = last_.poses;
    iterations_ += last_.iterations;
    add(last_.times, times_);
  }

  RelationGraph moving_;
  std::span<const std::uint32_t> fixed_;
  const FitOptions& options_;
  FitResult last_;
  FitTimes times_;
  int iterations_ = 0;
};

/// Soft enough for the loss to be convex at these poses (their remark 5): mu = w^2 / (2 largest chi^2 - w^2).
double convex_softness(const RelationGraph& graph, double square) {
  double most = 0;
  for (const GraphRelation& r : graph.relations) {
    if (r.may_be_wrong) most = std::max(most, excess(r, graph.poses));
  }
  return std::max(0.0, (2 * most - square) / square);
}

}  // namespace

RobustFit fit_robustly(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const FitOptions& options) {
  RobustFit robust;
  robust.width = options.loss.width;
  if (options.loss.kind != LossKind::truncated) {
    robust.result = fit(graph, fixed, options);
    return robust;
  }
  ConsistentStart start = consistent_start(graph, fixed, options);
  FitOptions truncated = options;
  if (start.is_determined) truncated.loss.width = robust.width = std::sqrt(start.gate);
  const double square = robust.width * robust.width;
  Hardening hardening(graph, fixed, truncated);
  robust.result = start.is_determined ? hardening.run(std::move(start.poses), 0)
                                      : hardening.run(graph.poses, convex_softness(graph, square));
  robust.result.times.total_s += start.cpu_s;
  for (std::uint32_t i = 0; i < graph.relations.size(); ++i) {
    if (graph.relations[i].may_be_wrong && excess(graph.relations[i], robust.result.poses) > square)
      robust.wrong.push_back(i);
  }
  return robust;
}

}  // namespace helicoid
