#include "helicoid/fit/relation_graph.hpp"

#include <algorithm>
#include <iterator>
#include <numeric>

namespace helicoid {

namespace {

std::int64_t residuals_of(const Measurement& measurement) {
  if (std::holds_alternative<PosePose>(measurement) || std::holds_alternative<Correspondences>(measurement)) return 3;
  return std::holds_alternative<PointPosition>(measurement) ? 2 : 1;
}

}  // namespace

std::vector<Component> find_components(const RelationGraph& graph) {
  std::vector<std::uint32_t> root(graph.poses.size());
  std::iota(root.begin(), root.end(), 0U);
  const auto find = [&root](std::uint32_t node) {
    while (root[node] != node) node = root[node] = root[root[node]];
    return node;
  };
  for (const GraphRelation& r : graph.relations) {
    if (r.a == kWorld) continue;
    const std::uint32_t a = find(r.a);
    const std::uint32_t b = find(r.b);
    // The lowest node is the root.
    if (a < b) root[b] = a;
    if (b < a) root[a] = b;
  }
  std::vector<Component> components;
  std::vector<std::size_t> number(graph.poses.size());
  for (std::uint32_t i = 0; i < graph.poses.size(); ++i) {
    const std::uint32_t top = find(i);
    if (top == i) {
      number[i] = components.size();
      components.emplace_back();
    }
    components[number[top]].nodes.push_back(i);
  }
  for (const GraphRelation& r : graph.relations) {
    if (r.a == kWorld) components[number[find(r.b)]].has_prior = true;
  }
  return components;
}

std::vector<std::uint32_t> default_gauge(const RelationGraph& graph) {
  return gauge_with(graph, {});
}

std::vector<std::uint32_t> gauge_with(const RelationGraph& graph, std::span<const std::uint32_t> held) {
  std::vector<bool> is_held(graph.poses.size(), false);
  for (const std::uint32_t node : held) is_held[node] = true;
  const auto is_pose = [&](std::uint32_t node) { return graph.is_landmark.empty() || !graph.is_landmark[node]; };
  std::vector<std::uint32_t> gauge;
  for (const Component& component : find_components(graph)) {
    const auto& nodes = component.nodes;
    const std::size_t before = gauge.size();
    std::copy_if(nodes.begin(), nodes.end(), std::back_inserter(gauge), [&](auto node) { return is_held[node]; });
    if (gauge.size() > before || component.has_prior) continue;
    const auto first = std::find_if(nodes.begin(), nodes.end(), is_pose);
    gauge.push_back(first != nodes.end() ? *first : nodes.front());
  }
  return gauge;
}

std::int64_t degrees_of_freedom(const RelationGraph& graph, std::span<const std::uint32_t> held) {
  const auto unknowns = [&](std::size_t node) { return !graph.is_landmark.empty() && graph.is_landmark[node] ? 2 : 3; };
  std::int64_t degrees = 0;
  for (const GraphRelation& r : graph.relations) degrees += residuals_of(r.measurement);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) degrees -= unknowns(i);
  for (const std::uint32_t node : held) degrees += unknowns(node);
  return degrees;
}

std::int64_t degrees_of_freedom(const RelationGraph& graph) {
  return degrees_of_freedom(graph, default_gauge(graph));
}

double least_cost(const RelationGraph& graph) {
  double sum = 0;
  for (const GraphRelation& r : graph.relations) {
    if (const auto* m = std::get_if<Correspondences>(&r.measurement)) sum += m->scale * m->least_cost;
  }
  return sum;
}

}  // namespace helicoid
