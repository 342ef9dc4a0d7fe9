#include "helicoid/align/open_direction.hpp"

#include <gtest/gtest.h>

#include "helicoid/base/random.hpp"
#include "helicoid/geometry/pose2.hpp"

namespace helicoid {
namespace {

Eigen::Vector2f at(double degrees_) {
  return {static_cast<float>(std::cos(radians(degrees_))), static_cast<float>(std::sin(radians(degrees_)))};
}

/// Walls on both sides of a corridor that runs at 30 degrees, their normals off by up to five degrees.
std::vector<Eigen::Vector2f> corridor_normals() {
  Random random(2);
  std::vector<Eigen::Vector2f> normals;
  normals.reserve(100);
  for (int i = 0; i < 100; ++i) normals.push_back(at((i % 2 == 0 ? 120 : -60) + random.uniform(-5, 5)));
  return normals;
}

NormalScatter scatter_of(const std::vector<Eigen::Vector2f>& normals) {
  NormalScatter scatter;
  for (const Eigen::Vector2f& n : normals) scatter.add(n.x(), n.y(), 0.7);
  return scatter;
}

TEST(OpenDirection, IsAlongACorridor) {
  const auto open = scatter_of(corridor_normals()).open_direction();
  ASSERT_TRUE(open.has_value());
  EXPECT_GT(std::abs(open->dot(at(30))), 0.999F);
}

TEST(OpenDirection, AlongACorridorNormalsSayNothingButThoseOfWhatStandsAcross) {
  std::vector<Eigen::Vector2f> normals = corridor_normals();
  const Eigen::Vector2f jamb = at(205);
  normals.push_back(jamb);
  const auto open = scatter_of(normals).open_direction();
  ASSERT_TRUE(open.has_value());
  for (const Eigen::Vector2f& n : corridor_normals()) {
    const Eigen::Vector2f squared = squared_to(*open, n);
    EXPECT_LT(std::abs(open->dot(squared)), 1e-6F);
    EXPECT_NEAR(squared.norm(), 1, 1e-6F);
    EXPECT_GT(squared.dot(n), 0.99F);
  }
  EXPECT_EQ(squared_to(*open, jamb), jamb);
}

TEST(OpenDirection, InARoomThereIsNone) {
  std::vector<Eigen::Vector2f> normals = corridor_normals();
  for (int i = 0; i < 8; ++i) normals.push_back(at(30));
  EXPECT_FALSE(scatter_of(normals).open_direction().has_value());
  EXPECT_FALSE(NormalScatter{}.open_direction().has_value());
}

}  // namespace
}  // namespace helicoid
