// Which patches lie about a place of an island's plane, at the cost of those alone.
#pragma once

#include <cmath>
#include <cstdint>
#include <unordered_map>
#include <vector>

#include "helicoid/base/ids.hpp"
#include "helicoid/geometry/pose2.hpp"

namespace helicoid {

class PlaneIndex {
 public:
  /// From now on the patch stands here; patches are numbered as they come.
  void place(PatchId patch, IslandId island, const Vector2d& p_plane);

  /// A superset of the island's patches within so many metres, in no order that means anything.
  template <typename Visit>
  void for_each_about(IslandId island, const Vector2d& p_plane, double radius, const Visit& visit) const {
    for (std::int64_t y = cell_of(p_plane.y() - radius); y <= cell_of(p_plane.y() + radius); ++y) {
      for (std::int64_t x = cell_of(p_plane.x() - radius); x <= cell_of(p_plane.x() + radius); ++x) {
        const auto cell = cells_.find(key_of(island, x, y));
        if (cell == cells_.end()) continue;
        for (const PatchId patch : cell->second) visit(patch);
      }
    }
  }

 private:
  static constexpr double kCell = 3;                            ///< metres
  static constexpr std::int64_t kMost = (1 << 20U) - 1;         ///< cells to either side; beyond lies one last cell
  static constexpr std::uint64_t kNowhere = ~std::uint64_t{0};  ///< no cell's key

  static std::int64_t cell_of(double metres) {
    const double cell = std::floor(metres / kCell);
    if (!(cell > static_cast<double>(-kMost))) return -kMost;
    return cell < static_cast<double>(kMost) ? static_cast<std::int64_t>(cell) : kMost;
  }
  static std::uint64_t key_of(IslandId island, std::int64_t x, std::int64_t y) {
    return (static_cast<std::uint64_t>(island.value) << 42U) | (static_cast<std::uint64_t>(x + kMost) << 21U) |
           static_cast<std::uint64_t>(y + kMost);
  }

  std::unordered_map<std::uint64_t, std::vector<PatchId>> cells_;
  std::vector<std::uint64_t> cell_of_patch_;
};

}  // namespace helicoid
