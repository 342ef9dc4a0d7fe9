#include "helicoid/eval/team_error.hpp"

#include <gtest/gtest.h>

namespace helicoid {
namespace {

/// Two robots on circles, their truth ten times a second.
std::vector<TeamTrack> circles() {
  std::vector<TeamTrack> tracks(2);
  for (std::size_t robot = 0; robot < 2; ++robot) {
    for (int k = 0; k < 300; ++k) {
      const double angle = 0.01 * k + static_cast<double>(robot);
      tracks[robot].true_stamps.push_back(0.1 * k);
      tracks[robot].truth.push_back({3 * std::cos(angle) + 4.0 * static_cast<double>(robot), 3 * std::sin(angle),
                                     wrap_angle(angle + radians(90))});
    }
    tracks[robot].stamps = tracks[robot].true_stamps;
    tracks[robot].poses = tracks[robot].truth;
  }
  return tracks;
}

TEST(TeamError, OneRigidTransformForAllIsNoError) {
  std::vector<TeamTrack> tracks = circles();
  const Pose2 T_plane_world{5, -2, 2};
  for (TeamTrack& track : tracks) {
    for (Pose2& pose : track.poses) pose = T_plane_world * pose;
  }
  const TeamError error = team_error(tracks);
  EXPECT_EQ(error.matched, 600U);
  EXPECT_NEAR(error.rms_m, 0, 1e-12);
  EXPECT_NEAR(error.rms_deg, 0, 1e-9);
  EXPECT_NEAR((error.T_world_plane * T_plane_world).distance(), 0, 1e-12);
}

TEST(TeamError, ATransformForEachRobotWouldHideWhatThisOneShows) {
  std::vector<TeamTrack> tracks = circles();
  for (Pose2& pose : tracks[1].poses) pose.x += 1;
  const TeamError error = team_error(tracks);
  EXPECT_GT(error.rms_m, 0.2);
  EXPECT_GT(error.robots_m[0], 0.2);
  EXPECT_GT(error.robots_m[1], 0.2);
}

TEST(TeamError, TruthIsInterpolatedButNotAcrossGaps) {
  std::vector<TeamTrack> tracks = circles();
  for (double& stamp : tracks[0].stamps) stamp += 0.05;
  // A hole of two seconds in the truth, and the last stamp after its end.
  tracks[0].true_stamps.erase(tracks[0].true_stamps.begin() + 100, tracks[0].true_stamps.begin() + 120);
  tracks[0].truth.erase(tracks[0].truth.begin() + 100, tracks[0].truth.begin() + 120);
  const TeamError error = team_error(tracks);
  EXPECT_EQ(error.matched, 600U - 21 - 1);
  EXPECT_NEAR(error.robots_m[0], 0.015, 0.01);  // half a step of 3 cm, some of it taken by the transform
}

TEST(TeamError, WithoutTruthNothingIsMatched) {
  std::vector<TeamTrack> tracks = circles();
  for (TeamTrack& track : tracks) track.true_stamps.clear(), track.truth.clear();
  EXPECT_EQ(team_error(tracks).matched, 0U);
  EXPECT_EQ(team_error({}).matched, 0U);
}

}  // namespace
}  // namespace helicoid
