#include "processes/node/message/keypoint_messages.h"

#include <gtest/gtest.h>

#include <vector>

namespace airdos {
namespace {

/// Joint j of person p is at (100 p + j, 50 p + j) with confidence 0.5 + p / 4 + j / 100.
person_keypoints_t Message(int layout, int num_people, int num_joints) {
  person_keypoints_t message{};
  message.layout = static_cast<std::int8_t>(layout);
  message.num_people = num_people;
  message.num_joints = num_joints;
  for (int p = 0; p < num_people; ++p) {
    std::vector<float> u_px, v_px, confidence;
    for (int j = 0; j < num_joints; ++j) {
      u_px.push_back(static_cast<float>(100 * p + j));
      v_px.push_back(static_cast<float>(50 * p + j));
      confidence.push_back(0.5F + 0.25F * static_cast<float>(p) + 0.01F * static_cast<float>(j));
    }
    message.u_px.push_back(u_px);
    message.v_px.push_back(v_px);
    message.confidence.push_back(confidence);
  }
  return message;
}

TEST(KeypointMessages, Coco18IsTakenAsItIs) {
  const auto people = ToPeople(Message(person_keypoints_t::LAYOUT_COCO18, 2, 18));
  ASSERT_EQ(people.size(), 2u);
  for (int p = 0; p < 2; ++p) {
    for (int j = 0; j < kNumJoints; ++j) {
      const BodyKeypoint& joint = people[static_cast<std::size_t>(p)][static_cast<std::size_t>(j)];
      EXPECT_EQ(joint.u_px, 100 * p + j);
      EXPECT_EQ(joint.v_px, 50 * p + j);
      EXPECT_NEAR(joint.confidence, 0.5 + 0.25 * p + 0.01 * j, 1e-6);
    }
  }
}

TEST(KeypointMessages, OtherLayoutsAreReordered) {
  // COCO-17: 0 nose, 5 and 6 left and right shoulder, 16 right ankle; the neck lies between the
  // shoulders.
  const auto coco17 = ToPeople(Message(person_keypoints_t::LAYOUT_COCO17, 1, 17));
  ASSERT_EQ(coco17.size(), 1u);
  EXPECT_EQ(coco17[0][kNose].u_px, 0);
  EXPECT_EQ(coco17[0][kLeftShoulder].u_px, 5);
  EXPECT_EQ(coco17[0][kRightShoulder].u_px, 6);
  EXPECT_EQ(coco17[0][kRightAnkle].u_px, 16);
  EXPECT_EQ(coco17[0][kNeck].u_px, 5.5);
  // Halpe-26 starts with the same.
  const auto halpe26 = ToPeople(Message(person_keypoints_t::LAYOUT_HALPE26, 1, 26));
  ASSERT_EQ(halpe26.size(), 1u);
  EXPECT_EQ(halpe26[0][kRightShoulder].u_px, 6);
  EXPECT_EQ(halpe26[0][kRightAnkle].u_px, 16);
}

TEST(KeypointMessages, NobodyWhereThereIsNobodyOrTheLayoutIsUnknown) {
  EXPECT_TRUE(ToPeople(Message(person_keypoints_t::LAYOUT_COCO18, 0, 18)).empty());
  EXPECT_TRUE(ToPeople(Message(person_keypoints_t::LAYOUT_INVALID, 2, 18)).empty());
  EXPECT_TRUE(ToPeople(Message(99, 2, 18)).empty());
}

}  // namespace
}  // namespace airdos
