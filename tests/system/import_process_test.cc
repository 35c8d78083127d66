// airdos-import as its users meet it: what it writes, and one clear line where something does not
// fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "common/calibration/rig_writer.h"
#include "common/calibration/stereo_rectifier.h"
#include "common/dataset/stereo_sequence.h"
#include "tests/support/child_process.h"
#include "tests/support/distorted_rig.h"
#include "tests/support/input_errors.h"
#include "tests/support/rendered_scene.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr int kNumPairs = 6;

struct Answer {
  int exit_code = 0;
  std::string output;
  std::string errors;
};

class ImportProcessTest : public testing::Test {
 protected:
  ImportProcessTest() {
    const RenderedScene scene(3);
    for (int k = 0; k < kNumPairs; ++k) {
      const StereoPair pair = scene.Render(SmallStereoCamera(), SwayingPath(k));
      const std::string name = "/frame" + std::to_string(k) + ".png";
      folder_.WritePicture("l" + name, distorted_.Left(pair.left, cv::INTER_CUBIC));
      folder_.WritePicture("r" + name, distorted_.Right(pair.right, cv::INTER_CUBIC));
    }
    const StereoRectifier unused(distorted_.rig());  // only calib.json needs one
    folder_.Write("kalibr.yaml", WriteRig(distorted_.rig(), unused, "kalibr").front().text);
  }
  Answer Run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), AIRDOS_BINARY_DIR "/bin/" + program);
    ChildProcess process(arguments, folder_.PathOf("said"));
    constexpr double kDeadline_s = 120;
    const int code = process.Wait(kDeadline_s).value_or(-1000);
    return {code, process.Output(), process.Errors()};
  }
  std::vector<std::string> Recording() const {
    return {"--images", Path("l"), Path("r"), "--rate", "10", "--calibration", Path("kalibr.yaml")};
  }
  Answer Import(const std::vector<std::string>& more) const {
    std::vector<std::string> arguments = Recording();
    arguments.insert(arguments.end(), more.begin(), more.end());
    arguments.insert(arguments.end(), {"--no-progress", "--no-check"});
    return Run("airdos-import", arguments);
  }
  /// Exit code 2 and one line that holds the text.
  static void ExpectRefused(const Answer& answer, const std::string& text) {
    EXPECT_EQ(answer.exit_code, 2) << answer.errors;
    EXPECT_EQ(std::count(answer.errors.begin(), answer.errors.end(), '\n'), 1) << answer.errors;
    EXPECT_TRUE(Holds(answer.errors, text)) << answer.errors;
    EXPECT_EQ(answer.output, "");
  }
  std::string Path(const std::string& name) const { return folder_.PathOf(name); }
  std::string BytesOf(const std::string& name) const {
    std::ifstream file(Path(name), std::ios::binary);
    return {std::istreambuf_iterator<char>(file), {}};
  }
  /// AlphaPose's results: somebody in each of the images, with the nose at this column; of
  /// those who are in the same one, each below the other.
  std::string WritePeople(const std::string& name, const std::vector<std::string>& images,
                          double u_px = 150) const {
    nlohmann::json list = nlohmann::json::array();
    std::map<std::string, int> count;
    for (const std::string& image : images) {
      const int lower_px = 25 * count[image]++;
      nlohmann::json joints = nlohmann::json::array();
      for (int j = 0; j < 17; ++j)
        joints.insert(joints.end(), {u_px + 3 * j, 60 + 5 * j + lower_px, 0.8});
      list.push_back({{"image_id", image}, {"keypoints", joints}, {"score", 2.9}, {"idx", "1"}});
    }
    return folder_.Write(name, list.dump());
  }

  ScratchFolder folder_{"import_process"};
  const DistortedRig distorted_{SmallStereoCamera()};
};

TEST_F(ImportProcessTest, ALogIsWhatThePlayerWrites) {
  const Answer answer = Import({"-o", Path("a.lcm")});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  EXPECT_TRUE(Holds(answer.output, "a.lcm: 6 frames of ")) << answer.output;
  std::vector<std::string> arguments = Recording();
  arguments.insert(arguments.end(), {"--session", "1", "--write-log", Path("b.lcm")});
  ASSERT_EQ(Run("airdos-stereo-player", arguments).exit_code, 0);
  ASSERT_FALSE(BytesOf("a.lcm").empty());
  EXPECT_EQ(BytesOf("a.lcm"), BytesOf("b.lcm"));
  ASSERT_EQ(Import({"-o", Path("copy")}).exit_code, 0);
  ASSERT_EQ(Run("airdos-import", {Path("copy"), "-o", Path("c.lcm"), "--no-check"}).exit_code, 0);
  EXPECT_EQ(BytesOf("a.lcm"), BytesOf("c.lcm"));
}

TEST_F(ImportProcessTest, PeopleAreSaidAndReadAgain) {
  const std::string left = WritePeople("left.json", {"frame2.jpg", "frame3.jpg", "frame77.jpg"});
  const std::string right = WritePeople("right.json", {"2", "3"});
  const Answer answer =
      Import({"-o", Path("set"), "--keypoints-left", left, "--keypoints-right", right});
  ASSERT_EQ(answer.exit_code, 0) << answer.errors;
  for (const char* line :
       {"airdos-import: keypoints, left: AlphaPose, COCO-17, 2 of 6 images have people\n",
        "airdos-import: keypoints, right: AlphaPose, COCO-17, 2 of 6 images have people\n",
        "1 of its 3 images is none of ours: 'frame77.jpg'\n", "rectified with them\n"}) {
    EXPECT_TRUE(Holds(answer.errors, line)) << answer.errors;
  }
  const auto sequence = OpenStereoSequence(Path("set"));
  EXPECT_EQ(sequence->Load(1).keypoints_left.size(), 0u);
  ASSERT_EQ(sequence->Load(2).keypoints_left.size(), 1u);
  EXPECT_EQ(sequence->Load(3).keypoints_right.size(), 1u);
  const Eigen::Vector2d nose = StereoRectifier(distorted_.rig()).RectifyLeft({150, 60});
  EXPECT_NEAR(sequence->Load(2).keypoints_left[0][0].u_px, nose.x(), 1e-3);
}

