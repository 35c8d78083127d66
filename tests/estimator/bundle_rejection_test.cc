#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "common/optimization/bundle/bundle_adjuster.h"

// One wrong measurement of each kind, just below and just above the limit of its own kind, and what
// is counted where.

namespace airdos {
namespace {

const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};
constexpr double kNone = 1e9;
constexpr double kExact = 1e-6;

/// No kind is rejected.
BundleOptions Options() {
  BundleOptions options;
  options.max_iterations = 60;
  options.max_iterations_after_rejection = 60;
  options.function_tolerance = 1e-14;
  options.huber_static_sigmas = options.huber_dynamic_sigmas = kNone;
  options.reject_static_sigmas = options.reject_joint_sigmas = kNone;
  options.reject_rigidity_sigmas = options.reject_motion_sigmas = kNone;
  options.rigidity_sigma_m = 0.02;
  options.motion_sigma_m = 0.05;
  options.person_speed_m_s = 0;
  return options;
}

BundleProblem Empty() {
  BundleProblem problem;
  problem.camera = kCamera;
  problem.frames.push_back({FrameId{3}, 0, {ExpSo3({0.1, 0.2, 0.3}), {1, 2, 3}}, true});
  problem.frames.push_back({FrameId{4}, 0.1, {ExpSo3({0.2, 0.1, 0.3}), {1.2, 2, 3}}, true});
  return problem;
}

/// Measured there, to that, and believed to be where it is.
void AddJoint(int frame, int joint, const Eigen::Vector3d& p_W, double sigma_m, std::size_t human,
              BundleProblem* problem) {
  problem->humans.resize(std::max(problem->humans.size(), human + 1));
  BundleProblem::JointState state;
  state.frame = frame;
  state.joint = joint;
  state.p_W = p_W;
  const Se3& T_W_C = problem->frames[static_cast<std::size_t>(frame)].T_W_C;
  state.point = BundleProblem::PointMeasurement{T_W_C.inverse() * p_W, sigma_m};
  problem->humans[human].id.value = static_cast<std::int64_t>(human) + 1;
  problem->humans[human].joints.push_back(state);
}

struct Counts {
  int num_reprojection, num_rigidity, num_motion;
  friend bool operator==(const Counts& a, const Counts& b) {
    return a.num_reprojection == b.num_reprojection && a.num_rigidity == b.num_rigidity &&
           a.num_motion == b.num_motion;
  }
};

Counts CountsOf(const BundleSummary& summary) {
  return {summary.num_reprojection_rejected, summary.num_rigidity_rejected,
          summary.num_motion_rejected};
}

constexpr Counts kNobody = {0, 0, 0};

/// A landmark that cannot move, seen `sigmas` off its place; and a free frame.
BundleProblem WrongLandmark(double sigmas) {
  BundleProblem problem = Empty();
  problem.frames.push_back({FrameId{5}, 0.2, Se3(), false});
  const Eigen::Vector3d p_C(0.5, 0.2, 5);
  problem.landmarks.push_back({LandmarkId{1}, problem.frames[1].T_W_C * p_C, true});
  const Eigen::Vector3d uvu = kCamera.ProjectStereo(p_C);
  problem.observations.push_back({1, 0, uvu, true, 0.5, false});
  problem.observations.push_back(
      {1, 0, uvu + 0.5 * sigmas * Eigen::Vector3d(0.6, 0, 0.8), true, 0.5, false});
  return problem;
}

TEST(BundleRejection, ALandmark) {
  BundleOptions options = Options();
  options.reject_static_sigmas = 4;
  BundleProblem problem = WrongLandmark(3.99);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
  EXPECT_FALSE(problem.observations[1].is_rejected);
  problem = WrongLandmark(4.01);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), (Counts{1, 0, 0}));
  EXPECT_FALSE(problem.observations[0].is_rejected);
  EXPECT_TRUE(problem.observations[1].is_rejected);
  problem = WrongLandmark(4.01);
  options = Options();
  options.reject_joint_sigmas = options.reject_rigidity_sigmas = options.reject_motion_sigmas = 4;
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
}

