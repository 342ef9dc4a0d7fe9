#include "helicoid/exploration/known_floor.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

TEST(KnownFloor, IsWhatSomePatchOfTheIslandHasSeenFree) {
  synthetic::Builder builder;
  const auto walls = synthetic::rectangle(0, 0, 20, 6);
  builder.add(walls, {5, 3, 0});
  builder.add(walls, {6, 3, 3.14159});
  KnownFloor floor(builder.map);
  const KnownSquares& known = floor.of(builder.map.island_of(PatchId{0}));
  for (const double x : {1.0, 5.0, 10.0, 19.0}) EXPECT_TRUE(known.has(square_at({x, 3.0}))) << x;
  EXPECT_FALSE(known.has(square_at({-1.0, 3.0})));
  EXPECT_FALSE(known.has(square_at({10.0, 7.0})));
  EXPECT_NEAR(kSeenSquare * kSeenSquare * static_cast<double>(known.squares().size()), 120, 12);
}

TEST(KnownFloor, EverySquareHoldsItsMiddle) {
  for (const FloorSquare square : {FloorSquare{0, 0}, FloorSquare{-1, 3}, FloorSquare{7, -9}}) {
    EXPECT_EQ(square_at(middle_of(square)), square);
  }
}

TEST(KnownFloor, OfAnIslandWithoutPatchesNothingIsKnown) {
  const Map map;
  EXPECT_TRUE(KnownSquares(map, IslandId{0}).squares().empty());
  EXPECT_FALSE(KnownSquares(map, IslandId{0}).has({0, 0}));
}

}  // namespace
}  // namespace helicoid
