#include "helicoid/fit/incremental_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "helicoid/fit/tie_blocks.hpp"

namespace helicoid {

std::uint32_t IncrementalFit::add_pose(const Pose2& start, bool is_landmark) {
  const auto node = static_cast<std::uint32_t>(nodes_.size());
  nodes_.push_back({start, std::cos(start.yaw), std::sin(start.yaw), {}, is_landmark, false, false, false});
  delta_.insert(delta_.end(), kBlock, 0.0);
  index_.push_back(-1);
  tree_.add_node();
  loose_.push_back(static_cast<std::int32_t>(node));
  return node;
}

std::uint32_t IncrementalFit::add_relation(const GraphRelation& relation) {
  const auto id = static_cast<std::uint32_t>(relations_.size());
  relations_.push_back(relation);
  is_removed_.push_back(false);
  looked_.push_back(0);
  for (const std::uint32_t node : {relation.a, relation.b}) {
    if (node == kWorld) continue;
    nodes_[node].relations.push_back(id);
    touched_.push_back(node);
  }
  return id;
}

void IncrementalFit::remove_relation(std::uint32_t relation) {
  is_removed_[relation] = true;
  for (const std::uint32_t node : {relations_[relation].a, relations_[relation].b}) {
    if (node == kWorld) continue;
    std::erase(nodes_[node].relations, relation);
    touched_.push_back(node);
  }
}

void IncrementalFit::remove_pose(std::uint32_t node) {
  const std::vector<std::uint32_t> relations = nodes_[node].relations;
  for (const std::uint32_t r : relations) remove_relation(r);
  nodes_[node].is_removed = true;
  touched_.push_back(node);
}

void IncrementalFit::hold(std::uint32_t node, bool is_held) {
  nodes_[node].is_held = is_held;
  linearise_at(node, pose(node));
  claim_around(node);
}

void IncrementalFit::linearise_at(std::uint32_t node, const Pose2& pose) {
  nodes_[node].linearised_at = pose;
  nodes_[node].cosine = std::cos(pose.yaw);
  nodes_[node].sine = std::sin(pose.yaw);
  std::fill_n(delta_.begin() + kBlock * static_cast<std::ptrdiff_t>(node), kBlock, 0.0);
}

/// Every relation of the node is linearised anew: so its neighbours' rows change, too.
void IncrementalFit::claim_around(std::uint32_t node) {
  tree_.claim(static_cast<std::int32_t>(node));
  for (const std::uint32_t r : nodes_[node].relations) {
    const std::uint32_t other = relations_[r].a == node ? relations_[r].b : relations_[r].a;
    if (other != kWorld) tree_.claim(static_cast<std::int32_t>(other));
  }
}

void IncrementalFit::list_far(std::uint32_t node) {
  if (!std::exchange(nodes_[node].is_far, true)) far_.push_back(node);
}

void IncrementalFit::relinearise(IncrementalStep& step) {
  std::vector<std::pair<double, std::uint32_t>> far;
  for (const std::uint32_t node : far_) {
    const double off = distance(twist(node));
    if (off > 1) far.emplace_back(-off, node);
    nodes_[node].is_far = false;
  }
  far_.clear();
  std::sort(far.begin(), far.end());
  double work = 0;
  for (const auto& [unused, node] : far) {
    double more = tree_.work_to_claim(static_cast<std::int32_t>(node));
    for (const std::uint32_t r : nodes_[node].relations) {
      const std::uint32_t other = relations_[r].a == node ? relations_[r].b : relations_[r].a;
      if (other != kWorld) more = std::max(more, tree_.work_to_claim(static_cast<std::int32_t>(other)));
    }
    if (step.relinearised > 0 && work + more > options_.most_work) {
      list_far(node);
      continue;
    }
    work += more;
    linearise_at(node, pose(node));
    claim_around(node);
    ++step.relinearised;
  }
  step.waiting = far.size() - step.relinearised;
}

RelativePose IncrementalFit::relative(const GraphRelation& r) const {
  static const Node world{};
  const Node& a = r.a == kWorld ? world : nodes_[r.a];
  const Node& b = nodes_[r.b];
  const double dx = b.linearised_at.x - a.linearised_at.x;
  const double dy = b.linearised_at.y - a.linearised_at.y;
  return {a.cosine * dx + a.sine * dy, a.cosine * dy - a.sine * dx, b.linearised_at.yaw - a.linearised_at.yaw,
          a.cosine * b.cosine + a.sine * b.sine, a.cosine * b.sine - a.sine * b.cosine};
}

PairExpansion IncrementalFit::expansion(const GraphRelation& r, const RelativePose& T_a_b) const {
  PairExpansion pair = expand(r.measurement, T_a_b);
  soften(r, options_.loss, pair);
  return pair;
}

void IncrementalFit::add(const GraphRelation& r, LooseSystem& system) const {
  const RelativePose T_a_b = relative(r);
  TieBlocks blocks = tie_blocks(expansion(r, T_a_b), T_a_b);
  const bool has_a = r.a != kWorld;
  if (has_a && nodes_[r.a].is_landmark) drop_heading(blocks.aa, blocks.a), blocks.ab.row(2).setZero();
  if (nodes_[r.b].is_landmark) drop_heading(blocks.bb, blocks.b), blocks.ab.col(2).setZero();
  // Of a relation to a node that is in a clique, that clique holds all but the share of the end that is loose.
  const bool a_moves = has_a && !nodes_[r.a].is_held && index_[r.a] >= 0;
  const bool b_moves = !nodes_[r.b].is_held && index_[r.b] >= 0;
  if (a_moves) {
    system.diagonal[index_[r.a]] += blocks.aa;
    system.gradient[index_[r.a]] += blocks.a;
  }
  if (b_moves) {
    system.diagonal[index_[r.b]] += blocks.bb;
    system.gradient[index_[r.b]] += blocks.b;
  }
  if (a_moves && b_moves) system.ties.push_back({index_[r.a], index_[r.b], blocks.ab});
}

LooseSystem IncrementalFit::linearise(std::vector<std::int32_t> nodes) {
  LooseSystem system;
  system.nodes = std::move(nodes);
  system.diagonal.assign(system.nodes.size(), Matrix3d::Zero());
  system.gradient.assign(system.nodes.size(), Vector3d::Zero());
  for (std::size_t i = 0; i < system.nodes.size(); ++i) index_[system.nodes[i]] = static_cast<std::int32_t>(i);
  for (std::size_t i = 0; i < system.nodes.size(); ++i) {
    const auto node = static_cast<std::uint32_t>(system.nodes[i]);
    for (const std::uint32_t id : nodes_[node].relations) {
      const GraphRelation& r = relations_[id];
      // Once: from b where both ends are loose.
      if (r.b == node || index_[r.b] < 0) add(r, system);
    }
  }
  for (std::size_t i = 0; i < system.nodes.size(); ++i) {
    const Node& node = nodes_[system.nodes[i]];
    if (node.is_held) system.diagonal[i].setIdentity();
    if (node.is_landmark) system.diagonal[i](2, 2) = 1;
    index_[system.nodes[i]] = -1;
  }
  system.last = static_cast<std::int32_t>(system.nodes.size()) - 1;
  return system;
}

Pose2 IncrementalFit::pose(std::uint32_t node) const {
  const double* xi = delta_.data() + kBlock * static_cast<std::size_t>(node);
  return nodes_[node].linearised_at * exponential({xi[0], xi[1], xi[2]});
}

std::vector<Pose2> IncrementalFit::poses() const {
  std::vector<Pose2> all;
  all.reserve(nodes_.size());
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) all.push_back(pose(node));
  return all;
}

