// What is written as a data set is read as it was, and nothing of others is mixed with it.
#include "common/dataset/folder_writer.h"

#include <gtest/gtest.h>

#include "common/dataset/image_file.h"
#include "common/util/text_file.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::vector<std::uint8_t> Picture(int grey, const std::string& ending = ".png",
                                  int type = CV_8UC1) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(ending, cv::Mat(48, 64, type, cv::Scalar(grey)), bytes);
  return bytes;
}

StereoCamera Camera() {
  StereoCamera camera;
  camera.width = 64;
  camera.height = 48;
  camera.fx_px = 70.1234567890123456;
  camera.fy_px = 71.3;
  camera.cx_px = 31.7;
  camera.cy_px = 24.2;
  camera.baseline_m = 0.123456789012345;
  return camera;
}

PersonKeypoints Person(int num_joints, float offset) {
  PersonKeypoints person;
  for (int j = 0; j < num_joints; ++j) {
    person.push_back({offset + static_cast<float>(j) / 3, 20.F - static_cast<float>(j) / 7, 0.1F});
  }
  return person;
}

/// A camera that walks forward and pitches a little.
SequenceFrame Frame(int k) {
  SequenceFrame frame;
  frame.utime = 1403636579763555 + 50001 * k;
  frame.left_image_file = Picture(10 + k, k % 2 == 0 ? ".png" : ".jpg");
  frame.right_image_file = Picture(90 + k, ".png", CV_16UC1);
  frame.ground_truth = Se3();
  frame.ground_truth->translation = {0.01 * k, -0.02 * k, 0.3 * k};
  frame.ground_truth->rotation = Eigen::Quaterniond(ExpSo3({0.01 * k, 0.02 * k, -0.03 * k}));
  return frame;
}

class FolderWriterTest : public ::testing::Test {
 protected:
  std::string Out(const std::string& name = "out") const { return folder_.PathOf(name); }
  void WriteFrames(int num_frames, bool force = false) const {
    FolderWriter writer(Out(), {{}, force});
    for (int k = 0; k < num_frames; ++k) writer.Add(Frame(k), TrajectoryAxes::kOptical);
    writer.Finish(Camera());
  }
  std::string Refusal(bool force) const {
    return ErrorOf([&] { FolderWriter(Out(), {{}, force}); });
  }
  ScratchFolder folder_{"folder_writer"};
};

void ExpectSamePeople(const std::vector<PersonKeypoints>& a,
                      const std::vector<PersonKeypoints>& b) {
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    ASSERT_EQ(a[i].size(), b[i].size());
    for (std::size_t j = 0; j < a[i].size(); ++j) {
      EXPECT_EQ(a[i][j].u_px, b[i][j].u_px);
      EXPECT_EQ(a[i][j].v_px, b[i][j].v_px);
      EXPECT_EQ(a[i][j].confidence, b[i][j].confidence);
    }
  }
}

TEST_F(FolderWriterTest, EverythingIsReadAsItWasWritten) {
  std::vector<SequenceFrame> frames;
  for (int k = 0; k < 3; ++k) frames.push_back(Frame(k));
  frames[0].keypoint_layout = frames[2].keypoint_layout = KeypointLayout::kHalpe26;
  frames[0].keypoints_left = {Person(26, 3.3F), Person(26, 5)};
  frames[2].keypoints_right = {Person(26, 1.1F)};
  frames[1].person_mask_file = Picture(255);
  frames[2].ground_truth = std::nullopt;
  {
    FolderWriter writer(Out(), {});
    for (const SequenceFrame& frame : frames) writer.Add(frame, TrajectoryAxes::kOptical);
    writer.Finish(Camera());
    EXPECT_EQ(writer.num_frames(), 3u);
  }
  const auto sequence = OpenStereoSequence(Out());
  ASSERT_EQ(sequence->num_frames(), 3u);
  const StereoCamera camera = sequence->camera();
  EXPECT_EQ(camera.width, 64);
  EXPECT_EQ(camera.height, 48);
  EXPECT_EQ(camera.fx_px, Camera().fx_px);
  EXPECT_EQ(camera.fy_px, Camera().fy_px);
  EXPECT_EQ(camera.cx_px, Camera().cx_px);
  EXPECT_EQ(camera.cy_px, Camera().cy_px);
  EXPECT_EQ(camera.baseline_m, Camera().baseline_m);
  EXPECT_EQ(sequence->ground_truth_axes(), TrajectoryAxes::kNed);
  for (std::size_t k = 0; k < 3; ++k) {
    const SequenceFrame read = sequence->Load(k);
    EXPECT_EQ(read.utime, frames[k].utime);
    EXPECT_EQ(read.left_image_file, frames[k].left_image_file);
    EXPECT_EQ(read.right_image_file, frames[k].right_image_file);
    EXPECT_EQ(read.person_mask_file.empty(), k != 1);
    EXPECT_EQ(read.keypoint_layout, KeypointLayout::kHalpe26);
    ExpectSamePeople(read.keypoints_left, frames[k].keypoints_left);
    ExpectSamePeople(read.keypoints_right, frames[k].keypoints_right);
    EXPECT_EQ(read.ground_truth.has_value(), k != 2);
  }
}

