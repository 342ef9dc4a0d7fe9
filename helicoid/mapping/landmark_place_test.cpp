#include "helicoid/mapping/landmark_place.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

TEST(LandmarkPlace, TheMedoidStaysAmongTheMany) {
  Random random(5);
  std::vector<Vector2d> places;
  for (int i = 0; i < 1000; ++i) {
    const bool wrong = i % 3 == 0;
    places.emplace_back(wrong ? random.uniform(-50, 50) : 3 + 0.1 * random.normal(),
                        wrong ? 40 : 0.1 * random.normal());
  }
  EXPECT_LT((medoid(places) - Vector2d(3, 0)).norm(), 0.3);
  EXPECT_EQ(medoid(std::vector<Vector2d>{{1, 2}}), Vector2d(1, 2));
}

TEST(LandmarkPlace, OnlyALandmarkThatMostDetectionsContradictIsMoved) {
  TeamGraph team;
  team.graph.poses = {{0, 0, 0}, {9, 9, 0}, {1, 0, 0}};
  team.graph.is_landmark = {false, true, true};
  std::vector<bool> wrong;
  for (int i = 0; i < 10; ++i) {
    team.graph.relations.push_back({0, 1, PointPosition{{2, 0.01 * i}, Matrix2d::Identity()}, true});
    team.graph.relations.push_back({0, 2, PointPosition{{i < 4 ? 5.0 : 1.0, 0}, Matrix2d::Identity()}, true});
    wrong.push_back(true);
    wrong.push_back(i < 4);
  }
  const std::vector<Pose2> poses = reseat_landmarks(team, wrong);
  EXPECT_NEAR((poses[1].translation() - Vector2d(2, 0.05)).norm(), 0, 0.02);
  EXPECT_EQ(poses[0], team.graph.poses[0]);
  EXPECT_EQ(poses[2], team.graph.poses[2]);
}

}  // namespace
}  // namespace helicoid
