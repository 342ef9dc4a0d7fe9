#include "helicoid/exploration/meeting_worth.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "helicoid/manifold/map_editor.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

/// Views of two islands that look alike in several ways, none of which agrees with another.
struct LookAlikes {
  synthetic::Builder builder;
  std::vector<Doubt> doubts;
  RendezvousDesk desk;

  explicit LookAlikes(std::size_t count) {
    const auto walls = synthetic::rectangle(0, 0, 8, 6);
    const PatchId a = builder.add(walls, {1.5, 3, 0});
    builder.island = MapEditor(builder.map).add_island();
    for (std::size_t i = 0; i < count; ++i) {
      // Each lays b's island elsewhere.
      const PatchId b = builder.add(walls, {1.5, 3, 0}, {10.0 * static_cast<double>(i), 3, 0});
      doubts.push_back({i, a, b, {{}, Matrix3d::Identity() * 1e-4}, 0});
    }
  }
  [[nodiscard]] double likelihood(const MeetingRecord& record = {}) const {
    return likelihood_of(builder.map, doubts.front(), doubts, desk, record);
  }
};

TEST(MeetingWorth, OfDoubtsThatContradictOneAnotherOneIsTrueAtMost) {
  EXPECT_NEAR(4 * LookAlikes(4).likelihood(), LookAlikes(1).likelihood(), 1e-12);
}

TEST(MeetingWorth, WhereLookAlikesWereDistinctTheNextOneIsBelievedLess) {
  const LookAlikes one(1);
  EXPECT_LT(one.likelihood({0, 3}), one.likelihood());
  EXPECT_GT(one.likelihood({1, 3}), one.likelihood({0, 3}));
}

TEST(MeetingWorth, APlaceThatWasRuledOutMakesItsRivalLikelier) {
  EXPECT_GT(LookAlikes(1).likelihood({0, 1}), LookAlikes(2).likelihood());
}

TEST(MeetingWorth, ARivalPlacementThatFitsAsWellHalvesIt) {
  LookAlikes one(1);
  const double without = one.likelihood();
  one.doubts.front().ambiguity = 1;
  EXPECT_NEAR(one.likelihood(), without / 2, 1e-12);
}

struct AtWork {
  LookAlikes alike{1};
  std::vector<Frontier> frontiers;
  Eigen::MatrixXd way;

  explicit AtWork(double gain_m2) : frontiers(gain_m2 > 0 ? 2 : 0), way(2, std::ssize(frontiers)) {
    way.setConstant(1);
    for (std::size_t i = 0; i < frontiers.size(); ++i) {
      const auto square = static_cast<std::int32_t>(i);
      frontiers[i].island = alike.builder.map.island_of(alike.doubts.front().a);
      frontiers[i].middle = {alike.doubts.front().a, Vector2d::Zero()};
      frontiers[i].gain_m2 = gain_m2;
      frontiers[i].seen = {{square, 0, gain_m2}};
    }
  }
  [[nodiscard]] bool is_worth(double likelihood, double longest) const {
    KnownFloor floor(alike.builder.map);
    return is_worth_meeting(alike.builder.map, alike.doubts.front(), likelihood, {0, 1, longest}, {frontiers, way},
                            floor);
  }
};

TEST(MeetingWorth, WhoHasNothingElseToDoMeets) {
  EXPECT_TRUE(AtWork(0).is_worth(0.01, 500));
}

/// One robot has seen a room, the other what may be the same room and a long hall beyond it.
struct RoomAndHall {
  synthetic::Builder builder;
  Doubt doubt;
  std::vector<Frontier> frontiers{1};
  Eigen::MatrixXd way = Eigen::MatrixXd::Constant(2, 1, std::numeric_limits<double>::infinity());

  /// The first has yet to look at one square metre about this place.
  explicit RoomAndHall(const Vector2d& open_plane) {
    const PatchId a = builder.add(synthetic::rectangle(0, 0, 8, 6), {1.5, 3, 0});
    builder.island = MapEditor(builder.map).add_island();
    const PatchId b = builder.add(synthetic::rectangle(0, 0, 25, 6), {1.5, 3, 0});
    doubt = {0, a, b, {{}, Matrix3d::Identity() * 1e-4}, 0};
    const FloorSquare square = square_at(open_plane);
    frontiers[0].island = builder.map.island_of(a);
    frontiers[0].middle = {a, Vector2d::Zero()};
    frontiers[0].gain_m2 = 1;
    frontiers[0].seen = {{square.row, square.column, 1.0}};
    way(0, 0) = 5;
  }
  [[nodiscard]] bool is_worth(double longest) const {
    KnownFloor floor(builder.map);
    return is_worth_meeting(builder.map, doubt, 1.0, {0, 1, longest}, {frontiers, way}, floor);
  }
};

TEST(MeetingWorth, WhatTheOtherSideKnowsIsAReasonToMeet) {
  EXPECT_TRUE(RoomAndHall({12, 3}).is_worth(10));
}

TEST(MeetingWorth, WhatNeitherSideHasSeenIsNone) {
  EXPECT_FALSE(RoomAndHall({12, 9}).is_worth(10));
}

TEST(MeetingWorth, AWayThatIsLongerThanWhatItSavesIsNotGone) {
  EXPECT_FALSE(RoomAndHall({12, 3}).is_worth(200));
}

TEST(MeetingWorth, ALongWayToTheOnlyFrontierIsNoReason) {
  RoomAndHall far({12, 9});
  far.way(0, 0) = 100;
  EXPECT_FALSE(far.is_worth(10));
}

TEST(MeetingWorth, WhoHasMuchToSeeNearByDoesNotGoFarForAnUnlikelyAnswer) {
  EXPECT_FALSE(AtWork(12).is_worth(0.05, 30));
}

}  // namespace
}  // namespace helicoid
