#include "helicoid/mapping/fit_around.hpp"

#include <Eigen/Cholesky>
#include <algorithm>
#include <cmath>

#include "helicoid/fit/fit_graph.hpp"
#include "helicoid/fit/pose_marks.hpp"
#include "helicoid/fit/tie_blocks.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

/// Islands of so many patches are fitted whole, in some milliseconds.
constexpr std::size_t kWhole = 1000;
/// In larger ones a region begins with so many.
constexpr std::size_t kFirstRegion = 200;
/// A held patch that would go this much farther if it alone were let go does not hold: metres, turns at kReach.
constexpr double kAtRest = 1e-4;
constexpr double kReach = 3;

/// A part of an island that is fitted while the patches about it are held.
class Region {
 public:
  explicit Region(const Map& map) : map_(map), is_inside_(map.patch_count()) {}

  /// Takes in the patches and, outward from them along relations, others until there are so many more.
  void grow(std::span<const PatchId> from, std::size_t more) {
    const std::size_t limit = inside_.size() + more;
    std::size_t next = inside_.size();
    for (const PatchId id : from) take(id);
    for (; next < inside_.size(); ++next) {
      const PatchId id = inside_[next];
      for (const RelationId r : map_.relations_of(id)) {
        if (inside_.size() < limit) take(other_end(r, id));
      }
    }
  }

  /// Nothing is inside any more.
  void let_go() {
    for (const PatchId id : inside_) is_inside_.set(id.value, PoseMarks::kNone);
    inside_.clear();
  }

  /// Fits what is inside. Where nothing is held, its first patch is the gauge.
  void fit_inside(MapEditor& editor) const {
    const std::vector<PatchId> inside = patches();
    const std::vector<PatchId> held = related_outside();
    const auto place = [&](PatchId id) {
      const std::vector<PatchId>& all = is_inside(id) ? inside : held;
      const std::size_t first = is_inside(id) ? 0 : inside.size();
      return static_cast<std::uint32_t>(
          first + static_cast<std::size_t>(std::lower_bound(all.begin(), all.end(), id) - all.begin()));
    };
    std::vector<Pose2> start;
    start.reserve(inside.size() + held.size());
    for (const PatchId id : inside) start.push_back(map_.T_plane_patch(id));
    std::vector<std::uint32_t> fixed;
    for (const PatchId id : held) {
      fixed.push_back(static_cast<std::uint32_t>(start.size()));
      start.push_back(map_.T_plane_patch(id));
    }
    if (fixed.empty()) fixed.push_back(0);
    std::vector<GraphEdge> edges;
    for (const RelationId id : relations()) {
      const Relation& r = map_.relation(id);
      edges.push_back({place(r.a), place(r.b), &r.form, 1 / information_divisor(map_, r)});
    }
    if (edges.empty()) return;
    const FitResult result = fit(make_graph(start, edges), fixed);
    for (std::size_t i = 0; i < inside.size(); ++i) editor.set_pose(inside[i], result.poses[i]);
  }

  /// The patches about it that would move if they were let go.
  [[nodiscard]] std::vector<PatchId> strained() const {
    std::vector<PatchId> moving = related_outside();
    std::erase_if(moving, [&](PatchId id) { return step_alone(id) < kAtRest; });
    return moving;
  }

  [[nodiscard]] bool is_whole_island() const { return related_outside().empty(); }
  [[nodiscard]] std::size_t size() const { return inside_.size(); }
  /// What is inside, ascending.
  [[nodiscard]] std::vector<PatchId> patches() const {
    std::vector<PatchId> ascending = inside_;
    std::sort(ascending.begin(), ascending.end());
    return ascending;
  }

 private:
  static constexpr std::int32_t kInside = 0;

  [[nodiscard]] bool is_inside(PatchId id) const { return is_inside_[id.value] == kInside; }
  void take(PatchId id) {
    if (is_inside(id)) return;
    is_inside_.set(id.value, kInside);
    inside_.push_back(id);
  }
  [[nodiscard]] PatchId other_end(RelationId id, PatchId one) const {
    const Relation& r = map_.relation(id);
    return r.a == one ? r.b : r.a;
  }

  /// All relations of what is inside, in the order in which they were made.
  [[nodiscard]] std::vector<RelationId> relations() const {
    std::vector<RelationId> all;
    for (const PatchId id : inside_) {
      const std::span<const RelationId> of_patch = map_.relations_of(id);
      all.insert(all.end(), of_patch.begin(), of_patch.end());
    }
    std::sort(all.begin(), all.end());
    all.erase(std::unique(all.begin(), all.end()), all.end());
    return all;
  }

  /// Related to something inside without being there; ascending.
  [[nodiscard]] std::vector<PatchId> related_outside() const {
    std::vector<PatchId> about;
    for (const PatchId id : inside_) {
      for (const RelationId r : map_.relations_of(id)) {
        if (!is_inside(other_end(r, id))) about.push_back(other_end(r, id));
      }
    }
    std::sort(about.begin(), about.end());
    about.erase(std::unique(about.begin(), about.end()), about.end());
    return about;
  }

  /// How far a patch would go if it alone were let go: metres, turns at kReach.
  [[nodiscard]] double step_alone(PatchId id) const {
    Matrix3d H = Matrix3d::Zero();
    Vector3d g = Vector3d::Zero();
    for (const RelationId r : map_.relations_of(id)) {
      const Relation& relation = map_.relation(r);
      const Pose2 T_a_b = map_.T_plane_patch(relation.a).inverse() * map_.T_plane_patch(relation.b);
      const TieBlocks blocks = tie_blocks(expand(relation.form, T_a_b), RelativePose::of(T_a_b));
      const double scale = 1 / information_divisor(map_, relation);
      H += scale * (relation.a == id ? blocks.aa : blocks.bb);
      g += scale * (relation.a == id ? blocks.a : blocks.b);
    }
    const Vector3d step = H.ldlt().solve(g);
    return std::max(step.head<2>().norm(), kReach * std::abs(step[2]));
  }

  const Map& map_;
  PoseMarks is_inside_;
  std::vector<PatchId> inside_;  ///< in the order in which they were taken in
};

/// The related patches are of one island.
std::vector<PatchId> fit_region(const Map& map, MapEditor& editor, std::span<const PatchId> related) {
  Region region(map);
  region.grow(related, kWhole);
  if (!region.is_whole_island()) {
    region.let_go();
    region.grow(related, kFirstRegion);
  }
  region.fit_inside(editor);
  while (true) {
    const std::vector<PatchId> strained = region.strained();
    if (strained.empty()) return region.patches();
    // Twice as many each time: all rounds together cost little more than the last.
    region.grow(strained, region.size());
    region.fit_inside(editor);
  }
}

}  // namespace

std::vector<PatchId> fit_around(const Map& map, MapEditor& editor, std::span<const PatchId> related) {
  std::vector<PatchId> fitted;
  std::vector<PatchId> left(related.begin(), related.end());
  while (!left.empty()) {
    const IslandId island = map.island_of(left.front());
    const auto others =
        std::stable_partition(left.begin(), left.end(), [&](PatchId id) { return map.island_of(id) == island; });
    const std::vector<PatchId> of_island = fit_region(map, editor, std::span(left.begin(), others));
    fitted.insert(fitted.end(), of_island.begin(), of_island.end());
    left.erase(left.begin(), others);
  }
  std::sort(fitted.begin(), fitted.end());
  return fitted;
}

}  // namespace helicoid
