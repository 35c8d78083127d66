// airdos-calibration as its users meet it: what it prints, and one clear line where something does
// not fit.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/input_errors.h"
#include "tests/support/rendered_scene.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

/// Kalibr's file of SmallStereoCamera() as if it were not rectified; the second camera stands at
/// `right` in the first.
std::string Kalibr(const Eigen::Vector3d& right = {0.25, 0, 0}) {
  const StereoCamera c = SmallStereoCamera();
  const std::string camera =
      "  camera_model: pinhole\n  distortion_model: radtan\n"
      "  distortion_coeffs: [0, 0, 0, 0]\n  resolution: [" +
      std::to_string(c.width) + ", " + std::to_string(c.height) + "]\n  intrinsics: [" +
      std::to_string(c.fx_px) + ", " + std::to_string(c.fy_px) + ", " + std::to_string(c.cx_px) +
      ", " + std::to_string(c.cy_px) + "]\n";
  return "cam0:\n" + camera + "cam1:\n" + camera + "  T_cn_cnm1:\n  - [1, 0, 0, " +
         std::to_string(-right.x()) + "]\n  - [0, 1, 0, " + std::to_string(-right.y()) +
         "]\n  - [0, 0, 1, " + std::to_string(-right.z()) + "]\n  - [0, 0, 0, 1]\n";
}

class CalibrationProcessTest : public testing::Test {
 protected:
  struct Answer {
    int exit_code = -1;
    std::string output;
    std::string errors;
  };
  Answer Run(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), AIRDOS_BINARY_DIR "/bin/airdos-calibration");
    ChildProcess process(arguments, folder_.PathOf("said"));
    constexpr double kDeadline_s = 60;
    const int code = process.Wait(kDeadline_s).value_or(-1000);
    return {code, process.Output(), process.Errors()};
  }
  /// Exit code 2 and one line that has the text.
  void ExpectRefused(const std::vector<std::string>& arguments, const std::string& text) const {
    const Answer answer = Run(arguments);
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_EQ(std::count(answer.errors.begin(), answer.errors.end(), '\n'), 1) << answer.errors;
    EXPECT_TRUE(Holds(answer.errors, text)) << answer.errors;
  }
  /// Frames of a walk; the right images may be those of `shift` frames later.
  void WriteImages(int shift = 0) const {
    constexpr int kFrames = 8;
    const RenderedScene scene(3);
    for (int k = 0; k < kFrames; ++k) {
      const std::string name = "/00000" + std::to_string(k) + ".png";
      folder_.WritePicture("left" + name, scene.Render(SmallStereoCamera(), SwayingPath(k)).left);
      folder_.WritePicture("right" + name,
                           scene.Render(SmallStereoCamera(), SwayingPath(k + shift)).right);
    }
  }
  Answer Check(const std::string& file, const std::string& left, const std::string& right,
               const std::vector<std::string>& more = {}) const {
    std::vector<std::string> arguments = {"check", file, "--images", folder_.PathOf(left),
                                          folder_.PathOf(right)};
    arguments.insert(arguments.end(), more.begin(), more.end());
    return Run(arguments);
  }
  ScratchFolder folder_{"calibration_process"};
};

