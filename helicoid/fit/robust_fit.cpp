#include "helicoid/fit/robust_fit.hpp"

#include <algorithm>

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

}  // namespace

RobustFit fit_robustly(const RelationGraph& graph, std::span<const std::uint32_t> fixed, const FitOptions& options) {
  RobustFit robust;
  if (options.loss.kind != LossKind::truncated) {
    robust.result = fit(graph, fixed, options);
    return robust;
  }
  RelationGraph moving = graph;
  ConsistentStart start = consistent_start(graph, fixed, options);
  if (start.is_determined) moving.poses = std::move(start.poses);
  // Soft enough to be convex at the start (their remark 5): mu = w^2 / (2 largest chi^2 - w^2).
  double most = 0;
  for (const GraphRelation& r : graph.relations) {
    if (r.may_be_wrong) most = std::max(most, excess(r, graph.poses));
  }
  const double square = options.loss.width * options.loss.width;
  FitOptions soft = options;
  soft.max_iterations = 5;
  FitTimes times;
  times.total_s = start.cpu_s;
  int iterations = 0;
  constexpr double kHardening = 1.4;
  const auto run = [&](const FitOptions& with) {
    robust.result = fit(moving, fixed, with);
    moving.poses = robust.result.poses;
    iterations += robust.result.iterations;
    add(robust.result.times, times);
  };
  // From a start that agrees with the trusted relations the loss need not let everything in again.
  constexpr double kSoftEnough = 4;
  const double convex = std::max(0.0, (2 * most - square) / square);
  for (soft.loss.softness = start.is_determined ? std::min(convex, kSoftEnough) : convex; soft.loss.softness > 0.01;
       soft.loss.softness /= kHardening) {
    run(soft);
  }
  FitOptions hard = options;
  run(hard);
  robust.result.iterations = iterations;
  robust.result.times = times;
  for (std::uint32_t i = 0; i < graph.relations.size(); ++i) {
    if (graph.relations[i].may_be_wrong && excess(graph.relations[i], moving.poses) > square) robust.wrong.push_back(i);
  }
  return robust;
}

}  // namespace helicoid
