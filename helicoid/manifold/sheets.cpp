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
      : neighbours_(island.patches.size(), PatchSet(island.patches.size())), left_(island.patches.size()) {
    std::vector<std::size_t> place(map.patch_count(), 0);
    for (std::size_t i = 0; i < island.patches.size(); ++i) place[island.patches[i].index()] = i;
    for (std::size_t i = 0; i < island.patches.size(); ++i) {
      for (const PatchId n : neighbours[island.patches[i].index()]) neighbours_[i].insert(place[n.index()]);
      positions_.push_back(map.T_plane_patch(island.patches[i]).translation());
    }
  }

  /// True if there are more groups than that when only the patches over the cell may join: then there may be more by
  /// longer chains, too, and never otherwise.
  bool exceeds_directly(const CoveredRun& run, std::size_t limit) {
    cover(run);
    return exceeds(limit);
  }

  /// The same if patches near both of these columns may join: at one column the contract's groups, at two never fewer
  /// than at any column between them.
  bool exceeds(const CoveredRun& run, std::int32_t first, std::int32_t last, std::size_t limit) {
    cover(run);
    let_near_join(run.row, first, last);
    return exceeds(limit);
  }

  /// The contract's groups at one cell of the run.
  std::vector<PatchSet> at(const CoveredRun& run, std::int32_t column) {
    cover(run);
    let_near_join(run.row, column, column);
    std::vector<PatchSet> groups;
    while (left_count_ > 0) {
      PatchSet group = left_;
      take_group();
      group -= left_;
      groups.push_back(std::move(group));
    }
    return groups;
  }

 private:
  void cover(const CoveredRun& run) {
    left_.clear();
    for (const std::uint32_t place : run.patches) left_.insert(place);
    left_count_ = run.patches.size();
    within_ = left_;
  }

  void let_near_join(std::int32_t row, std::int32_t first, std::int32_t last) {
    const Vector2d from((first + 0.5) * kCell, (row + 0.5) * kCell);
    const Vector2d to((last + 0.5) * kCell, (row + 0.5) * kCell);
    for (std::size_t i = 0; i < positions_.size(); ++i) {
      const double farther = std::max((positions_[i] - from).squaredNorm(), (positions_[i] - to).squaredNorm());
      if (farther <= kChainRadius * kChainRadius) within_.insert(i);
    }
  }

  bool exceeds(std::size_t limit) {
    for (std::size_t groups = 1; left_count_ > 0; ++groups) {
      if (groups > limit) return true;
      // Were each of those left a group of its own, there would still be no more than the limit.
      take_group(limit - groups);
      if (left_count_ <= limit - groups) return false;
    }
    return false;
  }

  /// Takes out of `left_` all that chains of neighbours within `within_` join to its first member, or only some of
  /// them as soon as no more than `few` are left. Where most are neighbours, all are found after a few steps.
  void take_group(std::size_t few = 0) {
    const auto reach = [this](std::size_t i) {
      frontier_.push_back(i);
      if (!left_.contains(i)) return;
      left_.erase(i);
      --left_count_;
    };
    const std::size_t seed = left_.first();
    within_.erase(seed);
    frontier_.clear();
    reach(seed);
    while (!frontier_.empty() && left_count_ > few) {
      const PatchSet& next = neighbours_[frontier_.back()];
      frontier_.pop_back();
      within_.take_common(next, reach);
    }
  }

  std::vector<PatchSet> neighbours_;
  std::vector<Vector2d> positions_;
  PatchSet left_;    ///< patches over the cell that are in no group yet
  PatchSet within_;  ///< patches that may still join them
  std::size_t left_count_ = 0;
  std::vector<std::size_t> frontier_;
};

}  // namespace

int count_sheets(const Map& map, const Neighbours& neighbours, const Island& island) {
  const std::vector<CellSpan> spans = covered_cells(map, island.patches, kCell);
  Grouping grouping(map, neighbours, island);
  std::size_t count = 1;
  const auto visit = [&](const CoveredRun& run) {
    if (run.patches.size() <= count || !grouping.exceeds_directly(run, count)) return;
    if (!grouping.exceeds(run, run.first, run.last, count)) return;
    for (std::int32_t column = run.first; column <= run.last; ++column) {
      while (grouping.exceeds(run, column, column, count)) ++count;
    }
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
      if (run.patches.size() < 2 || !grouping.exceeds_directly(run, 1)) return;
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
