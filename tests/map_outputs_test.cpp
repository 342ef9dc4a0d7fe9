// What is drawn of a map.
#include "apps/map_outputs.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

TEST(MapOutputs, TheDrawnTopologyLeadsWhereARobotDroveAsItsRoutesDo) {
  synthetic::Builder builder;
  const auto walls = synthetic::rectangle(0, 0, 8, 6);
  builder.add(walls, {2, 3, 0});
  builder.add(walls, {4, 3, 0});
  const MapReport report = report_on(builder.map, true);
  ASSERT_TRUE(report.neighbours[0].empty()) << "nothing relates the two patches";
  const SketchDrawing drawing = draw_sketch(builder.map, report, report.islands.front(), 1);
  ASSERT_EQ(drawing.topology->nodes.size(), 2U);
  EXPECT_EQ(drawing.topology->edges.size(), 1U);
}

}  // namespace
}  // namespace helicoid
