#include "helicoid/mapping/close_loops.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/manifold/content_hash.hpp"
#include "helicoid/mapping/mapper.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

using synthetic::Drive;
using synthetic::drive;

Mapper map_drive(const Drive& d, bool closures) {
  MapperOptions options;
  options.closures = closures;
  Mapper mapper(options);
  mapper.add_robot("robot1", {synthetic::lms200()});
  for (const Event& event : d.events) mapper.process(event);
  mapper.finish();
  return mapper;
}

std::size_t closure_relations(const Map& map) {
  return static_cast<std::size_t>(std::count_if(map.relations().begin(), map.relations().end(),
                                                [](const Relation& r) { return r.kind == RelationKind::closure; }));
}

double worst_error(const Map& map, const Drive& d) {
  const auto& scans = map.robots()[0].trajectory;
  double worst = 0;
  for (std::size_t i = 0; i < scans.size(); ++i) {
    const Pose2 there = map.project(scans.front().pose).inverse() * map.project(scans[i].pose);
    const Pose2 truth = d.truth.front().inverse() * d.truth[i];
    worst = std::max(worst, (truth.inverse() * there).distance());
  }
  return worst;
}

/// Three rounds of a corridor, with enough noise that the second does not know the first by itself.
const Drive& rounds() {
  static const Drive d = drive(3, 2, synthetic::round_the_ring(), synthetic::ring());
  return d;
}

TEST(Loops, ACorridorIsClosedAndRoundsAfterwardsAddNothing) {
  const Mapper closed = map_drive(rounds(), true);
  const Mapper open = map_drive(rounds(), false);
  EXPECT_GT(closure_relations(closed.map()), 0U);
  EXPECT_LT(2 * closed.map().patch_count(), open.map().patch_count());
  EXPECT_LT(worst_error(closed.map(), rounds()), 0.10);
}

TEST(Loops, StayOpenWhenTheyAreNotToBeClosed) {
  const Mapper open = map_drive(rounds(), false);
  EXPECT_EQ(closure_relations(open.map()), 0U);
  EXPECT_TRUE(open.ledger().empty());
}

TEST(Loops, NoEntryIsAcceptedThatStandsAlone) {
  const Mapper closed = map_drive(rounds(), true);
  const Ledger& ledger = closed.ledger();
  ASSERT_FALSE(ledger.empty());
  for (std::size_t i = 0; i < ledger.size(); ++i) {
    EXPECT_FALSE(ledger[i].reason.empty());
    EXPECT_LT(ledger[i].a, ledger[i].b);
    if (ledger[i].state != HypothesisState::accepted) continue;
    const bool supports_another = std::any_of(ledger.begin(), ledger.end(), [i](const Hypothesis& h) {
      return std::count(h.supports.begin(), h.supports.end(), i) > 0;
    });
    EXPECT_TRUE(supports_another || ledger[i].supports.size() >= 2) << i;
  }
}

TEST(Loops, ASecondFinishInducesNothing) {
  Mapper closed = map_drive(rounds(), true);
  const auto before = content_hash(closed.map());
  closed.finish();
  EXPECT_EQ(content_hash(closed.map()), before);
}

}  // namespace
}  // namespace helicoid