// NED: x forward, y right, z down, of body and world; optical: z forward, x right, y down.
TEST_F(FolderWriterTest, OpticalPosesBecomeNed) {
  WriteFrames(3);
  const auto sequence = OpenStereoSequence(Out());
  const Se3 ned = *sequence->ground_truth(2);
  const Se3 optical = *Frame(2).ground_truth;
  Eigen::Matrix3d R_ned_optical;
  R_ned_optical << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  EXPECT_NEAR((ned.translation - R_ned_optical * optical.translation).norm(), 0, 1e-15);
  EXPECT_NEAR((ned.rotation.toRotationMatrix() -
               R_ned_optical * optical.rotation.toRotationMatrix() * R_ned_optical.transpose())
                  .norm(),
              0, 1e-14);
}

TEST_F(FolderWriterTest, PosesInNedStayAsTheyAre) {
  {
    FolderWriter writer(Out(), {});
    writer.Add(Frame(1), TrajectoryAxes::kNed);
    writer.Finish(Camera());
  }
  const Se3 read = *OpenStereoSequence(Out())->ground_truth(0);
  EXPECT_EQ(read.translation, Frame(1).ground_truth->translation);
  EXPECT_LT(read.rotation.angularDistance(Frame(1).ground_truth->rotation), 1e-7);
}

TEST_F(FolderWriterTest, TimesBeforeTheEpochAndAtItAreExact) {
  {
    FolderWriter writer(Out(), {});
    for (const std::int64_t utime : {std::int64_t{-1500001}, std::int64_t{-1}, std::int64_t{0}}) {
      SequenceFrame frame = Frame(0);
      frame.utime = utime;
      frame.ground_truth.reset();
      writer.Add(frame, TrajectoryAxes::kUnknown);
    }
    writer.Finish(Camera());
  }
  const auto sequence = OpenStereoSequence(Out());
  EXPECT_EQ(sequence->utime(0), -1500001);
  EXPECT_EQ(sequence->utime(1), -1);
  EXPECT_EQ(sequence->utime(2), 0);
}

TEST_F(FolderWriterTest, WhatWasInterruptedCannotBeOpened) {
  {
    FolderWriter writer(Out(), {});
    writer.Add(Frame(0), TrajectoryAxes::kOptical);
  }
  EXPECT_TRUE(Holds(ErrorOf([&] { OpenStereoSequence(Out()); }), "calib.json: is not there"));
  EXPECT_TRUE(Holds(Refusal(false), "is not empty; --force"));
  WriteFrames(2, true);
  EXPECT_EQ(OpenStereoSequence(Out())->num_frames(), 2u);
}

TEST_F(FolderWriterTest, ForceRemovesWhatAnEarlierRunWrote) {
  WriteFrames(3);
  folder_.Write("out/my_notes.txt", "mine");
  EXPECT_TRUE(Holds(Refusal(false), "is not empty; --force"));
  EXPECT_EQ(OpenStereoSequence(Out())->num_frames(), 3u);
  WriteFrames(1, true);
  EXPECT_EQ(OpenStereoSequence(Out())->num_frames(), 1u);
  EXPECT_FALSE(fs::exists(Out() + "/image_0/000002.png"));
  EXPECT_TRUE(fs::exists(Out() + "/my_notes.txt"));
}

TEST_F(FolderWriterTest, NothingIsMixedWithFilesOfOthers) {
  WriteFrames(1);
  folder_.Write("out/image_0/mine.png", "");
  EXPECT_TRUE(Holds(Refusal(true), "image_0/mine.png: was not written by airdos-import"));
  EXPECT_EQ(OpenStereoSequence(Out())->camera().width, 64) << "nothing has been removed";
  fs::remove(Out() + "/image_0/mine.png");
  folder_.Write("out/calib.txt", "");
  EXPECT_TRUE(Holds(Refusal(true), "calib.txt: was not written by airdos-import"));
  fs::remove(Out() + "/calib.txt");
  EXPECT_EQ(Refusal(true), "");
}

TEST_F(FolderWriterTest, InputsAndNothingAtAllAreRefused) {
  EXPECT_TRUE(Holds(ErrorOf([&] { FolderWriter(Out(), {{folder_.path()}, true}); }), "input"));
  const std::string said = ErrorOf([&] { FolderWriter(Out(), {}).Finish(Camera()); });
  EXPECT_TRUE(Holds(said, "there is no frame")) << said;
}

}  // namespace
}  // namespace airdos
