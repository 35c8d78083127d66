// Which images of another program are ours, and what becomes of its people.
#include "common/dataset/keypoints/keypoint_matching.h"

#include <gtest/gtest.h>

#include "common/dataset/folder_writer.h"
#include "common/dataset/keypoints/keypoint_sequence.h"
#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "common/geometry/se3.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

using Names = std::vector<std::string>;

KeypointMatching Match(const Names& theirs, const Names& ours) {
  std::vector<ForeignImage> images;
  for (const std::string& name : theirs) images.push_back({name, {}});
  return MatchKeypoints("FILE", images, ours);
}

/// For each of ours their index, -1 for none.
std::vector<int> Indices(const KeypointMatching& matching) {
  std::vector<int> indices;
  for (const auto& image : matching.image_of)
    indices.push_back(image ? static_cast<int>(*image) : -1);
  return indices;
}

TEST(KeypointMatching, ByNameWithoutFolderAndEnding) {
  const KeypointMatching matching =
      Match({"some/where/b_2.png", "a_1.jpg", "c_3"}, {"a_1.png", "b_2.png", "c_3.png", "d_4.png"});
  EXPECT_EQ(Indices(matching), (std::vector<int>{1, 0, 2, -1}));
  EXPECT_TRUE(matching.notes.empty());
}

TEST(KeypointMatching, ByTheNumberThatCounts) {
  EXPECT_EQ(Indices(Match({"3", "1", "2"}, {"000001.png", "000002.png", "000003.png"})),
            (std::vector<int>{1, 2, 0}));
  EXPECT_EQ(Indices(Match({"out0000010.png", "out0000009.png"}, {"left9.jpg", "left10.jpg"})),
            (std::vector<int>{1, 0}));
  EXPECT_EQ(Indices(Match({"cam02.0008", "cam02.0009"}, {"000008.png", "000009.png"})),
            (std::vector<int>{0, 1}));
  // The last number is the same in all names.
  EXPECT_EQ(Indices(Match({"7", "8"}, {"000007_10.png", "000008_10.png"})),
            (std::vector<int>{0, 1}));
}

TEST(KeypointMatching, NeverByRank) {
  const std::string said = ErrorOf([] { Match({"a", "b"}, {"000000.png", "000001.png"}); });
  EXPECT_EQ(said,
            "FILE: none of its images, such as 'a', is one of ours, such as '000000.png': names or "
            "numbers must be the same");
  EXPECT_NE(ErrorOf([] { Match({"1", "2"}, {"1403636579763555584.png"}); }), "");
  EXPECT_EQ(Indices(Match({"1403636579.763555"}, {"1403636579.763555.png"})), std::vector<int>{0});
}

TEST(KeypointMatching, WhatIsNoneOfOursIsCounted) {
  const KeypointMatching matching = Match({"1", "8", "9"}, {"000001.png", "000002.png"});
  ASSERT_EQ(matching.notes.size(), 1u);
  EXPECT_EQ(matching.notes[0], "FILE: 2 of its 3 images are none of ours: '8', '9'");
}

TEST(KeypointMatching, CountingFromOneIsAskedFor) {
  const KeypointMatching matching = Match({"1", "2", "3"}, {"0.png", "1.png", "2.png"});
  EXPECT_EQ(Indices(matching), (std::vector<int>{-1, 0, 1}));
  ASSERT_EQ(matching.notes.size(), 1u);
  EXPECT_TRUE(Holds(matching.notes[0], "does it count from 1")) << matching.notes[0];
  EXPECT_FALSE(Holds(Match({"1", "2", "3"}, {"1.png", "2.png"}).notes[0], "count from 1"));
}

TEST(KeypointMatching, TwoForOneAreRefused) {
  const std::string said = ErrorOf([] { Match({"1.jpg", "01"}, {"1.png", "2.png"}); });
  EXPECT_EQ(said, "FILE: '1.jpg' and '01' are both the image '1.png'");
}

/// Joint j at (50 + j, 30 + j), each seen; the first one where it is told to be.
PersonKeypoints Person(float u_px = 50, float v_px = 30) {
  PersonKeypoints person;
  for (int j = 0; j < 18; ++j) {
    person.push_back({50.F + static_cast<float>(j), 30.F + static_cast<float>(j), 0.5F});
  }
  person[0] = {u_px, v_px, 0.5F};
  return person;
}

ForeignKeypoints People(const std::string& image, const PersonKeypoints& person) {
  ForeignKeypoints people;
  people.path = "FILE";
  people.program = "OpenPose";
  people.layout = ForeignLayout::kBody25;
  people.images = {{image, {person}}};
  return people;
}

