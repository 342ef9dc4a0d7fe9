#include "helicoid/fit/pose_marks.hpp"

#include <gtest/gtest.h>

namespace helicoid {
namespace {

TEST(PoseMarks, AreForgottenWhenTheyAreNoLongerUsed) {
  {
    PoseMarks marks(100);
    marks.set(7, 3);
    marks.set(7, 4);
    EXPECT_EQ(marks[7], 4);
  }
  const PoseMarks again(200);
  for (std::uint32_t pose = 0; pose < 200; ++pose) EXPECT_EQ(again[pose], PoseMarks::kNone);
}

TEST(PoseMarks, OfTwoUsesAtATimeKeepApart) {
  PoseMarks first(10);
  first.set(1, 5);
  PoseMarks second(10);
  second.set(1, 6);
  EXPECT_EQ(first[1], 5);
  EXPECT_EQ(second[1], 6);
}

}  // namespace
}  // namespace helicoid
