#include "helicoid/exploration/patch_view.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

#include "helicoid/sensor/scan_points.hpp"

namespace helicoid {

namespace {

/// Beams on either side whose ends are compared with a point.
constexpr std::ptrdiff_t kMostBeams = 8;

float squared_distance(const Eigen::Vector2f& p, const Eigen::Vector2f& from, const Eigen::Vector2f& to) {
  const Eigen::Vector2f along = to - from;
  const float length = along.squaredNorm();
  const float at = length > 0 ? std::clamp((p - from).dot(along) / length, 0.0F, 1.0F) : 0.0F;
  return (from + at * along - p).squaredNorm();
}

}  // namespace

PatchView::PatchView(const Patch& patch, const PatchViewOptions& options)
    : patch_(&patch), options_(options), beams_(patch.laser) {
  const Pose2 T_laser_patch = patch.scan.T_robot_laser.inverse();
  R_laser_patch_ = T_laser_patch.rotation().cast<float>();
  t_laser_patch_ = T_laser_patch.translation().cast<float>();
  const std::size_t beams = patch.free_ranges.size();
  const BeamTable table = make_beam_table(patch.laser);
  ends_.resize(beams, Eigen::Vector2f::Zero());
  returned_.resize(beams, 0);
  for (std::size_t i = 0; i < beams; ++i) {
    const float range = i < patch.scan.ranges.size() ? patch.scan.ranges[i] : 0.0F;
    returned_[i] = is_return(range, patch.laser) ? 1 : 0;
    ends_[i] = (returned_[i] != 0 ? range : patch.free_ranges[i]) * Eigen::Vector2f(table.cosine[i], table.sine[i]);
  }
  find_in_between();
  find_open_points();
}

void PatchView::find_in_between() {
  in_between_.assign(ends_.size(), 0);
  // By the next beams on either side that say anything: grazing surfaces swallow some.
  std::vector<std::size_t> beams;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    if (returned_[i] != 0) beams.push_back(i);
  }
  for (std::size_t k = 1; k + 1 < beams.size(); ++k) {
    const auto [before, at, after] = std::tuple(beams[k - 1], beams[k], beams[k + 1]);
    if (is_surface(before, at) || is_surface(at, after)) continue;
    const float range = ends_[at].norm();
    in_between_[at] = (ends_[before].norm() < range) != (ends_[after].norm() < range) ? 1 : 0;
  }
}

bool PatchView::is_surface(std::size_t beam, std::size_t next) const {
  if (returned_[beam] == 0 || returned_[next] == 0) return false;
  // Two beams' ends that are a little farther apart than what a laser vouches for are still one wall, met at an angle.
  const auto longest = static_cast<float>(1.4 * patch_->laser.largest_gap);
  return (ends_[next] - ends_[beam]).squaredNorm() <= longest * longest;
}

std::size_t PatchView::surface_end(std::size_t beam) const {
  return beam + 1 < ends_.size() && is_surface(beam, beam + 1) ? beam + 1 : beam;
}

bool PatchView::near_obstacle(const Eigen::Vector2f& p_laser, std::ptrdiff_t beam) const {
  const auto reach = static_cast<float>(options_.obstacle_reach);
  const float angle = std::asin(std::min(1.0F, reach / std::max(reach, p_laser.norm())));
  const auto beams = static_cast<std::ptrdiff_t>(angle / static_cast<float>(patch_->laser.bearing_step));
  const std::ptrdiff_t width = std::min(kMostBeams, beams + 1);
  const std::ptrdiff_t first = std::max<std::ptrdiff_t>(0, beam - width);
  const std::ptrdiff_t last = std::min(std::ssize(ends_) - 1, beam + width);
  for (std::ptrdiff_t i = first; i <= last; ++i) {
    const auto at = static_cast<std::size_t>(i);
    if (!is_obstacle(at)) continue;
    if (squared_distance(p_laser, ends_[at], ends_[surface_end(at)]) <= reach * reach) return true;
  }
  return false;
}

