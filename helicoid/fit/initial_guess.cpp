#include "helicoid/fit/initial_guess.hpp"

#include <cmath>
#include <deque>
#include <optional>

#include "helicoid/fit/linear_system.hpp"

namespace helicoid {

namespace {

/// T_a_b as a relation has it, if it tells it; of landmarks the place alone.
std::optional<Pose2> told_pose(const Measurement& measurement) {
  if (const auto* m = std::get_if<PosePose>(&measurement)) return m->T_a_b;
  if (const auto* m = std::get_if<Correspondences>(&measurement)) return minimise(*m->form, Pose2{}).T_a_b;
  if (const auto* m = std::get_if<PointPosition>(&measurement)) return Pose2{m->p_a.x(), m->p_a.y(), 0};
  return std::nullopt;
}

/// Places node after node; chains run ahead of all other relations.
class DeadReckoning {
 public:
  DeadReckoning(const RelationGraph& graph, const std::vector<bool>& is_placed)
      : graph_(graph), poses_(graph.poses), placed_(is_placed), relations_of_(graph.poses.size()) {
    if (placed_.empty()) placed_.assign(graph.poses.size(), false);
    for (std::uint32_t i = 0; i < graph.relations.size(); ++i) {
      const GraphRelation& r = graph.relations[i];
      relations_of_[r.b].push_back(i);
      if (r.a != kWorld) relations_of_[r.a].push_back(i);
    }
  }

  std::vector<Pose2> run() {
    const auto count = static_cast<std::uint32_t>(poses_.size());
    for (std::uint32_t i = 0; i < graph_.relations.size(); ++i) {
      const GraphRelation& r = graph_.relations[i];
      const std::optional<Pose2> told = r.a == kWorld && !placed_[r.b] ? told_pose(r.measurement) : std::nullopt;
      if (told) place(r.b, *told);
    }
    for (std::uint32_t i = 0; i < count; ++i) {
      if (placed_[i]) offer(i);
    }
    grow();
    for (std::uint32_t i = 0; i < count; ++i) {
      if (placed_[i]) continue;
      place(i, Pose2{});
      offer(i);
      grow();
    }
    return poses_;
  }

 private:
  struct Candidate {
    std::uint32_t relation;
    std::uint32_t from;
  };

  void place(std::uint32_t node, const Pose2& pose) {
    poses_[node] = pose;
    placed_[node] = true;
    if (!graph_.is_landmark.empty() && graph_.is_landmark[node]) poses_[node].yaw = 0;
  }

  void offer(std::uint32_t node) {
    for (const std::uint32_t i : relations_of_[node]) {
      const GraphRelation& r = graph_.relations[i];
      if (r.a == kWorld) continue;
      const std::uint32_t other = r.a == node ? r.b : r.a;
      if (placed_[other]) continue;
      if (other == node + 1 || node == other + 1) {
        queue_.push_front({i, node});
      } else {
        queue_.push_back({i, node});
      }
    }
  }

  void grow() {
    std::vector<Candidate> vague;
    while (!queue_.empty()) {
      const Candidate c = queue_.front();
      queue_.pop_front();
      const GraphRelation& r = graph_.relations[c.relation];
      const bool forward = r.a == c.from;
      const std::uint32_t other = forward ? r.b : r.a;
      if (placed_[other]) continue;
      const std::optional<Pose2> told = told_pose(r.measurement);
      const bool only_place = std::holds_alternative<PointPosition>(r.measurement);
      if (told && (forward || !only_place)) {
        place(other, poses_[c.from] * (forward ? *told : told->inverse()));
        offer(other);
      } else {
        vague.push_back(c);
      }
    }
    // Whom only ranges and bearings tie starts where the other end stands, a step apart.
    for (const Candidate& c : vague) {
      const GraphRelation& r = graph_.relations[c.relation];
      const std::uint32_t other = r.a == c.from ? r.b : r.a;
      if (placed_[other]) continue;
      const auto* range = std::get_if<RelativeRange>(&r.measurement);
      const auto* bearing = std::get_if<RelativeBearing>(&r.measurement);
      const double distance = range != nullptr ? range->range : 1;
      const double angle = bearing != nullptr ? bearing->bearing : 0;
      place(other, poses_[c.from] * Pose2{distance * std::cos(angle), distance * std::sin(angle), 0});
      offer(other);
    }
    if (!queue_.empty()) grow();
  }

