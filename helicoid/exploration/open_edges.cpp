#include "helicoid/exploration/open_edges.hpp"

#include <algorithm>

namespace helicoid {

namespace {

/// The neighbours of patches and the neighbours' neighbours, as sets. A chain of two: patches that see one place from
/// far apart need not be confident of each other to be on one sheet.
std::vector<PatchSet> within_two(const Neighbours& neighbours) {
  std::vector<PatchSet> near(neighbours.size(), PatchSet(neighbours.size()));
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    near[i].insert(i);
    for (const PatchId n : neighbours[i]) near[i].insert(n.index());
  }
  std::vector<PatchSet> two = near;
  for (std::size_t i = 0; i < neighbours.size(); ++i) {
    for (const PatchId n : neighbours[i]) two[i] |= near[n.index()];
  }
  return two;
}

PatchSet enlarged(const PatchSet& set, std::size_t size) {
  PatchSet larger(size);
  set.for_each([&](std::size_t i) { larger.insert(i); });
  return larger;
}

}  // namespace

void OpenEdges::update(const Map& map, const Neighbours& neighbours) {
  if (map.patch_count() < edges_.size()) edges_.clear();
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    // Another map: a replay may have kept other scans under the same numbers.
    if (&edges_[i].view->patch() != &map.patch(make_id<PatchId>(i))) {
      edges_.clear();
      break;
    }
  }
  for (std::size_t i = edges_.size(); i < map.patch_count(); ++i) {
    const auto id = make_id<PatchId>(i);
    Edge& edge = edges_.emplace_back();
    edge.view = std::make_unique<PatchView>(map.patch(id), options_.view);
    edge.open = edge.view->open_points();
    edge.T_plane_patch_compared = map.T_plane_patch(id);
  }
  find_same_place(map);
  find_around(map, neighbours);
  forget_moved(map);
  for (std::size_t i = 0; i < edges_.size(); ++i) compare(map, i);
}

void OpenEdges::find_same_place(const Map& map) {
  // What is known grows with the relations; poses that a fit moves change little about it.
  if (same_place_.size() == map.patch_count() && relations_then_ == map.relations().size()) return;
  same_place_ = find_neighbours(map, options_.same_place);
  relations_then_ = map.relations().size();
}

void OpenEdges::find_around(const Map& map, const Neighbours& neighbours) {
  std::vector<PatchSet> told_by = within_two(neighbours);
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    Edge& edge = edges_[i];
    const Patch& patch = map.patch(make_id<PatchId>(i));
    const Vector2d at = map.T_plane_patch(patch.id).translation();
    for (const PatchId other : same_place_[i]) told_by[i].insert(other.index());
    edge.around.clear();
    edge.near = PatchSet(edges_.size());
    told_by[i].for_each([&](std::size_t k) {
      const auto other = make_id<PatchId>(k);
      const double apart = (map.T_plane_patch(other).translation() - at).norm();
      if (apart > patch.free_reach + map.patch(other).reach + 2 * options_.beyond) return;
      edge.around.push_back(other);
      edge.near.insert(k);
    });
  }
}

void OpenEdges::forget_moved(const Map& map) {
  PatchSet moved(edges_.size());
  bool any = false;
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    const Pose2& now = map.T_plane_patch(make_id<PatchId>(i));
    const Pose2& then = edges_[i].T_plane_patch_compared;
    if (std::hypot(now.x - then.x, now.y - then.y) <= options_.moved &&
        std::abs(wrap_angle(now.yaw - then.yaw)) <= options_.turned) {
      continue;
    }
    moved.insert(i);
    any = true;
    edges_[i].T_plane_patch_compared = now;
  }
  for (std::size_t i = 0; i < edges_.size(); ++i) {
    Edge& edge = edges_[i];
    edge.compared = enlarged(edge.compared, edges_.size());
    PatchSet gone = edge.compared;
    gone -= edge.near;
    const bool anew = gone.intersects(gone) || (any && (moved.contains(i) || moved.intersects(edge.compared)));
    if (!anew) continue;
    edge.open = edge.view->open_points();
    edge.compared.clear();
  }
}

void OpenEdges::compare(const Map& map, std::size_t patch) {
  Edge& edge = edges_[patch];
  const Pose2& T_plane_patch = map.T_plane_patch(make_id<PatchId>(patch));
  for (const PatchId other : edge.around) {
    if (edge.compared.contains(other.index())) continue;
    edge.compared.insert(other.index());
    if (edge.open.empty()) continue;
    const PatchView& view = *edges_[other.index()].view;
    const Pose2 T_other_patch = map.T_plane_patch(other).inverse() * T_plane_patch;
    const Matrix2d R = T_other_patch.rotation();
    std::erase_if(edge.open, [&](const OpenPoint& point) {
      const Eigen::Vector2f p = point.p_patch + static_cast<float>(options_.beyond) * point.outward_patch;
      return view.knows(R * p.cast<double>() + T_other_patch.translation());
    });
  }
}

}  // namespace helicoid
