#include "helicoid/geometry/polysolid.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>
#include <thread>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

/// A star-shaped polygon about a centre, as a scan's free space is one.
Ring star(Random& random, const Vector2d& centre, int vertices, double least, double most) {
  Ring ring;
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices;
    ring.push_back(centre + random.uniform(least, most) * Vector2d(std::cos(angle), std::sin(angle)));
  }
  return ring;
}

/// Stars with a hole, some of several parts: what unions and differences of free space look like.
Polysolid random_solid(Random& random) {
  const auto centre = [&random] { return Vector2d(random.uniform(-4, 4), random.uniform(-4, 4)); };
  const auto vertices = [&random] { return 3 + static_cast<int>(random.below(60)); };
  const Vector2d first = centre();
  Polysolid solid = make_polysolid(star(random, first, vertices(), 1, 6));
  if (random.chance(0.5)) solid = union_of(solid, make_polysolid(star(random, centre(), vertices(), 0.5, 4)));
  if (random.chance(0.5)) solid = difference(solid, make_polysolid(star(random, first, vertices(), 0.2, 0.9)));
  return solid;
}

/// Pairs that share vertices, edges or everything, or nearly so: where overlay is hardest.
Polysolid near_twin(Random& random, const Polysolid& solid) {
  switch (random.below(4)) {
    case 0: return solid;
    case 1: return transformed({1e-9, -1e-9, 0}, solid);
    case 2: return transformed({0, 0, 1e-8}, solid);
    default: return offset(solid, -1e-6);
  }
}

constexpr double kRounding = 1e-7;  // square metres; coordinates are some 10 m and rounded to 1e-15 of it

void expect_laws(const Polysolid& a, const Polysolid& b) {
  const Polysolid both = intersection(a, b);
  const Polysolid either = union_of(a, b);
  const Polysolid only_a = difference(a, b);
  const Polysolid only_b = difference(b, a);
  for (const Polysolid& s : {both, either, only_a, only_b}) ASSERT_TRUE(is_valid(s));
  // Inclusion and exclusion.
  EXPECT_NEAR(area(either) + area(both), area(a) + area(b), kRounding);
  // The difference and the intersection partition a, and the three parts the union.
  EXPECT_NEAR(area(only_a) + area(both), area(a), kRounding);
  EXPECT_NEAR(area(only_a) + area(both) + area(only_b), area(either), kRounding);
  EXPECT_NEAR(area(intersection(only_a, both)), 0, kRounding);
  EXPECT_NEAR(area(intersection(only_a, b)), 0, kRounding);
  // De Morgan, inside a box that holds both.
  const Polysolid box = make_rectangle({-30, -30}, {30, 30});
  const Polysolid outside = difference(box, either);
  const Polysolid outside_each = intersection(difference(box, a), difference(box, b));
  EXPECT_NEAR(area(difference(outside, outside_each)), 0, kRounding);
  EXPECT_NEAR(area(difference(outside_each, outside)), 0, kRounding);
}

TEST(Polysolid, ObeysTheLawsOfSetsOnRandomSolids) {
  Random random(11);
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    expect_laws(random_solid(random), random_solid(random));
  }
}

TEST(Polysolid, ObeysTheLawsOfSetsOnNearlyEqualSolids) {
  Random random(12);
  for (int i = 0; i < 150; ++i) {
    SCOPED_TRACE(i);
    const Polysolid a = random_solid(random);
    expect_laws(a, near_twin(random, a));
  }
}

TEST(Polysolid, IsItsOwnUnionAndIntersection) {
  Random random(13);
  for (int i = 0; i < 100; ++i) {
    const Polysolid a = random_solid(random);
    EXPECT_EQ(union_of(a, a), a);
    EXPECT_EQ(intersection(a, a), a);
    EXPECT_TRUE(difference(a, a).empty());
  }
}

TEST(Polysolid, TheEmptySolidIsNeutral) {
  const Polysolid a = make_rectangle({0, 0}, {2, 1});
  const Polysolid nothing;
  EXPECT_EQ(union_of(a, nothing), a);
  EXPECT_TRUE(intersection(a, nothing).empty());
  EXPECT_EQ(difference(a, nothing), a);
  EXPECT_TRUE(difference(nothing, a).empty());
  EXPECT_TRUE(contains(a, nothing));
  EXPECT_FALSE(contains(nothing, a));
  EXPECT_FALSE(contains(nothing, Vector2d(0, 0)));
  EXPECT_EQ(area(nothing), 0);
  EXPECT_TRUE(is_valid(nothing));
  EXPECT_TRUE(offset(nothing, 1).empty());
  EXPECT_TRUE(simplify(nothing, 1).empty());
}

