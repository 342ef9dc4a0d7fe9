#include "helicoid/geometry/ray_casting.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

TEST(RayCaster, AgreesWithBruteForceOnRandomSegmentsAndRays) {
  Random random(7);
  std::vector<Segment> segments;
  for (int i = 0; i < 300; ++i) {
    const Vector2d from(random.uniform(-20, 20), random.uniform(-10, 10));
    segments.push_back({from, from + Vector2d(random.uniform(-4, 4), random.uniform(-4, 4))});
  }
  const RayCaster caster(segments);
  for (int i = 0; i < 20000; ++i) {
    const Vector2d origin(random.uniform(-25, 25), random.uniform(-15, 15));
    const double angle = i % 10 == 0 ? (i / 10 % 4) * std::numbers::pi / 2 : random.uniform(-4, 4);
    const Vector2d direction(std::cos(angle), std::sin(angle));
    double best = 30;
    bool found = false;
    for (const Segment& s : segments) {
      const double d = intersect(origin, direction, s);
      if (d <= best) {
        best = d;
        found = true;
      }
    }
    const RayCaster::Hit hit = caster.cast(origin, direction, 30);
    ASSERT_EQ(hit.segment >= 0, found);
    if (found) {
      ASSERT_DOUBLE_EQ(hit.distance, best);
    }
  }
}

TEST(RayCaster, ClearanceIsTheDistanceToTheNearestSegment) {
  const std::vector<Segment> wall{{{0, 0}, {10, 0}}};
  const RayCaster caster(wall);
  EXPECT_DOUBLE_EQ(caster.clearance({3, 0.4}, 1), 0.4);
  EXPECT_DOUBLE_EQ(caster.clearance({10.3, 0.4}, 1), 0.5);
  EXPECT_TRUE(std::isinf(caster.clearance({3, 2}, 1)));
}

TEST(RayCaster, TheNearestPointOfTheNearestSegmentIsAtItsClearance) {
  Random random(3);
  std::vector<Segment> segments;
  for (int i = 0; i < 50; ++i) {
    const Vector2d from(random.uniform(-20, 20), random.uniform(-10, 10));
    segments.push_back({from, from + Vector2d(random.uniform(-4, 4), random.uniform(-4, 4))});
  }
  const RayCaster caster(segments);
  for (int i = 0; i < 1000; ++i) {
    const Vector2d p(random.uniform(-25, 25), random.uniform(-15, 15));
    const RayCaster::Hit hit = caster.nearest(p, 100);
    ASSERT_GE(hit.segment, 0);
    ASSERT_NEAR((nearest_point(p, segments[hit.segment]) - p).norm(), hit.distance, 1e-12);
    for (const Segment& s : segments) ASSERT_GE((nearest_point(p, s) - p).norm(), hit.distance - 1e-12);
  }
}

TEST(RayCaster, AnEmptyWorldHasNoHits) {
  EXPECT_EQ(RayCaster({}).cast({0, 0}, {1, 0}, 50).segment, -1);
}

}  // namespace
}  // namespace helicoid
