#include <gtest/gtest.h>

#include "common/evaluation/identity.h"

namespace airdos {
namespace {

TEST(Identity, PerfectTracks) {
  IdentityEvaluator evaluator;
  for (int frame = 0; frame < 5; ++frame) evaluator.AddFrame({1, 2}, {{10, 1}, {11, 2}});
  const IdentityScore score = evaluator.Score();
  EXPECT_EQ(score.num_switches, 0);
  EXPECT_EQ(score.num_people, 2);
  EXPECT_DOUBLE_EQ(score.idf1, 1);
}

TEST(Identity, ASwitchCostsTheShorterPart) {
  IdentityEvaluator evaluator;
  for (int frame = 0; frame < 6; ++frame) evaluator.AddFrame({1}, {{10, 1}});
  for (int frame = 0; frame < 4; ++frame) evaluator.AddFrame({1}, {{11, 1}});
  const IdentityScore score = evaluator.Score();
  EXPECT_EQ(score.num_switches, 1);
  EXPECT_DOUBLE_EQ(score.idf1, 2 * 6.0 / (10 + 10));
}

TEST(Identity, MissesAndFalseTracksCount) {
  IdentityEvaluator evaluator;
  evaluator.AddFrame({1}, {});
  evaluator.AddFrame({1}, {{10, 1}, {12, std::nullopt}});
  evaluator.AddFrame({}, {{10, 1}});  // not to be seen, but it is there: neither right nor wrong
  const IdentityScore score = evaluator.Score();
  EXPECT_DOUBLE_EQ(score.id_recall, 0.5);
  EXPECT_DOUBLE_EQ(score.id_precision, 0.5);
  EXPECT_DOUBLE_EQ(score.idf1, 0.5);
}

TEST(Identity, NothingAtAll) { EXPECT_DOUBLE_EQ(IdentityEvaluator().Score().idf1, 1); }

}  // namespace
}  // namespace airdos