TEST(Polysolid, UnionOfManyIsTheUnionOneByOne) {
  Random random(14);
  std::vector<Polysolid> solids;
  Polysolid one_by_one;
  for (int i = 0; i < 12; ++i) {
    solids.push_back(random_solid(random));
    one_by_one = union_of(one_by_one, solids.back());
  }
  const Polysolid at_once = union_of(solids);
  EXPECT_TRUE(is_valid(at_once));
  EXPECT_NEAR(area(at_once), area(one_by_one), kRounding);
  EXPECT_NEAR(area(difference(at_once, one_by_one)), 0, kRounding);
}

TEST(Polysolid, TouchingAreasShareNothing) {
  const Polysolid a = make_rectangle({0, 0}, {1, 1});
  const Polysolid beside = make_rectangle({1, 0}, {2, 1});
  const Polysolid at_corner = make_rectangle({1, 1}, {2, 2});
  EXPECT_TRUE(intersection(a, beside).empty());
  EXPECT_TRUE(intersection(a, at_corner).empty());
  EXPECT_EQ(difference(a, beside), a);
  EXPECT_EQ(union_of(a, beside).polygons.size(), 1U);
  EXPECT_EQ(union_of(a, at_corner).polygons.size(), 2U);
  EXPECT_DOUBLE_EQ(area(union_of(a, at_corner)), 2);
}

TEST(Polysolid, CollinearAndRepeatedVerticesHaveNoEffectOnTheArea) {
  EXPECT_TRUE(make_polysolid(Ring{{0, 0}, {1, 1}, {2, 2}}).empty());
  EXPECT_TRUE(make_polysolid(Ring{{1, 1}, {1, 1}, {1, 1}, {1, 1}}).empty());
  EXPECT_TRUE(make_polysolid(Ring{{0, 0}, {1, 0}}).empty());
  EXPECT_TRUE(make_polysolid({}).empty());
  EXPECT_DOUBLE_EQ(area(make_polysolid(Ring{{0, 0}, {1, 0}, {1, 0}, {2, 0}, {2, 1}, {0, 1}})), 2);
}

TEST(Polysolid, SliversSurvive) {
  const Polysolid sliver = make_polysolid(Ring{{0, 0}, {10, 0}, {10, 1e-6}});
  EXPECT_NEAR(area(sliver), 5e-6, 1e-12);
  expect_laws(sliver, make_rectangle({4, -1}, {5, 1}));
}

TEST(Polysolid, ARingThatCrossesItselfEnclosesByTheEvenOddRule) {
  const Polysolid bow = make_polysolid(Ring{{0, 0}, {2, 2}, {2, 0}, {0, 2}});
  EXPECT_EQ(bow.polygons.size(), 2U);
  EXPECT_NEAR(area(bow), 2, 1e-12);
  EXPECT_TRUE(is_valid(bow));
}

TEST(Polysolid, HolesAreOutside) {
  const Polysolid ring = difference(make_rectangle({0, 0}, {4, 4}), make_rectangle({1, 1}, {3, 3}));
  ASSERT_EQ(ring.polygons.size(), 1U);
  ASSERT_EQ(ring.polygons[0].holes.size(), 1U);
  EXPECT_DOUBLE_EQ(area(ring), 12);
  EXPECT_FALSE(contains(ring, Vector2d(2, 2)));
  EXPECT_TRUE(contains(ring, Vector2d(0.5, 2)));
  EXPECT_TRUE(contains(ring, Vector2d(1, 2)));  // the boundary belongs to the solid
  EXPECT_FALSE(contains(ring, make_rectangle({1.5, 1.5}, {2, 2})));
  EXPECT_TRUE(contains(ring, make_rectangle({0, 0}, {1, 4})));
  EXPECT_TRUE(contains(make_rectangle({0, 0}, {4, 4}), ring));
}

TEST(Polysolid, ResultsTurnOuterRingsAnticlockwiseWhateverTheInput) {
  const Ring clockwise{{0, 0}, {0, 1}, {1, 1}, {1, 0}};
  const Ring anticlockwise{{1, 0}, {1, 1}, {0, 1}, {0, 0}};
  EXPECT_EQ(make_polysolid(clockwise), make_polysolid(anticlockwise));
  const Polysolid square = make_polysolid(clockwise);
  EXPECT_EQ(square.polygons[0].outer, (Ring{{0, 0}, {1, 0}, {1, 1}, {0, 1}}));
}

TEST(Polysolid, OffsetIsMonotone) {
  Random random(15);
  for (int i = 0; i < 60; ++i) {
    const Polysolid solid = random_solid(random);
    double before = 0;
    Polysolid smaller;
    for (const double distance : {-2.0, -0.5, -0.1, 0.0, 0.1, 0.5, 2.0}) {
      const Polysolid grown = offset(solid, distance);
      ASSERT_TRUE(is_valid(grown));
      EXPECT_GE(area(grown), before - kRounding);
      EXPECT_NEAR(area(difference(smaller, grown)), 0, 1e-4);
      before = area(grown);
      smaller = grown;
    }
    EXPECT_NEAR(area(offset(solid, 0)), area(solid), kRounding);
  }
}

