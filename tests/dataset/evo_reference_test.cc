// Our figures against those of the evo package for real trajectories.
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/evaluation/trajectory_report.h"

namespace airdos {
namespace {

// Both sides compute in double precision from the same decimals.
constexpr double kRelativeTolerance = 1e-6;

void ExpectSame(const Statistics& actual, const nlohmann::json& expected, const std::string& what) {
  const std::pair<const char*, double> values[] = {{"rmse", actual.rmse},
                                                   {"mean", actual.mean},
                                                   {"median", actual.median},
                                                   {"max", actual.max},
                                                   {"std", actual.std}};
  for (const auto& [name, value] : values) {
    const double reference = expected.at(name).get<double>();
    EXPECT_NEAR(value, reference, kRelativeTolerance * reference) << what << " " << name;
  }
}

TEST(EvoReferenceTest, AllFiguresAgree) {
  const char* const given = std::getenv("AIRDOS_DATA_DIR");
  const std::string data = given != nullptr ? given : AIRDOS_SOURCE_DIR "/../shared/data";
  const std::string folder = data + "/evo_reference/";
  std::ifstream file(folder + "reference.json");
  if (!file) GTEST_SKIP() << "no evo reference in " << folder << " (AIRDOS_DATA_DIR)";
  const nlohmann::json references = nlohmann::json::parse(file);
  ASSERT_EQ(references.size(), 4u);
  for (const nlohmann::json& reference : references) {
    const std::string name = reference.at("name");
    EvaluationOptions options;
    if (!reference.at("max_time_difference_s").is_null()) {
      options.max_time_difference_s = reference.at("max_time_difference_s");
    }
    const TrajectoryReport report = EvaluateTrajectory(
        ReadTrajectory(folder + reference.at("estimate").get<std::string>()),
        ReadTrajectory(folder + reference.at("ground_truth").get<std::string>()), options);
    EXPECT_EQ(report.num_matched, reference.at("matched_poses").get<std::size_t>()) << name;
    EXPECT_EQ(report.axes, GroundTruthAxes::Optical()) << name << ": " << report.axes_reason;
    ExpectSame(report.ate_none_m, reference.at("ate_none_m"), name + " ate none");
    ExpectSame(report.ate_se3_m, reference.at("ate_se3_m"), name + " ate SE(3)");
    ExpectSame(report.ate_sim3_m, reference.at("ate_sim3_m"), name + " ate Sim(3)");
    ExpectSame(report.rpe_translation_per_frame_m, reference.at("rpe_translation_per_frame_m"),
               name + " rpe translation");
    ExpectSame(report.rpe_rotation_per_frame_deg, reference.at("rpe_rotation_per_frame_deg"),
               name + " rpe rotation");
  }
}

}  // namespace
}  // namespace airdos
