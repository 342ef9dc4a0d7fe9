#include <Eigen/LU>
#include <cmath>

#include "helicoid/mapping/team_calibration.hpp"

namespace helicoid {

namespace {

/// A step between two poses: forward and sideways along the heading half-way.
struct Moved {
  double seconds = 0;
  double forward = 0;
  double sideways = 0;
  double turned = 0;
  double turning_variance = 0;  ///< of what was turned, as the model before has it
};

std::vector<Moved> moves_of(const CommandedMotion& motion, const OdometryModel& model, std::span<const double> stamps,
                            std::span<const Pose2> poses) {
  std::vector<Moved> moves;
  for (std::size_t k = 1; k < stamps.size(); ++k) {
    const Pose2 T = poses[k - 1].inverse() * poses[k];
    const Vector2d step = Pose2{0, 0, -0.5 * T.yaw} * T.translation();
    const double seconds = stamps[k] - stamps[k - 1];
    const double told = motion.told(stamps[k - 1], stamps[k]).turning;
    moves.push_back({seconds, step.x(), step.y(), T.yaw, model.turning_variance(seconds, told)});
  }
  return moves;
}

struct FittedGains {
  OdometryModel model;
  double chi2 = 0;
};

/// The gains of the model for this delay. Without motion to tell them by they stay as they were.
FittedGains gains_for_delay(std::span<const Velocity> velocities, std::span<const double> stamps,
                            std::span<const Moved> moves, OdometryModel model) {
  const CommandedMotion motion(velocities, model);
  std::vector<Commanded> told;
  Matrix2d A = Matrix2d::Zero();
  Vector2d right = Vector2d::Zero();
  Vector2d along = Vector2d::Zero();
  double forward = 0;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const Moved& m = moves[k];
    told.push_back(motion.told(stamps[k], stamps[k + 1]));
    const Vector2d row(told[k].turning, told[k].forward);
    A += row * row.transpose() / m.turning_variance;
    right += row * m.turned / m.turning_variance;
    along += Vector2d(m.forward, m.sideways) * told[k].forward / m.seconds;
    forward += told[k].forward * told[k].forward / m.seconds;
  }
  if (along.x() > 0) model.forward_gain = along.x() / forward, model.sideways_gain = along.y() / forward;
  if (A.determinant() > 1e-6 * A(0, 0) * A(1, 1)) {
    const Vector2d turning = A.inverse() * right;
    model.turning_gain = turning.x();
    model.veer = turning.y();
  }
  double chi2 = 0;
  for (std::size_t k = 0; k < moves.size(); ++k) {
    const double f = moves[k].forward / model.forward_gain - told[k].forward;
    const double t = moves[k].turned - model.turning_gain * told[k].turning - model.veer * told[k].forward;
    chi2 += f * f / (model.forward_rate * moves[k].seconds) + t * t / moves[k].turning_variance;
  }
  return {model, chi2};
}

}  // namespace

std::vector<OdometryModel> fit_gains(const TeamLog& log, const TeamNodes& nodes, std::span<const Pose2> poses,
                                     const std::vector<OdometryModel>& before) {
  constexpr double kLongestDelay = 1;  // seconds
  constexpr double kStep = 0.02;
  std::vector<OdometryModel> models;
  for (std::size_t i = 0; i < log.robots.size(); ++i) {
    const std::span<const Velocity> velocities = log.robots[i].velocities;
    const std::span<const double> stamps = nodes.stamps_of(i);
    const std::vector<Moved> moves = moves_of(CommandedMotion(velocities, before[i]), before[i], stamps,
                                              poses.subspan(nodes.first_of(i), stamps.size()));
    FittedGains best{before[i], HUGE_VAL};
    for (double delay = 0; delay < kLongestDelay && !moves.empty(); delay += kStep) {
      OdometryModel model = before[i];
      model.delay = delay;
      const FittedGains found = gains_for_delay(velocities, stamps, moves, model);
      if (found.chi2 < best.chi2) best = found;
    }
    models.push_back(best.model);
  }
  return models;
}

}  // namespace helicoid
