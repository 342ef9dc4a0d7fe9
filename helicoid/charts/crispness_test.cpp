#include "helicoid/charts/crispness.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

Crispness measure(const synthetic::Builder& builder) {
  const auto patches = builder.patches();
  return measure_crispness(builder.map, patches,
                           draw_occupancy(builder.map, patches, frame_around(builder.map, patches)));
}

TEST(Crispness, OfARoomDrawnOnceIsPerfect) {
  const Crispness crispness = measure(synthetic::pillar_map());
  EXPECT_GT(crispness.occupied, 400U);
  EXPECT_EQ(crispness.twins, 0U);
}

TEST(Crispness, FindsAWallDrawnTwice) {
  for (const double shift : {0.15, 0.25, 0.4, 0.55}) {
    synthetic::Builder builder;
    const std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, 6, 4);
    builder.add(walls, {2, 2, 0});
    builder.add(walls, {2.5, 2, 0}, {2.5 + shift, 2, 0});
    builder.add(walls, {2, 2.2, 0.1});
    builder.add(walls, {2.5, 1.8, 0.1}, {2.5 + shift, 1.8, 0.1});
    // The wall at x = 6 and its copy are 160 of some 500 cells.
    EXPECT_GT(measure(builder).share, 0.15) << shift;
  }
}

TEST(Crispness, DoesNotCountAThinWallSeenFromBothSides) {
  for (const double thickness : {0.1, 0.15, 0.2, 0.4}) {
    synthetic::Builder builder;
    const auto walls_left = synthetic::rectangle(0, 0, 4, 4);
    const auto walls_right = synthetic::rectangle(4 + thickness, 0, 8 + thickness, 4);
    for (const double y : {1.0, 2.0, 3.0}) {
      builder.add(walls_left, {2, y, 0});
      builder.add(walls_right, {6, y, radians(180)});
    }
    EXPECT_EQ(measure(builder).twins, 0U) << thickness;
  }
}

TEST(Crispness, DoesNotCountACupboardAgainstTheWall) {
  synthetic::Builder builder;
  auto walls = synthetic::rectangle(0, 0, 6, 4);
  synthetic::append(walls, synthetic::rectangle(5.6, 1, 6, 2.2));
  for (const double y : {1.0, 2.0, 3.0}) builder.add(walls, {2, y, 0});
  builder.add(walls, {4, 2, 0.4});
  EXPECT_EQ(measure(builder).twins, 0U);
}

TEST(Crispness, CountsApartWhatASingleScanShowsAtOnce) {
  synthetic::Builder builder;
  // A rail of short bars before a wall: every scan sees both.
  std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, 6, 4);
  for (double y = 0.8; y < 3.2; y += 0.16) walls.push_back({{5.7, y}, {5.7, y + 0.08}});
  for (double y = 0.5; y < 3.6; y += 0.1) builder.add(walls, {4.6, y, 0});
  const Crispness crispness = measure(builder);
  EXPECT_GT(crispness.seen_at_once, 20U);
  EXPECT_EQ(crispness.twins, 0U);
}

TEST(Crispness, OfNothingIsZero) {
  const synthetic::Builder builder;
  EXPECT_EQ(measure(builder).share, 0);
}

}  // namespace
}  // namespace helicoid
