#include "common/evaluation/help_curve.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/evaluation/help_curve_plot.h"
#include "tests/support/input_errors.h"

namespace airdos {
namespace {

constexpr auto kRpe = static_cast<std::size_t>(RunFigure::kRpeMedian);
constexpr auto kLost = static_cast<std::size_t>(RunFigure::kLost);

CappedRun Run(const std::string& sequence, const std::string& mode, std::optional<int> cap,
              double rpe_m, double lost_percent) {
  return {sequence, mode, cap, {0.5, rpe_m, 2 * rpe_m, lost_percent}};
}

/// Three sequences at caps 5 and none, in no order.
std::vector<CappedRun> SomeRuns() {
  return {Run("b", "on", 5, 0.01, 10),       Run("a", "mask_only", 5, 0.10, 40),
          Run("a", "on", 5, 0.05, 4),        Run("c", "on", 5, 0.04, 0),
          Run("c", "mask_only", 5, 0.04, 0), Run("b", "mask_only", 5, 0.05, 20),
          Run("a", "on", {}, 0.002, 0),      Run("a", "mask_only", {}, 0.001, 0),
          Run("b", "on", {}, 0.001, 1),      Run("b", "mask_only", {}, 0.001, 0)};
}

TEST(HelpCurve, HandWorkedMediansAndRatios) {
  const HelpCurve curve = ComputeHelpCurve(SomeRuns());
  ASSERT_EQ(curve.points.size(), 2u);
  const HelpPoint& five = curve.points[0];
  EXPECT_EQ(five.cap, 5);
  EXPECT_EQ(five.num_sequences, 3u);
  EXPECT_DOUBLE_EQ(five.mask_only[kRpe].median, 0.05);           // of 0.04 0.05 0.10
  EXPECT_DOUBLE_EQ(five.mask_only[kRpe].lower_quartile, 0.045);  // half-way
  EXPECT_DOUBLE_EQ(five.mask_only[kRpe].upper_quartile, 0.075);
  EXPECT_DOUBLE_EQ(five.on[kRpe].median, 0.04);
  EXPECT_DOUBLE_EQ(five.median_ratio[kRpe], 0.5);   // of 0.5 0.2 1
  EXPECT_DOUBLE_EQ(five.median_ratio[kLost], 0.5);  // of 0.1 0.5 and 0/0 = 1
  EXPECT_NEAR(five.ratio_of_sums[kLost], 14.0 / 60, 1e-12);

  const HelpPoint& uncapped = curve.points[1];
  EXPECT_EQ(uncapped.cap, std::nullopt);
  EXPECT_EQ(uncapped.num_sequences, 2u);
  EXPECT_DOUBLE_EQ(uncapped.median_ratio[kRpe], 1.5);     // of 2 and 1
  EXPECT_TRUE(std::isinf(uncapped.median_ratio[kLost]));  // of 1 and 1/0
  EXPECT_EQ(curve.runs.front().sequence, "a");
  EXPECT_EQ(curve.runs.front().cap, 5);
}

TEST(HelpCurve, RefusesWhatHasNothingToCompareWith) {
  std::vector<CappedRun> runs = SomeRuns();
  runs.erase(runs.begin());
  EXPECT_EQ(ErrorOf([&] { ComputeHelpCurve(runs); }),
            "sequence b, cap 5: no run with on to compare with");
  runs = SomeRuns();
  runs.push_back(runs[0]);
  EXPECT_NE(ErrorOf([&] { ComputeHelpCurve(runs); }).find("is there twice"), std::string::npos);
  runs = SomeRuns();
  runs[0].mode = "off";
  EXPECT_NE(ErrorOf([&] { ComputeHelpCurve(runs); }).find("must be mask_only or on"),
            std::string::npos);
  EXPECT_EQ(ErrorOf([] { ComputeHelpCurve({}); }), "no run at all");
}

TEST(HelpCurve, IsWrittenAndDrawn) {
  const HelpCurve curve = ComputeHelpCurve(SomeRuns());
  const nlohmann::json json = ToJson(curve);
  EXPECT_EQ(json["runs"].size(), 10u);
  EXPECT_TRUE(json["points"][1]["max_observations"].is_null());
  EXPECT_DOUBLE_EQ(json["points"][0]["median_ratio_on_to_mask_only"]["rpe_median_m"], 0.5);
  EXPECT_TRUE(json["points"][1]["median_ratio_on_to_mask_only"]["lost_percent"].is_null());
  const std::string text = ToMarkdown(curve);
  EXPECT_NE(text.find("| a | 5 | mask_only | 0.5000 | 0.1000 | 0.2000 | 40 |"), std::string::npos);
  EXPECT_NE(text.find("- 5, 3 sequences: ATE 1.00 (1.00), RPE-T median 0.50 (0.53)"),
            std::string::npos)
      << text;
  // Both modes' colours are in both panels.
  const cv::Mat picture = DrawHelpCurve(curve);
  for (const cv::Vec3b& color : {cv::Vec3b(40, 40, 200), cv::Vec3b(200, 90, 0)}) {
    for (const int half : {0, 1}) {
      const cv::Mat panel =
          picture.colRange(half * picture.cols / 2, (half + 1) * picture.cols / 2);
      int count = 0;
      for (int row = 0; row < panel.rows; ++row) {
        for (int column = 0; column < panel.cols; ++column) {
          count += panel.at<cv::Vec3b>(row, column) == color ? 1 : 0;
        }
      }
      EXPECT_GT(count, 500);
    }
  }
}

TEST(HelpCurve, ReadsRunsAndNamesTheLine) {
  const std::string path = (std::filesystem::temp_directory_path() /
                            ("airdos_help_curve_test_" + std::to_string(getpid())))
                               .string();
  const std::string row =
      R"("frames": 50, "frames_lost": 5, "ate_m": 1, "rpe_median_m": 2, "rpe_rmse_m": 3})";
  std::ofstream(path) << R"({"sequence": "a", "mode": "on", "max_observations": 8, )" << row << "\n"
                      << R"({"sequence": "a", "mode": "on", "max_observations": null, )" << row
                      << "\n";
  const std::vector<CappedRun> runs = ReadCappedRuns(path);
  ASSERT_EQ(runs.size(), 2u);
  EXPECT_EQ(runs[0].cap, 8);
  EXPECT_EQ(runs[1].cap, std::nullopt);
  EXPECT_EQ(runs[0].figures, (RunFigures{1, 2, 3, 10}));
  std::ofstream(path) << R"({"sequence": "a", "mode": "on"})";
  EXPECT_NE(ErrorOf([&] { ReadCappedRuns(path); }).find(path + ":1: "), std::string::npos);
  // Found by fuzzing: a number that no int holds.
  std::ofstream(path) << R"({"sequence": "a", "mode": "on", "max_observations": 3e98, )" << row;
  EXPECT_NE(ErrorOf([&] { ReadCappedRuns(path); }).find("is not a whole number"),
            std::string::npos);
  std::filesystem::remove(path);
  EXPECT_EQ(ErrorOf([&] { ReadCappedRuns(path); }),
            path + ": cannot be read: No such file or directory");
}

}  // namespace
}  // namespace airdos
