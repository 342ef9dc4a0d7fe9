// A building that changes from one day to the next, as one log.
#include <gtest/gtest.h>

#include "apps/simulated_run.hpp"

namespace helicoid {
namespace {

TEST(Days, StampsOdometryAndTruthGoOnOverNight) {
  const World world = load_world("room").value();
  const std::vector<World> days{world, world, world};
  SimulationOptions options;
  options.odometry_noise = OdometryNoise::none();
  double last_stamp = 0;
  int last_lap = 0;
  std::optional<Pose2> T_world_odom;
  const auto observe = [&](const SimulatedEvent& simulated, const Step&, const Mapper&) {
    EXPECT_GT(simulated.event.stamp, last_stamp);
    EXPECT_GE(simulated.lap, last_lap);
    last_stamp = simulated.event.stamp;
    last_lap = simulated.lap;
    const auto* scan = std::get_if<Scan>(&simulated.event.body);
    if (scan == nullptr) return;
    const Pose2 here = simulated.T_world_robot * scan->T_odom_robot.inverse();
    if (!T_world_odom) T_world_odom = here;
    // Odometry is exact but for the moment at which it is read.
    EXPECT_LT((T_world_odom->inverse() * here).distance(), 0.02);
  };
  const Result<SimulatedRun> run = map_days(days, options, {}, observe);
  ASSERT_TRUE(run.has_value());
  EXPECT_GE(last_lap, 2);
  EXPECT_EQ(run->map().robots()[0].trajectory.size(), run->tracks[0].stamps.size());
}

}  // namespace
}  // namespace helicoid
