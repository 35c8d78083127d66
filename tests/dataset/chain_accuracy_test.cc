// The whole chain on whole sequences: a pose for every frame, and every figure of the camera and of
// the people within the band of tests/dataset/bands.txt.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <ostream>
#include <string>

#include "tests/support/bands.h"
#include "tests/support/chain_run.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// What holds whatever is changed a little.
void ExpectComplete(const ChainRun& run) {
  EXPECT_GT(run.result.num_frames, 0);
  EXPECT_EQ(run.result.num_posed, run.result.num_frames);
  EXPECT_EQ(static_cast<std::int64_t>(run.trajectory.num_matched), run.result.num_frames);
  EXPECT_TRUE(run.is_closed);
  // Joints further away than the human tracker gives do not exist, nor such without disparity.
  if (run.use.people > 0) {
    EXPECT_GE(run.use.joints_adjusted, 0.98 * run.use.joints_seen);
  }
  if (run.people) {
    const JointErrors& errors = run.people->joint_errors;
    EXPECT_LT(errors.optimized.mean, 0.5 * errors.measured.mean);
    EXPECT_LT(errors.optimized.median, 0.8 * errors.measured.median);
  }
}

TEST(ChainTest, TheSampleLogStaysInTheBands) {
  const std::string root = AIRDOS_SOURCE_DIR;
  const std::string truth = root + "/tests/dataset/truth/road_crossing06_";
  const ChainRun run = RunChain({root + "/logs/road_crossing06.lcm",
                                 "on",
                                 true,
                                 {truth + "people.json.gz", truth + "camera.tum"}});
  EXPECT_EQ(run.result.num_frames, 50);
  EXPECT_TRUE(run.result.remarks.empty()) << run.result.remarks.front();
  ExpectComplete(run);
  ExpectInBands("sample/on", FiguresOf(run));
}

struct Case {
  const char* sequence;  ///< below the data folder
  const char* people;

  friend std::ostream& operator<<(std::ostream& out, const Case& c) {
    return out << c.sequence << " " << c.people;
  }
};

class SequenceTest : public testing::TestWithParam<Case> {};

TEST_P(SequenceTest, HasEveryPoseAndStaysInTheBands) {
  const char* const given = std::getenv("AIRDOS_DATA_DIR");
  const fs::path data = given != nullptr ? given : AIRDOS_SOURCE_DIR "/../shared/data";
  const fs::path sequence = data / GetParam().sequence;
  if (!fs::is_directory(sequence))
    GTEST_SKIP() << "no sequence at " << sequence << " (AIRDOS_DATA_DIR)";
  const bool is_crossing = sequence.parent_path().filename() == "crossing";
  ChainInput input{sequence.string(), GetParam().people, is_crossing, {}};
  if (is_crossing && input.people == "on")
    input.truth = {sequence / "joints_gt.json.gz", sequence / "gt_tum_optical.txt"};
  const ChainRun run = RunChain(input);
  ExpectComplete(run);
  ExpectInBands(sequence.filename().string() + "/" + input.people, FiguresOf(run));
}

// With people on the camera's path is that of mask_only as long as they are not believed, which is
// so in all of these but RoadCrossing07.
INSTANTIATE_TEST_SUITE_P(
    Shared, SequenceTest,
    testing::Values(Case{"crossing/Standing01", "on"}, Case{"crossing/Standing02", "on"},
                    Case{"crossing/RoadCrossing03", "on"}, Case{"crossing/RoadCrossing04", "on"},
                    Case{"crossing/RoadCrossing05", "on"}, Case{"crossing/RoadCrossing06", "on"},
                    Case{"crossing/RoadCrossing07", "on"},
                    Case{"crossing/RoadCrossing06", "mask_only"},
                    Case{"crossing/RoadCrossing07", "mask_only"},
                    Case{"crossing/RoadCrossing03", "off"}, Case{"crossing/RoadCrossing07", "off"},
                    Case{"kitti_odo_seq1", "mask_only"}, Case{"kitti_raw_pedestrian", "on"}));

}  // namespace
}  // namespace airdos
