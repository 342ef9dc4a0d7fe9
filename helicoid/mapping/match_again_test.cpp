#include "helicoid/mapping/match_again.hpp"

#include <gtest/gtest.h>

#include "helicoid/manifold/content_hash.hpp"
#include "helicoid/mapping/relate.hpp"
#include "tests/synthetic_room.hpp"

namespace helicoid {
namespace {

/// Two views of a room with a pillar, related by their match with the second one `off` from where it lies.
struct TwoViews {
  static constexpr Pose2 kFirst{1.5, 1.5, 0.3};
  static constexpr Pose2 kSecond{2.3, 1.9, 0.5};
  synthetic::Builder builder;
  MapEditor editor{builder.map};

  explicit TwoViews(const Pose2& off) {
    const std::vector<synthetic::Wall> walls = synthetic::pillar_room();
    Relation relation;
    relation.a = builder.add(walls, kFirst);
    relation.b = builder.add(walls, kSecond);
    relation.radius = kMatchRadius;
    relation.T_a_b = kFirst.inverse() * kSecond * off;
    const PairMatch match = match_patches(builder.map.patch(relation.a), builder.map.patch(relation.b), relation.T_a_b);
    relation.form = match.form;
    relation.correspondences = match.correspondences;
    editor.add_relation(relation);
  }
  [[nodiscard]] const Relation& relation() const { return builder.map.relations().front(); }
  [[nodiscard]] Pose2 T_a_b() const { return builder.map.poses()[0].inverse() * builder.map.poses()[1]; }
};

TEST(MatchAgain, AMatchThatWasMadeElsewhereIsMadeAnewWhereItsPatchesLie) {
  TwoViews views({0.1, -0.05, 0});
  const int before = views.relation().correspondences;
  EXPECT_GT(match_again(views.builder.map, views.editor), 0U);
  EXPECT_LT((views.relation().T_a_b.inverse() * views.T_a_b()).distance(), kMatchRadius);
  EXPECT_GT(views.relation().correspondences, before);
  EXPECT_LT(((TwoViews::kFirst.inverse() * TwoViews::kSecond).inverse() * views.T_a_b()).distance(), 0.01);
  EXPECT_EQ(match_again(views.builder.map, views.editor), 0U);
}

TEST(MatchAgain, ATurnCountsAsWell) {
  TwoViews views({0, 0, 0.03});
  EXPECT_GT(match_again(views.builder.map, views.editor), 0U);
}

TEST(MatchAgain, OneThatHoldsIsLeftAsItIs) {
  TwoViews views({0.01, 0, 0.005});
  const auto before = content_hash(views.builder.map);
  EXPECT_EQ(match_again(views.builder.map, views.editor), 0U);
  EXPECT_EQ(content_hash(views.builder.map), before);
}

TEST(MatchAgain, APairThatDoesNotMatchWhereItLiesKeepsWhatItHad) {
  TwoViews views({});
  views.editor.set_pose(PatchId{1}, {100, 0, 0});
  const auto before = content_hash(views.builder.map);
  EXPECT_EQ(match_again(views.builder.map, views.editor), 0U);
  EXPECT_EQ(content_hash(views.builder.map), before);
}

}  // namespace
}  // namespace helicoid
