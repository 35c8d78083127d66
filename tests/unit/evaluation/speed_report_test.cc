#include "common/evaluation/speed_report.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <string>

#include "common/util/error.h"

namespace airdos {
namespace {

class SpeedReportTest : public testing::Test {
 protected:
  std::string Write(const std::string& text) const {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    const std::string path = testing::TempDir() + "airdos_speed_" + info->name();
    std::ofstream(path) << text;
    return path;
  }
};

constexpr char kRows[] = R"({"sequence": "one", "num_frames": 100,
 "processes": {"frontend": {"p50_ms": 20.25, "p99_ms": 31, "peak_memory_mb": 90.5},
               "optimizer": {"p50_ms": 40, "p99_ms": 61}},
 "serial_fps": 12, "parallel_fps": 21.5, "replay_memory_mb": 150, "live_fps": null})";

constexpr char kSolver[] = R"({"context": {}, "benchmarks": [
 {"name": "BM_PaperProblem/artic/full/structured", "cpu_time": 5, "time_unit": "ms",
  "median_ms": 4.5, "ms_per_iteration": 0.5},
 {"name": "BM_PaperProblem/artic/full/ceres", "cpu_time": 25000, "time_unit": "us"},
 {"name": "BM_Scaling/30/20/structured/warm", "cpu_time": 6e7, "time_unit": "ns"},
 {"name": "BM_Scaling/10/20/structured/warm", "cpu_time": 2e7, "time_unit": "ns"},
 {"name": "BM_Scaling/30/10/structured/warm", "cpu_time": 1, "time_unit": "s"},
 {"name": "BM_Scaling/5/20/ceres/cold", "error_occurred": true, "cpu_time": 0, "time_unit": "ns"},
 {"name": "BM_Other/3", "cpu_time": 1, "time_unit": "ms"}]})";

std::string OneLine(std::string text) {
  for (char& c : text) c = c == '\n' ? ' ' : c;
  return text;
}

TEST_F(SpeedReportTest, TheChainsTable) {
  const auto chains = ReadChainSpeeds(Write(OneLine(kRows) + "\n"));
  ASSERT_EQ(chains.size(), 1u);
  const std::string text = ToMarkdown(chains, {});
  EXPECT_NE(text.find("| one | 100 | 20.2 / 31.0, 90.5 | 40.0 / 61.0, - | 12.0 | 21.5 | 150 | - | "
                      "- |"),
            std::string::npos)
      << text;
  EXPECT_EQ(ToJson(chains, {})["sequences"][0]["parallel_fps"], 21.5);
}

TEST_F(SpeedReportTest, TheSolversTables) {
  const auto solves = ReadSolveTimes(Write(kSolver));
  ASSERT_EQ(solves.size(), 5u);
  const std::string text = ToMarkdown({}, solves);
  EXPECT_NE(text.find("| artic/full | 25.00, - | 4.50, 0.50 |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 30 | 20 | warm | 60.00, - |"), std::string::npos) << text;
  EXPECT_NE(text.find("| 30 | 10 | warm | 1000.00, - |"), std::string::npos) << text;
  EXPECT_EQ(ToJson({}, solves)["solves"].size(), 5u);
}

TEST_F(SpeedReportTest, ThePictureHasAPanelForEachPart) {
  const auto chains = ReadChainSpeeds(Write(OneLine(kRows)));
  const auto solves = ReadSolveTimes(Write(kSolver));
  const cv::Mat all = DrawSpeed(chains, solves);
  EXPECT_EQ(all.cols, 3 * DrawSpeed(chains, {}).cols);
  EXPECT_EQ(all.cols * 2, 3 * DrawSpeed({}, solves).cols);
  EXPECT_LT(cv::mean(all)[0], 254);  // something is on it
}

TEST_F(SpeedReportTest, WhatIsNoReportIsSaid) {
  EXPECT_THROW(ReadChainSpeeds("/nonexistent"), InputError);
  EXPECT_THROW(ReadChainSpeeds(Write("{\"sequence\": \"one\"}")), InputError);
  EXPECT_THROW(ReadSolveTimes(Write("not JSON")), InputError);
  EXPECT_THROW(ReadSolveTimes(Write(R"({"benchmarks": [{"name": "BM_Scaling/x/5/ceres/cold",
      "cpu_time": 1, "time_unit": "ms"}]})")),
               InputError);
  EXPECT_THROW(ReadSolveTimes(Write(R"({"benchmarks": [{"name": "BM_Scaling/1/5/ceres/cold",
      "cpu_time": 1, "time_unit": "h"}]})")),
               InputError);
}

}  // namespace
}  // namespace airdos
