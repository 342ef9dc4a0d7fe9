#include "helicoid/charts/crispness.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace helicoid {

namespace {

/// The surfaces in a cell are told apart by the quarter in which their normal points.
constexpr std::size_t kFacings = 4;
/// Fewer points than this are no surface.
constexpr float kFewestPoints = 1.5F;

/// So many points of one scan are a surface: fewer may be beams that hit an edge.
constexpr std::size_t kPointsOfOneScan = 3;

/// Sum of the unit normals of the points that face one way; its length is about their number.
struct Normals {
  float x = 0, y = 0;
};

/// A point that a patch has in a cell.
struct PointInCell {
  std::size_t cell;
  PatchId patch;
  Eigen::Vector2f normal;
};

class Surfaces {
 public:
  Surfaces(const Map& map, std::span<const PatchId> patches, const OccupancyGrid& grid)
      : frame_(grid.frame), states_(classify(grid)), normals_(frame_.size()) {
    for (const PatchId id : patches) add(map.patch(id), map.T_plane_patch(id));
    std::sort(points_.begin(), points_.end(), [](const PointInCell& p, const PointInCell& q) {
      return p.cell != q.cell ? p.cell < q.cell : p.patch < q.patch;
    });
  }

  [[nodiscard]] const std::vector<CellState>& states() const { return states_; }
  [[nodiscard]] const std::array<Normals, kFacings>& normals(std::size_t cell) const { return normals_[cell]; }

  /// True if at this place [cells], or within one cell of it along `normal`, an occupied cell holds a surface that
  /// faces along `normal`.
  [[nodiscard]] bool there(const Vector2d& at, const Vector2d& normal, double same_facing) const {
    const double steps[] = {0.0, 1.0, -1.0};
    return std::any_of(std::begin(steps), std::end(steps),
                       [&](double step) { return exactly_there(at + step * normal, normal, same_facing); });
  }

  /// Without the slack of a cell along the normal, which would call the blur of one wall its twin.
  [[nodiscard]] bool exactly_there(const Vector2d& at, const Vector2d& normal, double same_facing) const {
    const std::optional<std::size_t> cell = cell_at(at);
    if (!cell || states_[*cell] != CellState::occupied) return false;
    return std::any_of(normals_[*cell].begin(), normals_[*cell].end(), [&](const Normals& n) {
      const double length = std::hypot(n.x, n.y);
      return length >= static_cast<double>(kFewestPoints) &&
             n.x * normal.x() + n.y * normal.y() >= same_facing * length;
    });
  }

  /// The patches that have enough points on the surface that runs through this place [cells], faces along `normal` and
  /// is so long to either side; ascending.
  [[nodiscard]] std::vector<PatchId> seen_by(const Vector2d& centre, const Vector2d& normal, int cells,
                                             double same_facing) const {
    std::vector<PatchId> patches;
    const Vector2d along(-normal.y(), normal.x());
    for (int step = -cells; step <= cells; ++step) {
      const std::optional<std::size_t> cell = cell_at(centre + step * along);
      if (!cell) continue;
      auto point = std::lower_bound(points_.begin(), points_.end(), *cell,
                                    [](const PointInCell& p, std::size_t c) { return p.cell < c; });
      for (; point != points_.end() && point->cell == *cell; ++point) {
        if (point->normal.cast<double>().dot(normal) >= same_facing) patches.push_back(point->patch);
      }
    }
    std::sort(patches.begin(), patches.end());
    std::vector<PatchId> with_enough;
    for (std::size_t i = kPointsOfOneScan - 1; i < patches.size(); ++i) {
      if (patches[i] != patches[i - (kPointsOfOneScan - 1)]) continue;
      if (with_enough.empty() || with_enough.back() != patches[i]) with_enough.push_back(patches[i]);
    }
    return with_enough;
  }

 private:
  [[nodiscard]] std::optional<std::size_t> cell_at(const Vector2d& at) const {
    const auto column = static_cast<int>(std::floor(at.x()));
    const auto row = static_cast<int>(std::floor(at.y()));
    return frame_.inside(column, row) ? std::optional(frame_.index(column, row)) : std::nullopt;
  }

  void add(const Patch& patch, const Pose2& T_plane_patch) {
    const Matrix2d R = T_plane_patch.rotation();
    const ScanPoints& points = patch.points;
    for (std::size_t i = 0; i < points.size(); ++i) {
      if (points.weight[i] <= 0) continue;
      const Vector2d p = frame_.to_cells(T_plane_patch * Vector2d(points.x[i], points.y[i]));
      const Vector2d n = R * Vector2d(points.nx[i], points.ny[i]);
      if (const auto cell = cell_at(p)) points_.push_back({*cell, patch.id, n.cast<float>()});
      // Beams lie wider than cells: a point speaks for the cells beside it on its surface, too.
      for (const double step : {-1.0, 0.0, 1.0}) add(p + step * Vector2d(-n.y(), n.x()), n);
    }
  }

