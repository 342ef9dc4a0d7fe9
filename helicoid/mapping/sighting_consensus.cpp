#include "helicoid/mapping/sighting_consensus.hpp"

#include <Eigen/LU>
#include <algorithm>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/sighting_fit.hpp"

namespace helicoid {

namespace {

/// A supposed relative pose of two islands, by a patch of either, and how all else lies to those patches.
class Supposition {
 public:
  Supposition(const Map& map, const InformationGraph& graph, PatchId a, PatchId b, const UncertainPose2& T_a_b)
      : map_(map), a_(a), b_(b), T_a_b_(T_a_b), about_a_(spread(map, graph, a)), about_b_(spread(map, graph, b)) {}

  /// How well a sighting between the islands fits.
  [[nodiscard]] SightingFit fit(const PlacedSighting& s) const {
    const bool forward = map_.island_of(s.observer.patch) == map_.island_of(a_);
    const UncertainPose2 T_near = from(forward ? about_a_ : about_b_, s.observer);
    const UncertainPose2 T_far = from(forward ? about_b_ : about_a_, s.observed);
    const UncertainPose2 across = forward ? T_a_b_ : invert(T_a_b_);
    return fit_of(s.sighting, compound(compound(invert(T_near), across), T_far));
  }

 private:
  using About = std::vector<UncertainPose2>;

  /// T_patch_x of every patch x of its island, by id.
  static About spread(const Map& map, const InformationGraph& graph, PatchId patch) {
    BoundOptions everything = bound_options(map.patch(patch), 1e3, 1e3, 1e9);
    everything.most = map.patch_count();
    About about(map.patch_count(), {Pose2{}, 1e6 * Matrix3d::Identity()});
    for (const BoundedPose& p : tree_bound(graph, map.poses(), patch.value, everything)) about[p.pose] = p.relative;
    return about;
  }
  static UncertainPose2 from(const About& about, const ManifoldPose& robot) {
    return compound(about[robot.patch.index()], {robot.T_patch_robot, Matrix3d::Zero()});
  }

  const Map& map_;
  PatchId a_, b_;
  UncertainPose2 T_a_b_;
  About about_a_, about_b_;
};

/// Those that agree, each record's best candidate.
std::vector<SightingOption> members_of(const Supposition& supposed, std::span<const SightingOption> options) {
  std::vector<SightingOption> members;
  double best = 0;
  for (const SightingOption& option : options) {
    const SightingFit fit = supposed.fit(option.placed);
    if (fit.measurements == 0 || !fit.agrees()) continue;
    if (members.empty() || members.back().record != option.record) {
      members.push_back(option);
    } else if (fit.chi2 < best) {
      members.back() = option;
    } else {
      continue;
    }
    best = fit.chi2;
  }
  return members;
}

std::vector<PlacedSighting> placed(std::span<const SightingOption> options) {
  std::vector<PlacedSighting> all;
  for (const SightingOption& option : options) all.push_back(option.placed);
  return all;
}

SightingConsensus consensus_of(const Map& map, std::vector<SightingOption> members) {
  IslandJoin join = estimate_join(map, placed(members));
  return {join, std::move(members)};
}

/// The joint optimum of all, without those that do not fit it.
SightingConsensus trim(const Map& map, const InformationGraph& graph, std::vector<SightingOption> left) {
  while (!left.empty()) {
    const IslandJoin join = estimate_join(map, placed(left));
    if (!join.determined) break;
    const Supposition supposed(map, graph, join.a, join.b, {join.T_a_b, join.information.inverse()});
    const auto excess = [&](const SightingOption& option) {
      const SightingFit fit = supposed.fit(option.placed);
      return fit.agrees() ? 0 : fit.chi2;
    };
    const auto worst =
        std::max_element(left.begin(), left.end(),
                         [&](const SightingOption& x, const SightingOption& y) { return excess(x) < excess(y); });
    if (excess(*worst) <= 0) return {join, std::move(left)};
    left.erase(worst);
  }
  return {};
}

std::size_t identified(const SightingConsensus& c) {
  return static_cast<std::size_t>(
      std::count_if(c.members.begin(), c.members.end(), [](const SightingOption& o) { return o.identified; }));
}

bool is_better(const SightingConsensus& x, const SightingConsensus& y) {
  if (x.members.size() != y.members.size()) return x.members.size() > y.members.size();
  if (identified(x) != identified(y)) return identified(x) > identified(y);
  return x.join.chi2 < y.join.chi2;
}

bool has_same_members(const SightingConsensus& x, const SightingConsensus& y) {
  return std::equal(x.members.begin(), x.members.end(), y.members.begin(), y.members.end(),
                    [](const SightingOption& p, const SightingOption& q) {
                      return p.record == q.record && p.candidate == q.candidate;
                    });
}

}  // namespace

std::vector<SightingConsensus> find_consensuses(const Map& map, const InformationGraph& graph,
                                                std::span<const SightingOption> options) {
  std::vector<SightingConsensus> found;
  const auto offer = [&](SightingConsensus consensus) {
    const bool known = std::any_of(found.begin(), found.end(),
                                   [&](const SightingConsensus& c) { return has_same_members(c, consensus); });
    if (!known && consensus.join.determined) found.push_back(std::move(consensus));
  };
  bool partial = false;
  for (const SightingOption& option : options) {
    const std::optional<UncertainPose2> T = whole_pose(option.placed.sighting);
    partial = partial || !T;
    if (!T) continue;
    const PlacedSighting& s = option.placed;
    const UncertainPose2 T_patches = compound(compound({s.observer.T_patch_robot, Matrix3d::Zero()}, *T),
                                              {s.observed.T_patch_robot.inverse(), Matrix3d::Zero()});
    const Supposition supposed(map, graph, s.observer.patch, s.observed.patch, T_patches);
    offer(consensus_of(map, members_of(supposed, options)));
  }
  if (partial) offer(trim(map, graph, {options.begin(), options.end()}));
  std::stable_sort(found.begin(), found.end(), is_better);
  return found;
}

}  // namespace helicoid
