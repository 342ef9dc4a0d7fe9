#include "helicoid/mapping/island_overlay.hpp"

#include <gtest/gtest.h>

#include "helicoid/manifold/confidence.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;

/// A room of 8 m by 6 m with a cupboard that stands so far from its left wall.
std::vector<synthetic::Wall> room(double cupboard_at) {
  std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, 8, 6);
  synthetic::append(walls, synthetic::rectangle(cupboard_at, 4.5, cupboard_at + 1, 5.5));
  return walls;
}

/// Two islands on which one room was seen, twice each; and the same joined as they truly lie.
struct TwoVisits {
  Builder apart, joined;
  TwoVisits(double first_cupboard, double second_cupboard) {
    for (Builder* builder : {&apart, &joined}) {
      MapEditor editor(builder->map);
      const IslandId first = builder->island;
      const IslandId second = builder == &apart ? editor.add_island() : first;
      const RobotId robots[] = {builder->robot, editor.add_robot("robot2", {builder->laser})};
      const double cupboards[] = {first_cupboard, second_cupboard};
      for (const std::size_t i : {0U, 1U}) {
        builder->robot = robots[i];
        builder->island = i == 0 ? first : second;
        for (const double x : {2.0, 2.5, 3.0, 3.5}) builder->add(room(cupboards[i]), {x, 2, 0.6});
      }
      for (std::uint32_t k = 1; k < builder->map.patch_count(); ++k) {
        if (k != 4 || builder == &joined) builder->relate(PatchId{k - 1}, PatchId{k});
      }
    }
  }
  [[nodiscard]] IslandOverlay compare() const {
    const std::vector<double> along{0, 0.5, 1, 1.5, 0, 0.5, 1, 1.5};
    MapperOptions options;
    options.reference_position = options.reference_heading = 1;
    return lay_over(joined.map, information_graph(joined.map), apart.map, joined.island, along, options);
  }
};

TEST(IslandOverlay, OfOneRoomSeenTwiceNothingIsGone) {
  const IslandOverlay overlay = TwoVisits(3, 3).compare();
  EXPECT_GT(overlay.between.places, 20U);
  EXPECT_GT(overlay.within.places, 20U);
  EXPECT_EQ(overlay.between.gone, 0U);
  EXPECT_EQ(overlay.within.gone, 0U);
  EXPECT_FALSE(is_contradicted(overlay));
}

TEST(IslandOverlay, WhatStandsElsewhereOnTheOtherIslandIsGoneThere) {
  const IslandOverlay overlay = TwoVisits(3, 6).compare();
  EXPECT_GT(overlay.between.gone, 2U);
  EXPECT_EQ(overlay.within.gone, 0U);
  EXPECT_TRUE(is_contradicted(overlay));
}

TEST(IslandOverlay, IslandsMayContradictEachOtherAsOftenAsThemselves) {
  EXPECT_FALSE(is_contradicted({{0, 0}, {0, 0}}));
  EXPECT_FALSE(is_contradicted({{1000, 0}, {1000, 0}}));
  for (const std::size_t gone : {1U, 10U, 100U}) EXPECT_FALSE(is_contradicted({{1000, gone}, {1000, gone}}));
  EXPECT_TRUE(is_contradicted({{1000, 0}, {1000, 10}}));
  EXPECT_TRUE(is_contradicted({{1000, 10}, {1000, 40}}));
}

TEST(IslandOverlay, TheMoreGroundIsSharedTheSurerAContradictionIs) {
  EXPECT_FALSE(is_contradicted({{1000, 10}, {100, 3}}));
  EXPECT_TRUE(is_contradicted({{10000, 100}, {1000, 30}}));
}

}  // namespace
}  // namespace helicoid
