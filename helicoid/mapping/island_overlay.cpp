#include "helicoid/mapping/island_overlay.hpp"

#include <array>
#include <cmath>
#include <map>

#include "helicoid/manifold/seen_free.hpp"

namespace helicoid {

namespace {

/// Who looks: the same passage, another one of the same island, the other island.
enum class Looker : std::uint8_t { same_passage, same_island, other_island };
constexpr std::size_t kLookers = 3;

struct View {
  SeenFreeFrom seen;  ///< by points of the patch that is looked at
  Looker looker;
};

/// How many views saw a point again, and how many saw through it.
struct Looks {
  int there = 0, gone = 0;
};
using LooksByLooker = std::array<Looks, kLookers>;
Looks& of(LooksByLooker& looks, Looker looker) {
  return looks[static_cast<std::size_t>(looker)];
}

LooksByLooker look_at(const std::vector<View>& views, const Eigen::Vector2f& p_patch,
                      const IslandOverlayOptions& options) {
  LooksByLooker looks{};
  for (const View& view : views) {
    if (view.seen.is_deep(p_patch, static_cast<float>(options.deep))) {
      ++of(looks, view.looker).gone;
    } else if (view.seen.ends_at(p_patch, static_cast<float>(options.surface))) {
      ++of(looks, view.looker).there;
    }
  }
  return looks;
}

/// Points by the place at which they stood, in the joined island's plane; the two islands' apart.
class Places {
 public:
  explicit Places(const IslandOverlayOptions& options) : options_(options) {}
  void add(IslandId island, const Vector2d& p_plane, bool gone) {
    const auto cell = [&](double x) { return static_cast<int>(std::floor(x / options_.place)); };
    Points& points = places_[{static_cast<int>(island.value), cell(p_plane.x()), cell(p_plane.y())}];
    ++points.all;
    points.gone += gone ? 1 : 0;
  }
  [[nodiscard]] SecondLook count() const {
    SecondLook look;
    for (const auto& [place, points] : places_) {
      if (points.all < options_.points) continue;
      ++look.places;
      look.gone += points.gone >= options_.points && 2 * points.gone > points.all ? 1 : 0;
    }
    return look;
  }

 private:
  struct Points {
    std::size_t all = 0, gone = 0;
  };
  IslandOverlayOptions options_;
  std::map<std::array<int, 3>, Points> places_;
};

/// The looks at what stood still, island by island and between them.
class Overlay {
 public:
  explicit Overlay(const IslandOverlayOptions& options)
      : options_(options), passing_(options), again_(options), between_(options) {}

  void add(const Map& map, const Patch& patch, IslandId island, const std::vector<View>& views) {
    for (std::size_t i = 0; i < patch.points.size(); ++i) {
      if (patch.points.weight[i] <= 0) continue;
      const Eigen::Vector2f p_patch(patch.points.x[i], patch.points.y[i]);
      add(island, map.T_plane_patch(patch.id) * p_patch.cast<double>(), look_at(views, p_patch, options_));
    }
  }
  [[nodiscard]] IslandOverlay count() const {
    const SecondLook passing = passing_.count();
    const SecondLook again = again_.count();
    return {{passing.places + again.places, passing.gone + again.gone}, between_.count()};
  }

 private:
  void add(IslandId island, const Vector2d& p_plane, LooksByLooker looks) {
    const Looks& passing = of(looks, Looker::same_passage);
    // A view of the same passage says how things stand once another one has shown that they do.
    if (passing.gone == 0 && passing.there >= 2) passing_.add(island, p_plane, false);
    if (passing.gone == 1 && passing.there >= 1) passing_.add(island, p_plane, true);
    if (passing.gone > 0 || passing.there == 0) return;
    const auto add_to = [&](Places& places, const Looks& by) {
      if (by.there + by.gone > 0) places.add(island, p_plane, by.gone > by.there);
    };
    add_to(again_, of(looks, Looker::same_island));
    add_to(between_, of(looks, Looker::other_island));
  }

  IslandOverlayOptions options_;
  Places passing_, again_, between_;
};

}  // namespace

IslandOverlay lay_over(const Map& joined, const InformationGraph& graph, const Map& apart, IslandId joined_island,
                       std::span<const double> along, const MapperOptions& mapper,
                       const IslandOverlayOptions& options) {
  Overlay overlay(options);
  const auto looker = [&](PatchId id, PatchId view) {
    if (apart.island_of(view) != apart.island_of(id)) return Looker::other_island;
    const bool passing = joined.patch(view).robot == joined.patch(id).robot &&
                         std::abs(along[view.index()] - along[id.index()]) < options.passage;
    return passing ? Looker::same_passage : Looker::same_island;
  };
  for (std::size_t i = 0; i < joined.patch_count(); ++i) {
    const PatchId id = make_id<PatchId>(i);
    if (joined.island_of(id) != joined_island) continue;
    std::vector<View> views;
    bool is_shared = false;
    for (const LocalPatch& p : find_local_map(joined, graph, id, mapper)) {
      if (p.patch == id) continue;
      views.push_back({SeenFreeFrom(joined.patch(p.patch), p.T_anchor_patch.inverse()), looker(id, p.patch)});
      is_shared = is_shared || views.back().looker == Looker::other_island;
    }
    if (is_shared) overlay.add(joined, joined.patch(id), apart.island_of(id), views);
  }
  return overlay.count();
}

bool is_contradicted(const IslandOverlay& overlay, const IslandOverlayOptions& options) {
  const auto places = static_cast<double>(overlay.between.places);
  const double expected =
      places * static_cast<double>(overlay.within.gone + 1) / static_cast<double>(overlay.within.places + 2);
  // Of rare things the count follows Poisson's law.
  double fewer = 0;
  double probability = std::exp(-expected);
  for (std::size_t k = 0; k < overlay.between.gone; ++k) {
    fewer += probability;
    probability *= expected / static_cast<double>(k + 1);
  }
  return 1 - fewer < options.by_chance;
}

}  // namespace helicoid
