#include "helicoid/charts/occupancy_grid.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <thread>

namespace helicoid {

namespace {

constexpr std::uint16_t kFull = std::numeric_limits<std::uint16_t>::max();
/// Neighbouring returns are one surface if their normals agree to this cosine and lie across the step between them.
constexpr float kSameNormal = 0.8F;
constexpr float kAcross = 0.5F;

/// Draws patches one by one; keeps its buffers.
class Pen {
 public:
  explicit Pen(OccupancyGrid& grid)
      : grid_(grid),
        frame_(grid.frame),
        vote_(frame_.size(), kMayMiss),
        beside_(frame_.size(), 0),
        crossings_(static_cast<std::size_t>(frame_.height)) {}

  /// By cell: 1 if it lies in free space beside a surface of the same patch.
  [[nodiscard]] std::vector<std::uint8_t> take_beside() { return std::move(beside_); }

  void draw(const Patch& patch, const Pose2& T_plane_patch) {
    place(T_plane_patch);
    draw_surfaces(patch);
    draw_free_space(patch);
    for (const std::size_t cell : touched_) vote_[cell] = kMayMiss;
    touched_.clear();
  }

 private:
  /// Everything is drawn in units of cells.
  struct Point {
    float x, y;
  };

  void place(const Pose2& T_plane_patch) {
    const Vector2d at = frame_.to_cells(T_plane_patch.translation());
    x_ = static_cast<float>(at.x());
    y_ = static_cast<float>(at.y());
    cos_ = static_cast<float>(std::cos(T_plane_patch.yaw) / frame_.resolution);
    sin_ = static_cast<float>(std::sin(T_plane_patch.yaw) / frame_.resolution);
  }
  [[nodiscard]] Point to_cells(float x, float y) const { return {x_ + cos_ * x - sin_ * y, y_ + sin_ * x + cos_ * y}; }

  /// What the patch at hand may say about a cell: 1 where its free space counts as a miss.
  enum Vote : std::uint8_t { kSilent = 0, kMayMiss = 1, kHit = 2 };

  void touch(std::size_t cell, Vote vote) {
    if (vote_[cell] == kHit || vote_[cell] == vote) return;
    if (vote_[cell] == kMayMiss) touched_.push_back(cell);
    vote_[cell] = vote;
  }

  void hit(int column, int row) {
    if (!frame_.inside(column, row)) return;
    const std::size_t cell = frame_.index(column, row);
    if (vote_[cell] == kHit) return;
    touch(cell, kHit);
    if (column > 0) touch(cell - 1, kSilent);
    if (column + 1 < frame_.width) touch(cell + 1, kSilent);
    if (row > 0) touch(cell - static_cast<std::size_t>(frame_.width), kSilent);
    if (row + 1 < frame_.height) touch(cell + static_cast<std::size_t>(frame_.width), kSilent);
    if (grid_.hits[cell] != kFull) ++grid_.hits[cell];
  }

  void draw_surfaces(const Patch& patch) {
    const ScanPoints& points = patch.points;
    const auto gap = static_cast<float>(patch.laser.largest_gap);
    for (std::size_t i = 0; i < points.size(); ++i) {
      const Point p = to_cells(points.x[i], points.y[i]);
      hit(static_cast<int>(std::floor(p.x)), static_cast<int>(std::floor(p.y)));
      if (i + 1 < points.size() && one_surface(points, i, gap)) {
        draw_line(p, to_cells(points.x[i + 1], points.y[i + 1]));
      }
    }
  }

  /// True if the wall goes on between return i and the next.
  static bool one_surface(const ScanPoints& points, std::size_t i, float gap) {
    const std::size_t j = i + 1;
    if (points.beam[j] != points.beam[i] + 1 || points.weight[i] <= 0 || points.weight[j] <= 0) return false;
    const float dx = points.x[j] - points.x[i];
    const float dy = points.y[j] - points.y[i];
    const float square = dx * dx + dy * dy;
    if (square > gap * gap) return false;
    if (points.nx[i] * points.nx[j] + points.ny[i] * points.ny[j] < kSameNormal) return false;
    const float across = dx * points.nx[i] + dy * points.ny[i];
    return across * across <= kAcross * kAcross * square;
  }

