#include <gtest/gtest.h>

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <opencv2/core.hpp>
#include <ostream>
#include <string>

#include "tests/support/human_scoring.h"

namespace airdos {
namespace {

std::string DataFolder() {
  const char* folder = std::getenv("AIRDOS_DATA_DIR");
  return folder != nullptr ? folder : AIRDOS_SOURCE_DIR "/../shared/data";
}

// What the tracker reached when the band was set (2026-11), with room for small changes.
struct Band {
  const char* sequence;
  double max_median_error_m;
  int max_switches;
  double min_idf1;

  // GoogleTest prints parameters into names; without it, as raw bytes.
  friend std::ostream& operator<<(std::ostream& out, const Band& band) {
    return out << band.sequence;
  }
};

std::string SequenceName(const testing::TestParamInfo<Band>& info) { return info.param.sequence; }

class HumanTrackingOnCrossing : public testing::TestWithParam<Band> {};

TEST_P(HumanTrackingOnCrossing, StaysInTheBand) {
  const std::string folder = DataFolder() + "/crossing/" + GetParam().sequence;
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << folder << " is not there";
  cv::setNumThreads(1);
  const HumanScore score = ScoreCrossing({}, folder);
  std::printf("%s\n%s\n", HumanScore::TableHead().c_str(), score.Table().c_str());
  EXPECT_GT(score.PairRecall(), 0.97);
  EXPECT_GT(score.PairPrecision(), 0.985);
  EXPECT_GT(score.num_visible_found, 0.92 * score.num_visible);
  EXPECT_LT(score.num_false, 0.01 * score.num_reported);
  EXPECT_LT(score.num_swapped_sides, 0.012 * score.num_reported);
  EXPECT_LT(score.MedianJointError(), GetParam().max_median_error_m);
  EXPECT_LE(score.identity.num_switches, GetParam().max_switches);
  EXPECT_GT(score.identity.idf1, GetParam().min_idf1);
}

INSTANTIATE_TEST_SUITE_P(
    All, HumanTrackingOnCrossing,
    testing::Values(Band{"Standing01", 0.15, 16, 0.92}, Band{"Standing02", 0.27, 32, 0.80},
                    Band{"RoadCrossing03", 0.20, 22, 0.80}, Band{"RoadCrossing04", 0.17, 20, 0.80},
                    Band{"RoadCrossing05", 0.14, 13, 0.90}, Band{"RoadCrossing06", 0.24, 105, 0.58},
                    Band{"RoadCrossing07", 0.31, 125, 0.43}),
    SequenceName);

}  // namespace
}  // namespace airdos
