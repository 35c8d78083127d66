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
    options.gate = 9;
    options.left_only_gate = 5;
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
