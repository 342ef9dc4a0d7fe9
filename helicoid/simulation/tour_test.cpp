#include "helicoid/simulation/tour.hpp"

#include <gtest/gtest.h>

#include "helicoid/simulation/simulator.hpp"

namespace helicoid {
namespace {

World without_routes(const char* name) {
  World world = load_world(name).value();
  world.routes.clear();
  return world;
}

TEST(Tour, ComesNearEveryPlaceOfTheGivenRoute) {
  for (const char* name : {"office", "branch", "loop", "room"}) {
    const World world = without_routes(name);
    const Result<Route> tour = plan_tour(world);
    ASSERT_TRUE(tour.has_value()) << name << ": " << tour.error().message;
    ASSERT_TRUE(tour->closed);
    const std::vector<Route> routes = load_world(name)->routes;
    for (const Vector2d& place : routes[0].points) {
      double nearest = INFINITY;
      for (std::size_t i = 0; i < tour->points.size(); ++i) {
        const Vector2d a = tour->points[i];
        const Vector2d b = tour->points[(i + 1) % tour->points.size()];
        for (const double share : {0.0, 0.25, 0.5, 0.75})
          nearest = std::min(nearest, (a + share * (b - a) - place).norm());
      }
      EXPECT_LT(nearest, 3.5) << name << " at " << place.transpose();
    }
  }
}

TEST(Tour, CanBeDrivenWithoutTouchingAWall) {
  for (const char* name : {"office", "hall", "corridor"}) {
    World world = without_routes(name);
    world.routes.push_back(plan_tour(world).value());
    SimulationOptions options;
    options.scan_period = 5;
    Result<Simulator> simulator = Simulator::make(world, options);
    const RayCaster walls(world.walls);
    while (const auto event = simulator->next()) {
      ASSERT_GT(walls.clearance(event->T_world_robot.translation(), 100), 0.22) << name;
    }
  }
}

TEST(Tour, WithoutAStartStaysInsideTheBuilding) {
  World world = without_routes("office");
  world.starts.clear();
  const Result<Route> tour = plan_tour(world);
  ASSERT_TRUE(tour.has_value());
  for (const Vector2d& p : tour->points) {
    EXPECT_GT(p.x(), -3);
    EXPECT_LT(p.x(), 33);
    EXPECT_LT(p.y(), 0);
    EXPECT_GT(p.y(), -20.4);
  }
}

TEST(Tour, SaysWhyThereIsNone) {
  World cupboard;
  cupboard.name = "cupboard";
  cupboard.walls = {{{0, 0}, {0.5, 0}}, {{0.5, 0}, {0.5, 0.5}}, {{0.5, 0.5}, {0, 0.5}}, {{0, 0.5}, {0, 0}}};
  EXPECT_FALSE(plan_tour(cupboard).has_value());
  World desert = cupboard;
  desert.walls.push_back({{1e5, 1e5}, {1e5, 1e5 + 1}});
  EXPECT_NE(plan_tour(desert).error().message.find("too large"), std::string::npos);
}

}  // namespace
}  // namespace helicoid
