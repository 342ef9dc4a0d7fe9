#include "helicoid/mapping/join_islands.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "helicoid/mapping/mapper.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

/// Two robots drive through one building at the same time, each with an odometry of its own; at the end the first sees
/// the second.
struct TwoDrives {
  synthetic::Drive first = synthetic::drive(1, 5, {{1.2, 5.5}, {3.6, 5.5}, {3.6, 2}, {3.6, 5.5}, {7, 6.4}});
  synthetic::Drive second = synthetic::drive(1, 6, {{12.8, 7.6}, {10.6, 5.5}, {10.6, 2}, {10.6, 5.5}, {7, 6.4}});

  [[nodiscard]] Mapper map(bool sighting) const {
    Mapper mapper;
    mapper.add_robot("first", {synthetic::lms200()});
    mapper.add_robot("second", {synthetic::lms200()});
    const std::size_t count = std::min(first.events.size(), second.events.size());
    for (std::size_t i = 0; i < count; ++i) {
      mapper.process(first.events[i]);
      if (sighting && i == count / 2) mapper.process(sight(i));
      Event event = second.events[i];
      event.robot = make_id<RobotId>(1);
      mapper.process(event);
    }
    mapper.finish();
    return mapper;
  }

  [[nodiscard]] Event sight(std::size_t i) const {
    const Pose2 T = first.truth[i].inverse() * second.truth[i];
    return {make_id<RobotId>(0), first.events[i].stamp,
            Sighting{"second", T.distance() + 0.02, std::atan2(T.y, T.x) + 0.01, T.yaw - 0.02, 0.03, 0.01, 0.03}};
  }
};

TEST(Islands, StayApartWithoutASighting) {
  const Mapper mapper = TwoDrives().map(false);
  EXPECT_EQ(mapper.map().islands().size(), 2U);
  for (const Hypothesis& h : mapper.ledger()) {
    EXPECT_EQ(mapper.map().island_of(h.a), mapper.map().island_of(h.b));
  }
}

TEST(Islands, OneSightingMakesOneOfTwoAndTheirWallsMeet) {
  const TwoDrives drives;
  const Mapper mapper = drives.map(true);
  const Map& map = mapper.map();
  ASSERT_EQ(map.islands().size(), 1U);
  EXPECT_EQ(mapper.counts().sightings, 1U);
  EXPECT_EQ(mapper.counts().sightings_left, 0U);
  // Between the robots the map is better than the sighting was: the scans have tied it.
  const auto& a = map.robots()[0].trajectory;
  const auto& b = map.robots()[1].trajectory;
  double worst = 0;
  for (std::size_t i = 0; i < std::min(a.size(), b.size()); i += 10) {
    const Pose2 T = map.project(a[i].pose).inverse() * map.project(b[i].pose);
    const Pose2 truth = drives.first.truth[i].inverse() * drives.second.truth[i];
    worst = std::max(worst, (truth.inverse() * T).distance());
  }
  EXPECT_LT(worst, 0.10);
}

TEST(Islands, AMergeMovesTheIslandWithFewerPatches) {
  const TwoDrives drives;
  const Map before = drives.map(false).map();
  const Map after = drives.map(true).map();
  const auto islands = before.islands();
  const IslandId larger = islands[0].patches.size() >= islands[1].patches.size() ? islands[0].id : islands[1].id;
  EXPECT_EQ(after.islands().front().id, larger);
}

}  // namespace
}  // namespace helicoid