TEST_F(CalibrationProcessTest, ShowSaysFormatFilesAndNotes) {
  const std::string file = folder_.Write("a.yaml", Kalibr({250, 0, 0}));
  const Answer answer = Run({"show", file, "--json", folder_.PathOf("a.json")});
  EXPECT_EQ(answer.exit_code, 0) << answer.errors;
  for (const char* part : {"format     Kalibr camera chain\n", "a.yaml\n", "baseline   0.25000 m",
                           "note       a baseline of 250 is taken in mm: 0.25 m\n"}) {
    EXPECT_TRUE(Holds(answer.output, part)) << part << answer.output;
  }
  std::ifstream stream(folder_.PathOf("a.json"));
  const std::string json{std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
  EXPECT_TRUE(Holds(json, "\"baseline_m\": 0.25")) << json;
}

TEST_F(CalibrationProcessTest, WhatDoesNotFitIsOneLine) {
  const auto written = [&](const Eigen::Vector3d& right) {
    return folder_.Write("a.yaml", Kalibr(right));
  };
  ExpectRefused({"show", written({-0.25, 0, 0})}, "say --swap");
  EXPECT_EQ(Run({"show", folder_.PathOf("a.yaml"), "--swap"}).exit_code, 0);
  ExpectRefused({"show", written({0.02, 0.25, 0})}, "one above the other");
  ExpectRefused({"show", written({0.25, 0, 0}), "--size", "640x384"}, "but --size says 640x384 px");
  ExpectRefused({"show", folder_.PathOf("a.yaml"), "--size", "640"}, "--size: '640' must be");
  ExpectRefused({"show", folder_.PathOf("a.yaml"), "--size", "0x0"}, "no size of images");
  ExpectRefused({"show", folder_.Write("b.yaml", "a: 1\n")}, "is no calibration file");
}

TEST_F(CalibrationProcessTest, ConvertedIsTheSameAndReplacesNothing) {
  const std::string file = folder_.Write("a.yaml", Kalibr({0.25, 0.01, 0.02}));
  const std::string out = folder_.PathOf("");
  EXPECT_EQ(Run({"convert", file, "--to", "ros", "--out", out}).output,
            folder_.PathOf("left.yaml") + "\n" + folder_.PathOf("right.yaml") + "\n");
  const Answer answer = Run({"show", folder_.PathOf("left.yaml"), folder_.PathOf("right.yaml")});
  EXPECT_TRUE(Holds(answer.output, "ROS camera_info pair")) << answer.output << answer.errors;
  EXPECT_TRUE(Holds(answer.output, "at (0.25000, 0.01000, 0.02000) m")) << answer.output;
  folder_.Write("stereo.yml", "mine");
  ExpectRefused({"convert", file, "--to", "opencv", "--out", out}, "--force");
}

TEST_F(CalibrationProcessTest, CheckHoldsTheFileAgainstImages) {
  WriteImages();
  const std::string file = folder_.Write("a.yaml", Kalibr());
  const Answer fits = Check(file, "left", "right");
  EXPECT_EQ(fits.exit_code, 0) << fits.errors;
  EXPECT_TRUE(Holds(fits.output, "rows after rectification:  0.")) << fits.output;
  EXPECT_TRUE(Holds(fits.output, "[rig.fits]")) << fits.output;
  const Answer exchanged = Check(file, "right", "left");
  EXPECT_EQ(exchanged.exit_code, 1);
  EXPECT_TRUE(Holds(exchanged.output, "left and right images are exchanged")) << exchanged.output;
}

TEST_F(CalibrationProcessTest, CheckFindsImagesOfAnotherTimeAndSize) {
  WriteImages(1);
  const std::string file = folder_.Write("a.yaml", Kalibr());
  const Answer shifted = Check(file, "left", "right");
  EXPECT_EQ(shifted.exit_code, 1);
  EXPECT_TRUE(Holds(shifted.output, "the right images are one frame early")) << shifted.output;
  for (const char* name : {"half/000000.png", "half_right/000000.png"})
    folder_.WritePicture(name, NoisePicture(160, 96, 1));
  const Answer half = Check(file, "half", "half_right");
  EXPECT_EQ(half.exit_code, 2);
  EXPECT_TRUE(Holds(half.errors, "calibrated for images of 320x192 px, these have 160x96 px"));
  EXPECT_EQ(Check(file, "half", "half_right", {"--scale-calibration"}).exit_code, 0);
  folder_.WritePicture("half_right/000000.png", NoisePicture(160, 95, 1));
  EXPECT_TRUE(
      Holds(Check(file, "half", "half_right").errors, "have 160x95 px, the left ones 160x96"));
}

}  // namespace
}  // namespace airdos
