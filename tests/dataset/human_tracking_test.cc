// The human tracker on whole sequences with known people: each figure within its band
// (tests/dataset/bands.txt).
#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/config/config_reader.h"
#include "common/util/quantile.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "tests/support/bands.h"
#include "tests/support/human_scoring.h"
#include "tests/support/test_overrides.h"

namespace airdos {
namespace {

std::string DataFolder() {
  const char* folder = std::getenv("AIRDOS_DATA_DIR");
  return folder != nullptr ? folder : AIRDOS_SOURCE_DIR "/../shared/data";
}

HumanTrackerOptions Options() {
  const std::string process = "human_tracker:";
  ConfigReader config =
      ConfigReader::FromFile(AIRDOS_SOURCE_DIR "/launch_scripts/config/human_tracker.yaml");
  for (const std::string& text : TestOverrides()) {
    if (text.compare(0, process.size(), process) == 0) config.Override(text.substr(process.size()));
  }
  return ReadHumanTrackerOptions(&config);
}

double Percent(int part, int whole) { return 100.0 * part / whole; }

Figures FiguresOf(const HumanScore& score) {
  return {{"pairs_found_percent", 100 * score.PairRecall()},
          {"pairs_wrong_percent", 100 * (1 - score.PairPrecision())},
          {"people_found_percent", Percent(score.num_visible_found, score.num_visible)},
          {"people_false_percent", Percent(score.num_false, score.num_reported)},
          {"people_swapped_percent", Percent(score.num_swapped_sides, score.num_reported)},
          {"joints", score.num_joints},
          {"joint_error_median_m", score.MedianJointError()},
          {"joint_error_mean_m", score.MeanJointError()},
          {"depth_bias_m", Quantile(score.depth_bias_m, 0.5)},
          {"normalised_error", score.sum_normalised_squared / (3 * score.num_normalised)},
          {"switches", score.identity.num_switches},
          {"idf1", score.identity.idf1}};
}

class HumanTrackingOnCrossing : public testing::TestWithParam<std::string> {};

TEST_P(HumanTrackingOnCrossing, StaysInTheBands) {
  const std::string folder = DataFolder() + "/crossing/" + GetParam();
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  cv::setNumThreads(1);
  const HumanScore score = ScoreCrossing(Options(), folder);
  std::printf("%s\n%s\n", HumanScore::TableHead().c_str(), score.Table().c_str());
  ExpectInBands(GetParam() + "/tracking", FiguresOf(score));
}

INSTANTIATE_TEST_SUITE_P(All, HumanTrackingOnCrossing,
                         testing::Values("Standing01", "Standing02", "RoadCrossing03",
                                         "RoadCrossing04", "RoadCrossing05", "RoadCrossing06",
                                         "RoadCrossing07"),
                         [](const auto& sequence) { return sequence.param; });

}  // namespace
}  // namespace airdos
