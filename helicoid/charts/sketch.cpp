#include "helicoid/charts/sketch.hpp"

#include <algorithm>
#include <cmath>

#include "helicoid/charts/contour.hpp"
#include "helicoid/charts/simplify.hpp"

namespace helicoid {

namespace {

using charts::Contour;

/// Turns frontiers that are too short to drive through into walls, where walls are on both sides.
void close_cracks(Contour& contour, std::size_t shortest) {
  const std::size_t size = contour.steps.size();
  std::size_t start = 0;
  while (start < size && !contour.steps[start].wall) ++start;
  if (start == size) return;
  std::size_t run = 0;
  for (std::size_t k = 1; k <= size; ++k) {
    const std::size_t i = (start + k) % size;
    if (!contour.steps[i].wall) {
      ++run;
      continue;
    }
    for (std::size_t back = 1; run < shortest && back <= run; ++back)
      contour.steps[(i + size - back) % size].wall = true;
    run = 0;
  }
}

/// Turns the contour so that it begins where wall meets frontier, or else at its first step.
void begin_at_change(Contour& contour) {
  for (std::size_t i = 1; i < contour.steps.size(); ++i) {
    if (contour.steps[i].wall == contour.steps[i - 1].wall) continue;
    std::rotate(contour.steps.begin(), contour.steps.begin() + static_cast<std::ptrdiff_t>(i), contour.steps.end());
    return;
  }
}

class RingMaker {
 public:
  RingMaker(const GridFrame& frame, double tolerance) : frame_(frame), tolerance_(tolerance) {}

  SketchRing make(Contour contour) const {
    begin_at_change(contour);
    SketchRing ring;
    const std::size_t size = contour.steps.size();
    for (std::size_t first = 0; first < size;) {
      std::size_t last = first;
      while (last < size && contour.steps[last].wall == contour.steps[first].wall) ++last;
      add_run(contour, first, last, ring);
      first = last;
    }
    return ring;
  }

 private:
  [[nodiscard]] Vector2d to_plane(const Contour::Step& step) const {
    return frame_.origin + 0.5 * frame_.resolution * Vector2d(step.x2, step.y2);
  }

  /// Steps first..last, and on to the step after them: each point but the last of these goes into the ring.
  void add_run(const Contour& contour, std::size_t first, std::size_t last, SketchRing& ring) const {
    std::vector<Vector2d> line;
    for (std::size_t i = first; i < last; ++i) line.push_back(to_plane(contour.steps[i]));
    line.push_back(to_plane(contour.steps[last < contour.steps.size() ? last : 0]));
    const Border border = contour.steps[first].wall ? Border::wall : Border::frontier;
    const bool closed = first == 0 && last == contour.steps.size();
    // A ring that closes on itself has no ends to hold on to: the point farthest from its first is one.
    const std::size_t middle = closed ? farthest(line) : line.size() - 1;
    add_line(std::span(line).first(middle + 1), border, ring);
    if (closed) add_line(std::span(line).subspan(middle), border, ring);
  }

  static std::size_t farthest(const std::vector<Vector2d>& line) {
    std::size_t best = 0;
    for (std::size_t i = 1; i < line.size(); ++i) {
      if ((line[i] - line[0]).squaredNorm() > (line[best] - line[0]).squaredNorm()) best = i;
    }
    return best;
  }

  void add_line(std::span<const Vector2d> line, Border border, SketchRing& ring) const {
    std::vector<Vector2d> simple = charts::simplify(line, tolerance_);
    simple.pop_back();
    ring.borders.insert(ring.borders.end(), simple.size(), border);
    ring.points.insert(ring.points.end(), simple.begin(), simple.end());
  }

  const GridFrame& frame_;
  double tolerance_;
};

double area(const SketchRing& ring) {
  double twice = 0;
  for (std::size_t i = 0; i < ring.points.size(); ++i) {
    const Vector2d& a = ring.points[i];
    const Vector2d& b = ring.points[i + 1 < ring.points.size() ? i + 1 : 0];
    twice += a.x() * b.y() - a.y() * b.x();
  }
  return twice / 2;
}

}  // namespace

Sketch make_sketch(const OccupancyGrid& grid, const SketchOptions& options) {
  const double cell = grid.frame.resolution * grid.frame.resolution;
  const auto shortest = static_cast<std::size_t>(std::ceil(options.shortest_frontier / grid.frame.resolution));
  const RingMaker maker(grid.frame, options.tolerance);
  Sketch sketch;
  for (Contour& contour : charts::trace_contours(grid.frame, classify(grid))) {
    const double size = charts::signed_area(contour) * cell;
    const bool any_wall = std::any_of(contour.steps.begin(), contour.steps.end(), [](const auto& s) { return s.wall; });
    if (size > 0 && size < options.smallest_piece) {
      ++sketch.dropped_specks;
      continue;
    }
    if (size <= 0 && -size < options.smallest_hole && !any_wall) {
      ++sketch.filled_holes;
      continue;
    }
    close_cracks(contour, shortest);
    SketchRing ring = maker.make(std::move(contour));
    if (ring.points.size() > 2) sketch.rings.push_back(std::move(ring));
  }
  return sketch;
}

double area(const Sketch& sketch) {
  double sum = 0;
  for (const SketchRing& ring : sketch.rings) sum += area(ring);
  return sum;
}

}  // namespace helicoid
