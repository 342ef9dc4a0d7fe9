#include "helicoid/mapping/island_join.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

constexpr double kSigma = 0.03;

/// Two islands with a patch each; the second lies at T_a_b of the first, in truth.
struct TwoIslands {
  Map map;
  Pose2 T_a_b{4, -2, 2.1};
  TwoIslands() {
    MapEditor editor(map);
    const LaserModel laser = synthetic::test_laser();
    for (std::size_t i = 0; i < 2; ++i) {
      const RobotId robot = editor.add_robot(i == 0 ? "a" : "b", {laser});
      Scan scan;
      scan.ranges.assign(static_cast<std::size_t>(laser.beams), 5.0F);
      editor.add_patch(make_patch(make_id<PatchId>(i), robot, 0, 0, scan, laser),
                       Pose2{7.0 * static_cast<double>(i), 1, 0.5}, editor.add_island());
    }
  }
  /// What one robot at p (on a) measures of the other at q (on b), or the other way round.
  [[nodiscard]] PlacedSighting see(const Pose2& p_a, const Pose2& q_b, bool from_a) const {
    const Pose2 T_p_q = p_a.inverse() * T_a_b * q_b;
    const Pose2 T = from_a ? T_p_q : T_p_q.inverse();
    PlacedSighting s;
    s.observer = from_a ? ManifoldPose{PatchId{0}, p_a} : ManifoldPose{PatchId{1}, q_b};
    s.observed = from_a ? ManifoldPose{PatchId{1}, q_b} : ManifoldPose{PatchId{0}, p_a};
    s.sighting = {"other", T.distance(), std::atan2(T.y, T.x), T.yaw, kSigma, kSigma, kSigma};
    return s;
  }
};

double distance(const Pose2& a, const Pose2& b) {
  const Pose2 off = a.inverse() * b;
  return off.distance() + std::abs(off.yaw);
}

TEST(IslandJoin, OneWholeSightingDeterminesIt) {
  const TwoIslands two;
  for (const bool from_a : {true, false}) {
    const std::vector<PlacedSighting> seen{two.see({1, 2, 0.3}, {-0.5, 0.2, -1}, from_a)};
    const IslandJoin join = estimate_join(two.map, seen);
    EXPECT_TRUE(join.determined);
    EXPECT_LT(distance(join.T_a_b, two.T_a_b), 1e-5);
    EXPECT_EQ(join.measurements, 3);
  }
}

TEST(IslandJoin, RangeAndBearingOfOneSightingDoNot) {
  const TwoIslands two;
  std::vector<PlacedSighting> seen{two.see({1, 2, 0.3}, {-0.5, 0.2, -1}, true)};
  seen[0].sighting.orientation.reset();
  EXPECT_FALSE(estimate_join(two.map, seen).determined);
}

TEST(IslandJoin, ButSeenBothWaysTheyDo) {
  const TwoIslands two;
  std::vector<PlacedSighting> seen{two.see({1, 2, 0.3}, {-0.5, 0.2, -1}, true),
                                   two.see({1, 2, 0.3}, {-0.5, 0.2, -1}, false)};
  for (PlacedSighting& s : seen) s.sighting.orientation.reset();
  const IslandJoin join = estimate_join(two.map, seen);
  EXPECT_TRUE(join.determined);
  EXPECT_LT(distance(join.T_a_b, two.T_a_b), 1e-4);
}

TEST(IslandJoin, ThreeRangesLeaveAMirrorImageAndMoreRangesDoNot) {
  const TwoIslands two;
  std::vector<PlacedSighting> seen;
  const auto add_range = [&](const Pose2& p, const Pose2& q) {
    seen.push_back(two.see(p, q, true));
    seen.back().sighting.bearing.reset();
    seen.back().sighting.orientation.reset();
  };
  // One robot stands, the other drives along a line: its mirror image fits as well.
  add_range({0, 0, 0}, {0, 0, 0});
  add_range({0, 0, 0}, {2, 0, 0});
  add_range({0, 0, 0}, {4, 0, 0});
  EXPECT_FALSE(estimate_join(two.map, seen).determined);
  add_range({3, 1, 0}, {1, 3, 0});
  add_range({-2, 4, 0}, {-1, -3, 0});
  add_range({2, -3, 0}, {3, 2, 0});
  add_range({5, 2, 0}, {0, -4, 0});
  const IslandJoin join = estimate_join(two.map, seen);
  EXPECT_TRUE(join.determined);
  EXPECT_LT(distance(join.T_a_b, two.T_a_b), 1e-3);
}

TEST(IslandJoin, MeasurementsThatAreNoNumbersAreNotUsed) {
  const TwoIslands two;
  std::vector<PlacedSighting> seen{two.see({1, 2, 0.3}, {-0.5, 0.2, -1}, true)};
  seen[0].sighting.range = std::nan("");
  EXPECT_FALSE(estimate_join(two.map, seen).determined);
  seen[0].sighting.range = 2;
  seen[0].sighting.sigma_range = 0;
  EXPECT_FALSE(estimate_join(two.map, seen).determined);
  EXPECT_FALSE(estimate_join(two.map, {}).determined);
}

}  // namespace
}  // namespace helicoid
