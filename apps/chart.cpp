#include "apps/chart.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace helicoid {

namespace {

constexpr double kLeft = 74, kRight = 24, kTop = 44, kBottom = 54;  // margins, pixels
constexpr charts::Colour kGrid = 0xE3E7EC;

/// From the data's numbers to the drawing's pixels.
class Axes {
 public:
  Axes(const Chart& chart, const Vector2d& corner) {
    find_range(chart);
    const Vector2d size(chart.width - kLeft - kRight, chart.height - kTop - kBottom);
    scale_ = size.cwiseQuotient(high_ - low_);
    if (chart.same_scale) {
      scale_.setConstant(scale_.minCoeff());
      const Vector2d spare = size.cwiseQuotient(scale_) - (high_ - low_);
      low_ -= 0.5 * spare;
      high_ += 0.5 * spare;
    }
    origin_ = corner + Vector2d(kLeft, kTop + size.y());
  }
  [[nodiscard]] Vector2d operator()(const Vector2d& p) const {
    return origin_ + Vector2d(scale_.x() * (p.x() - low_.x()), -scale_.y() * (p.y() - low_.y()));
  }
  [[nodiscard]] const Vector2d& low() const { return low_; }
  [[nodiscard]] const Vector2d& high() const { return high_; }

 private:
  void find_range(const Chart& chart) {
    low_.setConstant(INFINITY);
    high_.setConstant(-INFINITY);
    for (const Series& series : chart.series) {
      for (const Vector2d& p : series.points) {
        if (!p.allFinite()) continue;
        low_ = low_.cwiseMin(p);
        high_ = high_.cwiseMax(p);
      }
    }
    if (low_.x() > high_.x()) {
      low_.setZero();
      high_.setOnes();
    }
    if (std::any_of(chart.series.begin(), chart.series.end(),
                    [](const Series& s) { return s.look == Series::Look::bars; })) {
      low_.x() -= 0.4;
      high_.x() += 0.4;
    }
    if (chart.y_from) low_.y() = *chart.y_from;
    for (int axis = 0; axis < 2; ++axis) {
      if (!(high_[axis] > low_[axis])) high_[axis] = low_[axis] + 1;
      const double room = 0.04 * (high_[axis] - low_[axis]);
      high_[axis] += room;
      if (axis == 0 || !chart.y_from) low_[axis] -= room;
    }
  }
  Vector2d low_, high_, scale_, origin_;
};

void draw_axes(SvgDrawing& drawing, const Axes& axes, const Chart& chart, const Vector2d& corner) {
  for (std::size_t i = 0; i < chart.x_names.size(); ++i) {
    const Vector2d at = axes({static_cast<double>(i + 1), axes.low().y()});
    drawing.text(at + Vector2d(0, 18), chart.x_names[i], {11, "middle"});
  }
  for (const double x : round_ticks(axes.low().x(), axes.high().x(), 8)) {
    if (!chart.x_names.empty()) break;
    drawing.line(axes({x, axes.low().y()}), axes({x, axes.high().y()}), {kGrid, 1, ""});
    drawing.text(axes({x, axes.low().y()}) + Vector2d(0, 18), fmt::format("{:g}", x), {11, "middle"});
  }
  for (const double y : round_ticks(axes.low().y(), axes.high().y(), 5)) {
    drawing.line(axes({axes.low().x(), y}), axes({axes.high().x(), y}), {kGrid, 1, ""});
    drawing.text(axes({axes.low().x(), y}) + Vector2d(-8, 4), fmt::format("{:g}", y), {11, "end"});
  }
  drawing.text(corner + Vector2d(kLeft, 24), chart.title, {14, "start", charts::kText, true, 0});
  drawing.text(corner + Vector2d(kLeft + 0.5 * (chart.width - kLeft - kRight), chart.height - 14), chart.x_label,
               {12, "middle"});
  drawing.text(corner + Vector2d(18, 0.5 * chart.height), chart.y_label, {12, "middle", charts::kText, false, -90});
}

void draw_series(SvgDrawing& drawing, const Axes& axes, const Series& series) {
  std::vector<Vector2d> line;
  for (const Vector2d& p : series.points) {
    if (!p.allFinite()) continue;
    const Vector2d at = axes(p);
    if (series.look == Series::Look::dots) {
      drawing.disc(at, 2, series.colour, 0.5);
    } else if (series.look == Series::Look::bars) {
      const double width = 0.7 * (axes({1, 0}).x() - axes({0, 0}).x());
      const double floor = axes({p.x(), axes.low().y()}).y();
      drawing.rectangle({at.x() - 0.5 * width, at.y()}, {width, floor - at.y()}, series.colour, 0.85);
    } else if (line.empty() || (at - line.back()).norm() > 0.7) {
      line.push_back(at);
    }
  }
  if (line.size() > 1) drawing.polyline(line, {series.colour, 1.5, ""});
}

void draw_legend(SvgDrawing& drawing, const Chart& chart, const Vector2d& corner) {
  double x = chart.width - kRight;
  for (auto series = chart.series.rbegin(); series != chart.series.rend(); ++series) {
    if (series->name.empty()) continue;
    drawing.text(corner + Vector2d(x, 24), series->name, {12, "end"});
    x -= 7.0 * static_cast<double>(series->name.size()) + 12;
    drawing.disc(corner + Vector2d(x, 20), 5, series->colour);
    x -= 18;
  }
}

}  // namespace

std::vector<double> round_ticks(double low, double high, int count) {
  const double rough = (high - low) / count;
  const double power = std::pow(10, std::floor(std::log10(rough)));
  const double step = power * (rough / power < 1.5 ? 1 : rough / power < 3.5 ? 2 : rough / power < 7.5 ? 5 : 10);
  std::vector<double> ticks;
  for (double k = std::ceil(low / step); k * step <= high; ++k) ticks.push_back(k == 0 ? 0 : k * step);
  return ticks;
}

void draw_chart(SvgDrawing& drawing, const Vector2d& corner, const Chart& chart) {
  const Axes axes(chart, corner);
  draw_axes(drawing, axes, chart, corner);
  for (const Series& series : chart.series) draw_series(drawing, axes, series);
  draw_legend(drawing, chart, corner);
}

std::string draw_charts(const std::vector<Chart>& charts) {
  double width = 0;
  double height = 0;
  for (const Chart& chart : charts) {
    width = std::max(width, chart.width);
    height += chart.height;
  }
  SvgDrawing drawing(width, height);
  double y = 0;
  for (const Chart& chart : charts) {
    draw_chart(drawing, {0, y}, chart);
    y += chart.height;
  }
  return drawing.finish();
}

}  // namespace helicoid
