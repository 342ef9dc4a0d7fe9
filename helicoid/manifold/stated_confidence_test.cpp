#include "helicoid/manifold/stated_confidence.hpp"

#include <gtest/gtest.h>

#include <Eigen/Cholesky>

#include "helicoid/base/random.hpp"
#include "helicoid/manifold/confidence.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

/// A robot that drives along a chain of patches by one step again and again, a quarter of a second each.
synthetic::Builder chain(const Pose2& step, int patches) {
  synthetic::Builder builder("robot1", 31);
  const std::vector<synthetic::Wall> walls = synthetic::rectangle(-20, -20, 20, 20);
  Pose2 pose;
  for (int i = 0; i < patches; ++i, pose = pose * step) {
    builder.add(walls, pose);
    if (i > 0) builder.relate(make_id<PatchId>(i - 1), make_id<PatchId>(i), RelationKind::chain);
  }
  return builder;
}

Matrix3d with_floors_only(const Map& map, PatchId a, PatchId b) {
  const Island island = map.islands().front();
  const RelativeCovariance exact(island_poses(map, island), graph_edges(map, island));
  const LaserModel& laser = map.patch(a).laser;
  const Matrix3d floor = noise_floor(laser.floor_position, laser.floor_heading);
  return with_noise_floor(exact.of(a.value, b.value), floor, floor);
}

Vector3d draw(Random& random, const Matrix3d& covariance) {
  return covariance.llt().matrixL() * Vector3d(random.normal(), random.normal(), random.normal());
}

const PatchId kA{1};
const PatchId kB{4};
/// Headings as the graph has them, and a true measure.
StatedConfidenceOptions as_the_graph(double timing_sigma) {
  return {timing_sigma, 1, 0};
}

TEST(StatedConfidence, OfARobotThatStandsStillIsTheExactOneWithTheFloorsOfBothScans) {
  const synthetic::Builder builder = chain({}, 6);
  const StatedConfidence stated(builder.map, builder.map.islands().front(), as_the_graph(0.006));
  ASSERT_TRUE(stated.is_determined());
  EXPECT_LT((stated.between(kA, kB).covariance - with_floors_only(builder.map, kA, kB)).norm(), 1e-15);
}

TEST(StatedConfidence, AddsAMomentOfTheMotionOfEitherEnd) {
  const Pose2 step{0.2, 0, 0.25};
  const synthetic::Builder builder = chain(step, 6);
  const StatedConfidence stated(builder.map, builder.map.islands().front(), as_the_graph(0.01));
  const Matrix3d more = stated.between(kA, kB).covariance - with_floors_only(builder.map, kA, kB);
  const Vector3d moved = 0.01 * logarithm(step) / 0.25;
  // By the ends' own derivatives: T_a_b is of both what a and what b moves by.
  const Pose2 T_a_b = builder.map.T_plane_patch(kA).inverse() * builder.map.T_plane_patch(kB);
  const Composition by_b = compose_with_jacobians(T_a_b, {});
  const Inversion back = invert_with_jacobian({});
  const Composition by_a = compose_with_jacobians({}, T_a_b);
  const Vector3d off_a = by_a.by_first * back.by_pose * moved;
  const Vector3d off_b = by_b.by_second * moved;
  const Matrix3d expected = off_a * off_a.transpose() + off_b * off_b.transpose();
  EXPECT_LT((more - expected).norm(), 1e-12);
  EXPECT_NEAR(more(2, 2), 2 * std::pow(0.01 * 0.25 / 0.25, 2), 1e-12);
}

TEST(StatedConfidence, HoldsForStampsThatAreOff) {
  // What is drawn by the model's own account, moved along the drive and not by derivatives, has its covariance.
  Random random(1);
  const synthetic::Builder builder = chain({0.2, 0, 0.25}, 6);
  const StatedConfidence stated(builder.map, builder.map.islands().front(), as_the_graph(0.01));
  const Matrix3d exact = with_floors_only(builder.map, kA, kB);
  const UncertainPose2 whole = stated.between(kA, kB);
  const Vector3d twist = twist_at(builder.map, {RobotId{0}, kA.value});
  double nees = 0;
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    const Pose2 scans = Pose2::from_vector(whole.T_a_b.vector() + draw(random, exact));
    const Pose2 truth =
        exponential(0.01 * random.normal() * twist).inverse() * scans * exponential(0.01 * random.normal() * twist);
    const Vector3d off(truth.x - whole.T_a_b.x, truth.y - whole.T_a_b.y, wrap_angle(truth.yaw - whole.T_a_b.yaw));
    nees += off.dot(whole.covariance.ldlt().solve(off)) / kDraws;
  }
  EXPECT_NEAR(nees, 3, 0.16);  // four standard deviations of the mean of so many
}

