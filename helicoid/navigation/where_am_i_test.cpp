#include "helicoid/navigation/where_am_i.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using synthetic::Wall;

/// All patches of one room vouch for one another.
Neighbours rooms_of(std::size_t patches, std::size_t in_a_room) {
  Neighbours neighbours(patches);
  for (std::size_t i = 0; i < patches; ++i) {
    for (std::size_t j = 0; j < patches; ++j) {
      if (i != j && i / in_a_room == j / in_a_room) neighbours[i].push_back(make_id<PatchId>(j));
    }
  }
  return neighbours;
}

/// A room 7 m wide with a niche, its corner at (x, 0).
std::vector<Wall> room(double x, double depth) {
  const double far = depth + 0.8;
  std::vector<Wall> walls{{{x, 0}, {x + 7, 0}},
                          {{x + 7, 0}, {x + 7, depth}},
                          {{x + 7, depth}, {x + 5, depth}},
                          {{x + 5, depth}, {x + 5, far}},
                          {{x + 5, far}, {x + 3.6, far}},
                          {{x + 3.6, far}, {x + 3.6, depth}},
                          {{x + 3.6, depth}, {x, depth}},
                          {{x, depth}, {x, 0}}};
  synthetic::append(walls, synthetic::rectangle(x + 2, 1.2, x + 2.7, 1.9));
  synthetic::append(walls, synthetic::rectangle(x + 5.8, depth - 1.4, x + 6.2, depth - 0.6));
  return walls;
}

/// Four views of either of two rooms.
Builder two_rooms(double depth_of_the_second) {
  Builder builder;
  for (const auto& [x, depth] : {std::pair{0.0, 5.0}, std::pair{30.0, depth_of_the_second}}) {
    const std::vector<Wall> walls = room(x, depth);
    for (const double yaw : {0.0, 1.57, 3.1, -1.57}) builder.add(walls, {x + 4.2, 3.2, yaw});
  }
  return builder;
}

/// The rooms have one corner in common: who looks there cannot tell, and must say so.
TEST(WhereAmI, FindsARobotThatWasPutDownAnywhereAndIsSureOnlyOfWhatIsTrue) {
  const Builder builder = two_rooms(6.2);
  Random random(6);
  int sure = 0;
  for (int k = 0; k < 24; ++k) {
    const double x = k % 2 == 0 ? 0 : 30;
    const Pose2 truth{x + random.uniform(3.2, 5.2), random.uniform(2.4, 4.2), random.uniform(-3.1, 3.1)};
    const Scan scan = synthetic::take_scan(room(x, k % 2 == 0 ? 5.0 : 6.2), truth, builder.laser);
    double confidence = 0;
    for (const PlaceHypothesis& place : where_am_i(builder.map, rooms_of(8, 4), scan, builder.laser)) {
      const Pose2 off = truth.inverse() * builder.map.project(place.pose);
      const bool is_true = off.distance() < 0.1 && std::abs(off.yaw) < 0.05;
      if (is_true) confidence = place.confidence;
      EXPECT_TRUE(is_true || place.confidence <= 0.9) << k << ": " << place.confidence;
    }
    EXPECT_GT(confidence, 0.2) << k;
    sure += confidence > 0.9 ? 1 : 0;
  }
  EXPECT_GE(sure, 12);
}

TEST(WhereAmI, CannotTellTwoRoomsThatLookAlike) {
  const Builder builder = two_rooms(5.0);
  const Pose2 truth{4.0, 3.0, 0.4};
  const Scan scan = synthetic::take_scan(room(0, 5.0), truth, builder.laser);
  const std::vector<PlaceHypothesis> places = where_am_i(builder.map, rooms_of(8, 4), scan, builder.laser);
  ASSERT_GE(places.size(), 2U);
  EXPECT_NEAR(places[0].confidence, places[1].confidence, 0.1);
  EXPECT_LT(places[0].confidence, 0.55);
  const Pose2 between = builder.map.project(places[0].pose).inverse() * builder.map.project(places[1].pose);
  EXPECT_NEAR(between.distance(), 30, 0.2);
}

TEST(WhereAmI, IsNotSureOfAPlaceThatTheMapDoesNotHave) {
  const Builder builder = two_rooms(6.2);
  std::vector<Wall> elsewhere;
  for (int k = 0; k < 9; ++k) {
    const double a = radians(40.0 * k);
    const double b = radians(40.0 * (k + 1));
    elsewhere.push_back({{(k % 3 + 2) * std::cos(a), (k % 3 + 2) * std::sin(a)},
                         {((k + 1) % 3 + 2) * std::cos(b), ((k + 1) % 3 + 2) * std::sin(b)}});
  }
  const Scan scan = synthetic::take_scan(elsewhere, {0, 0, 0}, builder.laser);
  for (const PlaceHypothesis& place : where_am_i(builder.map, rooms_of(8, 4), scan, builder.laser)) {
    EXPECT_LT(place.confidence, 0.5);
  }
  Scan blind;
  blind.ranges.assign(181, 80);
  EXPECT_TRUE(where_am_i(builder.map, rooms_of(8, 4), blind, builder.laser).empty());
}

/// The room's four views, and a patch of a robot that came back to it on another sheet: the plane has that half a metre
/// off.
TEST(FindOnSheet, TellsWhereARobotStandsWhateverThePlaneSays) {
  Builder builder;
  const std::vector<Wall> walls = room(0, 5);
  for (const double yaw : {0.0, 1.57, 3.1, -1.57}) builder.add(walls, {4.2, 3.2, yaw});
  const Pose2 taken{3.4, 3.0, 0.3};
  const PatchId other = builder.add(walls, taken, {3.8, 2.7, 0.36});
  Neighbours neighbours = rooms_of(4, 4);
  neighbours.emplace_back();
  const auto found = find_on_sheet(builder.map, neighbours, PatchId{0}, {other, {}},
                                   synthetic::take_scan(walls, taken, builder.laser), builder.laser);
  ASSERT_TRUE(found.has_value());
  const Pose2 off = found->T_patch_robot.inverse() * builder.map.T_plane_patch(PatchId{0}).inverse() * taken;
  EXPECT_LT(off.distance(), 0.03);
  EXPECT_LT(std::abs(off.yaw), 0.01);
}

TEST(FindOnSheet, SaysNothingWhereTheScanFitsAnywhereAlongTheWalls) {
  Builder builder;
  const std::vector<Wall> walls{{{-60, 0}, {60, 0}}, {{60, 3}, {-60, 3}}};
  builder.add(walls, {0, 1.5, 0});
  const PatchId other = builder.add(walls, {0.5, 1.5, 0}, {0, 1.5, 0});
  EXPECT_FALSE(find_on_sheet(builder.map, Neighbours(2), PatchId{0}, {other, {}},
                             synthetic::take_scan(walls, {0.5, 1.5, 0}, builder.laser), builder.laser));
}

}  // namespace
}  // namespace helicoid
