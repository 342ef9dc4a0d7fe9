// Sightings, true and false, of two robots that drive through one building (tests/known_building.hpp).
#include "helicoid/mapping/join_on_sightings.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "helicoid/manifold/content_hash.hpp"
#include "helicoid/mapping/mapper.hpp"
#include "tests/known_building.hpp"

namespace helicoid {
namespace {

constexpr std::size_t kFirst = 0;
constexpr std::size_t kSecond = 1;

struct Meeting {
  synthetic::Drive first = synthetic::drive(1, 5);
  synthetic::Drive second = synthetic::drive(1, 6, backwards());
  std::size_t steps = std::min(first.events.size(), second.events.size());

  static std::vector<Vector2d> backwards() {
    std::vector<Vector2d> stops = synthetic::through_all_rooms();
    std::reverse(stops.begin(), stops.end());
    return stops;
  }
  /// What one sees of the other at a step, if it stands at T from where it truly does.
  [[nodiscard]] Event see(std::size_t i, const std::string& name, const Pose2& T_true_said = {}) const {
    const Pose2 T = first.truth[i].inverse() * second.truth[i] * T_true_said;
    return {make_id<RobotId>(kFirst), first.events[i].stamp,
            Sighting{name, T.distance(), std::atan2(T.y, T.x), T.yaw, 0.03, 0.01, 0.03}};
  }
  /// Maps with these sightings, each after the step of its stamp.
  [[nodiscard]] Mapper map(const std::vector<std::pair<std::size_t, Event>>& sightings,
                           std::vector<Decision> decisions = {}) const {
    MapperOptions options;
    options.decisions = std::move(decisions);
    Mapper mapper(options);
    mapper.add_robot("first", {synthetic::lms200()});
    mapper.add_robot("second", {synthetic::lms200()});
    for (std::size_t i = 0; i < steps; ++i) {
      mapper.process(first.events[i]);
      for (const auto& [step, event] : sightings) {
        if (step == i) mapper.process(event);
      }
      Event event = second.events[i];
      event.robot = make_id<RobotId>(kSecond);
      mapper.process(event);
    }
    mapper.finish();
    return mapper;
  }
  /// How far the second robot's start lies from where it truly does, seen from the first's; infinite on two islands.
  [[nodiscard]] double error(const Map& map) const {
    if (map.islands().size() > 1) return HUGE_VAL;
    const Pose2 T =
        map.project(map.robots()[0].trajectory[0].pose).inverse() * map.project(map.robots()[1].trajectory[0].pose);
    return ((first.truth[0].inverse() * second.truth[0]).inverse() * T).distance();
  }
};

const Meeting& meeting() {
  static const Meeting m;
  return m;
}

const Hypothesis& entry_at(const Mapper& mapper, double stamp) {
  return *std::find_if(mapper.ledger().begin(), mapper.ledger().end(),
                       [&](const Hypothesis& h) { return h.seen && std::abs(h.seen->stamp - stamp) < 1e-9; });
}

TEST(Sightings, AFalseOneIsRejectedByTheScansAndTheTrueOneJoins) {
  const std::size_t half = meeting().steps / 2;
  const Event lie = meeting().see(half - 40, "second", {2.5, 1.5, 1});
  const Event truth = meeting().see(half, "second");
  const Mapper mapper = meeting().map({{half - 40, lie}, {half, truth}});
  EXPECT_LT(meeting().error(mapper.map()), 0.15);
  EXPECT_EQ(entry_at(mapper, lie.stamp).state, HypothesisState::rejected);
  EXPECT_EQ(entry_at(mapper, truth.stamp).state, HypothesisState::accepted);
  EXPECT_TRUE(mapper.regrets().empty());
}

TEST(Sightings, ARobotThatWasNotIdentifiedIsTakenForTheOneThatTheScansConfirm) {
  const std::size_t half = meeting().steps / 2;
  const Event seen = meeting().see(half, "?");
  const Mapper mapper = meeting().map({{half, seen}});
  EXPECT_EQ(mapper.counts().unidentified_sightings, 1U);
  EXPECT_LT(meeting().error(mapper.map()), 0.15);
  const Hypothesis& h = entry_at(mapper, seen.stamp);
  EXPECT_EQ(h.state, HypothesisState::accepted);
  EXPECT_EQ(h.seen->identified, make_id<RobotId>(kSecond));
}

TEST(Sightings, AfterTheIslandsAreJoinedEachIsJudgedByTheMap) {
  const std::size_t half = meeting().steps / 2;
  const Event lie = meeting().see(half + 60, "second", {0.8, 0, 0.3});
  const Event later = meeting().see(half + 40, "second");
  const Mapper mapper = meeting().map({{half, meeting().see(half, "second")}, {half + 40, later}, {half + 60, lie}});
  EXPECT_EQ(entry_at(mapper, later.stamp).state, HypothesisState::accepted);
  EXPECT_EQ(entry_at(mapper, later.stamp).decided_by, DecidedBy::evidence);
  EXPECT_EQ(entry_at(mapper, lie.stamp).state, HypothesisState::rejected);
}

TEST(Sightings, OneThatTheOperatorRejectsIsAsThoughItHadNeverBeenSeen) {
  const std::size_t half = meeting().steps / 2;
  const Event seen = meeting().see(half, "second");
  const Mapper believed = meeting().map({{half, seen}});
  const Hypothesis& h = entry_at(believed, seen.stamp);
  const Decision no{HypothesisState::rejected, h.source, first_place(believed.map(), h),
                    second_place(believed.map(), h)};
  EXPECT_EQ(content_hash(meeting().map({{half, seen}}, {no}).map()), content_hash(meeting().map({}).map()));
}

TEST(Sightings, AnOperatorWhoAcceptsOneIsNotContradicted) {
  const std::size_t half = meeting().steps / 2;
  const Event lie = meeting().see(half, "second", {2.5, 1.5, 1});
  const Mapper doubted = meeting().map({{half, lie}});
  const Hypothesis& h = entry_at(doubted, lie.stamp);
  ASSERT_EQ(h.state, HypothesisState::rejected);
  const Mapper ordered = meeting().map(
      {{half, lie}},
      {{HypothesisState::accepted, h.source, first_place(doubted.map(), h), second_place(doubted.map(), h)}});
  EXPECT_EQ(ordered.map().islands().size(), 1U);
  EXPECT_TRUE(ordered.regrets().empty());
}

}  // namespace
}  // namespace helicoid
