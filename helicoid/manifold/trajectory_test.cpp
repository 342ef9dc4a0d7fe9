#include "helicoid/manifold/trajectory.hpp"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <vector>

#include "helicoid/base/random.hpp"

namespace helicoid {

namespace {

Pose2 random_pose(Random& random) {
  return {random.uniform(-20, 20), random.uniform(-20, 20), random.uniform(-3.14, 3.14)};
}

Matrix3d random_covariance(Random& random) {
  Matrix3d root;
  for (int k = 0; k < 9; ++k) root(k / 3, k % 3) = random.uniform(-0.1, 0.1);
  // Every fourth leaves a direction out, as a corridor does the other way round.
  if (random.below(4) == 0) root.col(2) = root.col(1);
  return root * root.transpose();
}

/// Scans in stretches of a few, on patches whose poses change between them; stamps step back now and then.
std::vector<TrackedScan> random_scans(std::uint64_t seed, int count) {
  Random random(seed);
  std::vector<TrackedScan> scans;
  TrackedScan scan;
  scan.pose.patch = PatchId{0};
  scan.stamp = 976052857.355;
  for (int i = 0; i < count; ++i) {
    if (random.below(5) == 0) scan.pose.patch = PatchId{static_cast<std::uint32_t>(random.below(30))};
    if (random.below(9) == 0) scan.T_island_patch_online = random_pose(random);
    scan.stamp += random.below(20) == 0 ? -0.5 : random.uniform(0.01, 0.3);
    scan.pose.T_patch_robot = random_pose(random);
    scan.covariance = random_covariance(random);
    scans.push_back(scan);
  }
  return scans;
}

Trajectory trajectory_of(const std::vector<TrackedScan>& scans) {
  Trajectory trajectory;
  for (const TrackedScan& scan : scans) trajectory.push_back(scan);
  return trajectory;
}

}  // namespace

TEST(Trajectory, ReadsBackWhatWasAppendedToWithinItsRounding) {
  const std::vector<TrackedScan> scans = random_scans(1, 1000);
  const Trajectory trajectory = trajectory_of(scans);
  ASSERT_EQ(trajectory.size(), scans.size());
  std::size_t i = 0;
  for (const TrackedScan& read : trajectory) {
    const TrackedScan& scan = scans[i++];
    EXPECT_NEAR(read.stamp, scan.stamp, 1e-6);
    EXPECT_EQ(read.pose.patch, scan.pose.patch);
    EXPECT_EQ(read.T_island_patch_online, scan.T_island_patch_online);
    EXPECT_NEAR(read.pose.T_patch_robot.x, scan.pose.T_patch_robot.x, 1.6e-5 * 20);
    EXPECT_NEAR(read.pose.T_patch_robot.y, scan.pose.T_patch_robot.y, 1.6e-5 * 20);
    EXPECT_LE(std::abs(wrap_angle(read.pose.T_patch_robot.yaw - scan.pose.T_patch_robot.yaw)), 5e-5);
  }
  EXPECT_EQ(i, scans.size());
}

TEST(Trajectory, AnEntryIsTheSameByItsPlaceAndInARow) {
  const Trajectory trajectory = trajectory_of(random_scans(2, 300));
  std::size_t i = 0;
  for (const TrackedScan& scan : trajectory) {
    EXPECT_EQ(scan.stamp, trajectory[i].stamp);
    EXPECT_EQ(scan.stamp, trajectory.stamp(i));
    EXPECT_EQ(scan.pose, trajectory[i++].pose);
  }
}

TEST(Trajectory, TheLastScanNotAfterAStampIsFoundThoughStampsStepBack) {
  std::vector<TrackedScan> scans = random_scans(3, 400);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const std::size_t half_seconds = (7 * i) % 90 + i / 4;
    scans[i].stamp = 100 + 0.5 * static_cast<double>(half_seconds);
  }
  const Trajectory trajectory = trajectory_of(scans);
  for (double stamp = 90; stamp < 210; stamp += 0.3) {
    std::size_t last = scans.size();
    for (std::size_t i = 0; i < scans.size(); ++i) {
      if (trajectory.stamp(i) <= stamp) last = i;
    }
    EXPECT_EQ(trajectory.last_not_after(stamp), last);
  }
}

TEST(Trajectory, NeverStatesASmallerDeviationThanItWasGivenNorAnImpossibleCovariance) {
  const std::vector<TrackedScan> scans = random_scans(3, 1000);
  const Trajectory trajectory = trajectory_of(scans);
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Matrix3d read = trajectory[i].covariance;
    for (int k = 0; k < 3; ++k) {
      EXPECT_GE(read(k, k), scans[i].covariance(k, k) * (1 - 1e-6));
      EXPECT_LE(read(k, k), std::max(1e-10, scans[i].covariance(k, k) * 1.13));
    }
    const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(read);
    EXPECT_GE(solver.eigenvalues()[0], -1e-12 * solver.eigenvalues()[2]);
  }
}

TEST(Trajectory, WhatWasReadAppendsToTheSameBits) {
  const Trajectory once = trajectory_of(random_scans(4, 2000));
  Trajectory twice;
  for (const TrackedScan& scan : once) twice.push_back(scan);
  for (std::size_t i = 0; i < once.size(); ++i) {
    EXPECT_EQ(once[i].stamp, twice[i].stamp);
    EXPECT_EQ(once[i].pose, twice[i].pose);
    EXPECT_EQ(once[i].covariance, twice[i].covariance);
  }
  EXPECT_EQ(once.bytes(), twice.bytes());
}

TEST(Trajectory, GrowsBySixteenBytesAScanOnOnePatch) {
  Trajectory trajectory;
  TrackedScan scan;
  scan.pose.patch = PatchId{0};
  for (int i = 0; i < 1000; ++i) {
    scan.stamp += 0.1;
    trajectory.push_back(scan);
  }
  EXPECT_LE(trajectory.bytes(), 1000U * 16 + 300);
}

}  // namespace helicoid