bool PatchView::knows(const Vector2d& p_patch) const {
  const double distance = p_patch.norm();
  if (distance <= options_.body) return true;
  if (distance > patch_->reach + options_.obstacle_reach) return false;
  const Eigen::Vector2f p_laser = R_laser_patch_ * p_patch.cast<float>() + t_laser_patch_;
  const float at = beams_.at(p_laser.x(), p_laser.y());
  const auto below = static_cast<std::ptrdiff_t>(std::floor(at));
  const std::vector<float>& free = patch_->free_ranges;
  if (below >= 0 && below + 1 < std::ssize(free)) {
    const auto i = static_cast<std::size_t>(below);
    const float part = at - static_cast<float>(below);
    const float r0 = free[i];
    const float r1 = free[i + 1];
    // Below the chord between the two beams' ends, in polar form; beams are close enough for sin x = x.
    if (r0 > 0 && r1 > 0 && p_laser.norm() * (r0 * part + r1 * (1 - part)) <= r0 * r1) return true;
  }
  return near_obstacle(p_laser, static_cast<std::ptrdiff_t>(std::lround(at)));
}

std::vector<PatchView::Surface> PatchView::surfaces() const {
  const Pose2& T_patch_laser = patch_->scan.T_robot_laser;
  const Eigen::Matrix2f R = T_patch_laser.rotation().cast<float>();
  const Eigen::Vector2f t = T_patch_laser.translation().cast<float>();
  std::vector<Surface> surfaces;
  for (std::size_t i = 0; i < ends_.size(); ++i) {
    if (!is_obstacle(i)) continue;
    surfaces.push_back({R * ends_[i] + t, R * ends_[surface_end(i)] + t});
  }
  return surfaces;
}

void PatchView::open_edge(const Eigen::Vector2f& from_patch, const Eigen::Vector2f& to_patch) {
  const Eigen::Vector2f along = to_patch - from_patch;
  const float length = along.norm();
  if (length < 1e-3F) return;
  // The ring is anticlockwise: what is outside lies to the right.
  const Eigen::Vector2f outward(along.y() / length, -along.x() / length);
  const int points = std::max(1, static_cast<int>(length / static_cast<float>(options_.spacing)));
  for (int k = 0; k < points; ++k) {
    const float share = (static_cast<float>(k) + 0.5F) / static_cast<float>(points);
    open_points_.push_back({from_patch + share * along, outward});
  }
}

void PatchView::find_open_points() {
  const Pose2& T_patch_laser = patch_->scan.T_robot_laser;
  const Eigen::Matrix2f R = T_patch_laser.rotation().cast<float>();
  const Eigen::Vector2f t = T_patch_laser.translation().cast<float>();
  const BeamTable table = make_beam_table(patch_->laser);
  const std::vector<float>& free = patch_->free_ranges;
  const auto vertex = [&](std::size_t i) -> Eigen::Vector2f {
    return R * (free[i] * Eigen::Vector2f(table.cosine[i], table.sine[i])) + t;
  };
  // An edge of the polygon is closed if both its ends are beams' ends on one surface.
  const auto ends_here = [&](std::size_t i) { return returned_[i] != 0 && free[i] >= patch_->scan.ranges[i] - 1e-3F; };
  const bool whole_turn = patch_->laser.field_of_view() + patch_->laser.bearing_step > 2 * std::numbers::pi - 1e-3;
  for (std::size_t i = 0; i < free.size(); ++i) {
    const std::size_t next = i + 1 < free.size() ? i + 1 : 0;
    if (next == 0 && !whole_turn) {
      open_edge(vertex(i), t);
      open_edge(t, vertex(next));
    } else if (!(ends_here(i) && ends_here(next) && is_surface(i, next))) {
      open_edge(vertex(i), vertex(next));
    }
  }
}

}  // namespace helicoid
