#include "helicoid/base/random.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace helicoid {
namespace {

TEST(Random, TheSameSeedGivesTheSameNumbersOnEveryMachine) {
  // From the published algorithms, worked out apart from this code.
  Random random(42);
  for (const std::uint64_t expected : {0xd0764d4f4476689fULL, 0x519e4174576f3791ULL, 0xfbe07cfb0c24ed8cULL})
    EXPECT_EQ(random.bits(), expected);
  EXPECT_NE(Random(1).bits(), Random(2).bits());
}

TEST(Random, UniformNumbersFillTheirRangeEvenly) {
  Random random(3);
  constexpr int kDraws = 100000;
  double sum = 0;
  double squares = 0;
  for (int i = 0; i < kDraws; ++i) {
    const double u = random.uniform(-2, 4);
    ASSERT_GE(u, -2);
    ASSERT_LT(u, 4);
    sum += u;
    squares += (u - 1) * (u - 1);
  }
  EXPECT_NEAR(sum / kDraws, 1, 0.03);
  EXPECT_NEAR(squares / kDraws, 3, 0.03);  // width^2 / 12
}

TEST(Random, NormalNumbersHaveTheirMoments) {
  Random random(4);
  constexpr int kDraws = 100000;
  double moments[5] = {};
  for (int i = 0; i < kDraws; ++i) {
    const double n = random.normal();
    for (int k = 1; k < 5; ++k) moments[k] += std::pow(n, k) / kDraws;
  }
  EXPECT_NEAR(moments[1], 0, 0.015);
  EXPECT_NEAR(moments[2], 1, 0.02);
  EXPECT_NEAR(moments[3], 0, 0.06);
  EXPECT_NEAR(moments[4], 3, 0.15);
}

TEST(Random, BelowIsEvenForCountsThatDivideNoPowerOfTwo) {
  Random random(5);
  std::vector<int> counts(7, 0);
  for (int i = 0; i < 70000; ++i) ++counts[random.below(7)];
  for (const int count : counts) EXPECT_NEAR(count, 10000, 400);
  EXPECT_EQ(random.below(1), 0U);
}

TEST(Random, ASplitGeneratorGoesItsOwnWay) {
  Random parent(6), twin(6);
  Random child = parent.split();
  Random other = twin.split();
  for (int i = 0; i < 10; ++i) (void)child.bits();
  EXPECT_EQ(parent.bits(), twin.bits());
  EXPECT_NE(other.bits(), twin.bits());
}

TEST(Random, ChanceIsNeverAtZeroAndAlwaysAtOne) {
  Random random(7);
  for (int i = 0; i < 1000; ++i) {
    EXPECT_FALSE(random.chance(0));
    EXPECT_TRUE(random.chance(1));
  }
}

}  // namespace
}  // namespace helicoid
