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

}  // namespace
}  // namespace helicoid