  /// The cells between two points, in steps of at most one cell.
  void draw_line(const Point& from, const Point& to) {
    const float dx = to.x - from.x;
    const float dy = to.y - from.y;
    const int steps = static_cast<int>(std::max(std::abs(dx), std::abs(dy))) + 1;
    for (int step = 1; step < steps; ++step) {
      const float at = static_cast<float>(step) / static_cast<float>(steps);
      hit(static_cast<int>(std::floor(from.x + at * dx)), static_cast<int>(std::floor(from.y + at * dy)));
    }
  }

  void draw_free_space(const Patch& patch) {
    outline(patch);
    if (ring_.size() < 3) return;
    float low = ring_.front().y;
    float high = low;
    for (const Point& p : ring_) {
      low = std::min(low, p.y);
      high = std::max(high, p.y);
    }
    for (std::size_t i = 0; i < ring_.size(); ++i) cross_rows(ring_[i], ring_[i + 1 < ring_.size() ? i + 1 : 0]);
    const int first = std::clamp(static_cast<int>(std::ceil(low - 0.5F)), 0, frame_.height);
    const int last = std::clamp(static_cast<int>(std::ceil(high - 0.5F)), 0, frame_.height);
    for (int row = first; row < last; ++row) fill_row(row);
  }

  /// The polygon of free_space_polygon with radii that end half a cell short.
  void outline(const Patch& patch) {
    ring_.clear();
    const Pose2& T = patch.scan.T_robot_laser;
    const auto step = static_cast<float>(0.5 * frame_.resolution);
    const auto c = static_cast<float>(std::cos(T.yaw));
    const auto s = static_cast<float>(std::sin(T.yaw));
    const auto lx = static_cast<float>(T.x);
    const auto ly = static_cast<float>(T.y);
    const LaserModel& laser = patch.laser;
    if (!(laser == table_laser_)) {
      table_ = make_beam_table(laser);
      table_laser_ = laser;
    }
    const bool whole_turn = laser.field_of_view() + laser.bearing_step > 2 * std::numbers::pi - 1e-3;
    const Point centre = to_cells(lx, ly);
    if (!whole_turn) ring_.push_back(centre);
    for (std::size_t i = 0; i < patch.free_ranges.size(); ++i) {
      const float radius = patch.free_ranges[i] - step;
      if (radius <= 0) {
        ring_.push_back(centre);
        continue;
      }
      const float x = radius * table_.cosine[i];
      const float y = radius * table_.sine[i];
      ring_.push_back(to_cells(lx + c * x - s * y, ly + s * x + c * y));
    }
  }

  /// Notes where an edge crosses the centre lines of rows.
  void cross_rows(const Point& a, const Point& b) {
    const Point& low = a.y < b.y ? a : b;
    const Point& high = a.y < b.y ? b : a;
    const int first = std::max(static_cast<int>(std::ceil(low.y - 0.5F)), 0);
    const int last = std::min(static_cast<int>(std::ceil(high.y - 0.5F)), frame_.height);
    if (first >= last) return;
    const float slope = (high.x - low.x) / (high.y - low.y);
    for (int row = first; row < last; ++row) {
      crossings_[static_cast<std::size_t>(row)].push_back(low.x + slope * (static_cast<float>(row) + 0.5F - low.y));
    }
  }

  void fill_row(int row) {
    std::vector<float>& crossings = crossings_[static_cast<std::size_t>(row)];
    std::sort(crossings.begin(), crossings.end());
    for (std::size_t i = 0; i + 1 < crossings.size(); i += 2) {
      const int first = std::clamp(static_cast<int>(std::ceil(crossings[i] - 0.5F)), 0, frame_.width);
      const int last = std::clamp(static_cast<int>(std::ceil(crossings[i + 1] - 0.5F)), 0, frame_.width);
      if (first >= last) continue;
      std::uint16_t* misses = grid_.misses.data() + frame_.index(first, row);
      const std::uint8_t* vote = vote_.data() + frame_.index(first, row);
      std::uint8_t* beside = beside_.data() + frame_.index(first, row);
      for (int k = 0; k < last - first; ++k) {
        beside[k] = static_cast<std::uint8_t>(beside[k] | static_cast<int>(vote[k] == kSilent));
        misses[k] = static_cast<std::uint16_t>(misses[k] + static_cast<int>(vote[k] == kMayMiss && misses[k] != kFull));
      }
    }
    crossings.clear();
  }

