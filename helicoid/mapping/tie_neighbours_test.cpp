#include "helicoid/mapping/tie_neighbours.hpp"

#include <gtest/gtest.h>

#include <numbers>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_islands.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

/// Round a room and back to where the way began, in the end 12 cm off; only each patch and the next are related, so
/// well that the last is `sigma` sure of the first, metres.
struct RoundTrip {
  static constexpr int kPatches = 9;
  synthetic::Builder builder;
  std::vector<double> along;

  explicit RoundTrip(double sigma) {
    for (int i = 0; i < kPatches; ++i) {
      const double angle = 2 * std::numbers::pi * i / (kPatches - 1);
      const Pose2 taken{4.5 + 2.6 * std::cos(angle), 3 + 1.7 * std::sin(angle), wrap_angle(angle + radians(90))};
      const double share = static_cast<double>(i) / (kPatches - 1);
      builder.add(synthetic::pillar_room(), taken, {taken.x + 0.10 * share, taken.y - 0.07 * share, taken.yaw});
      along.push_back(5.0 * i);
      if (i > 0) relate(i - 1, i, sigma);
    }
  }
  void relate(std::uint32_t a, std::uint32_t b, double sigma) {
    const double step = (kPatches - 1) / (sigma * sigma);
    builder.relate(PatchId{a}, PatchId{b}, RelationKind::odometry, {step, step, 100 * step});
  }
  [[nodiscard]] Pose2 first_to_last() const {
    return builder.map.T_plane_patch(PatchId{0}).inverse() * builder.map.T_plane_patch(PatchId{kPatches - 1});
  }
  void tie() {
    MapEditor editor(builder.map);
    InformationGraph graph = information_graph(builder.map);
    MapInProgress progress{builder.map, editor, graph};
    tie_neighbours(progress, along, {});
  }
};

TEST(TieNeighbours, WhatIsSureOfOneAnotherIsMeasuredAgainstOneAnother) {
  RoundTrip trip(0.05);
  ASSERT_GT(trip.first_to_last().distance(), 0.10);
  trip.tie();
  const Map& map = trip.builder.map;
  EXPECT_LT(trip.first_to_last().distance(), 0.02);
  EXPECT_TRUE(is_tied_to_stretch(map, PatchId{RoundTrip::kPatches - 1}, PatchId{0}, trip.along));
  const std::size_t relations = map.relations().size();
  trip.tie();
  EXPECT_EQ(map.relations().size(), relations);
}

TEST(TieNeighbours, WhatIsNotSureOfOneAnotherIsLeftApart) {
  RoundTrip trip(0.5);
  const std::size_t relations = trip.builder.map.relations().size();
  trip.tie();
  EXPECT_EQ(trip.builder.map.relations().size(), relations);
}

}  // namespace
}  // namespace helicoid
