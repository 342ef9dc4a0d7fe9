#include "helicoid/align/told_by_one_thing.hpp"

#include <gtest/gtest.h>

#include "tests/known_building.hpp"

namespace helicoid {
namespace {

using synthetic::lms200;
using synthetic::look;

std::vector<Segment> corridor_with(const std::vector<Segment>& things) {
  std::vector<Segment> walls{{{0, 0}, {60, 0}}, {{60, 2}, {0, 2}}};
  walls.insert(walls.end(), things.begin(), things.end());
  return walls;
}

/// What is across the corridor this far down it.
Segment across(double x, double from, double to) {
  return {{x, from}, {x, to}};
}

bool told(const std::vector<Segment>& before, const std::vector<Segment>& after) {
  ScanPointExtractor extractor(lms200());
  const Pose2 first{20, 1, 0};
  const ScanPoints seen = extractor.extract(look(RayCaster(corridor_with(before)), lms200(), first));
  const ReferencePart part{&seen, first};
  Reference reference;
  reference.build({&part, 1});
  const ScanPoints scan = extractor.extract(look(RayCaster(corridor_with(after)), lms200(), {20.5, 1, 0}));
  // Odometry has the robot half a metre farther on, the match has it where it was.
  return is_told_by_one_thing(reference, scan, {20.5, 1, 0}, first);
}

TEST(ToldByOneThing, SoIsWhatAPersonWhoWalksAheadTells) {
  EXPECT_TRUE(told({across(24, 0.7, 1.2)}, {across(24.5, 0.7, 1.2)}));
}

TEST(ToldByOneThing, WhatTwoThingsApartFromOneAnotherTellIsNot) {
  EXPECT_FALSE(told({across(24, 0, 0.4), across(24, 1.6, 2)}, {across(24.5, 0, 0.4), across(24.5, 1.6, 2)}));
}

TEST(ToldByOneThing, WhereNothingTellsItIsTrue) {
  EXPECT_TRUE(told({}, {}));
}

}  // namespace
}  // namespace helicoid
