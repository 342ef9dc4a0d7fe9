#include "helicoid/mapping/join_islands.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "helicoid/mapping/mapper.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

std::vector<Vector2d> the_other_way() {
  std::vector<Vector2d> stops = synthetic::through_all_rooms();
  std::reverse(stops.begin(), stops.end());
  return stops;
}

/// Two robots drive through one building at the same time, each with an odometry of its own; at the end the first sees
/// the second.
struct TwoDrives {
  synthetic::Drive first = synthetic::drive(1, 5);
  synthetic::Drive second = synthetic::drive(1, 6, the_other_way());

  [[nodiscard]] Mapper map(bool sighting, bool on_evidence = false) const {
    MapperOptions options;
    options.join_on_evidence = on_evidence;
    return map(sighting, options);
  }
  [[nodiscard]] Mapper map(bool sighting, const MapperOptions& options) const {
    Mapper mapper(options);
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

TEST(Islands, StayApartWithoutASightingAndLookAlikesAreProposals) {
  const Mapper mapper = TwoDrives().map(false);
  EXPECT_EQ(mapper.map().islands().size(), 2U);
  std::size_t proposals = 0;
  for (const Hypothesis& h : mapper.ledger()) {
    if (mapper.map().island_of(h.a) == mapper.map().island_of(h.b)) continue;
    EXPECT_EQ(h.state, HypothesisState::open);
    ++proposals;
  }
  EXPECT_GT(proposals, 0U);
}

TEST(Islands, OneSightingMakesOneOfTwoAndTheirWallsMeet) {
  const TwoDrives drives;
  const Mapper mapper = drives.map(true);
  const Map& map = mapper.map();
  ASSERT_EQ(map.islands().size(), 1U);
  EXPECT_EQ(mapper.counts().sightings, 1U);
  EXPECT_EQ(mapper.counts().sightings_without_place, 0U);
  EXPECT_TRUE(mapper.regrets().empty());
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

TEST(Islands, WhenTheyAreJoinedNoProposalStaysOpenThatTheMapContradicts) {
  const TwoDrives drives;
  Mapper mapper;
  mapper.add_robot("first", {synthetic::lms200()});
  mapper.add_robot("second", {synthetic::lms200()});
  const std::size_t count = std::min(drives.first.events.size(), drives.second.events.size());
  std::size_t proposals = 0;
  for (std::size_t i = 0; i <= count / 2 + 1; ++i) {
    if (i == count / 2) {
      mapper.propose();
      proposals = mapper.ledger().size();
      mapper.process(drives.sight(i));
    }
    mapper.process(drives.first.events[i]);
    Event event = drives.second.events[i];
    event.robot = make_id<RobotId>(1);
    mapper.process(event);
  }
  const Map& map = mapper.map();
  ASSERT_EQ(map.islands().size(), 1U);
  EXPECT_GT(proposals, 0U);
  for (const Hypothesis& h : mapper.ledger()) {
    if (!h.is_undecided()) continue;
    const Pose2 T_a_b = map.T_plane_patch(h.a).inverse() * map.T_plane_patch(h.b);
    EXPECT_LT((T_a_b.translation() - h.T_a_b.T_a_b.translation()).norm(), 1.0);
  }
}

/// Entries of the ledger that compare two places of one robot.
std::size_t comparisons_within_robots(const Mapper& mapper) {
  const auto& ledger = mapper.ledger();
  return static_cast<std::size_t>(std::count_if(ledger.begin(), ledger.end(), [&](const Hypothesis& h) {
    return h.source == HypothesisSource::lookalike && mapper.map().patch(h.a).robot == mapper.map().patch(h.b).robot;
  }));
}

TEST(Islands, WithoutLookAlikesNothingIsComparedUntilASightingSetsItOff) {
  MapperOptions lazy;
  lazy.look_alikes = false;
  TwoDrives drives;
  drives.first = synthetic::drive(3, 2, synthetic::round_the_ring(), synthetic::ring());
  drives.second = synthetic::drive(3, 3, synthetic::round_the_ring(), synthetic::ring());
  EXPECT_TRUE(drives.map(false, lazy).ledger().empty());
  EXPECT_GT(comparisons_within_robots(drives.map(true, lazy)), 0U);
}

TEST(Islands, WhatTheyHaveInCommonJoinsThemIfItMay) {
  const TwoDrives drives;
  const Mapper mapper = drives.map(false, true);
  const Map& map = mapper.map();
  ASSERT_EQ(map.islands().size(), 1U);
  const Pose2 T =
      map.project(map.robots()[0].trajectory[0].pose).inverse() * map.project(map.robots()[1].trajectory[0].pose);
  const Pose2 truth = drives.first.truth[0].inverse() * drives.second.truth[0];
  EXPECT_LT((truth.inverse() * T).distance(), 0.15);
}

TEST(Islands, FloorsOfOnePlanOnWhichThingsStandElsewhereStayApart) {
  std::vector<Segment> upstairs = synthetic::building();
  // The last are furniture.
  for (std::size_t i = upstairs.size() - 3; i < upstairs.size(); ++i) {
    upstairs[i].from += Vector2d(1.2, 1.3);
    upstairs[i].to += Vector2d(1.2, 1.3);
  }
  TwoDrives drives;
  drives.second = synthetic::drive(1, 6, the_other_way(), upstairs);
  const Mapper mapper = drives.map(false, true);
  EXPECT_EQ(mapper.map().islands().size(), 2U);
}

TEST(Islands, AMergeMovesTheIslandWithFewerPatches) {
  const TwoDrives drives;
  Map map = drives.map(false).map();
  const std::vector<Island> islands = map.islands();
  const bool first_is_larger = islands[0].patches.size() >= islands[1].patches.size();
  const Island& larger = islands[first_is_larger ? 0 : 1];
  const Island& smaller = islands[first_is_larger ? 1 : 0];
  const std::vector<Pose2> before(map.poses().begin(), map.poses().end());
  MapEditor editor(map);
  InformationGraph graph;
  MapInProgress progress{map, editor, graph};
  IslandJoin join;
  join.a = std::min(islands[0].patches.front(), islands[1].patches.front());
  join.b = std::max(islands[0].patches.front(), islands[1].patches.front());
  join.T_a_b = {3, 1, 0.7};
  move_rigidly(progress, join);
  EXPECT_EQ(map.islands().size(), 1U);
  for (const PatchId id : larger.patches) EXPECT_EQ(map.T_plane_patch(id), before[id.index()]);
  const auto distance = [](const Pose2& a, const Pose2& b) { return (a.inverse() * b).distance(); };
  EXPECT_LT(distance(map.T_plane_patch(join.a).inverse() * map.T_plane_patch(join.b), join.T_a_b), 1e-9);
  const PatchId s0 = smaller.patches.front();
  for (const PatchId id : smaller.patches) {
    EXPECT_LT(distance(map.T_plane_patch(s0).inverse() * map.T_plane_patch(id),
                       before[s0.index()].inverse() * before[id.index()]),
              1e-9);
  }
}

}  // namespace
}  // namespace helicoid
