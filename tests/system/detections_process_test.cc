// airdos-evaluate detections as its users meet it: from a data set and a log of it to the figures.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_sequence.h"
#include "tests/support/standing_person.h"

namespace airdos {
namespace {

using nlohmann::json;

struct Answer {
  int exit_code = 0;
  std::string output;
  std::string errors;
};

/// Joints of kStanding where the neck has been detected, in the camera.
json JointsAt(const StereoCamera& camera, double u_px, double v_px, double disparity_px) {
  json joints;
  for (std::size_t joint = 0; joint < kStanding.size(); ++joint) {
    const Eigen::Vector3d p_C =
        camera
            .Triangulate(u_px + kStanding[joint][0], v_px + kStanding[joint][1],
                         u_px + kStanding[joint][0] - disparity_px)
            .value();
    joints[std::to_string(joint)] = {p_C.x(), p_C.y(), p_C.z()};
  }
  return joints;
}

/// The small sequence, whose people have their true joints 1 px to the right of the detected ones.
class DetectionsProcessTest : public testing::Test {
 protected:
  void SetUp() override {
    const SmallSequence sequence = SmallSequence::Make();
    sequence.Write(Path("data"));
    json truth = json::array();
    std::string poses;
    for (int k = 0; k < SmallSequence::kNumFrames; ++k) {
      const json all = std::vector<int>(kStanding.size(), 2);
      const auto person = [&](int id, const json& joints) -> json {
        return {{"id", id}, {"joints_w", joints}, {"vis0", all}, {"vis1", all}};
      };
      truth.push_back({{"t", 0.1 * k},
                       {"humans",
                        {person(1, JointsAt(sequence.camera, 81 + k, 60, 10)),
                         person(2, JointsAt(sequence.camera, 221 - k, 70, 8))}}});
      poses += std::to_string(0.1 * k) + " 0 0 0 0 0 0 1\n";
    }
    folder_.Write("data/joints_gt.json", truth.dump());
    folder_.Write("data/gt_tum_optical.txt", poses);
    ASSERT_EQ(
        Run({"airdos-stereo-player", Path("data"), "--write-log", Path("in.lcm"), "--no-check"})
            .exit_code,
        0);
  }
  std::string Path(const std::string& name) const { return folder_.PathOf(name); }
  Answer Run(std::vector<std::string> arguments) const {
    arguments[0] = AIRDOS_BINARY_DIR "/bin/" + arguments[0];
    ChildProcess process(arguments, Path("said"));
    constexpr double kDeadline_s = 120;
    const int code = process.Wait(kDeadline_s).value_or(-1000);
    return {code, process.Output(), process.Errors()};
  }
  Answer Evaluate(const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"airdos-evaluate", "detections", "--log",
                                          Path("in.lcm"),    "--data",     Path("data")};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }
  ScratchFolder folder_{"detections_process"};
};

TEST_F(DetectionsProcessTest, FiguresOfALog) {
  const Answer answer = Evaluate({"--json", Path("out.json")});
  EXPECT_EQ(answer.exit_code, 0) << answer.errors;
  EXPECT_TRUE(Holds(answer.output, "detected people, against the true ones\n")) << answer.output;
  EXPECT_TRUE(Holds(answer.errors, "airdos-evaluate: WARNING: ")) << answer.errors;
  EXPECT_TRUE(Holds(answer.errors, "no detector ran")) << answer.errors;
  EXPECT_TRUE(Holds(answer.output, "no detector ran"));

  const json figures = json::parse(std::ifstream(Path("out.json")));
  EXPECT_EQ(figures.at("log"), Path("in.lcm"));
  EXPECT_EQ(figures.at("remarks").size(), 1u);
  EXPECT_EQ(figures.at("frames_with_truth"), SmallSequence::kNumFrames);
  const json& detected = figures.at("detected");
  for (const char* side : {"left", "right"}) {
    const json& image = detected.at(side);
    EXPECT_EQ(image.at("to_be_seen").at("people"), 2 * SmallSequence::kNumFrames);
    EXPECT_EQ(image.at("to_be_seen").at("recall_percent"), 100);
    EXPECT_EQ(image.at("to_be_seen_by_depth").at("below 6 m").at("people"),
              SmallSequence::kNumFrames);
    EXPECT_EQ(image.at("false"), 0);
    EXPECT_NEAR(image.at("joint_error_px").at("median"), 1, 1e-4);
  }
  EXPECT_NEAR(detected.at("disparity_error_px").at("percentile_90"), 0, 1e-4);
  EXPECT_EQ(figures.at("given").at("left").at("to_be_seen").at("recall_percent"), 100);
  EXPECT_EQ(figures.at("detected_against_given").at("right").at("given").at("recall_percent"), 100);
}

TEST_F(DetectionsProcessTest, OneLineWhereNothingCanBeCompared) {
  folder_.Write("mine.json", "mine");
  Answer answer = Evaluate({"--json", Path("mine.json")});
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_TRUE(Holds(answer.errors, "--force")) << answer.errors;
  std::string times;
  for (int k = 0; k < SmallSequence::kNumFrames; ++k) times += std::to_string(100 + k) + "\n";
  folder_.Write("data/times.txt", times);
  answer = Evaluate();
  EXPECT_EQ(answer.exit_code, 2);
  EXPECT_EQ(answer.output, "");
  EXPECT_EQ(std::count(answer.errors.begin(), answer.errors.end(), '\n'), 1) << answer.errors;
  EXPECT_TRUE(Holds(answer.errors, "have no time in common")) << answer.errors;
}

}  // namespace
}  // namespace airdos