TEST(Polysolid, OffsetOfASquareHasTheAreaOfItsParts) {
  const Polysolid square = make_rectangle({0, 0}, {1, 1});
  const double quarter_circles = std::numbers::pi * 0.25;
  EXPECT_NEAR(area(offset(square, 0.5, 64)), 1 + 4 * 0.5 + quarter_circles, 1e-3);
  EXPECT_NEAR(area(offset(square, -0.25)), 0.25, 1e-12);
  EXPECT_TRUE(offset(square, -0.6).empty());
}

TEST(Polysolid, SimplifiedSolidsStayValidAndNear) {
  Random random(16);
  for (int i = 0; i < 60; ++i) {
    const Polysolid solid = union_of(random_solid(random), transformed({12, 0, 0}, random_solid(random)));
    for (const double tolerance : {0.0, 0.02, 0.2, 1.0, 5.0}) {
      const Polysolid simple = simplify(solid, tolerance);
      ASSERT_TRUE(is_valid(simple)) << i << ' ' << tolerance;
      EXPECT_TRUE(contains(offset(solid, tolerance + 1e-6, 64), simple)) << i << ' ' << tolerance;
    }
    EXPECT_NEAR(area(simplify(solid, 0)), area(solid), kRounding);
  }
}

TEST(Polysolid, SimplifyLeavesOutWhatIsStraight) {
  const Polysolid square = make_polysolid(Ring{{0, 0}, {1, 0}, {2, 1e-4}, {3, 0}, {3, 3}, {0, 3}});
  EXPECT_EQ(simplify(square, 0.01), make_rectangle({0, 0}, {3, 3}));
}

TEST(Polysolid, MovingChangesNeitherAreaNorContainment) {
  Random random(17);
  for (int i = 0; i < 50; ++i) {
    const Polysolid solid = random_solid(random);
    const Pose2 T{random.uniform(-50, 50), random.uniform(-50, 50), random.uniform(-3, 3)};
    const Polysolid moved = transformed(T, solid);
    EXPECT_TRUE(is_valid(moved));
    EXPECT_NEAR(area(moved), area(solid), 1e-9);
    for (int k = 0; k < 20; ++k) {
      const Vector2d p(random.uniform(-8, 8), random.uniform(-8, 8));
      EXPECT_EQ(contains(moved, T * p), contains(solid, p));
    }
  }
}

TEST(Polysolid, ContainsThePointsThatAreInOneOfItsParts) {
  Random random(18);
  for (int i = 0; i < 50; ++i) {
    const Polysolid a = random_solid(random);
    const Polysolid b = random_solid(random);
    const Polysolid either = union_of(a, b);
    const Polysolid both = intersection(a, b);
    for (int k = 0; k < 20; ++k) {
      const Vector2d p(random.uniform(-8, 8), random.uniform(-8, 8));
      EXPECT_EQ(contains(either, p), contains(a, p) || contains(b, p));
      EXPECT_EQ(contains(both, p), contains(a, p) && contains(b, p));
    }
  }
}

TEST(Polysolid, CoordinatesThatAreNotFiniteAreRefused) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  EXPECT_THROW((void)make_polysolid(Ring{{0, 0}, {1, nan}, {1, 1}}), std::invalid_argument);
  EXPECT_THROW((void)make_polysolid(Ring{{0, 0}, {infinity, 0}, {1, 1}}), std::invalid_argument);
  EXPECT_THROW((void)contains(make_rectangle({0, 0}, {1, 1}), Vector2d(nan, 0)), std::invalid_argument);
}

TEST(Polysolid, ValidityNamesWhatIsWrong) {
  EXPECT_FALSE(is_valid(Polysolid{{{{{0, 0}, {2, 2}, {2, 0}, {0, 2}}, {}}}}));                  // crosses itself
  EXPECT_FALSE(is_valid(Polysolid{{{{{0, 0}, {1, 0}}, {}}}}));                                  // no area
  EXPECT_FALSE(is_valid(Polysolid{{{{{0, 0}, {1, 0}, {0, 1}}, {{{5, 5}, {5, 6}, {6, 5}}}}}}));  // hole outside
}

TEST(Polysolid, ThreadsGiveTheSameResults) {
  const auto work = [] {
    Random random(19);
    std::vector<Polysolid> results;
    for (int i = 0; i < 20; ++i) results.push_back(union_of(random_solid(random), random_solid(random)));
    return results;
  };
  std::vector<Polysolid> elsewhere;
  std::thread thread([&] { elsewhere = work(); });
  const std::vector<Polysolid> here = work();
  thread.join();
  EXPECT_EQ(here, elsewhere);
}

}  // namespace
}  // namespace helicoid
