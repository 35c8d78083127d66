// Every field that passes between messages and the types of common/, all values different.
#include "processes/node/message/conversions.h"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "processes/node/message/header.h"
#include "processes/node/message/keypoint_messages.h"

namespace airdos {
namespace {

// The quaternion w, x, y, z = (1, 5, 5, 7) / 10 turns by these exact rows:
//   1 - 2 (y^2 + z^2) = -0.48,  2 (x y - z w) = 0.36,  2 (x z + y w) = 0.80, and so on.
constexpr double kWxyz[4] = {0.1, 0.5, 0.5, 0.7};
constexpr double kPosition[3] = {-3.25, 0.5, 12.75};

TEST(ConversionsTest, TheCameraHasEachValueInItsPlace) {
  stereo_calibration_t message{};
  message.width = 641;
  message.height = 363;
  message.fx_px = 701.5;
  message.fy_px = 688.25;
  message.cx_px = 322.75;
  message.cy_px = 177.5;
  message.baseline_m = 0.2375;
  const StereoCamera camera = ToStereoCamera(message);
  EXPECT_EQ(camera.width, 641);
  EXPECT_EQ(camera.height, 363);
  EXPECT_EQ(camera.fx_px, 701.5);
  EXPECT_EQ(camera.fy_px, 688.25);
  EXPECT_EQ(camera.cx_px, 322.75);
  EXPECT_EQ(camera.cy_px, 177.5);
  EXPECT_EQ(camera.baseline_m, 0.2375);
}

TEST(ConversionsTest, TheMessageHasEachValueOfTheCameraInItsPlace) {
  const StereoCamera camera{1242, 375, 721.5, 719.25, 609.5, 172.75, 0.5375};
  stereo_calibration_t message{};
  message.utime = 11;
  message.seq = 12;
  message.session = 13;
  FromStereoCamera(camera, &message);
  EXPECT_EQ(message.width, 1242);
  EXPECT_EQ(message.height, 375);
  EXPECT_EQ(message.fx_px, 721.5);
  EXPECT_EQ(message.fy_px, 719.25);
  EXPECT_EQ(message.cx_px, 609.5);
  EXPECT_EQ(message.cy_px, 172.75);
  EXPECT_EQ(message.baseline_m, 0.5375);
  EXPECT_EQ(message.utime, 11);
  EXPECT_EQ(message.seq, 12);
  EXPECT_EQ(message.session, 13);
}

TEST(ConversionsTest, APoseIsThatOfTheMessage) {
  const Se3 T_W_C = ToSe3(kPosition, kWxyz);
  Eigen::Matrix3d R_W_C;
  R_W_C << -0.48, 0.36, 0.80, 0.64, -0.48, 0.60, 0.60, 0.80, 0.0;
  EXPECT_LT((T_W_C.rotation.toRotationMatrix() - R_W_C).norm(), 1e-12);
  EXPECT_EQ(T_W_C.translation, Eigen::Vector3d(-3.25, 0.5, 12.75));
  // R (1, 2, 3) = (2.64, 1.48, 2.2)
  EXPECT_LT((T_W_C * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-0.61, 1.98, 14.95)).norm(), 1e-12);
}

TEST(ConversionsTest, AQuaternionOfAnotherLengthIsMadeAUnit) {
  const double twice[4] = {0.2, 1.0, 1.0, 1.4};
  const Se3 T_W_C = ToSe3(kPosition, twice);
  EXPECT_NEAR(T_W_C.rotation.norm(), 1, 1e-15);
  EXPECT_NEAR(T_W_C.rotation.z(), 0.7, 1e-15);
}

TEST(ConversionsTest, TheMessageHasEachValueOfThePoseInItsPlace) {
  double position[3] = {};
  double orientation[4] = {};
  FromSe3({Eigen::Quaterniond(0.1, 0.5, 0.5, 0.7), {7.5, -8.25, 9.125}}, position, orientation);
  EXPECT_EQ(position[0], 7.5);
  EXPECT_EQ(position[1], -8.25);
  EXPECT_EQ(position[2], 9.125);
  // In another order these four would be other numbers: x and y are told apart below.
  FromSe3({Eigen::Quaterniond(0.8, -0.2, 0.4, 0.4), {1, 2, 3}}, position, orientation);
  EXPECT_EQ(orientation[0], 0.8);
  EXPECT_EQ(orientation[1], -0.2);
  EXPECT_EQ(orientation[2], 0.4);
  FromSe3({Eigen::Quaterniond(0.5, 0.1, -0.7, 0.3), {1, 2, 3}}, position, orientation);
  EXPECT_EQ(orientation[2], -0.7);
  EXPECT_EQ(orientation[3], 0.3);
}

TEST(ConversionsTest, TheHeaderIsTakenOverAndAllElseIsZero) {
  const auto message = MessageOf<stereo_calibration_t>({11, 12, 13});
  EXPECT_EQ(message.utime, 11);
  EXPECT_EQ(message.seq, 12);
  EXPECT_EQ(message.session, 13);
  EXPECT_EQ(message.width, 0);
  EXPECT_EQ(message.baseline_m, 0);
  const Header header = HeaderOf(message);
  EXPECT_EQ(header.utime, 11);
  EXPECT_EQ(header.seq, 12);
  EXPECT_EQ(header.session, 13);
}

TEST(ConversionsTest, ACovarianceIsItsUpperTriangleRowByRow) {
  Eigen::Matrix3d S;
  S << 1, 2, 3, 2, 4, 5, 3, 5, 6;
  EXPECT_EQ(FromCovariance(S), (std::vector<float>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(ToCovariance({1, 2, 3, 4, 5, 6}), S);
}

/// Joint j of person p: u = 1000 p + 7 j, v = 400 + 50 p - 3 j, confidence (3 j + p + 1) / 100.
person_keypoints_t Keypoints(int layout, int num_people, int num_joints) {
  person_keypoints_t message{};
  message.layout = static_cast<std::int8_t>(layout);
  message.num_people = num_people;
  message.num_joints = num_joints;
  for (int p = 0; p < num_people; ++p) {
    message.u_px.emplace_back();
    message.v_px.emplace_back();
    message.confidence.emplace_back();
    for (int j = 0; j < num_joints; ++j) {
      message.u_px.back().push_back(static_cast<float>(1000 * p + 7 * j));
      message.v_px.back().push_back(static_cast<float>(400 + 50 * p - 3 * j));
      message.confidence.back().push_back(static_cast<float>(3 * j + p + 1) / 100.0F);
    }
  }
  return message;
}

void ExpectJoint(const BodyKeypoint& joint, int person, int number) {
  EXPECT_EQ(joint.u_px, 1000 * person + 7 * number) << number;
  EXPECT_EQ(joint.v_px, 400 + 50 * person - 3 * number) << number;
  EXPECT_NEAR(joint.confidence, 0.01 * (3 * number + person + 1), 1e-6) << number;
}

TEST(ConversionsTest, DetectionsHaveEachJointOfEachPerson) {
  const auto detections = ToDetections(Keypoints(person_keypoints_t::LAYOUT_HALPE26, 3, 26));
  ASSERT_EQ(detections.size(), 3u);
  for (int p = 0; p < 3; ++p) {
    const auto& person = detections[static_cast<std::size_t>(p)];
    ASSERT_EQ(person.size(), 26u);
    for (int j = 0; j < 26; ++j) ExpectJoint(person[static_cast<std::size_t>(j)], p, j);
  }
}

/// Number of each body joint in a layout, as its authors give it; -1: the layout has none.
struct Layout {
  int layout;
  int num_joints;
  std::array<int, kNumJoints> number;
};

TEST(ConversionsTest, EachJointOfEachLayoutIsTheRightOne) {
  const Layout layouts[] = {
      {person_keypoints_t::LAYOUT_COCO18, 18, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}},
      {person_keypoints_t::LAYOUT_COCO17, 17, {0, -1, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15}},
      {person_keypoints_t::LAYOUT_HALPE26, 26, {0, 18, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15}}};
  for (const Layout& layout : layouts) {
    SCOPED_TRACE(layout.num_joints);
    const auto people = ToPeople(Keypoints(layout.layout, 3, layout.num_joints));
    ASSERT_EQ(people.size(), 3u);
    for (int p = 0; p < 3; ++p) {
      for (std::size_t j = 0; j < kNumJoints; ++j) {
        if (layout.number[j] < 0) continue;
        ExpectJoint(people[static_cast<std::size_t>(p)][j], p, layout.number[j]);
      }
    }
  }
}

TEST(ConversionsTest, LayoutsHaveTheNumbersOfTheMessage) {
  EXPECT_EQ(LayoutOf(person_keypoints_t::LAYOUT_COCO18), KeypointLayout::kCoco18);
  EXPECT_EQ(LayoutOf(person_keypoints_t::LAYOUT_COCO17), KeypointLayout::kCoco17);
  EXPECT_EQ(LayoutOf(person_keypoints_t::LAYOUT_HALPE26), KeypointLayout::kHalpe26);
  EXPECT_FALSE(LayoutOf(person_keypoints_t::LAYOUT_INVALID));
}

}  // namespace
}  // namespace airdos
