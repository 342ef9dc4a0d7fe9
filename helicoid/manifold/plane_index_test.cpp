#include "helicoid/manifold/plane_index.hpp"

#include <gtest/gtest.h>

#include "helicoid/manifold/map_editor.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

/// Written down apart from the code that is tested.
std::vector<PatchId> about_by_looking_at_all(const Map& map, PatchId id, double radius) {
  std::vector<PatchId> about;
  for (std::size_t i = 0; i < map.patch_count(); ++i) {
    const PatchId other = make_id<PatchId>(i);
    const Vector2d apart = map.T_plane_patch(other).translation() - map.T_plane_patch(id).translation();
    if (map.island_of(other) == map.island_of(id) && apart.squaredNorm() <= radius * radius) about.push_back(other);
  }
  return about;
}

TEST(PatchesAbout, AreThoseOfTheIslandThatLieNearHoweverTheyWereMoved) {
  Random random(3);
  synthetic::Builder builder("robot1", 3);
  MapEditor editor(builder.map);
  const std::vector<synthetic::Wall> walls = synthetic::rectangle(-30, -30, 30, 30);
  for (int i = 0; i < 200; ++i) {
    if (i == 100) builder.island = editor.add_island();
    builder.add(walls, synthetic::random_pose(random));
  }
  const auto all_agree = [&] {
    for (const PatchId id : builder.patches()) {
      for (const double radius : {0.5, 3.0, 9.0}) {
        EXPECT_EQ(builder.map.patches_about(id, radius), about_by_looking_at_all(builder.map, id, radius));
      }
    }
  };
  all_agree();
  for (int i = 0; i < 300; ++i)
    editor.set_pose(PatchId{static_cast<std::uint32_t>(random.below(200))}, synthetic::random_pose(random));
  all_agree();
  editor.merge_islands(builder.map.island_of(PatchId{0}), builder.map.island_of(PatchId{150}), {1, 2, 0.5});
  all_agree();
}

}  // namespace
}  // namespace helicoid