// What the check of a data set refuses, keypoints that are not read, is what is to be read now.
TEST_F(ImportProcessTest, KeypointsInTheDataSetsOwnFolders) {
  ASSERT_EQ(Import({"-o", Path("set")}).exit_code, 0);
  for (const char* folder : {"set/alphapose_0", "set/alphapose_1"}) {
    WritePeople(std::string(folder) + "/alphapose-results.json", {"000001.png"});
  }
  ExpectRefused(Run("airdos-import", {Path("set"), "-o", Path("b")}), "airdos-import --keypoints");
  const Answer answer =
      Run("airdos-import", {Path("set"), "-o", Path("b"), "--no-progress", "--keypoints-left",
                            Path("set/alphapose_0"), "--keypoints-right", Path("set/alphapose_1")});
  EXPECT_EQ(answer.exit_code, 0) << answer.errors;
  EXPECT_EQ(OpenStereoSequence(Path("b"))->Load(1).keypoints_right.size(), 1u);
}

// The disparity of people cannot be negative.
TEST_F(ImportProcessTest, ExchangedPeopleAreSaidOfWhatWasWritten) {
  std::vector<std::string> names;
  for (int k = 0; k < 2 * kNumPairs; ++k) names.push_back(std::to_string(k % kNumPairs));
  const std::string left = WritePeople("left.json", names, 120);
  const std::string right = WritePeople("right.json", names, 100);
  ASSERT_EQ(Import({"-o", Path("set")}).exit_code, 0);
  const auto import = [&](const std::string& out, const std::string& a, const std::string& b) {
    return Run("airdos-import", {Path("set"), "-o", Path(out), "--no-progress", "--keypoints-left",
                                 a, "--keypoints-right", b});
  };
  const Answer good = import("good", left, right);
  EXPECT_EQ(good.exit_code, 0) << good.errors;
  for (const char* out : {"bad", "bad.lcm"}) {
    const Answer exchanged = import(out, right, left);
    EXPECT_EQ(exchanged.exit_code, 2);
    EXPECT_TRUE(Holds(exchanged.errors, "keypoints are exchanged")) << exchanged.errors;
  }
}

TEST_F(ImportProcessTest, ProgressIsShownUnlessUnwanted) {
  std::vector<std::string> arguments = Recording();
  arguments.insert(arguments.end(), {"-o", Path("a.lcm")});
  EXPECT_TRUE(Holds(Run("airdos-import", arguments).errors, "100 %\n"));
  EXPECT_FALSE(Holds(Import({"-o", Path("b.lcm")}).errors, "100 %"));
}

TEST_F(ImportProcessTest, NothingIsOverwrittenWithoutForce) {
  ASSERT_EQ(Import({"-o", Path("a.lcm")}).exit_code, 0);
  ASSERT_EQ(Import({"-o", Path("set")}).exit_code, 0);
  ExpectRefused(Import({"-o", Path("a.lcm")}), "a.lcm: exists; --force replaces it");
  ExpectRefused(Import({"-o", Path("set")}), "set: is not empty; --force replaces");
  EXPECT_EQ(Import({"-o", Path("a.lcm"), "--force"}).exit_code, 0);
  EXPECT_EQ(Import({"-o", Path("set"), "--force", "--last", "2"}).exit_code, 0);
  EXPECT_EQ(OpenStereoSequence(Path("set"))->num_frames(), 3u);
  ExpectRefused(Import({"-o", Path("l"), "--force"}), "is an input");
  ExpectRefused(Import({"-o", Path("l/new"), "--force"}), "is in the input folder");
  EXPECT_EQ(std::distance(fs::directory_iterator(Path("l")), fs::directory_iterator()), kNumPairs);
}

TEST_F(ImportProcessTest, WhatDoesNotFitIsOneLine) {
  const std::string left = WritePeople("left.json", {"frame2.jpg"});
  const std::string other = WritePeople("other.json", {"somewhere.jpg"});
  const std::string log = folder_.Write("log.lcm", "x");
  ExpectRefused(Import({"-o", Path("x.lcm"), "--keypoints-left", left}), "belong together");
  ExpectRefused(Import({"-o", Path("x.lcm"), "--keypoints-left", left, "--keypoints-right", other}),
                "none of its images, such as 'somewhere.jpg', is one of ours");
  ExpectRefused(Import({"-o", Path("x.lcm"), "--keypoints-left", left, "--keypoints-right",
                        folder_.Write("bad.json", "[{]")}),
                "bad.json:1: column 3: this is not JSON");
  ExpectRefused(Import({"-o", Path("x.mp4")}), "neither a log");
  ExpectRefused(Import({"-o", Path("none/x.lcm")}), "there is no folder");
  ExpectRefused(Run("airdos-import", {log, "-o", Path("x")}), "log.lcm: is a file");
  ExpectRefused(Run("airdos-import", {Path("l"), "-o", Path("x")}), Path("l"));
  EXPECT_FALSE(fs::exists(Path("x.lcm")));
  EXPECT_FALSE(fs::exists(Path("x")));
}

}  // namespace
}  // namespace airdos