double IncrementalFit::distance(const Vector3d& twist) const {
  return std::max({std::abs(twist[0]) / options_.relinearise_move_beyond,
                   std::abs(twist[1]) / options_.relinearise_move_beyond,
                   std::abs(twist[2]) / options_.relinearise_turn_beyond});
}

double IncrementalFit::cost_of(const GraphRelation& r) const {
  const Pose2 T_a_b = r.a == kWorld ? pose(r.b) : pose(r.a).inverse() * pose(r.b);
  return expansion(r, RelativePose::of(T_a_b)).cost;
}

/// Of all relations of these nodes.
double IncrementalFit::cost_around(std::span<const SolutionChange> nodes) {
  ++looks_;
  double sum = 0;
  for (const SolutionChange& change : nodes) {
    for (const std::uint32_t r : nodes_[change.node].relations) {
      if (std::exchange(looked_[r], looks_) != looks_) sum += cost_of(relations_[r]);
    }
  }
  return sum;
}

/// Takes a step back that raises the cost of what it moved.
bool IncrementalFit::take_back(std::vector<SolutionChange> changes) {
  // What goes less far in one step, next to what is linearised anew, cannot lead astray. Not a number is a leap, too.
  constexpr double kLeap = 30;
  const auto leaps = [&](const SolutionChange& c) { return !(distance(twist(c.node) - c.before) < kLeap); };
  if (std::none_of(changes.begin(), changes.end(), leaps)) return false;
  const auto exchange = [&] {
    for (SolutionChange& c : changes) twist(c.node).swap(c.before);
  };
  const double after = cost_around(changes);
  exchange();
  const double before = cost_around(changes);
  if (!(after <= std::max(before + 0.5, (1 + options_.most_rise) * before))) return true;
  exchange();
  return false;
}