class KeypointSequenceTest : public ::testing::Test {
 protected:
  /// Two pairs, as recorded.
  std::unique_ptr<RectifiedSequence> Recorded(const StereoRig& rig) const {
    for (const char* folder : {"left", "right"}) {
      for (const char* name : {"/3.png", "/4.png"}) {
        folder_.WritePicture(std::string(folder) + name, cv::Mat(64, 96, CV_8UC1, cv::Scalar(9)));
      }
    }
    return std::make_unique<RectifiedSequence>(
        std::make_unique<FolderRecording>(
            FolderRecordingOptions{folder_.PathOf("left"), folder_.PathOf("right"), "", 10.0}),
        rig);
  }
  static StereoRig Rig() {
    StereoRig rig;
    rig.left = {
        96, 64, 80.5, 81, 47, 32.5, LensModel::kRadialTangential, {-0.2, 0.01, 0.001, 0.002}};
    rig.right = {
        96, 64, 80, 80.25, 48, 31, LensModel::kRadialTangential, {-0.1, 0.02, 0.003, 0.001}};
    rig.T_L_R.rotation = ExpSo3({0.01, -0.02, 0.03});
    rig.T_L_R.translation = {0.2, 0.01, -0.02};
    return rig;
  }
  ScratchFolder folder_{"keypoint_sequence"};
};

// The people were found in the images as recorded, each camera's with its own lens.
TEST_F(KeypointSequenceTest, PeopleAreRectifiedWithTheImages) {
  const StereoRig rig = Rig();
  const StereoRectifier rectifier(rig);
  const KeypointSequence sequence(Recorded(rig), People("4.jpg", Person()),
                                  People("4.jpg", Person()));
  EXPECT_TRUE(sequence.Load(0).keypoints_left.empty());
  const SequenceFrame frame = sequence.Load(1);
  EXPECT_EQ(frame.keypoint_layout, KeypointLayout::kCoco18);
  ASSERT_EQ(frame.keypoints_left.size(), 1u);
  const Eigen::Vector2d left = rectifier.RectifyLeft({53, 33});
  const Eigen::Vector2d right = rectifier.RectifyRight({53, 33});
  ASSERT_GT((left - right).norm(), 0.5);
  EXPECT_NEAR(frame.keypoints_left[0][3].u_px, left.x(), 1e-4);
  EXPECT_NEAR(frame.keypoints_left[0][3].v_px, left.y(), 1e-4);
  EXPECT_NEAR(frame.keypoints_right[0][3].u_px, right.x(), 1e-4);
  EXPECT_NEAR(frame.keypoints_right[0][3].v_px, right.y(), 1e-4);
  EXPECT_EQ(frame.keypoints_left[0][3].confidence, 0.5F);
  EXPECT_EQ(sequence.summaries()[0], "OpenPose, BODY_25, 1 of 2 images have people");
  EXPECT_TRUE(Holds(sequence.notes().back(), "rectified with them"));
}

TEST_F(KeypointSequenceTest, JointsOutsideTheImageAreNotSeen) {
  const auto of = [&](float u_px, float v_px) {
    const KeypointSequence sequence(Recorded(Rig()), People("3", Person(u_px, v_px)),
                                    People("3", Person()));
    return sequence.Load(0).keypoints_left[0][0].confidence;
  };
  EXPECT_EQ(of(-0.4F, 63.4F), 0.5F);
  EXPECT_EQ(of(95.4F, -0.4F), 0.5F);
  EXPECT_EQ(of(-0.6F, 5), 0);
  EXPECT_EQ(of(95.6F, 5), 0);
  EXPECT_EQ(of(5, -0.6F), 0);
  EXPECT_EQ(of(5, 63.6F), 0);
}

TEST_F(KeypointSequenceTest, PeopleOfLargerImagesAreRefused) {
  PersonKeypoints person = Person();
  for (Keypoint& joint : person) joint.u_px += 80;
  const std::string said = ErrorOf(
      [&] { KeypointSequence(Recorded(Rig()), People("3", Person()), People("3", person)); });
  EXPECT_EQ(
      said,
      "FILE: 18 of 18 joints lie outside the images of 96 x 64 px: found in images of another "
      "size?");
}

// What is rectified already stays where it is.
TEST_F(KeypointSequenceTest, PeopleOfADataSetStayAndReplaceItsOwn) {
  {
    FolderWriter writer(folder_.PathOf("set"), {});
    SequenceFrame with_people = Recorded(Rig())->Load(0);
    with_people.keypoints_left = {Person(1, 1), Person(2, 2)};
    writer.Add(with_people, TrajectoryAxes::kUnknown);
    writer.Add(Recorded(Rig())->Load(1), TrajectoryAxes::kUnknown);
    writer.Finish(StereoRectifier(Rig()).camera());
  }
  const KeypointSequence sequence(OpenStereoSequence(folder_.PathOf("set")),
                                  People("0", Person(7, 8)), People("1", Person()));
  const SequenceFrame frame = sequence.Load(0);
  ASSERT_EQ(frame.keypoints_left.size(), 1u);
  EXPECT_EQ(frame.keypoints_left[0][0].u_px, 7);
  EXPECT_EQ(frame.keypoints_left[0][0].v_px, 8);
  EXPECT_TRUE(frame.keypoints_right.empty());
  EXPECT_EQ(sequence.Load(1).keypoints_right.size(), 1u);
  EXPECT_TRUE(Holds(sequence.notes().back(), "takes the place of the keypoints"));
}

}  // namespace
}  // namespace airdos
