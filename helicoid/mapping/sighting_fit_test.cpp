#include "helicoid/mapping/sighting_fit.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "helicoid/base/random.hpp"

namespace helicoid {
namespace {

Sighting seen_at(const Pose2& T) {
  return {"other", T.distance(), std::atan2(T.y, T.x), T.yaw, 0.03, 0.01, 0.03};
}

TEST(SightingFit, IsPerfectWhereTheRobotIs) {
  const Pose2 T{3, -1, 2.5};
  const SightingFit fit = fit_of(seen_at(T), {T, Matrix3d::Zero()});
  EXPECT_EQ(fit.measurements, 3);
  EXPECT_NEAR(fit.chi2, 0, 1e-20);
  EXPECT_TRUE(fit.agrees());
}

TEST(SightingFit, CountsWhatWasMeasuredAlone) {
  Sighting s = seen_at({3, -1, 2.5});
  s.orientation.reset();
  s.bearing.reset();
  const SightingFit fit = fit_of(s, {Pose2{0, s.range.value() + 0.06, 0}, Matrix3d::Zero()});
  EXPECT_EQ(fit.measurements, 1);
  EXPECT_NEAR(fit.chi2, 4, 1e-9);
}

TEST(SightingFit, IsChiSquaredForNoiseOfThatSize) {
  Random random(3);
  const Pose2 T{2, 1.5, -2};
  double sum = 0;
  int agree = 0;
  constexpr int kRuns = 4000;
  for (int i = 0; i < kRuns; ++i) {
    Sighting s = seen_at(T);
    *s.range += 0.03 * random.normal();
    *s.bearing += 0.01 * random.normal();
    *s.orientation += 0.03 * random.normal();
    UncertainPose2 known{T, Matrix3d::Zero()};
    known.covariance.diagonal() << 0.02 * 0.02, 0.05 * 0.05, 0.02 * 0.02;
    known.T_a_b = Pose2::from_vector(T.vector() +
                                     Vector3d(0.02 * random.normal(), 0.05 * random.normal(), 0.02 * random.normal()));
    const SightingFit fit = fit_of(s, known);
    sum += fit.chi2;
    agree += fit.agrees() ? 1 : 0;
  }
  EXPECT_NEAR(sum / kRuns, 3, 0.2);
  EXPECT_GT(agree, kRuns - 20);
}

TEST(SightingFit, TheWholePoseOfASightingIsWhatItSays) {
  const Pose2 T{-1, 2, 1};
  const std::optional<UncertainPose2> whole = whole_pose(seen_at(T));
  ASSERT_TRUE(whole.has_value());
  EXPECT_NEAR((T.inverse() * whole->T_a_b).distance(), 0, 1e-12);
  EXPECT_TRUE(fit_of(seen_at(T), *whole).agrees());
  Sighting s = seen_at(T);
  s.range.reset();
  EXPECT_FALSE(whole_pose(s).has_value());
}

TEST(SightingFit, WhatIsNotFiniteIsOfNoUse) {
  Sighting s = seen_at({1, 0, 0});
  EXPECT_TRUE(is_usable(s));
  s.sigma_bearing = 0;
  EXPECT_FALSE(is_usable(s));
  s.bearing.reset();
  EXPECT_TRUE(is_usable(s));
  s.range = std::nan("");
  EXPECT_FALSE(is_usable(s));
}

}  // namespace
}  // namespace helicoid
