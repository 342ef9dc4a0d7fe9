// What the order in which events were heard is said to have done to a map.
#include "apps/order_effect.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "tests/live_box.hpp"

namespace helicoid {
namespace {

/// Two robots that drive about in a box, for so many seconds.
std::vector<Event> two_in_a_box(double seconds) {
  LiveOptions options;
  options.seed = 3;
  LiveSimulation simulation = simulate(box(), {{{-3, 0, 0}}, {{3, 1, 3.1}}}, options);
  simulation.command(0, {0.3, 0.2});
  simulation.command(1, {0.2, -0.25});
  std::vector<Event> events;
  for (LiveEvent& live : run(simulation, seconds)) events.push_back(std::move(live.event));
  return events;
}

/// The map of these robots' events, in this order.
Mapper map_of(const std::vector<Event>& events) {
  Mapper mapper;
  for (const char* name : {"robot1", "robot2"}) std::ignore = mapper.add_robot(name, {simulated_lms200()});
  for (const Event& event : events) std::ignore = mapper.process(event);
  mapper.finish();
  return mapper;
}

TEST(OrderEffect, IsNoneBetweenAMapAndItself) {
  const Mapper mapper = map_of(two_in_a_box(20));
  const OrderEffect effect = compare_orders(mapper, mapper);
  EXPECT_TRUE(effect.same_islands);
  EXPECT_EQ(effect.closures_heard, effect.closures_stamped);
  EXPECT_EQ(effect.closures_elsewhere, 0U);
  EXPECT_NEAR(effect.closures_apart_m, 0, 1e-9);
  EXPECT_NEAR(effect.farthest_m, 0, 1e-9);
  EXPECT_NEAR(effect.farthest_deg, 0, 1e-9);
}

TEST(OrderEffect, IsSmallIfOneRobotIsHeardAfterTheOther) {
  std::vector<Event> events = two_in_a_box(20);
  const Mapper stamped = map_of(events);
  ASSERT_EQ(stamped.map().islands().size(), 1U) << "they see each other";
  std::stable_sort(events.begin(), events.end(), [](const Event& a, const Event& b) { return a.robot < b.robot; });
  const OrderEffect effect = compare_orders(map_of(events), stamped);
  EXPECT_TRUE(effect.same_islands);
  EXPECT_GT(effect.farthest_m, 0);
  EXPECT_LT(effect.mean_m, 0.02);
  EXPECT_LE(effect.mean_m, effect.farthest_m);
  EXPECT_LE(effect.mean_deg, effect.farthest_deg);
}

TEST(OrderEffect, TellsThatRobotsOfOneMapAreApartInTheOther) {
  std::vector<Event> events = two_in_a_box(20);
  const Mapper together = map_of(events);
  std::erase_if(events, [](const Event& e) { return std::holds_alternative<Sighting>(e.body); });
  const Mapper apart = map_of(events);
  EXPECT_FALSE(compare_orders(apart, together).same_islands);
  EXPECT_FALSE(compare_orders(together, apart).same_islands);
}

TEST(OrderEffect, CountsTheScansThatWereHeard) {
  std::vector<Event> events = two_in_a_box(20);
  const Mapper stamped = map_of(events);
  const auto is_of_first = [](const Event& e) { return std::holds_alternative<Scan>(e.body) && e.robot.index() == 0; };
  const auto of_first = static_cast<std::size_t>(std::count_if(events.begin(), events.end(), is_of_first));
  EXPECT_EQ(compare_orders(stamped, stamped).scans_heard.at(0), of_first);
  const auto never_heard = std::find_if(events.rbegin(), events.rend(), is_of_first);
  events.erase(std::next(never_heard).base());
  EXPECT_EQ(compare_orders(map_of(events), stamped).scans_heard.at(0), of_first - 1);
}

TEST(OrderEffect, IsAsLargeAsARobotIsOffInOneOfThem) {
  std::vector<Event> events = two_in_a_box(20);
  const Mapper stamped = map_of(events);
  std::erase_if(events,
                [](const Event& e) { return std::holds_alternative<Sighting>(e.body) && e.robot.index() == 1; });
  // As if the first one saw the other half a metre farther off.
  for (Event& event : events) {
    if (auto* seen = std::get_if<Sighting>(&event.body)) *seen->range += 0.5;
  }
  const OrderEffect effect = compare_orders(map_of(events), stamped);
  EXPECT_TRUE(effect.same_islands);
  EXPECT_NEAR(effect.mean_m, 0.25, 0.1) << "either half of it after one rigid transform";
}

}  // namespace
}  // namespace helicoid
