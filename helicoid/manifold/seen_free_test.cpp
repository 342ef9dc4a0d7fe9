#include "helicoid/manifold/seen_free.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

TEST(SeenFree, IsDeepWhereThePolygonReachesFartherToAllSides) {
  const synthetic::Builder builder = synthetic::pillar_map();
  Random random(1);
  int deep = 0;
  for (const PatchId id : builder.patches()) {
    const Patch& patch = builder.map.patch(id);
    const SeenFree free(patch);
    for (int i = 0; i < 200; ++i) {
      const Vector2d p(random.uniform(-8, 8), random.uniform(-8, 8));
      if (!free.is_deep(p.cast<float>(), 0.2F)) continue;
      ++deep;
      EXPECT_TRUE(contains(patch, p));
      EXPECT_TRUE(contains(patch, (1 + 0.19 / p.norm()) * p));
    }
  }
  EXPECT_GT(deep, 200);
}

TEST(SeenFree, NothingIsContradictedByASecondLookAtTheSameWalls) {
  const synthetic::Builder builder = synthetic::pillar_map();
  const Map& map = builder.map;
  for (const PatchId a : builder.patches()) {
    for (const PatchId b : builder.patches()) {
      const Pose2 T_a_b = map.T_plane_patch(a).inverse() * map.T_plane_patch(b);
      EXPECT_EQ(count_contradictions(map.patch(a), map.patch(b).points, T_a_b, 0.15), 0);
    }
  }
}

TEST(SeenFree, AWallInFrontOfThatWhichWasSeenIsContradicted) {
  synthetic::Builder builder;
  const PatchId before = builder.add(synthetic::rectangle(0, 0, 6, 4), {1, 2, 0});
  const PatchId after = builder.add(synthetic::rectangle(0, 0, 5, 4), {1, 2, 0});
  const Map& map = builder.map;
  // The wall at x = 5 is seen by some 50 beams; what lies behind it contradicts nothing.
  EXPECT_GT(count_contradictions(map.patch(before), map.patch(after).points, {}, 0.15), 30);
  EXPECT_EQ(count_contradictions(map.patch(after), map.patch(before).points, {}, 0.15), 0);
}

TEST(SeenFree, AWallSeenAlongIsAcrossItNoDeeperThanItIsOff) {
  synthetic::Builder builder("robot1", 721);
  const auto corridor = synthetic::rectangle(0, 0, 20, 2);
  const PatchId there = builder.add(corridor, {3, 1, 0});
  const PatchId back = builder.add(corridor, {15, 1, std::numbers::pi});
  const Patch& a = builder.map.patch(there);
  const Patch& b = builder.map.patch(back);
  const auto aside = [](double off) { return Pose2{12, off, std::numbers::pi}; };
  EXPECT_EQ(count_contradictions_across(a, b, aside(0), 0.35), 0);
  EXPECT_GT(count_contradictions(a, b, aside(0.25), 0.35), 30) << "along the beams it is deep";
  EXPECT_EQ(count_contradictions_across(a, b, aside(0.25), 0.35), 0);
  EXPECT_GT(count_contradictions_across(a, b, aside(0.6), 0.35), 30) << "another corridor's wall";
}

TEST(SeenFree, ABeamEndsAtWhatItSawAndNotBeforeOrBehindIt) {
  synthetic::Builder builder;
  const PatchId id = builder.add(synthetic::rectangle(0, 0, 6, 4), {1, 2, 0});
  const SeenFree seen(builder.map.patch(id));
  // Straight ahead stands the wall at x = 6.
  EXPECT_TRUE(seen.ends_at({5, 0}, 0.05F));
  EXPECT_TRUE(seen.ends_at({4.9F, 0}, 0.15F));
  EXPECT_FALSE(seen.ends_at({4.5F, 0}, 0.15F));
  EXPECT_FALSE(seen.ends_at({5.5F, 0}, 0.15F));
  // No beam looks behind.
  EXPECT_FALSE(seen.ends_at({-1, 0}, 10));
}

}  // namespace
}  // namespace helicoid