  const RelationGraph& graph_;
  std::vector<Pose2> poses_;
  std::vector<bool> placed_;
  std::vector<std::vector<std::uint32_t>> relations_of_;
  std::deque<Candidate> queue_;
};

/// r_b = R(phi) r_a for the unit vectors of two headings, with this weight.
struct HeadingTie {
  double phi = 0;
  double weight = 0;
};
HeadingTie heading_tie(const Measurement& measurement) {
  if (const auto* m = std::get_if<PosePose>(&measurement)) return {m->T_a_b.yaw, m->information(2, 2)};
  if (const auto* m = std::get_if<Correspondences>(&measurement)) {
    const Pose2 T_a_b = minimise(*m->form, Pose2{}).T_a_b;
    return {T_a_b.yaw, m->scale * expand(*m->form, T_a_b).information(2, 2)};
  }
  return {};
}

void add_heading(BlockMatrix& H, std::vector<double>& right, std::size_t a, std::size_t b, bool a_moves, bool b_moves,
                 const HeadingTie& tie, const Pose2& pose_a, const Pose2& pose_b) {
  const double c = std::cos(tie.phi);
  const double s = std::sin(tie.phi);
  for (const auto& [node, moves] : {std::pair{a, a_moves}, std::pair{b, b_moves}}) {
    if (!moves) continue;
    H.diagonal[9 * node] += tie.weight;
    H.diagonal[9 * node + 4] += tie.weight;
  }
  if (a_moves && b_moves) {
    const std::size_t column = std::min(a, b);
    const auto begin = H.row.begin() + static_cast<std::ptrdiff_t>(H.first[column]);
    const auto end = H.row.begin() + static_cast<std::ptrdiff_t>(H.first[column + 1]);
    const auto at = std::lower_bound(begin, end, static_cast<std::int32_t>(std::max(a, b)));
    double* block = H.below.data() + 9 * (at - H.row.begin());
    // Row b, column a: -w R(phi); its transpose the other way round.
    const double sign = a < b ? s : -s;
    block[0] -= tie.weight * c;
    block[1] -= tie.weight * sign;
    block[3] += tie.weight * sign;
    block[4] -= tie.weight * c;
  } else if (b_moves) {
    right[3 * b] += tie.weight * std::cos(pose_a.yaw + tie.phi);
    right[3 * b + 1] += tie.weight * std::sin(pose_a.yaw + tie.phi);
  } else if (a_moves) {
    right[3 * a] += tie.weight * std::cos(pose_b.yaw - tie.phi);
    right[3 * a + 1] += tie.weight * std::sin(pose_b.yaw - tie.phi);
  }
}

/// Headings that fit best as free vectors, then normalised. False if they are not determined.
bool fit_headings(RelationGraph& graph, LinearSystem& system) {
  const Supernodes& supernodes = system.supernodes();
  BlockMatrix H = system.information();
  H.set_zero();
  std::vector<double> right(3 * graph.poses.size(), 0.0);
  for (const GraphRelation& r : graph.relations) {
    const HeadingTie tie = heading_tie(r.measurement);
    if (tie.weight <= 0 || r.a == kWorld) continue;
    add_heading(H, right, static_cast<std::size_t>(supernodes.place[r.a]),
                static_cast<std::size_t>(supernodes.place[r.b]), !system.is_fixed(r.a), !system.is_fixed(r.b), tie,
                graph.poses[r.a], graph.poses[r.b]);
  }
  for (std::uint32_t i = 0; i < graph.poses.size(); ++i) {
    double* block = H.diagonal.data() + 3 * system.offset(i);
    block[8] = 1;
    if (system.is_fixed(i) || block[0] == 0) block[0] = block[4] = 1;
  }
  BlockCholesky cholesky(supernodes);
  if (!cholesky.factorise(H)) return false;
  cholesky.solve(right);
  for (std::uint32_t i = 0; i < graph.poses.size(); ++i) {
    const double* r = right.data() + system.offset(i);
    if (!system.is_fixed(i) && (r[0] != 0 || r[1] != 0)) graph.poses[i].yaw = std::atan2(r[1], r[0]);
  }
  return true;
}

}  // namespace

std::vector<Pose2> odometry_start(const RelationGraph& graph, const std::vector<bool>& is_placed) {
  return DeadReckoning(graph, is_placed).run();
}

std::vector<Pose2> reckon_from(const RelationGraph& graph, std::span<const std::uint32_t> held) {
  std::vector<bool> is_held(graph.poses.size(), false);
  for (const std::uint32_t node : held) is_held[node] = true;
  return odometry_start(graph, is_held);
}

std::vector<Pose2> chordal_start(const RelationGraph& whole, std::span<const std::uint32_t> held) {
  RelationGraph graph = whole;
  graph.poses = reckon_from(whole, held);
  std::vector<Pose2> reckoned = graph.poses;
  std::erase_if(graph.relations, [](const GraphRelation& r) { return !told_pose(r.measurement); });
  const std::vector<std::uint32_t> gauge = gauge_with(graph, held);
  // Once headings are held, what is left is linear in the positions: one step solves it.
  graph.is_landmark.assign(graph.poses.size(), true);
  LinearSystem system(graph, gauge);
  if (!fit_headings(graph, system)) return reckoned;
  if (!whole.is_landmark.empty()) {
    for (std::size_t i = 0; i < graph.poses.size(); ++i) {
      if (whole.is_landmark[i]) graph.poses[i].yaw = 0;
    }
  }
  system.linearise(graph.poses);
  return system.factorise() ? system.moved(graph.poses, system.newton_step()) : reckoned;
}

}  // namespace helicoid
