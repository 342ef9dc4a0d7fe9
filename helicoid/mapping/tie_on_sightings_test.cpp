// Two robots of one island, far from known to each other, of which one sees the other.
#include "helicoid/mapping/tie_on_sightings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/manifold/map_editor.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

constexpr double kStamp = 10;

/// Back to back in a room: neither sees what the other does.
struct Pair {
  Pose2 T_world_first{1.2, 5.5, 0};
  Pose2 T_world_second{5, 5.2, 0.3};
  Map map;
  InformationGraph graph;
  LoopCloser closer{MapperOptions{}};
  SightingLog log;

  /// The map has the second robot `off` from where it is, and knows it to sigma: metres, and a third of it in radians.
  Pair(double sigma, const Pose2& off) {
    MapEditor editor(map);
    const RayCaster walls(synthetic::building());
    const IslandId island = [&] {
      editor.add_robot("first", {synthetic::lms200()});
      editor.add_robot("second", {synthetic::lms200()});
      return editor.add_island();
    }();
    const Pose2 T_world[] = {T_world_first, T_world_second};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto id = make_id<PatchId>(i);
      const auto robot = make_id<RobotId>(i);
      const Scan scan = synthetic::look(walls, synthetic::lms200(), T_world[i]);
      const Pose2 T_plane = i == 0 ? T_world[i] : T_world[i] * off;
      editor.add_patch(make_patch(id, robot, 0, kStamp, scan, synthetic::lms200()), T_plane, island);
      editor.append_scan(robot, {kStamp, {id, Pose2{}}, T_plane, Matrix3d::Zero()});
    }
    const Pose2 T_a_b = T_world_first.inverse() * T_world_second * off;
    const Vector3d weight = Vector3d(1, 1, 9) / (sigma * sigma);
    editor.add_relation({make_id<PatchId>(0), make_id<PatchId>(1), RelationKind::sighting,
                         pose_pose_form(T_a_b, weight.asDiagonal()), T_a_b, 0, 0, 0});
    graph = information_graph(map);
  }

  bool see(const Pose2& said_off = {}) {
    const Pose2 T = T_world_first.inverse() * T_world_second * said_off;
    log.add(make_id<RobotId>(0), make_id<RobotId>(1), kStamp,
            {"second", T.distance(), std::atan2(T.y, T.x), T.yaw, 0.03, 0.01, 0.03});
    log.place_waiting(map, graph, closer, {}, true);
    MapEditor editor(map);
    MapInProgress progress{map, editor, graph};
    return SightingTies().tie(progress, closer, log, true, {});
  }
  [[nodiscard]] double error() const {
    const Pose2 T = map.poses()[0].inverse() * map.poses()[1];
    return ((T_world_first.inverse() * T_world_second).inverse() * T).distance();
  }
  [[nodiscard]] std::size_t sightings() const {
    return static_cast<std::size_t>(std::count_if(map.relations().begin(), map.relations().end(),
                                                  [](const auto& r) { return r.kind == RelationKind::sighting; }));
  }
};

TEST(SightingTies, ASightingTellsWhereTheMapIsVague) {
  Pair pair(0.3, {0.35, -0.2, 0.1});
  EXPECT_TRUE(pair.see());
  EXPECT_EQ(pair.sightings(), 2U);
  EXPECT_LT(pair.error(), 0.1);
  EXPECT_EQ(pair.closer.ledger().front().state, HypothesisState::accepted);
  EXPECT_EQ(pair.closer.ledger().front().decided_by, DecidedBy::sighting);
}

TEST(SightingTies, WhatTheMapIsSureOfNeedsNoSighting) {
  Pair pair(0.02, {});
  EXPECT_FALSE(pair.see());
  EXPECT_EQ(pair.sightings(), 1U);
  EXPECT_TRUE(pair.closer.ledger().front().is_undecided());
}

TEST(SightingTies, OneThatDoesNotAgreeWithTheMapTiesNothing) {
  Pair pair(0.3, {});
  EXPECT_FALSE(pair.see({2, 1, 1}));
  EXPECT_EQ(pair.sightings(), 1U);
}

}  // namespace
}  // namespace helicoid
