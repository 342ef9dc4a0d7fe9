#include "helicoid/simulation/radio.hpp"

#include <gmock/gmock.h>

#include <map>

#include "tests/live_box.hpp"

namespace helicoid {
namespace {

/// The radio's events of so many seconds.
std::vector<LiveEvent> listen(LiveSimulation& simulation, Radio& radio, double seconds) {
  std::vector<LiveEvent> arrived;
  for (const double end = simulation.now() + seconds - 1e-6; simulation.now() < end;) {
    for (LiveEvent& event : radio.pass(simulation.tick(), simulation)) arrived.push_back(std::move(event));
  }
  return arrived;
}

std::map<std::uint32_t, std::vector<double>> stamps_by_robot(const std::vector<LiveEvent>& events) {
  std::map<std::uint32_t, std::vector<double>> stamps;
  for (const LiveEvent& e : events) stamps[e.event.robot.value].push_back(e.event.stamp);
  return stamps;
}

RadioOptions from_the_middle(double range, double wall_loss = 0) {
  RadioOptions options;
  options.range = range;
  options.wall_loss = wall_loss;
  return options;
}

const std::vector<LiveRobot> kThree{{{-3, 0, 0}}, {{0, 1, 0}}, {{3, 0, 0}}};

TEST(Radio, WithoutLimitsPassesEverythingAtOnce) {
  LiveSimulation plain = simulate(box(), kThree);
  LiveSimulation heard = simulate(box(), kThree);
  Radio radio(box(), 3, {});
  for (int k = 0; k < 20; ++k) {
    const auto sent = plain.tick();
    const auto arrived = radio.pass(heard.tick(), heard);
    EXPECT_EQ(stamps_by_robot(sent), stamps_by_robot(arrived));
  }
}

TEST(Radio, LosesNothingAndKeepsEachRobotsOrder) {
  LiveSimulation plain = simulate(box(), kThree);
  LiveSimulation heard = simulate(box(), kThree);
  RadioOptions options;
  options.cuts = {{1, 3, {0}}, {2, 4, {}}, {4.5, 6, {1, 2}}};
  Radio radio(box(), 3, options);
  std::vector<LiveEvent> arrived = listen(heard, radio, 5);
  EXPECT_GT(radio.waiting(1), 0U);
  EXPECT_EQ(radio.waiting(0), 0U);
  for (LiveEvent& event : radio.hand_over()) arrived.push_back(std::move(event));
  EXPECT_EQ(stamps_by_robot(arrived), stamps_by_robot(run(plain, 5)));
  EXPECT_TRUE(radio.hand_over().empty());
}

TEST(Radio, WhatWasCutComesInBulkWithTheContact) {
  LiveSimulation simulation = simulate(box(), {{{0, 0, 0}}});
  RadioOptions options;
  options.cuts = {{1, 3, {}}};
  Radio radio(box(), 1, options);
  EXPECT_EQ(listen(simulation, radio, 0.9).size(), 18U);  // an odometry and a scan ten times a second
  EXPECT_TRUE(listen(simulation, radio, 2).empty());
  EXPECT_FALSE(radio.in_contact(0));
  EXPECT_EQ(listen(simulation, radio, 0.1).size(), 42U);
  EXPECT_NEAR(radio.cut_seconds(0), 2, 0.11);
}

TEST(Radio, ReachesAsFarAsItsRangeAndFromRobotToRobot) {
  LiveSimulation simulation = simulate(box(), {{{-4, 0, 0}}, {{-1.5, 0, 0}}, {{4, 0, 0}}});
  Radio radio(box(), 3, from_the_middle(3));
  listen(simulation, radio, 0.1);
  EXPECT_TRUE(radio.in_contact(1));
  EXPECT_TRUE(radio.in_contact(0));  // by way of the second
  EXPECT_FALSE(radio.in_contact(2));
}

TEST(Radio, WallsTakeRangeByTheirFaces) {
  World world = box();
  world.walls.push_back({{1, -3}, {1, 3}});
  world.walls.push_back({{1.1, -3}, {1.1, 3}});
  const auto contact_at = [&](double range, double loss) {
    LiveSimulation simulation = simulate(world, {{{3, 0, 0}}});
    Radio radio(world, 1, from_the_middle(range, loss));
    listen(simulation, radio, 0.1);
    return radio.in_contact(0);
  };
  EXPECT_TRUE(contact_at(3.5, 0));
  EXPECT_FALSE(contact_at(3.5, 0.3));
  EXPECT_TRUE(contact_at(3.7, 0.3));
}

TEST(Radio, ADeadRobotPassesNothingOnAndWhatItKeptCanBeReadOut) {
  LiveSimulation simulation = simulate(box(), {{{-4, 0, 0}}, {{-2, 0, 0}, 0, 2}, {{4.5, 0, 0}, 0, 1}});
  Radio radio(box(), 3, from_the_middle(3));
  listen(simulation, radio, 1.9);
  EXPECT_TRUE(radio.in_contact(0));
  listen(simulation, radio, 0.5);
  EXPECT_FALSE(radio.in_contact(0));
  EXPECT_GT(radio.waiting(2), 0U);
  EXPECT_FALSE(stamps_by_robot(radio.hand_over())[2].empty());
}

}  // namespace
}  // namespace helicoid
