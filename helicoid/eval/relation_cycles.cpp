#include "helicoid/eval/relation_cycles.hpp"

#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace helicoid {

namespace {

/// Stamps of a relation's ends repeat those of others to rounding.
constexpr double kSameStamp = 1e-4;

/// The scans that relations name, numbered, and the relations of each.
class ScanGraph {
 public:
  ScanGraph(std::span<const EvaluatedRelation> relations, const Matrix3d& noise) {
    for (const EvaluatedRelation& r : relations) {
      const std::size_t a = number(r.robot_a, r.stamp_a);
      const std::size_t b = number(r.robot_b, r.stamp_b);
      if (a == b) continue;
      const UncertainPose2 T_a_b{r.T_a_b, noise};
      related_[a].emplace(b, T_a_b);
      related_[b].emplace(a, invert(T_a_b));
    }
  }
  using Related = std::map<std::size_t, UncertainPose2>;
  [[nodiscard]] const std::vector<Related>& related() const { return related_; }

 private:
  std::size_t number(const std::string& robot, double stamp) {
    const auto [at, is_new] = numbers_.try_emplace({robot, std::llround(stamp / kSameStamp)}, numbers_.size());
    if (is_new) related_.emplace_back();
    return at->second;
  }

  std::map<std::pair<std::string, long long>, std::size_t> numbers_;
  std::vector<Related> related_;
};

}  // namespace

CycleClosure close_cycles(std::span<const EvaluatedRelation> relations, const Matrix3d& noise) {
  const ScanGraph graph(relations, noise);
  CycleClosure closure;
  for (std::size_t a = 0; a < graph.related().size(); ++a) {
    for (const auto& [b, T_a_b] : graph.related()[a]) {
      if (b < a) continue;
      for (const auto& [c, T_b_c] : graph.related()[b]) {
        const auto T_c_a = graph.related()[c].find(a);
        if (c < b || T_c_a == graph.related()[c].end()) continue;
        closure.coverage.add(compound(compound(T_a_b, T_b_c), T_c_a->second), Pose2{});
      }
    }
  }
  closure.noise_factor = std::sqrt(closure.coverage.nees_per_freedom());
  return closure;
}

}  // namespace helicoid