/// A knee that is held where it is by a hip and a known length, and measured elsewhere.
BundleProblem WrongJoint(double sigmas) {
  BundleProblem problem = Empty();
  AddJoint(0, kRightHip, {1, 2, 8}, kExact, 0, &problem);
  AddJoint(0, kRightKnee, {1, 2.4 + 0.1 * sigmas, 8}, 0.1, 0, &problem);
  problem.humans[0].joints[1].p_W = {1, 2.4, 8};
  problem.humans[0].segment_length_m[9] = problem.humans[0].known_length_m[9] = 0.4;
  problem.humans[0].known_length_sigma_m[9] = kExact;
  return problem;
}

TEST(BundleRejection, AJoint) {
  BundleOptions options = Options();
  options.rigidity_sigma_m = options.segment_length_sigma_m = kExact;
  options.reject_joint_sigmas = 4;
  BundleProblem problem = WrongJoint(3.99);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
  problem = WrongJoint(4.01);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), (Counts{1, 0, 0}));
  EXPECT_FALSE(problem.humans[0].joints[0].is_rejected);
  EXPECT_TRUE(problem.humans[0].joints[1].is_rejected);
  EXPECT_EQ(problem.humans[0].num_rigidity_rejected, 0);
  options.reject_joint_sigmas = kNone;
  options.reject_static_sigmas = options.reject_rigidity_sigmas = options.reject_motion_sigmas = 4;
  problem = WrongJoint(4.01);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
}

/// Two people; the thigh of the second is longer than known.
BundleProblem WrongLength(double sigmas) {
  BundleProblem problem = Empty();
  for (const std::size_t human : {0U, 1U}) {
    AddJoint(0, kRightHip, {1, 2, 8}, kExact, human, &problem);
    AddJoint(0, kRightKnee, {1, 2.4 + (human == 1 ? 0.02 * sigmas : 0), 8}, kExact, human,
             &problem);
    problem.humans[human].segment_length_m[9] = problem.humans[human].known_length_m[9] = 0.4;
    problem.humans[human].known_length_sigma_m[9] = kExact;
  }
  return problem;
}

TEST(BundleRejection, ALength) {
  BundleOptions options = Options();
  options.segment_length_sigma_m = kExact;
  options.reject_rigidity_sigmas = 4;
  BundleProblem problem = WrongLength(3.99);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
  problem = WrongLength(4.01);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), (Counts{0, 1, 0}));
  EXPECT_EQ(problem.humans[0].num_rigidity_rejected, 0);
  EXPECT_EQ(problem.humans[1].num_rigidity_rejected, 1);
  EXPECT_EQ(problem.humans[1].num_motion_rejected, 0);
  // Counted anew each time.
  SolveBundle(options, &problem);
  EXPECT_EQ(problem.humans[1].num_rigidity_rejected, 1);
  options.reject_rigidity_sigmas = kNone;
  options.reject_static_sigmas = options.reject_joint_sigmas = options.reject_motion_sigmas = 4;
  problem = WrongLength(4.01);
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
}

/// Three joints stay, one moves: its share of the error against the common velocity is 3/4.
BundleProblem WrongStep(double sigmas, double joint_sigma_m = kExact) {
  BundleProblem problem = Empty();
  const double step_m = 0.05 * sigmas / 0.75;
  for (int frame = 0; frame < 2; ++frame) {
    for (const int joint : {kNeck, kRightShoulder, kLeftShoulder, kRightHip}) {
      const double moved_m = joint == kLeftShoulder && frame == 1 ? step_m : 0;
      AddJoint(frame, joint, {1.0 + moved_m, 2, 8.0 + 0.1 * joint}, joint_sigma_m, 0, &problem);
    }
  }
  return problem;
}