  OccupancyGrid& grid_;
  const GridFrame& frame_;
  std::vector<std::uint8_t> vote_;
  std::vector<std::uint8_t> beside_;
  std::vector<std::size_t> touched_;
  std::vector<std::vector<float>> crossings_;
  std::vector<Point> ring_;
  BeamTable table_;
  LaserModel table_laser_;
  float x_ = 0, y_ = 0, cos_ = 1, sin_ = 0;
};

/// What a thread counts.
struct Share {
  OccupancyGrid grid;
  std::vector<std::uint8_t> beside;
};

Share draw_share(const Map& map, std::span<const PatchId> patches, const GridFrame& frame,
                 const OccupancyModel& model) {
  Share share{{frame, std::vector<std::uint16_t>(frame.size()), std::vector<std::uint16_t>(frame.size()), model}, {}};
  Pen pen(share.grid);
  for (const PatchId id : patches) pen.draw(map.patch(id), map.T_plane_patch(id));
  share.beside = pen.take_beside();
  return share;
}

/// Cells of which it is known only that they lie beside a wall are free, if weakly.
void fill_beside_walls(OccupancyGrid& grid, const std::vector<std::uint8_t>& beside) {
  for (std::size_t cell = 0; cell < beside.size(); ++cell) {
    if (grid.misses[cell] == 0) grid.misses[cell] = beside[cell];
  }
}

void add(std::vector<std::uint16_t>& sum, const std::vector<std::uint16_t>& more) {
  for (std::size_t i = 0; i < sum.size(); ++i) {
    sum[i] = static_cast<std::uint16_t>(std::min<unsigned>(kFull, unsigned{sum[i]} + more[i]));
  }
}

}  // namespace

double OccupancyGrid::probability(std::size_t cell) const {
  return 1 / (1 + std::exp(-log_odds(cell)));
}

OccupancyGrid draw_occupancy(const Map& map, std::span<const PatchId> patches, const GridFrame& frame, int threads,
                             const OccupancyModel& model) {
  // Each thread counts its share into a grid of its own; whole numbers add up to the same in any order.
  const std::size_t shares =
      std::clamp<std::size_t>(static_cast<std::size_t>(std::max(threads, 1)), 1, 1 + patches.size() / 64);
  std::vector<Share> drawn(shares);
  const auto draw = [&](std::size_t share) {
    const std::size_t first = patches.size() * share / shares;
    const std::size_t last = patches.size() * (share + 1) / shares;
    drawn[share] = draw_share(map, patches.subspan(first, last - first), frame, model);
  };
  std::vector<std::thread> helpers;
  for (std::size_t share = 1; share < shares; ++share) helpers.emplace_back(draw, share);
  draw(0);
  for (std::thread& helper : helpers) helper.join();
  OccupancyGrid& sum = drawn[0].grid;
  for (std::size_t share = 1; share < shares; ++share) {
    add(sum.hits, drawn[share].grid.hits);
    add(sum.misses, drawn[share].grid.misses);
    for (std::size_t i = 0; i < frame.size(); ++i) drawn[0].beside[i] |= drawn[share].beside[i];
  }
  fill_beside_walls(sum, drawn[0].beside);
  return std::move(sum);
}

std::vector<CellState> classify(const OccupancyGrid& grid) {
  const auto to_log_odds = [](double probability) { return std::log(probability / (1 - probability)); };
  const double occupied = to_log_odds(grid.model.occupied_above);
  const double free = to_log_odds(grid.model.free_below);
  std::vector<CellState> states(grid.frame.size(), CellState::unknown);
  for (std::size_t cell = 0; cell < states.size(); ++cell) {
    if (!grid.seen(cell)) continue;
    const double log_odds = grid.log_odds(cell);
    if (log_odds > occupied) states[cell] = CellState::occupied;
    if (log_odds < free) states[cell] = CellState::free;
  }
  return states;
}

}  // namespace helicoid