IncrementalStep IncrementalFit::update() {
  IncrementalStep done = step();
  if (done.solved_fully) solve_fully();
  return done;
}

/// Says that the graph must be solved fully, and leaves that to others.
IncrementalStep IncrementalFit::step() {
  IncrementalStep step;
  for (const std::uint32_t node : touched_) tree_.claim(static_cast<std::int32_t>(node));
  touched_.clear();
  relinearise(step);
  std::vector<std::int32_t> nodes = tree_.release();
  nodes.insert(nodes.end(), loose_.begin(), loose_.end());
  std::sort(nodes.begin(), nodes.end());
  std::erase_if(nodes, [&](std::int32_t node) { return nodes_[node].is_removed; });
  loose_.clear();
  if (nodes.empty()) return step;
  const LooseSystem system = linearise(std::move(nodes));
  step.eliminated = system.nodes.size();
  step.is_determined = tree_.eliminate(system);
  for (const std::int32_t node : system.nodes) {
    if (!tree_.holds(node)) loose_.push_back(node);
  }
  std::vector<SolutionChange> changes = tree_.back_substitute(delta_, options_.propagate_beyond);
  step.moved = changes.size();
  for (const SolutionChange& change : changes) {
    if (distance(twist(change.node)) > 1) list_far(static_cast<std::uint32_t>(change.node));
  }
  step.solved_fully = take_back(std::move(changes));
  return step;
}

FitResult IncrementalFit::solve_fully(const FitOptions& options) {
  RelationGraph graph;
  std::vector<std::uint32_t> held;
  graph.poses = poses();
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    graph.is_landmark.push_back(nodes_[node].is_landmark);
    if (nodes_[node].is_held || nodes_[node].is_removed) held.push_back(node);
  }
  for (std::size_t r = 0; r < relations_.size(); ++r) {
    if (!is_removed_[r]) graph.relations.push_back(relations_[r]);
  }
  FitOptions with_loss = options;
  with_loss.loss = options_.loss;
  FitResult result = fit(graph, held, with_loss);
  for (std::uint32_t node = 0; node < nodes_.size(); ++node) {
    linearise_at(node, result.poses[node]);
    tree_.claim(static_cast<std::int32_t>(node));
  }
  // What is left is the last step's worth; where even that leads up it is taken back.
  step();
  return result;
}

double IncrementalFit::cost() const {
  double sum = 0;
  for (std::size_t i = 0; i < relations_.size(); ++i) {
    if (!is_removed_[i]) sum += cost_of(relations_[i]);
  }
  return sum;
}

}  // namespace helicoid
