#include "helicoid/simulation/true_relations.hpp"

#include <gtest/gtest.h>

namespace helicoid {
namespace {

/// Round a circle of 10 m, 60 s a lap, five scans a second.
TrueTrack circle(const std::string& robot, int laps) {
  TrueTrack track{robot, {}, {}};
  for (int i = 0; i < 300 * laps; ++i) {
    const double angle = 2 * std::numbers::pi * i / 300;
    track.stamps.push_back(0.2 * i);
    track.T_world_robot.push_back({10 * std::cos(angle), 10 * std::sin(angle), wrap_angle(angle)});
  }
  return track;
}

TEST(TrueRelations, AreAMomentApartOrRevisits) {
  const std::vector<TrueTrack> tracks{circle("robot1", 3)};
  const TrueRelationsOptions options;
  std::size_t local = 0;
  std::size_t revisits = 0;
  for (const ScanPair& p : choose_true_relations(tracks, 1)) {
    const double gap = tracks[0].stamps[p.scan_b] - tracks[0].stamps[p.scan_a];
    const double near = (tracks[0].T_world_robot[p.scan_a].inverse() * tracks[0].T_world_robot[p.scan_b]).distance();
    ASSERT_GT(gap, 0);
    if (gap <= options.longest_gap) {
      ++local;
    } else {
      ++revisits;
      ASSERT_LE(near, options.revisit_near);
    }
  }
  EXPECT_GE(local, 150U);
  EXPECT_GE(revisits, 100U);
}

TEST(TrueRelations, OfTwoRobotsJoinThem) {
  const std::vector<TrueTrack> tracks{circle("robot1", 1), circle("robot2", 1)};
  std::size_t between = 0;
  for (const ScanPair& p : choose_true_relations(tracks, 1)) between += p.robot_a != p.robot_b ? 1 : 0;
  EXPECT_GT(between, 100U);
}

TEST(TrueRelations, AreAscendingUniqueAndSeeded) {
  const std::vector<TrueTrack> tracks{circle("robot1", 2), circle("robot2", 2)};
  const auto pairs = choose_true_relations(tracks, 3);
  EXPECT_TRUE(std::is_sorted(pairs.begin(), pairs.end()));
  EXPECT_EQ(std::adjacent_find(pairs.begin(), pairs.end()), pairs.end());
  EXPECT_EQ(pairs, choose_true_relations(tracks, 3));
  EXPECT_NE(pairs, choose_true_relations(tracks, 4));
}

TEST(TrueRelations, OfNothingAreNone) {
  EXPECT_TRUE(choose_true_relations({}, 1).empty());
  const std::vector<TrueTrack> idle{{"robot1", {}, {}}, {"robot2", {0}, {{}}}};
  EXPECT_TRUE(choose_true_relations(idle, 1).empty());
}

}  // namespace
}  // namespace helicoid
