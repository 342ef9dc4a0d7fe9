#include "helicoid/navigation/driven_neighbours.hpp"

#include <gmock/gmock.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

using synthetic::Builder;
using testing::ElementsAre;
using testing::IsEmpty;

Builder two_patches() {
  Builder builder;
  const auto walls = synthetic::rectangle(0, 0, 8, 6);
  builder.add(walls, {2, 3, 0});
  builder.add(walls, {4, 3, 0});
  return builder;
}

TEST(DrivenNeighbours, WhereARobotDroveItCanGoBack) {
  const Builder builder = two_patches();
  ASSERT_THAT(find_neighbours(builder.map)[0], IsEmpty()) << "nothing relates them";
  const Neighbours driven = DrivenNeighbours().add_to(builder.map, find_neighbours(builder.map));
  EXPECT_THAT(driven[0], ElementsAre(PatchId{1}));
  EXPECT_THAT(driven[1], ElementsAre(PatchId{0}));
}

TEST(DrivenNeighbours, AreWhereScansStandNotWherePatchesWereTaken) {
  Builder builder = two_patches();
  const auto walls = synthetic::rectangle(0, 0, 8, 6);
  MapEditor editor(builder.map);
  // Back on the first patch, then on to a third.
  editor.append_scan(builder.robot, {2e9, {PatchId{0}, {0.1, 0, 0}}, {}, Matrix3d::Identity() * 1e-4});
  builder.add(walls, {3, 1, 0});
  EXPECT_THAT(DrivenNeighbours().add_to(builder.map, Neighbours(3))[2], ElementsAre(PatchId{0}));
}

TEST(DrivenNeighbours, ReadOnFromWhereTheyWereAndAnewOnAnotherMap) {
  Builder builder = two_patches();
  DrivenNeighbours driven;
  EXPECT_THAT(driven.add_to(builder.map, Neighbours(2))[0], ElementsAre(PatchId{1}));
  builder.add(synthetic::rectangle(0, 0, 8, 6), {5, 3, 0});
  EXPECT_THAT(driven.add_to(builder.map, Neighbours(3))[1], ElementsAre(PatchId{0}, PatchId{2}));
  Builder other;
  other.add(synthetic::rectangle(0, 0, 8, 6), {2, 3, 0});
  EXPECT_THAT(driven.add_to(other.map, Neighbours(1))[0], IsEmpty());
}

}  // namespace
}  // namespace helicoid
