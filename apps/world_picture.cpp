#include "apps/world_picture.hpp"

#include <algorithm>
#include <cmath>

#include "apps/svg_drawing.hpp"

namespace helicoid {

namespace {

constexpr double kLongestSide = 1200;  // pixels
constexpr double kMargin = 40;
constexpr double kFooter = 44;

/// From the world's metres to the picture's pixels.
class Paper {
 public:
  explicit Paper(const World& world) : low_(world.walls.front().from), high_(low_) {
    const auto take = [this](const Vector2d& p) {
      low_ = low_.cwiseMin(p);
      high_ = high_.cwiseMax(p);
    };
    for (const Segment& s : world.walls) {
      take(s.from);
      take(s.to);
    }
    for (const Route& r : world.routes) std::for_each(r.points.begin(), r.points.end(), take);
    scale_ = (kLongestSide - 2 * kMargin) / std::max((high_ - low_).maxCoeff(), 1.0);
  }
  [[nodiscard]] Vector2d operator()(const Vector2d& p) const {
    return {kMargin + scale_ * (p.x() - low_.x()), kMargin + scale_ * (high_.y() - p.y())};
  }
  [[nodiscard]] Vector2d size() const { return scale_ * (high_ - low_) + Vector2d(2 * kMargin, 2 * kMargin + kFooter); }
  [[nodiscard]] double scale() const { return scale_; }

 private:
  Vector2d low_, high_;
  double scale_ = 1;
};

void draw_scale_bar(SvgDrawing& drawing, const Paper& paper) {
  double length = 1;
  for (const double l : {2.0, 5.0, 10.0, 20.0, 50.0}) {
    if (l * paper.scale() < 0.25 * kLongestSide) length = l;
  }
  const Vector2d left(kMargin, paper.size().y() - 30);
  drawing.line(left, left + Vector2d(length * paper.scale(), 0), {charts::kText, 3, ""});
  drawing.text(left + Vector2d(0, 18), fmt::format("{:g} m", length));
}

void draw_robots(SvgDrawing& drawing, const Paper& paper, std::span<const TrueTrack> tracks) {
  double x = 0.35 * paper.size().x();
  for (std::size_t i = 0; i < tracks.size(); ++i) {
    const charts::Colour colour = charts::robot_colour(i);
    std::vector<Vector2d> way;
    for (const Pose2& pose : tracks[i].T_world_robot) {
      const Vector2d p = paper(pose.translation());
      if (way.empty() || (p - way.back()).norm() > 1) way.push_back(p);
    }
    if (way.empty()) continue;
    drawing.polyline(way, {colour, 1.2, ""});
    drawing.disc(way.front(), 5, colour);
    drawing.disc({x, paper.size().y() - 30}, 5, colour);
    drawing.text({x + 10, paper.size().y() - 26}, tracks[i].robot);
    x += 90;
  }
}

void draw_note(SvgDrawing& drawing, const Paper& paper, const WorldNote& note) {
  const Vector2d a = paper(note.p_world_a);
  const Vector2d b = paper(note.p_world_b);
  drawing.line(a, b, {charts::kText, 1.5, "6 5"});
  for (const Vector2d& p : {a, b}) drawing.disc(p, 6, charts::kText);
  drawing.text(0.5 * (a + b) - Vector2d(0, 8), note.text, {16, "middle", charts::kText, true});
}

}  // namespace

std::string draw_world(const World& world, std::span<const TrueTrack> tracks, std::span<const WorldNote> notes) {
  const Paper paper(world);
  SvgDrawing drawing(paper.size().x(), paper.size().y());
  for (const Route& route : world.routes) {
    std::vector<Vector2d> points;
    for (const Vector2d& p : route.points) points.push_back(paper(p));
    drawing.polyline(points, {0xB9C2CC, 4, ""}, route.closed);
  }
  for (const Segment& d : world.doors) drawing.line(paper(d.from), paper(d.to), {charts::kOverlap, 3, "6 5"});
  for (const Segment& w : world.walls) drawing.line(paper(w.from), paper(w.to), {charts::kWall, 2, ""});
  draw_robots(drawing, paper, tracks);
  for (const WorldNote& note : notes) draw_note(drawing, paper, note);
  draw_scale_bar(drawing, paper);
  drawing.text({paper.size().x() - kMargin, paper.size().y() - 26}, world.name, {14, "end", charts::kText, true});
  return drawing.finish();
}

}  // namespace helicoid