  void add(const Vector2d& at, const Vector2d& normal) {
    const std::optional<std::size_t> there = cell_at(at);
    if (!there) return;
    auto& cell = normals_[*there];
    Normals& sum = cell[facing(cell, normal)];
    sum.x += static_cast<float>(normal.x());
    sum.y += static_cast<float>(normal.y());
  }

  /// The surface of the cell that agrees with the normal, or the first that is still empty.
  static std::size_t facing(const std::array<Normals, kFacings>& cell, const Vector2d& n) {
    std::size_t best = 0;
    double agreement = -2;
    for (std::size_t k = 0; k < kFacings; ++k) {
      const double length = std::hypot(cell[k].x, cell[k].y);
      // An empty place is taken rather than a surface more than 45 degrees off.
      const double agrees = length > 0 ? (cell[k].x * n.x() + cell[k].y * n.y()) / length : 0.7;
      if (agrees <= agreement) continue;
      agreement = agrees;
      best = k;
    }
    return best;
  }

  const GridFrame& frame_;
  std::vector<CellState> states_;
  std::vector<std::array<Normals, kFacings>> normals_;
  std::vector<PointInCell> points_;  ///< ascending
};

/// Of one cell.
enum class Twin : std::uint8_t {
  none,
  seen_at_once,  ///< some scan has points on both surfaces: they are there
  drawn_twice
};

class TwinFinder {
 public:
  TwinFinder(const Surfaces& surfaces, const GridFrame& frame, const CrispnessOptions& options)
      : surfaces_(surfaces),
        frame_(frame),
        options_(options),
        extent_(std::max(1, static_cast<int>(std::lround(options.extent / frame.resolution)))) {}

  [[nodiscard]] Twin look(int column, int row) const {
    const Vector2d centre(column + 0.5, row + 0.5);
    Twin found = Twin::none;
    for (const Normals& sum : surfaces_.normals(frame_.index(column, row))) {
      const double length = std::hypot(sum.x, sum.y);
      if (length < static_cast<double>(kFewestPoints)) continue;
      const Vector2d normal = Vector2d(sum.x, sum.y) / length;
      if (!side_by_side(centre, normal, 0)) continue;
      const double first = options_.nearest / frame_.resolution;
      const double last = options_.farthest / frame_.resolution;
      for (double depth = first; depth <= last; depth += 1) {
        for (const double there : {depth, -depth}) {
          if (!side_by_side(centre, normal, there)) continue;
          if (!seen_at_once(centre, normal, there)) return Twin::drawn_twice;
          found = Twin::seen_at_once;
        }
      }
    }
    return found;
  }

 private:
  /// True if a surface that faces along `normal` runs for the extent, all of it to one side of here or with here
  /// anywhere in it, at this depth along the normal [cells], beside the surface at depth 0.
  [[nodiscard]] bool side_by_side(const Vector2d& centre, const Vector2d& normal, double depth) const {
    const Vector2d along(-normal.y(), normal.x());
    const int needed = static_cast<int>(std::ceil(options_.support * extent_));
    const auto both = [&](int step) {
      const Vector2d p = centre + step * along;
      return surfaces_.there(p, normal, options_.same_facing) &&
             (depth == 0 || surfaces_.exactly_there(p + depth * normal, normal, options_.same_facing));
    };
    if (!both(0)) return false;
    int count = 0;
    for (int step = -extent_; step < 0; ++step) count += both(step) ? 1 : 0;
    // The window slides from the one side to the other.
    for (int first = -extent_; first < 0; ++first) {
      if (count >= needed) return true;
      count += (both(first + extent_) ? 1 : 0) - (both(first) ? 1 : 0);
    }
    return count >= needed;
  }

  [[nodiscard]] bool seen_at_once(const Vector2d& centre, const Vector2d& normal, double depth) const {
    const std::vector<PatchId> here = surfaces_.seen_by(centre, normal, extent_, options_.same_facing);
    const std::vector<PatchId> there =
        surfaces_.seen_by(centre + depth * normal, normal, extent_, options_.same_facing);
    return std::any_of(here.begin(), here.end(),
                       [&](PatchId id) { return std::binary_search(there.begin(), there.end(), id); });
  }

  const Surfaces& surfaces_;
  const GridFrame& frame_;
  const CrispnessOptions& options_;
  int extent_;  ///< cells
};

}  // namespace

Crispness measure_crispness(const Map& map, std::span<const PatchId> patches, const OccupancyGrid& grid,
                            const CrispnessOptions& options) {
  const Surfaces surfaces(map, patches, grid);
  const TwinFinder finder(surfaces, grid.frame, options);
  Crispness result;
  for (int row = 0; row < grid.frame.height; ++row) {
    for (int column = 0; column < grid.frame.width; ++column) {
      if (surfaces.states()[grid.frame.index(column, row)] != CellState::occupied) continue;
      ++result.occupied;
      const Twin twin = finder.look(column, row);
      if (twin == Twin::drawn_twice) ++result.twins;
      if (twin == Twin::seen_at_once) ++result.seen_at_once;
    }
  }
  if (result.occupied > 0) result.share = static_cast<double>(result.twins) / static_cast<double>(result.occupied);
  return result;
}

}  // namespace helicoid
