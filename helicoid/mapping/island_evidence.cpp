#include "helicoid/mapping/island_evidence.hpp"

#include <fmt/format.h>

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "helicoid/align/place_search.hpp"
#include "helicoid/manifold/confidence.hpp"

namespace helicoid {

namespace {

/// All that an island's patches saw, in its plane, and a window that holds every placement on it.
struct IslandView {
  ScorePyramid pyramid;
  PlaceWindow window;
};

IslandView view_of(const Map& map, const Island& island, const IslandEvidenceOptions& options) {
  std::vector<ReferencePart> parts;
  Vector2d low(HUGE_VAL, HUGE_VAL);
  Vector2d high = -low;
  for (const PatchId id : island.patches) {
    parts.push_back({&map.patch(id).points, map.T_plane_patch(id)});
    low = low.cwiseMin(map.T_plane_patch(id).translation());
    high = high.cwiseMax(map.T_plane_patch(id).translation());
  }
  Reference reference;
  reference.build(parts);
  IslandView view{ScorePyramid(reference), {}};
  const Vector2d middle = 0.5 * (low + high);
  view.window.T_reference_scan = {middle.x(), middle.y(), 0};
  view.window.half_width = 0.5 * (high - low).maxCoeff() + 2;
  view.window.half_turn = std::numbers::pi;
  view.window.turn_step = options.turn_step;
  view.window.least_score = options.least_score;
  return view;
}

/// Patches of an island at equal distances along its robots' ways.
std::vector<PatchId> places_along(const Island& island, std::span<const double> along,
                                  const IslandEvidenceOptions& options) {
  std::vector<PatchId> places;
  double last = -HUGE_VAL;
  for (const PatchId id : island.patches) {
    if (std::abs(along[id.index()] - last) < options.place_spacing) continue;
    last = along[id.index()];
    places.push_back(id);
  }
  const std::size_t stride = places.size() / options.most_places + 1;
  std::vector<PatchId> spread;
  for (std::size_t i = 0; i < places.size(); i += stride) spread.push_back(places[i]);
  return spread;
}

PatchId nearest_patch(const Map& map, const Island& island, const Vector2d& p_plane) {
  return *std::min_element(island.patches.begin(), island.patches.end(), [&](PatchId x, PatchId y) {
    return (map.T_plane_patch(x).translation() - p_plane).squaredNorm() <
           (map.T_plane_patch(y).translation() - p_plane).squaredNorm();
  });
}

/// Where a place of one island seems to lie on another.
std::optional<Hypothesis> look_for(const Map& map, const InformationGraph& graph, PatchId place, const Island& there,
                                   const IslandView& view, const MapperOptions& mapper,
                                   const IslandEvidenceOptions& options) {
  const LookAlikeOptions look_alike;
  const PlaceBefore seen = see_place(map, place, look_alike);
  const PlaceSearch found = search_place(view.pyramid, seen.points, view.window);
  if (found.best.score <= 0) return std::nullopt;
  const Pose2& T_plane_place = found.best.T_reference_scan;
  const PatchId a = nearest_patch(map, there, T_plane_place.translation());
  Candidate candidate{a, {map.T_plane_patch(a).inverse() * T_plane_place, Matrix3d::Zero()}};
  const double position = options.placed_within / 1.96;
  const double heading = options.placed_within_turn / 1.96;
  candidate.T_a_b.covariance.diagonal() << position * position, position * position, heading * heading;
  std::optional<Hypothesis> h = compare_places(map, graph, candidate, seen, mapper, look_alike);
  if (!h) return std::nullopt;
  h->ambiguity = found.second.score / found.best.score;
  if (h->b < h->a) {
    std::swap(h->a, h->b);
    h->T_a_b = invert(h->T_a_b);
  }
  return h;
}

/// True of a proposal whose islands are one by now: it is rejected if the map has the two places elsewhere.
bool is_answered(const Map& map, LoopCloser& closer, std::size_t entry, const IslandEvidenceOptions& options) {
  Hypothesis h = closer.ledger()[entry];
  if (map.island_of(h.a) != map.island_of(h.b)) return false;
  const Pose2 T_a_b = map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
  const double off = (T_a_b.translation() - h.T_a_b.T_a_b.translation()).norm();
  const double allowed = 2 * options.placed_within + confidence_interval(h.T_a_b.covariance).position;
  if (!h.is_undecided() || off <= allowed) return true;
  h.state = HypothesisState::rejected;
  h.decided_by = DecidedBy::evidence;
  h.reason = fmt::format("the islands were joined otherwise: there the place lies {:.1f} m off", off);
  closer.revise(entry, std::move(h));
  return true;
}

/// One pair of islands; `here` is the smaller one.
bool compare_islands(MapInProgress& progress, LoopCloser& closer, const Island& there, const Island& here,
                     bool may_join, const MapperOptions& mapper, const IslandEvidenceOptions& options) {
  const Map& map = progress.map;
  const IslandView view = view_of(map, there, options);
  JoinTrials trials;
  for (const PatchId place : places_along(here, closer.along(), options)) {
    std::optional<Hypothesis> h = look_for(map, progress.graph, place, there, view, mapper, options);
    if (!h) continue;
    const std::vector<std::size_t> accepted = closer.consider_between(map, progress.graph, std::move(*h), may_join);
    if (!accepted.empty() && act_on_or_join(progress, closer, accepted, trials, mapper)) return true;
  }
  return false;
}

}  // namespace

bool join_on_evidence(MapInProgress& progress, LoopCloser& closer, bool may_join, const MapperOptions& mapper,
                      const IslandEvidenceOptions& options) {
  bool joined = false;
  for (bool again = true; again;) {
    again = false;
    std::vector<Island> islands = progress.map.islands();
    std::stable_sort(islands.begin(), islands.end(),
                     [](const Island& x, const Island& y) { return x.patches.size() > y.patches.size(); });
    for (std::size_t i = 1; i < islands.size() && !again; ++i) {
      for (std::size_t k = 0; k < i && !again; ++k) {
        again = compare_islands(progress, closer, islands[k], islands[i], may_join, mapper, options);
      }
    }
    joined = joined || again;
  }
  return joined;
}

std::vector<PatchId> IslandProposals::new_places(const Map& map, const LoopCloser& closer,
                                                 const IslandEvidenceOptions& options) {
  // A robot that has only just begun has not seen a place yet.
  looked_at_.resize(map.robots().size(), 0);
  std::vector<PatchId> places;
  for (; next_ < map.patch_count(); ++next_) {
    const PatchId id = make_id<PatchId>(next_);
    double& last = looked_at_[map.patch(id).robot.index()];
    if (closer.along()[next_] - last < options.place_spacing) continue;
    last = closer.along()[next_];
    places.push_back(id);
  }
  return places;
}

void IslandProposals::look(MapInProgress& progress, LoopCloser& closer, const MapperOptions& mapper,
                           const IslandEvidenceOptions& options) {
  const Map& map = progress.map;
  closer.follow_ways(map);
  const std::vector<PatchId> places = new_places(map, closer, options);
  const std::vector<Island> islands = map.islands();
  for (const Island& there : islands) {
    if (islands.size() == 1 || places.empty()) break;
    const IslandView view = view_of(map, there, options);
    for (const PatchId place : places) {
      if (map.island_of(place) == there.id) continue;
      std::optional<Hypothesis> h = look_for(map, progress.graph, place, there, view, mapper, options);
      if (!h) continue;
      waiting_.push_back(closer.ledger().size());
      closer.consider_between(map, progress.graph, std::move(*h), false);
    }
  }
}

void IslandProposals::answer(const Map& map, LoopCloser& closer, const IslandEvidenceOptions& options) {
  std::erase_if(waiting_, [&](std::size_t entry) { return is_answered(map, closer, entry, options); });
}

bool act_on_or_join(MapInProgress& progress, LoopCloser& closer, std::span<const std::size_t> accepted,
                    JoinTrials& trials, const MapperOptions& mapper) {
  const Hypothesis& h = closer.ledger()[accepted.back()];
  if (progress.map.island_of(h.a) == progress.map.island_of(h.b)) {
    act_on(progress, closer, accepted, mapper);
    return true;
  }
  if (h.decided_by == DecidedBy::evidence) return trials.join_if_it_holds(progress, closer, accepted, mapper);
  join_by_entries(progress, closer, accepted, mapper);
  return true;
}

}  // namespace helicoid
