#include "common/human/body_mask.h"

#include <gtest/gtest.h>

#include <limits>
#include <random>
#include <vector>

#include "tests/support/synthetic_people.h"

namespace airdos {
namespace {

const cv::Size kSize(kTestCamera.width, kTestCamera.height);
constexpr double kMinConfidence = 0.3;

BodyKeypoints PersonAt(const Eigen::Vector3d& root, double phase = 0.7) {
  std::mt19937 random(1);
  return Detect(kTestCamera, WalkingPerson(root, phase), false, 0, &random);
}

cv::Mat Draw(const std::vector<BodyKeypoints>& people) {
  return DrawBodyMask(people, kSize, kMinConfidence);
}

bool IsOn(const cv::Mat& mask, double u_px, double v_px) {
  return mask.at<uchar>(static_cast<int>(std::lround(v_px)), static_cast<int>(std::lround(u_px))) !=
         0;
}

/// Pixels that are on in the row, in the whole image.
int Width(const cv::Mat& mask, double v_px) {
  return cv::countNonZero(mask.row(static_cast<int>(std::lround(v_px))));
}

TEST(BodyMask, NobodyIsAnEmptyMask) {
  const cv::Mat mask = Draw({});
  EXPECT_EQ(mask.type(), CV_8UC1);
  EXPECT_EQ(mask.size(), kSize);
  EXPECT_EQ(cv::countNonZero(mask), 0);
}

TEST(BodyMask, CoversTheJointsAndWhatLiesBetween) {
  const BodyKeypoints person = PersonAt({0.3, 0.1, 6});
  const cv::Mat mask = Draw({person});
  for (const BodyKeypoint& joint : person) EXPECT_TRUE(IsOn(mask, joint.u_px, joint.v_px));
  for (const Segment& segment : kSegments) {
    const BodyKeypoint& a = person[static_cast<std::size_t>(segment.joint_a)];
    const BodyKeypoint& b = person[static_cast<std::size_t>(segment.joint_b)];
    for (const double part : {0.25, 0.5, 0.75}) {
      EXPECT_TRUE(IsOn(mask, a.u_px + part * (b.u_px - a.u_px), a.v_px + part * (b.v_px - a.v_px)));
    }
  }
  // The middle of the trunk lies on no line between joints.
  const BodyKeypoint& shoulder = person[kRightShoulder];
  const BodyKeypoint& hip = person[kLeftHip];
  EXPECT_TRUE(IsOn(mask, (shoulder.u_px + hip.u_px) / 2, (shoulder.v_px + hip.v_px) / 2));
  // Only 0 and 255, and not half of the image: a person of 1.7 m at 6 m is 200 px high, and less
  // than half as wide.
  EXPECT_EQ(cv::countNonZero(mask == 255), cv::countNonZero(mask));
  EXPECT_LT(cv::countNonZero(mask), 220 * 110);
  EXPECT_FALSE(IsOn(mask, 20, 20));
}

TEST(BodyMask, TheTrunkIsFilledHoweverBroad) {
  // Only the trunk is seen, three times as broad as a line around it is thick.
  BodyKeypoints person;
  person[kRightShoulder] = {200, 100, 1};
  person[kLeftShoulder] = {320, 100, 1};
  person[kRightHip] = {200, 200, 1};
  person[kLeftHip] = {320, 200, 1};
  const cv::Mat mask = Draw({person});
  EXPECT_EQ(cv::countNonZero(mask(cv::Rect(200, 100, 120, 100)) == 0), 0);
}

TEST(BodyMask, AsThickAsThePersonIsLarge) {
  // Just below the elbow's height there are arms and trunk: everything scales with 1 / depth.
  for (const double depth_m : {4.0, 8.0}) {
    const BodyKeypoints person = PersonAt({0, 0, depth_m}, 0);
    const double per_m_px = kTestCamera.fx_px / depth_m;
    const cv::Mat mask = Draw({person});
    // Across the shin: two legs, each a tenth of 1.7 m; slanted lines are cut a little wider.
    const double shin_px = Width(mask, (person[kLeftKnee].v_px + person[kLeftAnkle].v_px) / 2 - 2);
    EXPECT_GT(shin_px / per_m_px, 2 * 0.12) << depth_m;
    EXPECT_LT(shin_px / per_m_px, 2 * 0.25) << depth_m;
  }
  const int near_px = cv::countNonZero(Draw({PersonAt({0, 0, 5})}));
  const int far_px = cv::countNonZero(Draw({PersonAt({0, 0, 10})}));
  EXPECT_NEAR(static_cast<double>(near_px) / far_px, 4, 0.4);
}

TEST(BodyMask, JointsOfLowConfidenceDoNotCount) {
  BodyKeypoints person = PersonAt({0, 0, 6});
  const cv::Mat whole = Draw({person});
  BodyKeypoints wrong = person;
  wrong[kLeftWrist] = {30, 340, kMinConfidence / 2};
  const cv::Mat mask = Draw({wrong});
  EXPECT_FALSE(IsOn(mask, 30, 340));
  EXPECT_EQ(cv::countNonZero(mask & ~whole), 0);
  wrong[kLeftWrist].confidence = kMinConfidence;
  EXPECT_TRUE(IsOn(Draw({wrong}), 30, 340));
}

TEST(BodyMask, APersonOfTwoJointsIsLeftOut) {
  const BodyKeypoints person = PersonAt({0, 0, 6});
  BodyKeypoints few;
  few[kNeck] = person[kNeck];
  few[kLeftHip] = person[kLeftHip];
  EXPECT_EQ(cv::countNonZero(Draw({few})), 0);
  few[kLeftShoulder] = person[kLeftShoulder];
  EXPECT_GT(cv::countNonZero(Draw({few})), 0);
  // The others are painted all the same.
  few[kLeftShoulder] = {};
  EXPECT_EQ(cv::countNonZero(Draw({few, person}) != Draw({person})), 0);
}

TEST(BodyMask, EverybodyIsThere) {
  const cv::Mat both = Draw({PersonAt({-1, 0, 5}), PersonAt({1, 0, 7})});
  const cv::Mat each = Draw({PersonAt({-1, 0, 5})}) | Draw({PersonAt({1, 0, 7})});
  EXPECT_EQ(cv::countNonZero(both != each), 0);
}

TEST(BodyMask, WhoIsPartlyOutsideIsPaintedAsFarAsInside) {
  // The left half of the person is outside the image.
  const cv::Mat mask = Draw({PersonAt({-2.5, 0, 6})});
  EXPECT_GT(cv::countNonZero(mask.colRange(0, 60)), 500);
  EXPECT_EQ(cv::countNonZero(mask.colRange(120, mask.cols)), 0);
  EXPECT_EQ(cv::countNonZero(Draw({PersonAt({-9, 0, 6})})), 0);
}

TEST(BodyMask, ImpossibleCoordinatesDoNoHarm) {
  const double huge[] = {1e6,
                         -1e6,
                         1e18,
                         -1e18,
                         1e300,
                         std::numeric_limits<double>::infinity(),
                         std::numeric_limits<double>::quiet_NaN()};
  for (const double value : huge) {
    BodyKeypoints person = PersonAt({0, 0, 6});
    person[kLeftWrist].u_px = value;
    EXPECT_EQ(Draw({person}).size(), kSize) << value;
    for (BodyKeypoint& joint : person) joint = {value, value, 1};
    EXPECT_EQ(cv::countNonZero(Draw({person})), 0) << value;
    for (BodyKeypoint& joint : person) joint = {value, 100, 1};
    EXPECT_EQ(Draw({person}).size(), kSize) << value;
  }
}

TEST(BodyMask, AllJointsInOnePlaceAreNobody) {
  BodyKeypoints person;
  for (BodyKeypoint& joint : person) joint = {100, 100, 1};
  EXPECT_EQ(cv::countNonZero(Draw({person})), 0);
}

}  // namespace
}  // namespace airdos
