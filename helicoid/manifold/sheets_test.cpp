#include "helicoid/manifold/sheets.hpp"

#include <gtest/gtest.h>

#include <map>
#include <set>

#include "helicoid/geometry/row_spans.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

constexpr double kCell = 0.10;
using Cell = std::pair<std::int32_t, std::int32_t>;  ///< row, column

/// The groups over one cell, word for word as the contract has them.
int groups_over(const Map& map, const Neighbours& neighbours, const Cell& cell, std::set<PatchId> covering) {
  const Vector2d middle((cell.second + 0.5) * kCell, (cell.first + 0.5) * kCell);
  const std::set<PatchId> over = covering;
  const auto may_join = [&](PatchId id) {
    return over.contains(id) || (map.T_plane_patch(id).translation() - middle).norm() <= 10;
  };
  int groups = 0;
  for (; !covering.empty(); ++groups) {
    std::vector<PatchId> frontier{*covering.begin()};
    std::set<PatchId> reached{*covering.begin()};
    while (!frontier.empty()) {
      const PatchId at = frontier.back();
      frontier.pop_back();
      for (const PatchId next : neighbours[at.index()]) {
        if (may_join(next) && reached.insert(next).second) frontier.push_back(next);
      }
    }
    for (const PatchId id : reached) covering.erase(id);
  }
  return groups;
}

int sheets_by_definition(const Map& map, const Neighbours& neighbours, const Island& island) {
  std::map<Cell, std::set<PatchId>> covering;
  for (const PatchId id : island.patches) {
    for (const RowSpan& span : row_spans(map.patch(id).free_space, map.T_plane_patch(id), kCell)) {
      for (std::int32_t column = span.first; column <= span.last; ++column) covering[{span.row, column}].insert(id);
    }
  }
  int most = 1;
  for (const auto& [cell, over] : covering) most = std::max(most, groups_over(map, neighbours, cell, over));
  return most;
}

/// Patches of a long hall, each a neighbour of some of the others by chance.
synthetic::Builder random_hall(Random& random, int patches) {
  synthetic::Builder builder("robot1", 31);
  const std::vector<synthetic::Wall> walls = synthetic::rectangle(-14, -2, 14, 2);
  for (int i = 0; i < patches; ++i) {
    builder.add(walls, {random.uniform(-13, 13), random.uniform(-1.5, 1.5), random.uniform(-3.1, 3.1)});
  }
  return builder;
}

Neighbours random_neighbours(Random& random, std::size_t patches, double share) {
  Neighbours neighbours(patches);
  for (std::size_t i = 0; i < patches; ++i) {
    for (std::size_t j = 0; j < i; ++j) {
      if (random.uniform(0, 1) >= share) continue;
      neighbours[i].push_back(make_id<PatchId>(j));
      neighbours[j].push_back(make_id<PatchId>(i));
    }
  }
  return neighbours;
}

TEST(Sheets, AreAsManyAsTheDefinitionSays) {
  Random random(11);
  std::set<int> counts;
  for (int round = 0; round < 60; ++round) {
    const int patches = 4 + round % 12;
    const synthetic::Builder builder = random_hall(random, patches);
    const Neighbours neighbours =
        random_neighbours(random, static_cast<std::size_t>(patches), random.uniform(0.02, 0.4));
    const Island island = builder.map.islands().front();
    const int expected = sheets_by_definition(builder.map, neighbours, island);
    EXPECT_EQ(count_sheets(builder.map, neighbours, island), expected) << "round " << round;
    counts.insert(expected);
  }
  EXPECT_GE(counts.size(), 4U) << "the rounds must differ";
}

/// Six rooms on a circle that cannot be seen from one another, and the first one once more.
struct RoundTrip {
  synthetic::Builder builder;
  explicit RoundTrip(double sigma) {
    for (int i = 0; i < 7; ++i) {
      const double angle = radians(60) * i;
      const Pose2 at{9 * std::cos(angle), 9 * std::sin(angle), wrap_angle(angle)};
      builder.add(synthetic::rectangle(at.x - 3, at.y - 3, at.x + 3, at.y + 3), at);
      if (i > 0) relate(i - 1, i, sigma);
    }
  }
  void relate(std::uint32_t a, std::uint32_t b, double sigma) {
    const double position = 1 / (sigma * sigma);
    builder.relate(PatchId{a}, PatchId{b}, RelationKind::odometry, {position, position, 1e8});
  }
  [[nodiscard]] int sheets() const {
    return count_sheets(builder.map, find_neighbours(builder.map), builder.map.islands().front());
  }
};

TEST(Sheets, LieOverOneAnotherWhileTheWayRoundLeavesADoubtAndAreOneOnceItIsClosed) {
  RoundTrip doubtful(0.06);  // 1.96 sqrt(6) 0.06 m = 0.29 m
  EXPECT_EQ(doubtful.sheets(), 2);
  doubtful.relate(0, 6, 0.06);
  EXPECT_EQ(doubtful.sheets(), 1);
}

TEST(Sheets, AreOneWhereTheWayRoundLeavesNoDoubt) {
  EXPECT_EQ(RoundTrip(0.02).sheets(), 1);
}

TEST(Sheets, KeepApartWhatSeveralWaysTogetherLeaveInDoubt) {
  // Two ways round, each of 0.58 m, know the place to 0.41 m; ten of them to 0.18 m, and twenty to 0.13 m.
  RoundTrip ways(0.12);
  const auto more_ways = [&](int count) {
    for (int k = 0; k < count; ++k) ways.relate(0, 6, 0.12 * std::sqrt(6.0));
  };
  more_ways(1);
  EXPECT_EQ(ways.sheets(), 2);
  more_ways(8);
  EXPECT_EQ(ways.sheets(), 2);
  more_ways(10);
  EXPECT_EQ(ways.sheets(), 1);
}

TEST(Sheets, AreDrawnAsMoreThanOneWhereThereIsMoreThanOne) {
  Random random(12);
  for (int round = 0; round < 20; ++round) {
    const synthetic::Builder builder = random_hall(random, 10);
    const Neighbours neighbours = random_neighbours(random, 10, 0.15);
    const Island island = builder.map.islands().front();
    const Sheets sheets = find_sheets(builder.map, neighbours, island);
    const std::set<int> used(sheets.sheet_of.begin(), sheets.sheet_of.end());
    EXPECT_EQ(sheets.count, sheets_by_definition(builder.map, neighbours, island));
    EXPECT_GE(used.size(), sheets.count > 1 ? 2U : 1U);
  }
}

}  // namespace
}  // namespace helicoid
