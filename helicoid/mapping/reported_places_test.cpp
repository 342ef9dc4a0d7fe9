// What another program takes for the same place, told of a robot that goes round a ring (tests/known_building.hpp).
#include "helicoid/mapping/reported_places.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "helicoid/mapping/mapper.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

const synthetic::Drive& rounds() {
  static const synthetic::Drive d = synthetic::drive(3, 2, synthetic::round_the_ring(), synthetic::ring());
  return d;
}

/// Step i is said to be where step `there` was, off by T.
Event report(std::size_t i, std::size_t there, const Pose2& T_true_said = {}) {
  const Pose2 T = rounds().truth[there].inverse() * rounds().truth[i] * T_true_said;
  return {make_id<RobotId>(0), rounds().events[i].stamp,
          Lookalike{"robot1", rounds().events[there].stamp, T, 0.1, 0.03}};
}

/// A step of the first round near which step i truly is.
std::size_t same_place(std::size_t i) {
  const auto& truth = rounds().truth;
  const auto distance = [&](const Pose2& at) { return (truth[i].inverse() * at).distance(); };
  return static_cast<std::size_t>(
      std::min_element(truth.begin(), truth.begin() + static_cast<long>(truth.size() / 3),
                       [&](const Pose2& x, const Pose2& y) { return distance(x) < distance(y); }) -
      truth.begin());
}

/// The robot itself compares no places.
Mapper map_with(const std::vector<std::pair<std::size_t, Event>>& reports) {
  MapperOptions options;
  options.look_alikes = false;
  Mapper mapper(options);
  mapper.add_robot("robot1", {synthetic::lms200()});
  for (std::size_t i = 0; i < rounds().events.size(); ++i) {
    mapper.process(rounds().events[i]);
    for (const auto& [step, event] : reports) {
      if (step == i) mapper.process(event);
    }
  }
  mapper.finish();
  return mapper;
}

std::size_t entries(const Mapper& mapper, HypothesisState state) {
  return static_cast<std::size_t>(std::count_if(mapper.ledger().begin(), mapper.ledger().end(),
                                                [&](const Hypothesis& h) { return h.state == state; }));
}

TEST(ReportedPlaces, OneThatTheScansContradictIsRejected) {
  const std::size_t late = rounds().events.size() / 2;
  const Mapper mapper = map_with({{late, report(late, same_place(late), {1.5, 1.0, 1.2})}});
  EXPECT_EQ(mapper.counts().reported_lookalikes, 1U);
  EXPECT_EQ(entries(mapper, HypothesisState::rejected), 1U);
}

TEST(ReportedPlaces, OneAloneIsNeverActedOn) {
  const std::size_t late = rounds().events.size() / 2;
  const Mapper mapper = map_with({{late, report(late, same_place(late))}});
  EXPECT_EQ(entries(mapper, HypothesisState::accepted), 0U);
}

TEST(ReportedPlaces, OfARobotThatNobodyKnowsIsCounted) {
  Event event = report(5, 2);
  std::get<Lookalike>(event.body).robot = "nobody";
  const Mapper mapper = map_with({{5, event}});
  EXPECT_EQ(mapper.counts().lookalikes_of_nobody, 1U);
  EXPECT_TRUE(mapper.ledger().empty());
}

}  // namespace
}  // namespace helicoid
