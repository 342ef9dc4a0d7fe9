#include "helicoid/mapping/local_map.hpp"

#include <gtest/gtest.h>

#include "helicoid/manifold/confidence.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

const Vector3d kWellKnown(1e8, 1e8, 1e8);

/// Many laps up and down a hall of 12 m, a patch every metre, all well known.
struct ManyLaps {
  static constexpr std::uint32_t kOfLap = 10;
  static constexpr std::uint32_t kLaps = 20;
  synthetic::Builder builder;

  ManyLaps() {
    const std::vector<synthetic::Wall> walls = synthetic::rectangle(0, 0, 12, 4);
    for (std::uint32_t i = 0; i < kOfLap * kLaps; ++i) {
      const Pose2 T{1.0 + i % kOfLap, 2, 0};
      builder.add(walls, T, T);
      if (i % kOfLap > 0) builder.relate(PatchId{i - 1}, PatchId{i}, RelationKind::chain, kWellKnown);
      if (i >= kOfLap) builder.relate(PatchId{i - kOfLap}, PatchId{i}, RelationKind::overlap, kWellKnown);
    }
  }
};

TEST(LocalMap, HoldsAllKnownPatchesAboutTheAnchorHoweverManyLapsLeftThere) {
  const ManyLaps laps;
  const Map& map = laps.builder.map;
  const MapperOptions options;
  const LocalMap local = find_local_map(map, information_graph(map), PatchId{0}, options);
  std::size_t near = 0;
  for (const Pose2& T : map.poses()) {
    near += (T.translation() - map.T_plane_patch(PatchId{0}).translation()).norm() <= options.local_radius ? 1 : 0;
  }
  EXPECT_GT(near, 100U);
  EXPECT_EQ(local.size(), near);
}

TEST(LocalMap, HasOnePatchAPlaceTheOldestHoweverManyLapsLeftThere) {
  const ManyLaps laps;
  const Map& map = laps.builder.map;
  const PatchId anchor{ManyLaps::kOfLap * 3};
  const PatchId last_kept{ManyLaps::kOfLap * 5 + 1};
  const LocalMap local = find_local_map(map, information_graph(map), anchor, MapperOptions{});
  const LocalMap places = distinct_places(local, last_kept);
  ASSERT_FALSE(places.empty());
  EXPECT_EQ(places[0].patch, anchor);
  std::size_t of_first_lap = 0;
  for (const LocalPatch& p : places) {
    const bool is_oldest = p.patch.value < ManyLaps::kOfLap;
    of_first_lap += is_oldest ? 1 : 0;
    EXPECT_TRUE(is_oldest || p.patch == anchor || p.patch == last_kept);
  }
  // Of each place within the local map's reach.
  EXPECT_EQ(of_first_lap, local.size() / ManyLaps::kLaps);
}

/// A robot that looks the way its patches do, between two of them one metre apart.
std::size_t stands_on(double metres_beyond_the_first) {
  const ManyLaps laps;
  const LocalMap local{{PatchId{0}, {}}, {PatchId{1}, {1, 0, 0}}};
  const std::optional<std::size_t> place = choose_anchor(laps.builder.map, local, {metres_beyond_the_first, 0, 0});
  EXPECT_TRUE(place.has_value());
  return place.value_or(2);
}

TEST(Anchor, ChangesWhenAnotherPatchIsClearlyNearer) {
  EXPECT_EQ(stands_on(0.1), 0U);
  EXPECT_EQ(stands_on(0.45), 0U);
  EXPECT_EQ(stands_on(0.9), 1U);
}

TEST(Anchor, StaysWhileItIsNearHoweverNearAnotherOneIs) {
  const ManyLaps laps;
  const LocalMap local{{PatchId{0}, {}}, {PatchId{ManyLaps::kOfLap}, {0.3, 0, 0}}};
  EXPECT_EQ(choose_anchor(laps.builder.map, local, {0.3, 0, 0}), 0U);
  EXPECT_EQ(choose_anchor(laps.builder.map, local, {0.8, 0, 0}), 1U);
}

}  // namespace
}  // namespace helicoid
