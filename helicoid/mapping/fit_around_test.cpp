#include "helicoid/mapping/fit_around.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/manifold/confidence.hpp"
#include "helicoid/mapping/fit_islands.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

constexpr std::uint32_t kAlong = 30;
constexpr std::uint32_t kAcross = 40;

PatchId at(std::uint32_t x, std::uint32_t y) {
  return PatchId{y * kAlong + x};
}

/// A floor of patches two metres apart, each related to the next ones, at its best fit: more than is fitted whole.
synthetic::Builder floor_of_patches() {
  synthetic::Builder builder("robot1", 3);
  const std::vector<synthetic::Wall> walls = synthetic::rectangle(-10, -10, 100, 100);
  for (std::uint32_t i = 0; i < kAlong * kAcross; ++i) {
    const std::uint32_t row = i / kAlong;
    builder.add(walls, {2.0 * (i % kAlong), 2.0 * row, 0.01 * (i % 7)});
    if (i % kAlong > 0) builder.relate(PatchId{i - 1}, PatchId{i}, RelationKind::odometry);
    if (i >= kAlong) builder.relate(PatchId{i - kAlong}, PatchId{i}, RelationKind::odometry);
  }
  return builder;
}

/// Says that two patches lie a few centimetres from where the map has them.
void contradict(synthetic::Builder& builder, PatchId a, PatchId b) {
  Relation relation;
  relation.a = a;
  relation.b = b;
  relation.kind = RelationKind::odometry;
  relation.T_a_b = builder.map.T_plane_patch(a).inverse() * builder.map.T_plane_patch(b) * Pose2{0.05, -0.03, 0.01};
  relation.form = pose_pose_form(relation.T_a_b, Vector3d(1e4, 2e4, 3e4).asDiagonal());
  MapEditor(builder.map).add_relation(relation);
}

TEST(FitAround, IsWhatAFitOfEverythingIs) {
  synthetic::Builder around = floor_of_patches();
  contradict(around, at(3, 3), at(7, 6));
  synthetic::Builder whole = around;
  const PatchId related[] = {at(3, 3), at(7, 6)};
  MapEditor editor(around.map);
  const std::vector<PatchId> fitted = fit_around(around.map, editor, related);
  MapEditor of_whole(whole.map);
  fit_islands(whole.map, of_whole);
  const Pose2 T = around.map.T_plane_patch(at(3, 3)).inverse() * around.map.T_plane_patch(at(7, 6));
  const Pose2 T_whole = whole.map.T_plane_patch(at(3, 3)).inverse() * whole.map.T_plane_patch(at(7, 6));
  // What was moved from, at (3, 3) to (7, 6): centimetres.
  EXPECT_LT((T.inverse() * T_whole).distance(), 2e-3);
  EXPECT_FALSE(fitted.empty());
  EXPECT_TRUE(std::is_sorted(fitted.begin(), fitted.end()));
}

TEST(FitAround, LosesNothingThatAFitOfEverythingAfterItDoesNotGiveBack) {
  synthetic::Builder around = floor_of_patches();
  contradict(around, at(3, 3), at(7, 6));
  synthetic::Builder whole = around;
  const PatchId related[] = {at(3, 3), at(7, 6)};
  MapEditor editor(around.map);
  fit_around(around.map, editor, related);
  fit_islands(around.map, editor);
  MapEditor of_whole(whole.map);
  fit_islands(whole.map, of_whole);
  for (std::size_t i = 0; i < whole.map.patch_count(); ++i) {
    // The planes' origins may differ.
    const Pose2 T = around.map.T_plane_patch(at(0, 0)).inverse() * around.map.T_plane_patch(make_id<PatchId>(i));
    const Pose2 T_whole = whole.map.T_plane_patch(at(0, 0)).inverse() * whole.map.T_plane_patch(make_id<PatchId>(i));
    EXPECT_LT((T.inverse() * T_whole).distance(), 1e-6);
  }
}

TEST(FitAround, FitsEachIslandThatIsRelatedAndNoOther) {
  const std::vector<synthetic::Wall> walls = synthetic::rectangle(-10, -10, 20, 20);
  synthetic::Builder builder("robot1", 3);
  MapEditor editor(builder.map);
  for (std::uint32_t i = 0; i < 9; ++i) {
    if (i % 3 == 0 && i > 0) builder.island = editor.add_island();
    builder.add(walls, {2.0 * i, 0, 0});
    if (i % 3 > 0) builder.relate(PatchId{i - 1}, PatchId{i}, RelationKind::odometry);
  }
  for (const std::uint32_t first : {0U, 3U, 6U}) contradict(builder, PatchId{first}, PatchId{first + 2});
  const std::vector<Pose2> before(builder.map.poses().begin(), builder.map.poses().end());
  const PatchId related[] = {PatchId{6}, PatchId{8}, PatchId{0}, PatchId{2}};
  const std::vector<PatchId> fitted = fit_around(builder.map, editor, related);
  EXPECT_EQ(fitted, (std::vector{PatchId{0}, PatchId{1}, PatchId{2}, PatchId{6}, PatchId{7}, PatchId{8}}));
  for (const std::uint32_t i : {0U, 3U, 4U, 5U, 6U}) EXPECT_EQ(builder.map.T_plane_patch(PatchId{i}), before[i]);
  for (const std::uint32_t i : {2U, 8U}) EXPECT_NE(builder.map.T_plane_patch(PatchId{i}), before[i]);
}

TEST(FitAround, LeavesAloneWhatLiesFarOff) {
  synthetic::Builder builder = floor_of_patches();
  contradict(builder, at(3, 3), at(4, 4));
  const std::vector<Pose2> before(builder.map.poses().begin(), builder.map.poses().end());
  const PatchId related[] = {at(3, 3), at(4, 4)};
  MapEditor editor(builder.map);
  const std::vector<PatchId> fitted = fit_around(builder.map, editor, related);
  EXPECT_LT(fitted.size(), builder.map.patch_count());
  for (std::size_t i = 0; i < before.size(); ++i) {
    const PatchId id = make_id<PatchId>(i);
    if (!std::binary_search(fitted.begin(), fitted.end(), id)) {
      EXPECT_EQ(builder.map.T_plane_patch(id), before[i]);
    }
  }
}

TEST(RenewInformation, IsThatOfTheMapAsItStandsNow) {
  synthetic::Builder builder = floor_of_patches();
  InformationGraph renewed = information_graph(builder.map);
  MapEditor editor(builder.map);
  const PatchId moved[] = {at(5, 5), at(6, 5)};
  for (const PatchId id : moved) {
    editor.set_pose(id, builder.map.T_plane_patch(id) * Pose2{0.1, 0.2, 0.3});
  }
  renew_information(builder.map, moved, renewed);
  const InformationGraph anew = information_graph(builder.map);
  for (std::uint32_t i = 0; i < anew.size(); ++i) {
    ASSERT_EQ(renewed.edges(i).size(), anew.edges(i).size());
    for (std::size_t k = 0; k < anew.edges(i).size(); ++k) {
      EXPECT_EQ(renewed.edges(i)[k].to, anew.edges(i)[k].to);
      EXPECT_EQ(renewed.edges(i)[k].information, anew.edges(i)[k].information);
      EXPECT_EQ(renewed.ways(i)[k].spread, anew.ways(i)[k].spread);
    }
  }
}

}  // namespace
}  // namespace helicoid
