#include "helicoid/eval/trajectory_error.hpp"

#include <gtest/gtest.h>

#include <vector>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

TEST(AlignPoints, FindsTheTransformThatPointsWereMovedBy) {
  Random random(1);
  for (int i = 0; i < 50; ++i) {
    const Pose2 T{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-3.14, 3.14)};
    std::vector<Vector2d> points, targets;
    for (int k = 0; k < 10; ++k) {
      points.emplace_back(random.uniform(-9, 9), random.uniform(-9, 9));
      targets.push_back(T * points.back());
    }
    const Pose2 off = T.inverse() * align_points(points, targets);
    EXPECT_LT(off.distance() + std::abs(off.yaw), 1e-9);
  }
}

struct Track {
  std::vector<double> stamps;
  std::vector<Pose2> poses;
};

Track drive(double step) {
  Track track;
  Pose2 T;
  for (int i = 0; i < 100; ++i) {
    track.stamps.push_back(0.25 * i);
    track.poses.push_back(T);
    T = T * Pose2{step, 0, 0.05};
  }
  return track;
}

TEST(TrajectoryError, OfTheTruthInAnotherFrameIsZero) {
  const Track truth = drive(0.2);
  std::vector<Pose2> moved;
  for (const Pose2& pose : truth.poses) moved.push_back(Pose2{7, -3, 2} * pose);
  const TrajectoryError error = trajectory_error(truth.stamps, moved, truth.stamps, truth.poses);
  EXPECT_EQ(error.matched, 100U);
  EXPECT_NEAR(error.ate_m, 0, 1e-9);
  EXPECT_NEAR(error.rpe_m, 0, 1e-9);
  EXPECT_NEAR(error.rpe_deg, 0, 1e-7);
}

TEST(TrajectoryError, OverASecondIsWhatAScaleErrorMakesOfIt) {
  Track truth, estimate;
  for (int i = 0; i < 41; ++i) {
    truth.stamps.push_back(0.25 * i);
    truth.poses.push_back({0.2 * i, 0, 0});
    estimate.poses.push_back({0.21 * i, 0, 0});
  }
  const TrajectoryError error = trajectory_error(truth.stamps, estimate.poses, truth.stamps, truth.poses);
  EXPECT_NEAR(error.rpe_m, 0.04, 1e-9);  // 0.8 m driven in a second, 5 % too long
  EXPECT_NEAR(error.rpe_deg, 0, 1e-9);
}

TEST(TrajectoryError, PosesWithoutATrueOneAreNotMatched) {
  const Track truth = drive(0.2);
  const std::vector<double> stamps{0.1, 0.25, 0.5004, 99};
  const std::vector<Pose2> poses(4);
  EXPECT_EQ(trajectory_error(stamps, poses, truth.stamps, truth.poses).matched, 2U);
  EXPECT_EQ(trajectory_error({}, {}, truth.stamps, truth.poses).matched, 0U);
}

}  // namespace
}  // namespace helicoid
