#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/human/human_tracker.h"
#include "tests/support/synthetic_people.h"

// When a track starts, is reported, and ends: at exactly each limit.

namespace airdos {
namespace {

const Joints3d kStanding = WalkingPerson({0.3, 0.1, 5}, 0.4);

/// The person in both images, or in the left one alone; joints from `num_joints` on are not seen.
PeopleFrame Frame(const Joints3d& person, std::size_t num_joints = kNumJoints,
                  bool has_right = true) {
  std::mt19937 random(1);
  PeopleFrame frame;
  frame.left.push_back(Detect(kTestCamera, person, false, 0, &random));
  if (has_right) frame.right.push_back(Detect(kTestCamera, person, true, 0, &random));
  for (std::size_t joint = num_joints; joint < kNumJoints; ++joint) {
    frame.left[0][joint].confidence = 0;
    if (has_right) frame.right[0][joint].confidence = 0;
  }
  return frame;
}

TEST(HumanTrackerRules, ATrackEndsJustAfterTheLimit) {
  for (const int num_missed : {4, 5}) {
    HumanTrackerOptions options;
    options.max_missed_frames = 4;
    HumanTracker tracker(options, HumanId{70});
    ASSERT_EQ(tracker.Process(kTestCamera, Frame(kStanding)).humans.at(0).id.value, 70);
    for (int i = 0; i < num_missed; ++i) tracker.Process(kTestCamera, PeopleFrame());
    const TrackedFrame again = tracker.Process(kTestCamera, Frame(kStanding));
    ASSERT_EQ(again.humans.size(), 1U);
    EXPECT_EQ(again.humans[0].id.value, num_missed == 4 ? 70 : 71);
  }
}

TEST(HumanTrackerRules, MissesCountFromTheLastDetection) {
  HumanTrackerOptions options;
  options.max_missed_frames = 2;
  HumanTracker tracker(options);
  for (int i = 0; i < 4; ++i) {
    EXPECT_EQ(tracker.Process(kTestCamera, Frame(kStanding)).humans.at(0).id.value, 1) << i;
    for (int j = 0; j < 2; ++j) tracker.Process(kTestCamera, PeopleFrame());
  }
}

TEST(HumanTrackerRules, IsReportedFromSoManyDetectionsOn) {
  HumanTrackerOptions options;
  options.min_seen_to_report = 3;
  HumanTracker tracker(options);
  EXPECT_TRUE(tracker.Process(kTestCamera, Frame(kStanding)).humans.empty());
  tracker.Process(kTestCamera, PeopleFrame());
  EXPECT_TRUE(tracker.Process(kTestCamera, Frame(kStanding)).humans.empty());
  EXPECT_EQ(tracker.Process(kTestCamera, Frame(kStanding)).humans.size(), 1U);
}

TEST(HumanTrackerRules, IsReportedWithSoManyJoints) {
  HumanTrackerOptions options;
  options.min_joints = 6;
  HumanTracker tracker(options);
  EXPECT_TRUE(tracker.Process(kTestCamera, Frame(kStanding, 5)).humans.empty());
  EXPECT_EQ(tracker.Process(kTestCamera, Frame(kStanding, 6)).humans.size(), 1U);
}

TEST(HumanTrackerRules, WhatMatchesNobodyIsRejected) {
  HumanTrackerOptions options;
  options.use_shift_vote = false;  // one person alone would turn the camera
  HumanTracker tracker(options);
  const Joints3d far = WalkingPerson({1.5, 0.1, 5}, 0.4);
  // Nobody is known yet: a left detection alone starts nobody, nor does a right one.
  EXPECT_EQ(tracker.Process(kTestCamera, Frame(kStanding, kNumJoints, false)).num_rejected, 1);
  PeopleFrame right_only = Frame(kStanding);
  right_only.left.clear();
  EXPECT_EQ(tracker.Process(kTestCamera, right_only).num_rejected, 1);
  EXPECT_EQ(tracker.Process(kTestCamera, Frame(kStanding)).num_rejected, 0);
  // Whom the left image alone shows is known, but without images it has no depth.
  const TrackedFrame left_only = tracker.Process(kTestCamera, Frame(kStanding, kNumJoints, false));
  EXPECT_EQ(left_only.num_rejected, 0);
  EXPECT_TRUE(left_only.humans.empty());
  EXPECT_EQ(tracker.Process(kTestCamera, Frame(far, kNumJoints, false)).num_rejected, 1);
}

TEST(HumanTrackerRules, OneImageGivesLessRoom) {
  // The step that costs `cost`, in squared sigmas of the person's height; clothes that are not seen
  // cost 1.
  const auto step_m = [](double cost) { return std::sqrt(cost - 1) * 0.15 * kPersonHeightM; };
  for (const bool has_right : {true, false}) {
    HumanTrackerOptions options;
    options.max_squared_sigmas = 9;
    options.left_only_max_squared_sigmas = 5;
    options.use_shift_vote = false;
    const double gate = has_right ? 9 : 5;
    for (const double cost : {gate - 0.2, gate + 0.2}) {
      HumanTracker tracker(options);
      tracker.Process(kTestCamera, Frame(kStanding));
      Joints3d moved = kStanding;
      for (Eigen::Vector3d& joint : moved) joint.x() += step_m(cost);
      const TrackedFrame tracked =
          tracker.Process(kTestCamera, Frame(moved, kNumJoints, has_right));
      const bool is_known =
          has_right ? tracked.humans.at(0).id.value == 1 : tracked.num_rejected == 0;
      EXPECT_EQ(is_known, cost < gate) << has_right << ", " << cost;
    }
  }
}

/// The sides of the third frame's left detection are exchanged; where the tracker has the right
/// hip.
double RightHipX(double min_swap_gain_squared_sigmas,
                 double min_doubtful_swap_gain_squared_sigmas) {
  HumanTrackerOptions options;
  options.min_swap_gain_squared_sigmas = min_swap_gain_squared_sigmas;
  options.min_doubtful_swap_gain_squared_sigmas = min_doubtful_swap_gain_squared_sigmas;
  HumanTracker tracker(options);
  for (int i = 0; i < 2; ++i) tracker.Process(kTestCamera, Frame(kStanding));
  PeopleFrame frame = Frame(kStanding);
  frame.left[0] = SwapSides(frame.left[0], SideSwap::kAll);
  const TrackedFrame tracked = tracker.Process(kTestCamera, frame);
  EXPECT_EQ(NumObserved(tracked.humans.at(0).joints), kNumJoints) << "both images have one order";
  return tracked.humans.at(0).joints[kRightHip]->p_C.x();
}

TEST(HumanTrackerRules, WhereImagesDisagreeOnSidesLessDecides) {
  EXPECT_NEAR(RightHipX(1e6, 3), kStanding[kRightHip].x(), 1e-6);
  EXPECT_NEAR(RightHipX(3, 1e6), kStanding[kLeftHip].x(), 1e-6);
}

/// A wall of texture at the person's depth, as the camera sees it that far to the right.
cv::Mat Wall(double shift_px) {
  cv::Mat image(kTestCamera.height, kTestCamera.width, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double x = u + shift_px;
      image.at<unsigned char>(v, u) = static_cast<unsigned char>(
          128 + 40 * std::sin(0.31 * x + 0.2 * v) + 30 * std::sin(0.17 * x * (1 + 0.002 * v)) +
          20 * std::cos(0.53 * x - 0.41 * v));
    }
  }
  return image;
}

/// Somebody who stands before the wall; the third frame is given.
std::vector<TrackedFrame> BeforeTheWall(const HumanTrackerOptions& options,
                                        const std::vector<PeopleFrame>& frames) {
  static const cv::Mat left = Wall(0), right = Wall(38.5);  // 770 * 0.25 / 5
  HumanTracker tracker(options);
  std::vector<TrackedFrame> tracked;
  for (PeopleFrame frame : frames) {
    frame.left_gray = left;
    frame.right_gray = right;
    tracked.push_back(tracker.Process(kTestCamera, frame));
  }
  return tracked;
}

TEST(HumanTrackerRules, WhoIsMissedIsCarriedForSoManyFrames) {
  HumanTrackerOptions options;
  options.max_carried_frames = 2;
  options.carried_sigma_factor = 1.75;
  const PeopleFrame seen = Frame(kStanding);
  const auto tracked = BeforeTheWall(options, {seen, seen, {}, {}, {}});
  for (std::size_t k = 2; k < 4; ++k) {
    ASSERT_EQ(tracked[k].humans.size(), 1U) << k;
    EXPECT_EQ(tracked[k].humans[0].id.value, 1);
    // 0.009 of the height of 1.7 * 38.5 / 0.25 px, and wider by the factor.
    for (const auto& joint : tracked[k].humans[0].joints) {
      if (!joint) continue;
      EXPECT_NEAR(joint->sigma_px, 1.75 * 0.009 * 261.8, 0.01);
      EXPECT_NEAR(joint->p_C.z(), 5, 0.1);
    }
  }
  EXPECT_TRUE(tracked[4].humans.empty());
}

/// The wall, on which another piece hangs around a place of the left image, at the same depth.
PeopleFrame WithPicture(const Eigen::Vector2d& uv_px) {
  PeopleFrame frame;
  frame.left_gray = Wall(0);
  frame.right_gray = Wall(38.5);
  const int u = static_cast<int>(uv_px.x()), v = static_cast<int>(uv_px.y());
  const cv::Rect left(u - 30, v - 30, 60, 60), right(u - 69, v - 30, 60, 60);
  Wall(1000)(left).copyTo(frame.left_gray(left));
  Wall(1038.5)(right).copyTo(frame.right_gray(right));
  return frame;
}

TEST(HumanTrackerRules, AJointThatFlowLostIsNotCarried) {
  const PeopleFrame seen = Frame(kStanding);
  const auto carried = BeforeTheWall({}, {seen, seen, {}});
  ASSERT_EQ(carried[2].humans.size(), 1U);
  int num_tried = 0, num_lost = 0;
  for (std::size_t joint = 0; joint < kNumJoints; ++joint) {
    if (!carried[2].humans[0].joints[joint]) continue;
    HumanTracker tracker({});
    for (int k = 0; k < 2; ++k) {
      PeopleFrame frame = seen;
      frame.left_gray = Wall(0);
      frame.right_gray = Wall(38.5);
      tracker.Process(kTestCamera, frame);
    }
    // There the images have a disparity, but of something else.
    const TrackedFrame lost =
        tracker.Process(kTestCamera, WithPicture(seen.left[0][joint].uv_px()));
    if (lost.humans.empty()) continue;  // hardly anything is left
    num_lost += lost.humans[0].joints[joint] ? 0 : 1;
    ++num_tried;
  }
  // Flow takes what is like enough for the same, here and there.
  EXPECT_GT(num_tried, 1);
  EXPECT_GE(num_lost, num_tried - 1);
}

TEST(HumanTrackerRules, SidesOfOneImageAreExchangedForMuch) {
  PeopleFrame left_only = Frame(kStanding, kNumJoints, false);
  left_only.left[0] = SwapSides(left_only.left[0], SideSwap::kAll);
  const PeopleFrame seen = Frame(kStanding);
  HumanTrackerOptions options;
  options.min_swap_gain_squared_sigmas = 20;
  options.min_doubtful_swap_gain_squared_sigmas = 1e6;
  auto tracked = BeforeTheWall(options, {seen, seen, left_only});
  ASSERT_EQ(tracked[2].humans.size(), 1U);
  ASSERT_TRUE(tracked[2].humans[0].joints[kRightHip]);
  EXPECT_NEAR(tracked[2].humans[0].joints[kRightHip]->p_C.x(), kStanding[kRightHip].x(), 0.05);
  options.min_swap_gain_squared_sigmas = 1e6;
  options.min_doubtful_swap_gain_squared_sigmas = 1;
  tracked = BeforeTheWall(options, {seen, seen, left_only});
  ASSERT_TRUE(tracked[2].humans.at(0).joints[kRightHip]);
  EXPECT_NEAR(tracked[2].humans[0].joints[kRightHip]->p_C.x(), kStanding[kLeftHip].x(), 0.05);
}

TEST(HumanTrackerRules, EachTrackHasOneDetection) {
  HumanTracker tracker({});
  tracker.Process(kTestCamera, Frame(kStanding));
  PeopleFrame twice = Frame(kStanding);
  twice.left.push_back(twice.left[0]);  // as detectors give somebody twice
  const TrackedFrame tracked = tracker.Process(kTestCamera, twice);
  EXPECT_EQ(tracked.humans.size(), 1U);
  EXPECT_EQ(tracked.num_rejected, 1);
}

}  // namespace
}  // namespace airdos
