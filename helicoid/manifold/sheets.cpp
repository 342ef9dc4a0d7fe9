#include "helicoid/manifold/sheets.hpp"

#include <algorithm>
#include <optional>

#include "helicoid/manifold/coverage_sweep.hpp"
#include "helicoid/manifold/patch_set.hpp"

namespace helicoid {

namespace {

constexpr double kCell = 0.10;
constexpr double kChainRadius = 10;  ///< metres
/// Drawing needs conflicts, not every cell of them: rows half a metre apart.
constexpr int kDrawingRowStep = 5;

/// The groups of patches over one cell.
class Grouping {
 public:
  Grouping(const Map& map, const Neighbours& neighbours, const Island& island)
      : neighbours_(island.patches.size(), PatchSet(island.patches.size())), rest_(island.patches.size()) {
    std::vector<std::size_t> place(map.patch_count(), 0);
    for (std::size_t i = 0; i < island.patches.size(); ++i) place[island.patches[i].index()] = i;
    for (std::size_t i = 0; i < island.patches.size(); ++i) {
      for (const PatchId n : neighbours[island.patches[i].index()]) neighbours_[i].insert(place[n.index()]);
      positions_.push_back(map.T_plane_patch(island.patches[i]).translation());
    }
  }

  /// Groups if only the patches over the cell may join: never fewer than with longer chains.
  std::vector<PatchSet> direct(const CoveredRun& run) {
    const PatchSet covering = set_of(run);
    return group(covering, covering);
  }

  /// The contract's groups at one cell of the run.
  std::vector<PatchSet> at(const CoveredRun& run, std::int32_t column) {
    const PatchSet covering = set_of(run);
    PatchSet near = covering;
    const Vector2d cell((column + 0.5) * kCell, (run.row + 0.5) * kCell);
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      if ((positions_[i] - cell).squaredNorm() <= kChainRadius * kChainRadius) near.insert(i);
    }
    return group(covering, near);
  }

 private:
  PatchSet set_of(const CoveredRun& run) const {
    PatchSet set(positions_.size());
    for (const std::uint32_t place : run.patches) set.insert(place);
    return set;
  }

  /// The components of `within` under neighbourhood that hold members of `covering`, cut down to those.
  std::vector<PatchSet> group(const PatchSet& covering, PatchSet within) {
    std::vector<PatchSet> groups;
    covering.for_each([&](std::size_t seed) {
      if (!within.contains(seed)) return;
      PatchSet component(positions_.size());
      std::vector<std::size_t> frontier{seed};
      within.erase(seed);
      component.insert(seed);
      while (!frontier.empty()) {
        const std::size_t at = frontier.back();
        frontier.pop_back();
        rest_ = neighbours_[at];
        rest_ &= within;
        within -= rest_;
        component |= rest_;
        rest_.for_each([&](std::size_t i) { frontier.push_back(i); });
      }
      component &= covering;
      groups.push_back(std::move(component));
    });
    return groups;
  }

  std::vector<PatchSet> neighbours_;
  PatchSet rest_;
  std::vector<Vector2d> positions_;
};

/// A metre of cells lies between the places of a run at which its groups are looked at.
constexpr std::int32_t kRunStep = 10;

std::vector<PatchSet> most_groups(Grouping& grouping, const CoveredRun& run) {
  std::vector<PatchSet> most;
  for (std::int32_t column = run.first; column <= run.last; column += kRunStep) {
    std::vector<PatchSet> groups = grouping.at(run, column);
    if (groups.size() > most.size()) most = std::move(groups);
  }
  return most;
}

}  // namespace

int count_sheets(const Map& map, const Neighbours& neighbours, const Island& island) {
  const std::vector<CellSpan> spans = covered_cells(map, island.patches, kCell);
  Grouping grouping(map, neighbours, island);
  std::size_t count = 1;
  const auto visit = [&](const CoveredRun& run) {
    if (run.patches.size() <= count || grouping.direct(run).size() <= count) return;
    count = std::max(count, most_groups(grouping, run).size());
  };
  // Few rows first: the more sheets are known, the fewer runs need a closer look.
  sweep_coverage(spans, 10, visit);
  sweep_coverage(spans, 1, visit);
  return static_cast<int>(count);
}

Sheets find_sheets(const Map& map, const Neighbours& neighbours, const Island& island) {
  Sheets sheets{count_sheets(map, neighbours, island), std::vector<int>(map.patch_count(), -1)};
  const std::size_t size = island.patches.size();
  std::vector<PatchSet> conflicts(size, PatchSet(size));
  if (sheets.count > 1) {
    Grouping grouping(map, neighbours, island);
    sweep_coverage(covered_cells(map, island.patches, kCell), kDrawingRowStep, [&](const CoveredRun& run) {
      if (run.patches.size() < 2 || grouping.direct(run).size() < 2) return;
      const std::vector<PatchSet> groups = grouping.at(run, (run.first + run.last) / 2);
      for (const PatchSet& group : groups) {
        for (const std::uint32_t place : run.patches) {
          if (group.contains(place)) continue;
          group.for_each([&](std::size_t member) { conflicts[member].insert(place); });
        }
      }
    });
  }
  // In the order in which patches were made, each on the sheet of the one before it where that is free.
  std::vector<PatchSet> members;
  std::size_t last = 0;
  for (std::size_t i = 0; i < size; ++i) {
    std::size_t sheet = last;
    if (sheet >= members.size() || members[sheet].intersects(conflicts[i])) {
      sheet = 0;
      while (sheet < members.size() && members[sheet].intersects(conflicts[i])) ++sheet;
    }
    if (sheet == members.size()) members.emplace_back(size);
    members[sheet].insert(i);
    sheets.sheet_of[island.patches[i].index()] = static_cast<int>(sheet);
    last = sheet;
  }
  return sheets;
}

}  // namespace helicoid
