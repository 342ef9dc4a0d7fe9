#include "helicoid/geometry/row_spans.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"
#include "helicoid/geometry/polysolid.hpp"

namespace helicoid {
namespace {

using RingF = std::vector<Eigen::Vector2f>;

RingF star(Random& random, int vertices, double least, double most) {
  RingF ring;
  for (int i = 0; i < vertices; ++i) {
    const double angle = 2 * std::numbers::pi * i / vertices;
    const double radius = random.uniform(least, most);
    ring.push_back(Vector2d(radius * std::cos(angle), radius * std::sin(angle)).cast<float>());
  }
  return ring;
}

Polysolid solid_of(const RingF& ring, const Pose2& T) {
  Ring exact;
  for (const Eigen::Vector2f& p : ring) exact.push_back(T * p.cast<double>());
  return make_polysolid(exact);
}

TEST(RowSpans, CoverTheCellsWhoseCentresLieInside) {
  Random random(1);
  for (int i = 0; i < 20; ++i) {
    const RingF ring = star(random, 40, 0.3, 2);
    const Pose2 T{random.uniform(-3, 3), random.uniform(-3, 3), random.uniform(-3, 3)};
    const Polysolid solid = solid_of(ring, T);
    std::vector<RowSpan> spans = row_spans(ring, T, 0.1);
    std::int64_t inside = 0;
    for (int row = -60; row < 60; ++row) {
      for (int column = -60; column < 60; ++column) {
        if (contains(solid, Vector2d((column + 0.5) * 0.1, (row + 0.5) * 0.1))) ++inside;
      }
    }
    // A centre that lies on an edge to rounding may go either way.
    EXPECT_NEAR(static_cast<double>(count_cells(spans)), static_cast<double>(inside), 1);
  }
}

TEST(RowSpans, SharedCellsApproachTheAreaOfTheIntersection) {
  Random random(2);
  for (int i = 0; i < 50; ++i) {
    const RingF a = star(random, 60, 2, 6);
    const RingF b = star(random, 60, 2, 6);
    const Pose2 T{random.uniform(-6, 6), random.uniform(-6, 6), random.uniform(-3, 3)};
    const double exact = area(intersection(solid_of(a, {}), solid_of(b, T)));
    const auto shared = static_cast<double>(shared_cells(row_spans(a, {}, 0.1), row_spans(b, T, 0.1)));
    // Sampling at cells' centres errs like a random walk along the outline.
    EXPECT_NEAR(0.01 * shared, exact, 0.1 + 0.02 * exact);
  }
}

TEST(RowSpans, SharingIsSymmetricAndWholeWithItself) {
  Random random(3);
  for (int i = 0; i < 50; ++i) {
    const std::vector<RowSpan> a = row_spans(star(random, 90, 0.1, 5), {0.3, -0.2, 1}, 0.1);
    const std::vector<RowSpan> b = row_spans(star(random, 90, 0.1, 5), {1, 2, -1}, 0.1);
    EXPECT_EQ(shared_cells(a, b), shared_cells(b, a));
    EXPECT_EQ(shared_cells(a, a), count_cells(a));
    EXPECT_LE(shared_cells(a, b), std::min(count_cells(a), count_cells(b)));
  }
}

TEST(RowSpans, NothingCoversNothing) {
  EXPECT_TRUE(row_spans({}, {}, 0.1).empty());
  EXPECT_TRUE(row_spans(RingF{{0, 0}, {1, 0}}, {}, 0.1).empty());
  EXPECT_TRUE(row_spans(RingF{{0, 0}, {0.01F, 0}, {0, 0.01F}}, {}, 0.1).empty());
  EXPECT_EQ(shared_cells({}, row_spans(RingF{{0, 0}, {1, 0}, {1, 1}}, {}, 0.1)), 0);
}

TEST(RowSpans, ASquareOnTheRasterCoversItsCells) {
  const std::vector<RowSpan> spans = row_spans(RingF{{0, 0}, {1, 0}, {1, 0.5F}, {0, 0.5F}}, {}, 0.25);
  EXPECT_EQ(spans, (std::vector<RowSpan>{{0, 0, 3}, {1, 0, 3}}));
}

}  // namespace
}  // namespace helicoid
