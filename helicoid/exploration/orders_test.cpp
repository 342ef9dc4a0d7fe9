#include "helicoid/exploration/orders.hpp"

#include <gtest/gtest.h>

#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

constexpr RobotId kFirst{0}, kSecond{1};

Order order(OrderKind kind, RobotId robot = {}) {
  Order order;
  order.kind = kind;
  order.robot = robot;
  return order;
}

TEST(Orders, AreInForceUntilResumed) {
  OrderBook book;
  EXPECT_EQ(book.of(kFirst), nullptr);
  book.take(std::vector{order(OrderKind::pause, kFirst)});
  ASSERT_NE(book.of(kFirst), nullptr);
  EXPECT_EQ(book.of(kFirst)->kind, OrderKind::pause);
  EXPECT_EQ(book.of(kSecond), nullptr);
  book.take(std::vector{order(OrderKind::resume, kFirst)});
  EXPECT_EQ(book.of(kFirst), nullptr);
}

TEST(Orders, ToAllReplaceThoseToOneAndTheOtherWayRound) {
  OrderBook book;
  book.take(std::vector{order(OrderKind::home, kFirst), order(OrderKind::pause)});
  EXPECT_EQ(book.of(kFirst)->kind, OrderKind::pause);
  EXPECT_EQ(book.of(kSecond)->kind, OrderKind::pause);
  book.take(std::vector{order(OrderKind::resume, kSecond)});
  EXPECT_EQ(book.of(kFirst)->kind, OrderKind::pause);
  EXPECT_EQ(book.of(kSecond), nullptr);
}

TEST(Orders, ARegionIsForbiddenOnItsIslandWhereverAFitMovesIt) {
  synthetic::Builder builder;
  const auto walls = synthetic::rectangle(0, 0, 8, 6);
  builder.add(walls, {2, 3, 0});
  builder.add(walls, {5, 3, 1.5});
  Order forbid = order(OrderKind::forbid);
  forbid.point = {PatchId{0}, Vector2d::Zero()};
  forbid.region_patch = {{2, -1}, {4, -1}, {4, 1}, {2, 1}};
  OrderBook book;
  book.take(std::vector{forbid});
  EXPECT_TRUE(book.is_forbidden(builder.map, {PatchId{0}, {3, 0}}));
  EXPECT_TRUE(book.is_forbidden(builder.map, {PatchId{1}, {0, 0}}));
  EXPECT_FALSE(book.is_forbidden(builder.map, {PatchId{0}, {1, 0}}));
  MapEditor(builder.map).set_pose(PatchId{0}, {12, 3, 1});
  EXPECT_TRUE(book.is_forbidden(builder.map, {PatchId{0}, {3, 0}}));
  EXPECT_FALSE(book.is_forbidden(builder.map, {PatchId{1}, {0, 0}}));
}

}  // namespace
}  // namespace helicoid