TEST(StatedConfidence, TakesHeadingsByTheirShareAndLeavesPositionsAndCorrelationsAlone) {
  const synthetic::Builder builder = chain({}, 6);
  const Island island = builder.map.islands().front();
  const auto without_floors = [&](double share) -> Matrix3d {
    const Matrix3d floors =
        with_noise_floor({{}, Matrix3d::Zero()}, noise_floor(0.008, 0.006), noise_floor(0.008, 0.006));
    return StatedConfidence(builder.map, island, {0, share, 0}).between(kA, kB).covariance - floors;
  };
  const Matrix3d whole = without_floors(1);
  const Matrix3d half = without_floors(0.5);
  EXPECT_NEAR(half(2, 2), 0.5 * whole(2, 2), 1e-15);
  EXPECT_LT((half.topLeftCorner<2, 2>() - whole.topLeftCorner<2, 2>()).norm(), 1e-15);
  EXPECT_NEAR(half(0, 2), std::sqrt(0.5) * whole(0, 2), 1e-15);
}

TEST(StatedConfidence, IsLessAlongADisplacementByTheShareThatTheMeasureMayBeOff) {
  const synthetic::Builder builder = chain({0.4, 0.3, 0}, 6);
  const Island island = builder.map.islands().front();
  const Matrix3d more = StatedConfidence(builder.map, island, {0, 1, 0.01}).between(kA, kB).covariance -
                        with_floors_only(builder.map, kA, kB);
  const Vector2d displacement(3 * 0.4, 3 * 0.3);
  EXPECT_NEAR(displacement.normalized().dot(more.topLeftCorner<2, 2>() * displacement.normalized()),
              std::pow(0.01 * displacement.norm(), 2), 1e-12);
  EXPECT_NEAR(more.trace(), std::pow(0.01 * displacement.norm(), 2), 1e-12);  // and nowhere else
}

TEST(StatedConfidence, OfScansOnTheirPatchesIsThatOfThePatchesAndTheirOwn) {
  const synthetic::Builder builder = chain({0.2, 0, 0.1}, 6);
  const StatedConfidence stated(builder.map, builder.map.islands().front());
  const UncertainPose2 patches = stated.between(kA, kB);
  const UncertainPose2 scans = stated.between({RobotId{0}, kA.value}, {RobotId{0}, kB.value});
  EXPECT_LT((patches.T_a_b.vector() - scans.T_a_b.vector()).norm(), 1e-4);  // a trajectory's rounding
  // The builder's scans are known to 1 cm, 0.01 rad on their patches, standard deviations rounded up by a sixteenth.
  const Matrix3d more = scans.covariance - patches.covariance;
  EXPECT_GT(more(2, 2), 2e-4 * 0.99);
  EXPECT_LT(more(2, 2), 2e-4 * 1.13);
  EXPECT_GT(Eigen::LDLT<Matrix3d>(more).vectorD().minCoeff(), 0);
}

TEST(TwistAt, IsTheMotionAboutAScan) {
  const Pose2 step{0.2, 0, 0.25};
  const synthetic::Builder builder = chain(step, 6);
  EXPECT_LT((twist_at(builder.map, {RobotId{0}, 2}) - logarithm(step) / 0.25).norm(), 1e-3);
  EXPECT_LT((twist_at(builder.map, {RobotId{0}, 0}) - logarithm(step) / 0.25).norm(), 1e-3);
}

TEST(TwistAt, IsNothingWhereTheClockRunsBackOrStandsStill) {
  synthetic::Builder builder = chain({0.2, 0, 0.25}, 2);
  MapEditor editor(builder.map);
  const TrackedScan last = builder.map.robot(builder.robot).trajectory.back();
  editor.append_scan(builder.robot, {last.stamp - 3, {PatchId{0}, {}}, {}, Matrix3d::Identity()});
  EXPECT_EQ(twist_at(builder.map, {RobotId{0}, 1}).norm(), 0);
  EXPECT_EQ(twist_at(builder.map, {RobotId{0}, 2}).norm(), 0);
}

}  // namespace
}  // namespace helicoid
