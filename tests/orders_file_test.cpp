// An operator's orders are read as written, and a line that says nothing is refused with its place.
#include "apps/orders_file.hpp"

#include <gmock/gmock.h>

namespace helicoid {
namespace {

TEST(Orders, AreReadInTheOrderOfTheirTimes) {
  const auto orders = parse_orders(
      "# an operator\n20 all pause\n\n 5.5 robot2 send 3 -4.5  # there\n30 all forbid 0 0 1 0 1 1\n", "orders");
  ASSERT_TRUE(orders) << orders.error().message;
  ASSERT_EQ(orders->size(), 3U);
  EXPECT_EQ((*orders)[0].kind, OrderKind::send);
  EXPECT_EQ((*orders)[0].robot, "robot2");
  EXPECT_EQ((*orders)[0].places.front(), Vector2d(3, -4.5));
  EXPECT_EQ((*orders)[1].kind, OrderKind::pause);
  EXPECT_EQ((*orders)[1].robot, "");
  EXPECT_EQ((*orders)[2].places.size(), 3U);
}

TEST(Orders, WhatSaysNothingIsRefusedWithItsLine) {
  for (const char* wrong : {"soon all pause", "5 all", "5 all dance", "5 all send 3", "5 all send 3 x",
                            "5 all pause 1 2", "5 all forbid 0 0 1 1", "5 all send nan 1", "inf all pause"}) {
    const auto orders = parse_orders(std::string("0 all resume\n") + wrong + "\n", "orders.txt");
    ASSERT_FALSE(orders) << wrong;
    EXPECT_THAT(orders.error().message, testing::HasSubstr("orders.txt:2:"));
  }
}

}  // namespace
}  // namespace helicoid
