#include "helicoid/align/score_pyramid.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <random>

namespace helicoid {
namespace {

Reference scattered(unsigned seed) {
  std::mt19937 random(seed);
  std::uniform_real_distribution<float> place(-2.5F, 4.0F);
  ScanPoints points;
  for (std::uint16_t i = 0; i < 40; ++i) {
    points.x.push_back(place(random));
    points.y.push_back(place(random));
    points.nx.push_back(1);
    points.ny.push_back(0);
    points.weight.push_back(1);
    points.facing.push_back(1);
    points.beam.push_back(i);
  }
  Reference reference;
  const ReferencePart part{&points, Pose2{}};
  reference.build({&part, 1});
  return reference;
}

TEST(ScorePyramid, ASquareScoresTheMostOfItsCells) {
  const ScorePyramid pyramid(scattered(3));
  for (int level = 1; level < ScorePyramid::kLevels; ++level) {
    const int side = 1 << level;
    for (int row = -20; row < 90; row += 3) {
      for (int column = -20; column < 90; column += 3) {
        int most = 0;
        for (int r = 0; r < side; ++r) {
          for (int c = 0; c < side; ++c) most = std::max(most, pyramid.at(0, column + c, row + r));
        }
        ASSERT_EQ(pyramid.at(level, column, row), most) << level << ' ' << column << ' ' << row;
      }
    }
  }
}

TEST(ScorePyramid, OnASurfaceTheScoreIsFullAndFarFromAllItIsNothing) {
  const Reference reference = scattered(4);
  const ScorePyramid pyramid(reference);
  for (std::size_t i = 0; i < reference.size(); ++i) {
    const ScoreCell cell = pyramid.cell_of(reference.element(i).x, reference.element(i).y);
    EXPECT_GT(pyramid.at(0, cell.column, cell.row), 0.9 * ScorePyramid::kFull);
  }
  const ScoreCell far = pyramid.cell_of(40, -40);
  EXPECT_EQ(pyramid.at(0, far.column, far.row), 0);
}

TEST(ScorePyramid, OfAnEmptyReferenceNothingScores) {
  const ScorePyramid pyramid((Reference()));
  EXPECT_EQ(pyramid.at(4, 0, 0), 0);
}

}  // namespace
}  // namespace helicoid
