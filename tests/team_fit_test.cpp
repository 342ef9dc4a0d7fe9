// A simulated team without lasers: its estimate against the truth.
#include <gmock/gmock.h>

#include "helicoid/eval/team_error.hpp"
#include "helicoid/mapping/fit_team.hpp"
#include "helicoid/simulation/mark_simulator.hpp"

namespace helicoid {
namespace {

TeamError error_of(const SimulatedTeam& team, const TeamFit& fit) {
  std::vector<TeamTrack> tracks;
  for (std::size_t i = 0; i < team.log.robots.size(); ++i) {
    TeamTrack track{{}, {}, team.stamps, team.truth[i]};
    for (const StampedEstimate& e : poses_at(team.log, fit, i, steady_stamps(fit, i, 0.1))) {
      track.stamps.push_back(e.stamp);
      track.poses.push_back(e.pose);
    }
    tracks.push_back(std::move(track));
  }
  return team_error(tracks);
}

MarkSimulation short_drive(std::uint64_t seed) {
  MarkSimulation options;
  options.seed = seed;
  options.robots = 3;
  options.landmarks = 8;
  options.seconds = 150;
  return options;
}

TEST(TeamFit, FindsEveryRobotsWayFromUnknownStarts) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed) {
    const SimulatedTeam team = simulate_marks(short_drive(seed));
    const TeamFit fit = fit_team(team.log);
    EXPECT_TRUE(fit.is_still);
    EXPECT_EQ(fit.result.status, FitStatus::converged);
    const TeamError error = error_of(team, fit);
    EXPECT_GT(error.matched, 3U * 1400);
    EXPECT_LT(error.rms_m, 0.06) << "seed " << seed;
  }
}

TEST(TeamFit, WrongBarcodesAreLetGo) {
  MarkSimulation options = short_drive(4);
  options.wrong = 0.1;
  const SimulatedTeam team = simulate_marks(options);
  ASSERT_GT(team.wrong, 50U);
  const TeamFit fit = fit_team(team.log);
  // Some wrong ones stand where the right one would.
  EXPECT_NEAR(static_cast<double>(fit.wrong), static_cast<double>(team.wrong), 0.05 * static_cast<double>(team.wrong));
  EXPECT_LT(error_of(team, fit).rms_m, 0.06);
}

TEST(TeamFit, LearnsHowRobotsDriveAndSee) {
  MarkSimulation options;
  options.seed = 5;
  options.seconds = 300;
  const SimulatedTeam team = simulate_marks(options);
  const TeamFit fit = fit_team(team.log);
  for (std::size_t i = 0; i < team.log.robots.size(); ++i) {
    EXPECT_NEAR(fit.model.odometry[i].forward_gain, options.forward_gain, 0.05 * options.forward_gain);
    EXPECT_NEAR(fit.model.odometry[i].turning_gain, options.turning_gain, 0.07 * options.turning_gain);
    EXPECT_NEAR(fit.model.odometry[i].delay, options.delay, 0.11);
    EXPECT_NEAR(fit.model.detection[i].range_share, options.range_share, 0.3 * options.range_share);
    EXPECT_NEAR(fit.model.detection[i].bearing_sigma, options.bearing_sigma, 0.5 * options.bearing_sigma);
  }
}

TEST(TeamFit, RobotsThatSeeOnlyOneAnotherAreTheLandmarks) {
  MarkSimulation options;
  options.seed = 2;
  options.seconds = 150;
  const SimulatedTeam team = simulate_marks(options);
  TeamFitOptions fit_options;
  fit_options.landmarks = false;
  const TeamFit fit = fit_team(team.log, fit_options);
  EXPECT_EQ(fit.nodes.count(), fit.nodes.first_landmark());
  EXPECT_LT(error_of(team, fit).rms_m, 0.3);
}

TEST(TeamFit, RobotsThatShareNothingStayOnIslandsOfTheirOwn) {
  SimulatedTeam team = simulate_marks(short_drive(6));
  TeamRobot& hermit = team.log.robots[2];
  hermit.detections.clear();
  for (std::size_t i = 0; i < 2; ++i)
    std::erase_if(team.log.robots[i].detections, [](const Detection& d) { return d.subject == 2; });
  const TeamFit fit = fit_team(team.log);
  const auto island_of = [&](std::size_t robot) { return fit.island_of[fit.nodes.first_of(robot)]; };
  EXPECT_EQ(island_of(0), island_of(1));
  EXPECT_NE(island_of(0), island_of(2));
}

TEST(TeamFit, TheSameLogGivesTheSamePosesToTheBit) {
  const SimulatedTeam team = simulate_marks(short_drive(7));
  EXPECT_EQ(fit_team(team.log).result.poses, fit_team(team.log).result.poses);
}

TEST(TeamFit, EmptyLogsAreNoTeam) {
  EXPECT_EQ(fit_team({}).result.status, FitStatus::nothing_to_fit);
  TeamLog idle;
  idle.robots = {{"robot1", {}, {}}, {"robot2", {{10, 0.1, 0}, {11, 0.1, 0}}, {}}};
  const TeamFit fit = fit_team(idle);
  EXPECT_EQ(fit.detections, 0U);
  EXPECT_TRUE(poses_at(idle, fit, 0, std::vector<double>{10}).empty());
  EXPECT_EQ(poses_at(idle, fit, 1, std::vector<double>{9, 10, 10.5, 11, 12}).size(), 3U);
}

TEST(SimulatedTeam, TheSameSeedGivesTheSameDetections) {
  const SimulatedTeam once = simulate_marks(short_drive(8));
  const SimulatedTeam again = simulate_marks(short_drive(8));
  ASSERT_EQ(once.log.robots[1].detections.size(), again.log.robots[1].detections.size());
  EXPECT_EQ(once.log.robots[1].detections.back().range, again.log.robots[1].detections.back().range);
  EXPECT_EQ(once.truth, again.truth);
}

}  // namespace
}  // namespace helicoid
