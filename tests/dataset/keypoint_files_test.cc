// Keypoint files that people have (user_files/keypoints of the test data).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "common/dataset/keypoints/foreign_keypoints.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

class KeypointFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* const given = std::getenv("AIRDOS_DATA_DIR");
    folder_ = std::string(given != nullptr ? given : AIRDOS_SOURCE_DIR "/../shared/data") +
              "/user_files/keypoints/";
    if (!fs::exists(folder_))
      GTEST_SKIP() << "no keypoint files in " << folder_ << " (AIRDOS_DATA_DIR)";
  }
  static void ExpectJoint(const Keypoint& joint, double u_px, double v_px, double confidence) {
    EXPECT_NEAR(joint.u_px, u_px, 1e-3);
    EXPECT_NEAR(joint.v_px, v_px, 1e-3);
    EXPECT_NEAR(joint.confidence, confidence, 1e-5);
  }
  std::string folder_;
};

TEST_F(KeypointFiles, AlphaPoseCoco17) {
  const ForeignKeypoints read = ReadForeignKeypoints(folder_ + "alphapose_coco17.json");
  EXPECT_EQ(read.program, "AlphaPose");
  EXPECT_EQ(read.layout, ForeignLayout::kCoco17);
  ASSERT_FALSE(read.images.empty());
  EXPECT_EQ(read.images[0].name, "1.jpg");
  const PersonKeypoints& person = read.images[0].people[0];
  ExpectJoint(person[0], 801.16577, 175.18178, 0.93636);  // nose
  ExpectJoint(person[1], (834.67047 + 776.79871) / 2, (202.59474 + 208.68651) / 2, 0.80275);
  ExpectJoint(person[2], 776.79871, 208.68651, 0.87270);   // right shoulder
  ExpectJoint(person[13], 846.85406, 437.12784, 0.80366);  // left ankle
}

TEST_F(KeypointFiles, AlphaPoseHalpe26) {
  const ForeignKeypoints read = ReadForeignKeypoints(folder_ + "alphapose_halpe26.json");
  EXPECT_EQ(read.program, "AlphaPose");
  EXPECT_EQ(read.layout, ForeignLayout::kHalpe26);
  EXPECT_EQ(read.images[0].name, "out0000001.png");
  ExpectJoint(read.images[0].people[0][1], 123.71060, 521.17639, 0.91624);  // neck
  ExpectJoint(read.images[0].people[0][10], 15.93065, 1126.40222, 0.90028);
}

TEST_F(KeypointFiles, WhatIsNoJsonIsRefusedWithItsPlace) {
  EXPECT_EQ(
      ErrorOf([&] { ReadForeignKeypoints(folder_ + "alphapose_invalid.json"); }),
      folder_ + "alphapose_invalid.json:164: column 19: this is not JSON at the character ','");
}

TEST_F(KeypointFiles, OpenPoseFolder) {
  const ScratchFolder copy("keypoint_files");
  for (const char* name : {"cam02.0008", "cam02.0009", "cam02.0010", "cam02.0011", "cam02.0012"}) {
    fs::copy_file(folder_ + "openpose_body25_" + name + ".json",
                  copy.PathOf(std::string(name) + ".json"));
  }
  const ForeignKeypoints read = ReadForeignKeypoints(copy.path());
  EXPECT_EQ(read.program, "OpenPose");
  EXPECT_EQ(read.layout, ForeignLayout::kBody25B) << "eyes and ears come second to fifth";
  ASSERT_EQ(read.images.size(), 5u);
  EXPECT_EQ(read.images[0].name, "cam02.0008");
  EXPECT_EQ(read.images[0].people.size(), 2u);
  ExpectJoint(read.images[0].people[0][1], (647.304 + 520.906) / 2, (531.554 + 531.516) / 2,
              0.627629);                                                  // neck
  ExpectJoint(read.images[0].people[0][8], 526.335, 752.401, 0.640083);   // right hip
  ExpectJoint(read.images[0].people[0][15], 589.267, 452.647, 0.602958);  // left eye
}

TEST_F(KeypointFiles, OpenPoseWithJointsAndPeopleThatAreNotSeen) {
  const ForeignKeypoints one = ReadForeignKeypoints(folder_ + "openpose_body25_cam03.0008.json");
  ASSERT_EQ(one.images.size(), 1u);
  EXPECT_EQ(one.layout, ForeignLayout::kBody25B);
  EXPECT_EQ(one.images[0].people[0][14].confidence, 0) << "right eye: 0, 0, 0";
  const ForeignKeypoints read = ReadForeignKeypoints(folder_ + "openpose_body25_empty_person.json");
  ASSERT_EQ(read.images.size(), 1u);
  EXPECT_EQ(read.images[0].people.size(), 2u);
  ASSERT_FALSE(read.notes.empty());
  EXPECT_TRUE(Holds(read.notes.back(), "1 person has no joint that is seen"));
}

}  // namespace
}  // namespace airdos
