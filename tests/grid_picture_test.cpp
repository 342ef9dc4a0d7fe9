// An occupancy grid as a drawing.
#include "apps/grid_picture.hpp"

#include <gmock/gmock.h>

namespace helicoid {
namespace {

TEST(GridPicture, DrawsEachCellOnceInRunsAndTheLowestRowBelow) {
  OccupancyGrid grid;
  grid.frame.width = 3;
  grid.frame.height = 2;
  // Below: free, free, occupied; above: unknown, occupied, occupied.
  grid.hits = {0, 0, 3, 0, 3, 3};
  grid.misses = {3, 3, 0, 0, 0, 0};
  const std::string svg = draw_grid(grid);
  EXPECT_THAT(svg, testing::HasSubstr("d=\"M0 1h2v1h-2z\""));
  EXPECT_THAT(svg, testing::HasSubstr("d=\"M2 1h1v1h-1zM1 0h2v1h-2z\""));
  EXPECT_THAT(svg, testing::HasSubstr("viewBox=\"0 0 3 2\""));
}

}  // namespace
}  // namespace helicoid