TEST(BundleRejection, AMotion) {
  BundleOptions options = Options();
  options.reject_motion_sigmas = 4;
  BundleProblem problem = WrongStep(3.99);
  BundleSummary summary = SolveBundle(options, &problem);
  EXPECT_EQ(CountsOf(summary), kNobody);
  EXPECT_EQ(summary.num_motion, 4);
  EXPECT_NEAR(problem.humans[0].motions[0].motion_W.translation.x(), 0.05 * 3.99 / 3, 1e-5);
  problem = WrongStep(4.01);
  summary = SolveBundle(options, &problem);
  EXPECT_EQ(CountsOf(summary), (Counts{0, 0, 1}));
  EXPECT_EQ(problem.humans[0].num_motion_rejected, 1);
  EXPECT_EQ(problem.humans[0].num_rigidity_rejected, 0);
  EXPECT_NEAR(problem.humans[0].motions[0].motion_W.translation.x(), 0, 1e-5) << "solved again";
  EXPECT_NEAR(summary.initial_cost, 0.5 * (4.01 * 4.01 + 3 * std::pow(4.01 / 3, 2)), 1e-6);
  EXPECT_NEAR(summary.final_cost, 0, 1e-6);
  problem = WrongStep(4.01);
  options.max_iterations_after_rejection = 0;
  const BundleSummary first_pass = SolveBundle(options, &problem);
  EXPECT_EQ(CountsOf(first_pass), kNobody) << "no second pass";
  const auto num_iterations = [&options] {
    BundleProblem from_afar = WrongStep(4.01, 0.01);
    for (BundleProblem::JointState& joint : from_afar.humans[0].joints)
      joint.p_W.z() += joint.joint;
    return SolveBundle(options, &from_afar).num_iterations;
  };
  options.reject_motion_sigmas = 2;  // the anchors are weaker here
  const int num_of_first = num_iterations();
  ASSERT_GT(num_of_first, 2);  // more than the second pass is given
  options.max_iterations_after_rejection = 1;
  EXPECT_GT(num_iterations(), num_of_first) << "both passes count";
  options.reject_motion_sigmas = 4;
  options = Options();
  options.reject_static_sigmas = options.reject_joint_sigmas = options.reject_rigidity_sigmas = 4;
  EXPECT_EQ(CountsOf(SolveBundle(options, &problem)), kNobody);
}

TEST(BundleRejection, TheKernelKeepsOneWildJointFromCarryingTheRest) {
  BundleOptions options = Options();
  options.max_iterations_after_rejection = 0;
  BundleProblem problem = WrongStep(30);  // 2 m
  options.huber_dynamic_sigmas = 2;
  SolveBundle(options, &problem);
  // Three pull with v / sigma each, the fourth with two sigmas at most: v = 2 / 3 sigma.
  EXPECT_NEAR(problem.humans[0].motions[0].motion_W.translation.x(), 0.05 * 2 / 3, 1e-4);
}

TEST(BundleRejection, WhatOnlyFixedFramesSeeStaysWhereItIs) {
  BundleProblem problem = Empty();
  problem.frames.push_back({FrameId{5}, 0.2, {ExpSo3({0.1, 0.1, 0.3}), {1.4, 2, 3}}, false});
  const Se3 start = problem.frames[2].T_W_C, fixed = problem.frames[1].T_W_C;
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3d p_W = fixed * Eigen::Vector3d(-1 + 0.3 * i, 0.5 * (i % 3), 5 + i % 4);
    problem.landmarks.push_back({LandmarkId{i}, p_W + Eigen::Vector3d(0.01, 0, 0), i == 7});
    for (const int frame : {0, 1, 2}) {
      if (frame == 2 && i == 6) continue;
      const Se3& T_W_C = problem.frames[static_cast<std::size_t>(frame)].T_W_C;
      problem.observations.push_back(
          {frame, i, kCamera.ProjectStereo(T_W_C.inverse() * p_W), true, 0.5, false});
    }
  }
  BundleProblem solved = problem;
  const BundleSummary summary = SolveBundle(Options(), &solved);
  for (std::size_t i = 0; i < 8; ++i) {
    const double moved_m = (solved.landmarks[i].p_W - problem.landmarks[i].p_W).norm();
    if (i >= 6) {
      EXPECT_EQ(moved_m, 0) << i;
    } else {
      EXPECT_GT(moved_m, 0.005) << i;
    }
  }
  EXPECT_EQ(solved.frames[1].T_W_C.matrix(), fixed.matrix());
  EXPECT_GT(Boxminus(solved.frames[2].T_W_C, start).norm(), 1e-6) << "7 pulls at it";
  ASSERT_TRUE(summary.newest_covariance);
  problem.frames[2].is_fixed = true;
  EXPECT_FALSE(SolveBundle(Options(), &problem).newest_covariance);
  problem.frames[2].is_fixed = false;
  BundleOptions options = Options();
  options.compute_covariance = false;
  EXPECT_FALSE(SolveBundle(options, &problem).newest_covariance);
}

TEST(BundleRejection, SomebodyOfWhomNothingIsSeenDoesNotCount) {
  BundleProblem problem = WrongStep(0);
  problem.humans.resize(3);
  const BundleSummary summary = SolveBundle(Options(), &problem);
  EXPECT_EQ(summary.num_people, 1);
  EXPECT_EQ(summary.num_rigidity, 0);
}

}  // namespace
}  // namespace airdos
