#include "helicoid/align/place_search.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

using synthetic::building;
using synthetic::lms200;
using synthetic::look;

ScanPoints seen_from(const std::vector<Segment>& walls, const Pose2& T_world_robot) {
  ScanPointExtractor extractor(lms200());
  return extractor.extract(look(RayCaster(walls), lms200(), T_world_robot));
}

Reference reference_of(const std::vector<Segment>& walls, const std::vector<Pose2>& views) {
  std::vector<ScanPoints> points;
  for (const Pose2& view : views) points.push_back(seen_from(walls, view));
  std::vector<ReferencePart> parts;
  for (std::size_t i = 0; i < views.size(); ++i) parts.push_back({&points[i], views[i]});
  Reference reference;
  reference.build(parts);
  return reference;
}

std::vector<Pose2> all_round(double x, double y) {
  return {{x, y, 0}, {x, y, 1.57}, {x, y, 3.14}, {x, y, -1.57}};
}

TEST(PlaceSearch, FindsAScanWhereverItStandsInTheWindow) {
  std::vector<Pose2> views = all_round(3.6, 5.5);
  for (const Pose2& view : all_round(10.6, 5.5)) views.push_back(view);
  const Reference reference = reference_of(building(), views);
  Random random(4);
  for (int k = 0; k < 30; ++k) {
    const Pose2 truth{random.uniform(3, 11), random.uniform(4.8, 6.2), random.uniform(-3, 3)};
    PlaceWindow window;
    window.T_reference_scan = {truth.x + random.uniform(-1.8, 1.8), truth.y + random.uniform(-1.8, 1.8),
                               wrap_angle(truth.yaw + random.uniform(-0.25, 0.25))};
    const PlaceSearch found = search_place(reference, seen_from(building(), truth), window);
    EXPECT_GT(found.best.score, 0.6);
    const Pose2 off = truth.inverse() * found.best.T_reference_scan;
    EXPECT_LT(off.distance(), 0.2) << k;
    EXPECT_LT(std::abs(off.yaw), 0.05) << k;
  }
}

TEST(PlaceSearch, NothingScoresMoreThanWhatItFinds) {
  const Reference reference = reference_of(building(), all_round(3.6, 5.5));
  const ScanPoints scan = seen_from(building(), {3.2, 5.8, 0.4});
  PlaceWindow wide;
  wide.T_reference_scan = {3.6, 5.2, 0.3};
  const Placement best = search_place(reference, scan, wide).best;
  // A window of a single placement about any other place: the same points, the same grid.
  Random random(9);
  for (int k = 0; k < 200; ++k) {
    PlaceWindow one;
    one.half_width = 0.05;
    one.half_turn = 0;
    one.least_score = 0;
    one.T_reference_scan = {wide.T_reference_scan.x + 0.1 * static_cast<double>(random.below(39)) - 1.9,
                            wide.T_reference_scan.y + 0.1 * static_cast<double>(random.below(39)) - 1.9,
                            wide.T_reference_scan.yaw + 0.04 * static_cast<double>(random.below(15)) - 0.28};
    one.half_width = 0;
    EXPECT_LE(search_place(reference, scan, one).best.score, best.score + 1e-9);
  }
}

TEST(PlaceSearch, TellsThatTwoPlacesLookAlike) {
  // A row of equal bays, 2 m apart: which one it is cannot be told.
  std::vector<Segment> bays{{{-10, 0}, {10, 0}}};
  for (int k = -5; k < 5; ++k) {
    bays.push_back({{2.0 * k, 0}, {2.0 * k, 1}});
  }
  const Reference reference =
      reference_of(bays, {{-3, 2.5, -1.57}, {-1, 2.5, -1.57}, {1, 2.5, -1.57}, {3, 2.5, -1.57}});
  PlaceWindow window;
  window.half_width = 3;
  window.T_reference_scan = {-1, 2.5, -1.57};
  const PlaceSearch bay = search_place(reference, seen_from(bays, {-1, 2.5, -1.57}), window);
  EXPECT_GT(bay.second.score, 0.9 * bay.best.score);

  const Reference known = reference_of(building(), all_round(3.6, 5.5));
  window.T_reference_scan = {3.6, 5.5, 0};
  const PlaceSearch corner = search_place(known, seen_from(building(), {3.6, 5.5, 0}), window);
  EXPECT_LT(corner.second.score, 0.95 * corner.best.score);
}

TEST(PlaceSearch, OfNothingIsNothing) {
  EXPECT_EQ(search_place({}, seen_from(building(), {3, 5, 0}), {}).best.score, 0);
  EXPECT_EQ(search_place(reference_of(building(), all_round(3, 5)), {}, {}).best.score, 0);
}

}  // namespace
}  // namespace helicoid
