#include "common/optimization/window/human_tracks.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <optional>
#include <vector>

namespace airdos {
namespace {

const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};
constexpr std::size_t kRightThigh = 9;
constexpr std::size_t kLeftThigh = 11;

Se3 Pose(double x) { return {ExpSo3({0.1, -0.2, 0.3}), {x, -0.5 * x, 0.25 * x}}; }

Eigen::Matrix3d CovariancePx2() {
  Eigen::Matrix3d S;
  S << 1.2, 0.3, 0.9, 0.3, 0.7, 0.2, 0.9, 0.2, 1.4;
  return S;
}

JointObservation Seen(int joint, const Eigen::Vector3d& p_C) {
  return {joint, kCamera.ProjectStereo(p_C), CovariancePx2()};
}

/// Somebody who shows a thigh of this length and the neck.
HumanObservation Person(std::int64_t id, double thigh_m, double depth_m = 4) {
  return {HumanId{id},
          {Seen(kNeck, {0.5, -0.4, depth_m}), Seen(kRightHip, {0.6, 0.1, depth_m}),
           Seen(kRightKnee, {0.6, 0.1 + thigh_m, depth_m})}};
}

FrameInput Frame(std::int64_t id, std::vector<HumanObservation> humans) {
  FrameInput input;
  input.id.value = id;
  input.time_s = 0.1 * static_cast<double>(id) + 0.05;
  input.humans = std::move(humans);
  return input;
}

HumanTracksOptions Small() {
  HumanTracksOptions options;
  options.window_frames = 3;
  return options;
}

/// With these frames; each at a pose of its own.
BundleProblem ProblemOf(std::int64_t first, std::int64_t last, const HumanTracks& tracks) {
  BundleProblem problem;
  problem.camera = kCamera;
  for (std::int64_t id = first; id <= last; ++id) {
    problem.frames.push_back({FrameId{id}, 0, Pose(static_cast<double>(id)), false});
  }
  tracks.AddTo(&problem);
  return problem;
}

TEST(HumanTracks, AJointComesIntoTheProblemAsItWasSeen) {
  HumanTracks tracks(Small());
  HumanObservation two = Person(9, 0.4);
  two.joints.resize(1);
  tracks.AddFrame(kCamera, Frame(5, {Person(3, 0.4)}));
  tracks.AddFrame(kCamera, Frame(6, {Person(3, 0.5), two}));
  BundleProblem problem;
  problem.humans.resize(7);                     // of before
  for (const std::int64_t id : {2, 4, 5, 6}) {  // two key frames come first
    problem.frames.push_back({FrameId{id}, 0, Pose(static_cast<double>(id)), id < 5});
  }
  tracks.AddTo(&problem);
  ASSERT_EQ(problem.humans.size(), 2U);
  EXPECT_EQ(problem.humans[0].id.value, 3);
  EXPECT_EQ(problem.humans[1].id.value, 9);
  ASSERT_EQ(problem.humans[0].joints.size(), 6U);
  ASSERT_EQ(problem.humans[1].joints.size(), 1U);
  const BundleProblem::JointState& knee = problem.humans[0].joints[5];
  EXPECT_EQ(knee.frame, 3);
  EXPECT_EQ(knee.joint, kRightKnee);
  EXPECT_LT((knee.p_W - Pose(6) * Eigen::Vector3d(0.6, 0.6, 4)).norm(), 1e-9);
  EXPECT_LT((knee.uvu_px - Eigen::Vector3d(385, 320.5, 347.5)).norm(), 1e-9);
  EXPECT_EQ(knee.covariance_px2, CovariancePx2());
  EXPECT_FALSE(knee.is_rejected);
  EXPECT_FALSE(knee.point);
  const BundleProblem::JointState& earlier = problem.humans[0].joints[2];
  EXPECT_EQ(earlier.frame, 2);
  EXPECT_LT((earlier.p_W - Pose(5) * Eigen::Vector3d(0.6, 0.5, 4)).norm(), 1e-9);
  EXPECT_EQ(problem.humans[1].joints[0].frame, 3);
}

TEST(HumanTracks, WhatHasNoDepthIsLeftOut) {
  HumanTracksOptions options = Small();
  options.min_disparity_px = 2;
  options.max_depth_m = 50;
  HumanTracks tracks(options);
  HumanObservation person{HumanId{1}, {}};
  person.joints.push_back({0, {400, 200, 398.25}, CovariancePx2()});
  person.joints.push_back({1, {400, 200, 398}, CovariancePx2()});  // 75 m
  person.joints.push_back({2, {400, 200, 397}, CovariancePx2()});  // 50 m
  person.joints.push_back({3, {400, 200, 397.125}, CovariancePx2()});
  HumanObservation nobody{HumanId{2}, {person.joints[0]}};
  tracks.AddFrame(kCamera, Frame(0, {person, nobody}));
  const BundleProblem problem = ProblemOf(0, 0, tracks);
  ASSERT_EQ(problem.humans.size(), 1U);
  ASSERT_EQ(problem.humans[0].joints.size(), 1U);
  EXPECT_EQ(problem.humans[0].joints[0].joint, 2) << "exactly the farthest";
  options.max_depth_m = 1000;
  HumanTracks far(options);
  far.AddFrame(kCamera, Frame(0, {person}));
  ASSERT_EQ(ProblemOf(0, 0, far).humans[0].joints.size(), 3U);
  EXPECT_EQ(ProblemOf(0, 0, far).humans[0].joints[0].joint, 1) << "exactly the least disparity";
}

TEST(HumanTracks, TheWindowHoldsTheNewestFrames) {
  HumanTracks tracks(Small());
  for (std::int64_t id = 0; id < 2; ++id) tracks.AddFrame(kCamera, Frame(id, {Person(1, 0.4)}));
  EXPECT_FALSE(tracks.is_full());
  tracks.AddFrame(kCamera, Frame(2, {Person(1, 0.4)}));
  EXPECT_TRUE(tracks.is_full());
  EXPECT_EQ(tracks.frames(), (std::vector<FrameId>{{0}, {1}, {2}}));
  tracks.AddFrame(kCamera, Frame(3, {Person(2, 0.4)}));
  EXPECT_EQ(tracks.frames(), (std::vector<FrameId>{{1}, {2}, {3}}));
  const BundleProblem problem = ProblemOf(1, 3, tracks);
  ASSERT_EQ(problem.humans.size(), 2U);
  EXPECT_EQ(problem.humans[0].joints.size(), 6U) << "of frames 1 and 2";
  EXPECT_EQ(problem.humans[1].joints.size(), 3U);
}

/// Joints as a camera with the covariance above measures them; by differences of the projection.
std::map<int, MeasuredJoint> Measured(const HumanObservation& human) {
  std::map<int, MeasuredJoint> joints;
  for (const JointObservation& seen : human.joints) {
    const Eigen::Vector3d p =
        *kCamera.Triangulate(seen.uvu_px.x(), seen.uvu_px.y(), seen.uvu_px.z());
    Eigen::Matrix3d J;
    J << 500 / p.z(), 0, -500 * p.x() / (p.z() * p.z()), 0, 470 / p.z(),
        -470 * p.y() / (p.z() * p.z()), 500 / p.z(), 0, -500 * (p.x() - 0.3) / (p.z() * p.z());
    joints[seen.joint] = {p, J.inverse() * seen.covariance_px2 * J.inverse().transpose()};
  }
  return joints;
}

TEST(HumanTracks, LengthsComeFromAllFramesAndTheKnownOnesFromThoseBeforeTheWindow) {
  HumanTracks tracks(Small());
  SegmentLengths all, before;
  for (std::int64_t id = 0; id < 5; ++id) {
    const HumanObservation person = Person(1, 0.36 + 0.02 * static_cast<double>(id));
    tracks.AddFrame(kCamera, Frame(id, {person}));
    all.Add(Measured(person));
    if (id < 2) before.Add(Measured(person));
  }
  const BundleProblem problem = ProblemOf(2, 4, tracks);
  const BundleProblem::Human& human = problem.humans[0];
  for (const std::size_t thigh : {kRightThigh, kLeftThigh}) {
    ASSERT_TRUE(human.segment_length_m[thigh] && human.known_length_m[thigh]);
    EXPECT_NEAR(*human.segment_length_m[thigh], all.Find(kRightThigh)->mean_m, 1e-9);
    EXPECT_NEAR(*human.known_length_m[thigh], before.Find(kRightThigh)->mean_m, 1e-9);
    EXPECT_NEAR(human.known_length_sigma_m[thigh], before.Find(kRightThigh)->sigma_m, 1e-9);
  }
  EXPECT_GT(std::abs(all.Find(kRightThigh)->mean_m - before.Find(kRightThigh)->mean_m), 1e-3);
  EXPECT_FALSE(human.segment_length_m[4]) << "hip to hip was never seen";
  EXPECT_FALSE(human.known_length_m[4]);
}

TEST(HumanTracks, NothingIsKnownBeforeTheFirstFrameLeft) {
  HumanTracks tracks(Small());
  for (std::int64_t id = 0; id < 3; ++id) tracks.AddFrame(kCamera, Frame(id, {Person(1, 0.4)}));
  BundleProblem problem = ProblemOf(0, 2, tracks);
  EXPECT_TRUE(problem.humans[0].segment_length_m[kRightThigh]);
  EXPECT_FALSE(problem.humans[0].known_length_m[kRightThigh]);
}

TEST(HumanTracks, SomebodyWhoComesBackInTimeIsRemembered) {
  HumanTracksOptions options = Small();
  options.forget_after_frames = 20;
  for (const std::int64_t away : {20, 21}) {
    HumanTracks tracks(options);
    for (std::int64_t id = 0; id < 3; ++id) tracks.AddFrame(kCamera, Frame(id, {Person(1, 0.36)}));
    for (std::int64_t id = 3; id < 2 + away; ++id) tracks.AddFrame(kCamera, Frame(id, {}));
    EXPECT_TRUE(ProblemOf(away - 1, away + 1, tracks).humans.empty()) << "not in the window";
    // Somebody else's frame decides: the limit is looked at after the newest frame came.
    HumanObservation neck = Person(1, 0.36);
    neck.joints.resize(1);
    tracks.AddFrame(kCamera, Frame(2 + away, {Person(7, 0.4)}));
    tracks.AddFrame(kCamera, Frame(3 + away, {neck, Person(7, 0.4)}));
    const BundleProblem problem = ProblemOf(away, 3 + away, tracks);
    ASSERT_EQ(problem.humans.size(), 2U);
    EXPECT_EQ(problem.humans[0].segment_length_m[kRightThigh].has_value(), away == 20) << away;
    EXPECT_EQ(problem.humans[0].known_length_m[kRightThigh].has_value(), away == 20) << away;
    EXPECT_EQ(problem.humans[0].joints.size(), 1U);
  }
}

TEST(HumanTracks, TheResultIsKeptRelativeToItsCamera) {
  HumanTracks tracks(Small());
  for (std::int64_t id = 0; id < 2; ++id) tracks.AddFrame(kCamera, Frame(id, {Person(1, 0.4)}));
  BundleProblem problem = ProblemOf(0, 1, tracks);
  BundleProblem::JointState& knee = problem.humans[0].joints[5];
  problem.frames[1].T_W_C = Pose(7);
  knee.p_W = Pose(7) * Eigen::Vector3d(0.7, 0.8, 4.5);
  problem.humans[0].segment_length_m[kRightThigh] = 9;
  tracks.Absorb(problem);
  // Then the camera is corrected again, and the joint goes with it.
  const BundleProblem next = ProblemOf(0, 1, tracks);
  EXPECT_LT((next.humans[0].joints[5].p_W - Pose(1) * Eigen::Vector3d(0.7, 0.8, 4.5)).norm(), 1e-9);
  EXPECT_LT((next.humans[0].joints[2].p_W - Pose(0) * Eigen::Vector3d(0.6, 0.5, 4)).norm(), 1e-9);
  EXPECT_LT(*next.humans[0].segment_length_m[kRightThigh], 0.5) << "that is from measurements";
  const std::vector<HumanState> states = tracks.Describe({1}, Pose(3), next);
  ASSERT_EQ(states.size(), 1U);
  ASSERT_EQ(states[0].joints.size(), 3U);
  EXPECT_EQ(states[0].joints[2].joint, kRightKnee);
  EXPECT_LT((states[0].joints[2].p_W - Pose(3) * Eigen::Vector3d(0.7, 0.8, 4.5)).norm(), 1e-9);
  EXPECT_LT((states[0].joints[2].p_W_measured - Pose(3) * Eigen::Vector3d(0.6, 0.5, 4)).norm(),
            1e-9);
}

TEST(HumanTracks, ARejectedOrImpossibleJointStartsFromItsMeasurementAgain) {
  HumanTracksOptions options = Small();
  options.max_depth_m = 10;
  HumanTracks tracks(options);
  tracks.AddFrame(kCamera, Frame(0, {Person(1, 0.4), Person(2, 0.4)}));
  BundleProblem problem = ProblemOf(0, 0, tracks);
  std::vector<BundleProblem::JointState>& joints = problem.humans[0].joints;
  joints[0].is_rejected = true;
  joints[0].p_W = Pose(0) * Eigen::Vector3d(1, 1, 5);
  joints[1].p_W = Pose(0) * Eigen::Vector3d(1, 1, -0.001);
  joints[2].p_W = Pose(0) * Eigen::Vector3d(1, 1, 19.9);
  problem.humans[1].joints[0].p_W = Pose(0) * Eigen::Vector3d(1, 1, 20.1);
  problem.humans[1].joints[1].p_W.y() = std::nan("");
  tracks.Absorb(problem);
  const std::vector<HumanState> states = tracks.Describe({0}, Se3(), problem);
  ASSERT_EQ(states.size(), 2U);
  ASSERT_EQ(states[0].joints.size(), 1U);
  EXPECT_EQ(states[0].joints[0].joint, kRightKnee);
  ASSERT_EQ(states[1].joints.size(), 1U);
  EXPECT_EQ(states[1].joints[0].joint, kRightKnee);
  problem = ProblemOf(0, 0, tracks);
  ASSERT_EQ(problem.humans[0].joints.size(), 3U);
  EXPECT_FALSE(problem.humans[0].joints[0].is_rejected) << "it may come back";
  EXPECT_LT((problem.humans[0].joints[0].p_W - Pose(0) * Eigen::Vector3d(0.5, -0.4, 4)).norm(),
            1e-9);
  EXPECT_LT((problem.humans[0].joints[1].p_W - Pose(0) * Eigen::Vector3d(0.6, 0.1, 4)).norm(),
            1e-9);
  EXPECT_LT((problem.humans[0].joints[2].p_W - Pose(0) * Eigen::Vector3d(1, 1, 19.9)).norm(), 1e-9);
  tracks.Absorb(problem);  // now none of them is rejected
  EXPECT_EQ(tracks.Describe({0}, Se3(), problem)[0].joints.size(), 3U);
}

TEST(HumanTracks, DescribesWhoWasThereAndHowTheyMoved) {
  HumanTracks tracks(Small());
  tracks.AddFrame(kCamera, Frame(4, {Person(1, 0.4), Person(2, 0.4)}));
  tracks.AddFrame(kCamera, Frame(5, {Person(2, 0.4), Person(3, 0.4)}));
  BundleProblem problem = ProblemOf(3, 5, tracks);
  const auto add_motion = [&problem](std::size_t human, int frame, int part) {
    BundleProblem::PartMotion motion;
    motion.frame = frame;
    motion.part = part;
    problem.humans[human].motions.push_back(motion);
  };
  add_motion(0, 1, 5);
  add_motion(1, 1, 6);
  add_motion(1, 2, 7);
  add_motion(1, 2, 8);
  add_motion(2, 2, 4);
  const std::vector<HumanState> states = tracks.Describe({5}, Se3(), problem);
  ASSERT_EQ(states.size(), 2U);
  EXPECT_EQ(states[0].id.value, 2);
  EXPECT_EQ(states[1].id.value, 3);
  EXPECT_EQ(states[0].frame.value, 5);
  EXPECT_DOUBLE_EQ(states[0].time_s, 0.55);
  ASSERT_EQ(states[0].motions.size(), 2U);
  EXPECT_EQ(states[0].motions[0].part, 7);
  EXPECT_EQ(states[0].motions[1].part, 8);
  ASSERT_EQ(states[1].motions.size(), 1U);
  EXPECT_EQ(states[1].motions[0].part, 4);
  ASSERT_EQ(states[0].segments.size(), 2U) << "a thigh stands for both";
  EXPECT_EQ(states[0].segments[0].segment, static_cast<int>(kRightThigh));
  EXPECT_EQ(states[0].segments[1].segment, static_cast<int>(kLeftThigh));
  EXPECT_EQ(states[0].segments[0].length_m, *problem.humans[1].segment_length_m[kRightThigh]);
  EXPECT_EQ(tracks.Describe({4}, Se3(), problem)[1].motions.size(), 1U);
  for (const std::int64_t id : {6, 7}) tracks.AddFrame(kCamera, Frame(id, {Person(2, 0.4)}));
  EXPECT_TRUE(tracks.Describe({4}, Se3(), problem).empty()) << "no more in memory";
  EXPECT_DOUBLE_EQ(tracks.Describe({5}, Se3(), problem)[0].time_s, 0.55);
  EXPECT_DOUBLE_EQ(tracks.Describe({7}, Se3(), problem)[0].time_s, 0.75);
}

}  // namespace
}  // namespace airdos
