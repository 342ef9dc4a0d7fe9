#include "helicoid/mapping/relate.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

const PosePrior kAbout{Pose2{0.02, -0.03, 0.01}, 1e-3 * Matrix3d::Identity()};

TEST(Relate, FindsWhereAPatchStandsAmongViewsOfTheSameRoom) {
  synthetic::Builder builder;
  const std::vector<synthetic::Wall> walls = synthetic::pillar_room();
  const PatchId a = builder.add(walls, {2, 2, 0});
  const PatchId c = builder.add(walls, {2, 3, 0.5});
  const PatchId b = builder.add(walls, {2, 2, 0});
  const Pose2 T_a_c = builder.map.T_plane_patch(a).inverse() * builder.map.T_plane_patch(c);
  const std::vector<LocalPatch> views{{a, {}}, {c, T_a_c}};
  const RelatedPatch related = relate(builder.map, views, builder.map.patch(b), kAbout);
  EXPECT_EQ(related.relations.size(), 2U);
  EXPECT_LT(related.T_anchor_patch.distance(), 0.005);
  EXPECT_LT(std::abs(related.T_anchor_patch.yaw), 0.002);
}

/// The side walls of a corridor agree, but where one scan saw its end the other saw through.
TEST(Relate, LeavesOutAViewThatThePatchContradictsMoreThanItAgrees) {
  for (const double end : {2.0, 2.4}) {
    synthetic::Builder builder;
    const PatchId a = builder.add(synthetic::rectangle(0, 0, 3, 20), {1.5, 1, radians(90)});
    const PatchId b = builder.add(synthetic::rectangle(0, 0, 3, end), {1.5, 1, radians(90)});
    const std::vector<LocalPatch> views{{a, {}}};
    EXPECT_TRUE(relate(builder.map, views, builder.map.patch(b), kAbout).relations.empty()) << end;
    EXPECT_FALSE(relate(builder.map, views, builder.map.patch(a), kAbout).relations.empty());
  }
}

/// A corridor's walls as a noisy laser shows them.
std::vector<synthetic::Wall> rough_corridor(Random& random) {
  constexpr double kStep = 0.2;
  std::vector<synthetic::Wall> walls;
  for (const double y : {0.0, 3.0}) {
    Vector2d last(-60, y);
    while (last.x() < 60) {
      const Vector2d next(last.x() + kStep, y + 0.008 * random.normal());
      walls.push_back({last, next});
      last = next;
    }
  }
  return walls;
}

/// They say next to nothing of the way along them, and what they say is chance.
TEST(Relate, StaysWithinReachOfItsCorrespondencesAlongABareCorridor) {
  Random random(1);
  for (int run = 0; run < 60; ++run) {
    synthetic::Builder builder;
    const PatchId a = builder.add(rough_corridor(random), {0, 1.5, 0});
    const PatchId b = builder.add(rough_corridor(random), {0, 1.5, 0});
    const PosePrior open{{}, Vector3d(0.03, 6e3, 1e5).asDiagonal()};
    const RelatedPatch related = relate(builder.map, std::vector<LocalPatch>{{a, {}}}, builder.map.patch(b), open);
    EXPECT_LT(related.T_anchor_patch.distance(), 0.45) << run;
  }
}

}  // namespace
}  // namespace helicoid
