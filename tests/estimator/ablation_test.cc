// What people are worth to the camera, on simulated sequences: facts that are provable, and gains
// that were measured. Seeds here are not those of the tables in the README.
#include "processes/tools/evaluate/ablation.h"

#include <gtest/gtest.h>

#include <cmath>
#include <iostream>
#include <vector>

#include "common/simulation/settings.h"
#include "common/util/quantile.h"
#include "processes/tools/evaluate/ablation_report.h"
#include "processes/tools/evaluate/do_no_harm.h"

namespace airdos {
namespace {

constexpr std::uint64_t kFirstSeed = 9000;

double Mean(const std::vector<AblationErrors>& runs, double AblationErrors::*value) {
  double sum = 0;
  for (const AblationErrors& errors : runs) sum += errors.*value;
  return sum / static_cast<double>(runs.size());
}

const std::vector<AblationErrors>& Row(const AblationGroup& group, AblationRow row) {
  return group.rows[static_cast<std::size_t>(row)];
}

class PaperGroupTest : public testing::TestWithParam<std::string> {};

TEST_P(PaperGroupTest, TheTableShowsWhatIsProvableAndWhatWasMeasured) {
  const AblationGroup group = RunAblation({}, GetParam(), kFirstSeed, 3, nullptr);
  std::cout << ToTable(group) << "\n";
  for (const AblationRow row : AblationRows()) {
    for (const AblationErrors& errors : Row(group, row)) EXPECT_TRUE(errors.has_converged);
  }
  const auto& fixed = Row(group, AblationRow::kStatic);
  const auto& without_motion = Row(group, AblationRow::kWithoutMotion);
  const auto& full = Row(group, AblationRow::kFull);
  // Moving a camera together with all its dynamic points changes no residual.
  for (std::size_t i = 0; i < fixed.size(); ++i) {
    EXPECT_NEAR(without_motion[i].ate_aligned_m / fixed[i].ate_aligned_m, 1, 1e-3);
    EXPECT_NEAR(without_motion[i].ate_unaligned_m / fixed[i].ate_unaligned_m, 1, 1e-3);
    EXPECT_NEAR(without_motion[i].rpe_m / fixed[i].rpe_m, 1, 1e-3);
    EXPECT_NEAR(without_motion[i].rpe_deg / fixed[i].rpe_deg, 1, 1e-3);
  }
  const auto ratio = [&](double AblationErrors::*value) {
    return Mean(full, value) / Mean(fixed, value);
  };
  EXPECT_LT(ratio(&AblationErrors::ate_aligned_m), 0.70);
  EXPECT_LT(ratio(&AblationErrors::rpe_m), 0.62);
  EXPECT_LT(ratio(&AblationErrors::rpe_deg), 0.88);
  EXPECT_LT(Mean(without_motion, &AblationErrors::dynamic_m),
            0.85 * Mean(fixed, &AblationErrors::dynamic_m));
}

INSTANTIATE_TEST_SUITE_P(Groups, PaperGroupTest, testing::ValuesIn(PaperGroups()));

struct Walkers {
  std::vector<double> ate_ratio, rpe_ratio;
  int num_failed_static = 0, num_failed_full = 0;  // ATE over 10 cm
};

Walkers RunWalkers(const std::string& setting, int num_sequences) {
  AblationOptions options;  // the last digits of rigidity change nothing here
  options.function_tolerance = 1e-5;
  options.max_iterations = 60;
  Walkers walkers;
  for (int i = 0; i < num_sequences; ++i) {
    const SimulatedSequence sequence =
        Simulate(SettingByName(setting, kFirstSeed + static_cast<std::uint64_t>(i)));
    const Ablation ablation(options, sequence);
    const AblationErrors fixed = ablation.Run(AblationRow::kStatic);
    const AblationErrors full = ablation.Run(AblationRow::kFull);
    walkers.ate_ratio.push_back(full.ate_aligned_m / fixed.ate_aligned_m);
    walkers.rpe_ratio.push_back(full.rpe_m / fixed.rpe_m);
    walkers.num_failed_static += fixed.ate_aligned_m > 0.1 ? 1 : 0;
    walkers.num_failed_full += full.ate_aligned_m > 0.1 ? 1 : 0;
  }
  return walkers;
}

TEST(WalkersTest, EightStaticLandmarksGainMuch) {
  const Walkers walkers = RunWalkers("walkers8", 8);
  EXPECT_LT(Quantile(walkers.ate_ratio, 0.5), 0.65);
  EXPECT_LT(Quantile(walkers.rpe_ratio, 0.5), 0.60);
}

TEST(WalkersTest, WithoutAlmostAnyStaticLandmarkPeopleCarryTheCamera) {
  const Walkers walkers = RunWalkers("walkers3", 8);
  EXPECT_GE(walkers.num_failed_static, 6);
  EXPECT_LE(walkers.num_failed_full, 1);  // two in sixteen
}

TEST(WalkersTest, FiftyStaticLandmarksAreNotSpoiled) {
  const Walkers walkers = RunWalkers("walkers50", 6);
  EXPECT_LT(Quantile(walkers.ate_ratio, 0.5), 1.02);
  EXPECT_LT(Quantile(walkers.rpe_ratio, 0.5), 1.02);
}

class DoNoHarmTest : public testing::TestWithParam<std::string> {};

TEST_P(DoNoHarmTest, PeopleNeverMakeTheCameraWorse) {
  const DoNoHarmSetting result =
      RunDoNoHarm(DefaultDoNoHarmOptions(), GetParam(), kFirstSeed, 5, nullptr);
  std::cout << DoNoHarmTitle() << ToLine(result);
  std::vector<double> ratios;
  for (const DoNoHarmRun& run : result.runs) {
    ratios.push_back(run.AteRatio());
    EXPECT_LT(run.AteRatio(), 1.10) << "seed " << run.seed;
  }
  EXPECT_LT(Quantile(ratios, 0.5), 1.02);
}

INSTANTIATE_TEST_SUITE_P(Settings, DoNoHarmTest,
                         testing::Values("turn30", "stop30", "sit30", "swap30", "erratic30",
                                         "swap8"));

TEST(AblationTest, TheSameSeedGivesTheSameFigures) {
  const SimulatedSequence sequence = Simulate(SettingByName("walkers8", kFirstSeed));
  const Ablation ablation({}, sequence);
  const AblationErrors a = ablation.Run(AblationRow::kWithoutRigidity);
  const AblationErrors b = ablation.Run(AblationRow::kWithoutRigidity);
  EXPECT_EQ(a.ate_aligned_m, b.ate_aligned_m);
  EXPECT_EQ(a.rpe_deg, b.rpe_deg);
}

TEST(AblationTest, ExactMeasurementsGiveTheTruth) {
  SimulationOptions options = SettingByName("group1", kFirstSeed);
  options.point_sigma_m = 0;
  options.num_frames = 12;
  const SimulatedSequence sequence = Simulate(options);
  const Ablation ablation({}, sequence);
  for (const AblationRow row : {AblationRow::kStatic, AblationRow::kWithoutMotion}) {
    const AblationErrors errors = ablation.Run(row);
    EXPECT_LT(errors.ate_unaligned_m, 1e-5) << NameOf(row);
    EXPECT_LT(errors.dynamic_m, 1e-5) << NameOf(row);
  }
  EXPECT_GT(ablation.Run(AblationRow::kBefore).ate_unaligned_m, 0.05);
}

}  // namespace
}  // namespace airdos
