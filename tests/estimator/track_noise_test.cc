#include "common/optimization/window/track_noise.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

#include "common/simulation/random.h"

namespace airdos {
namespace {

struct Walk {
  double acceleration_m_s2 = 0.5;
  double motion_sigma_m = 0.03;
  double sigma_m = 0.02;  // of the measurements
  int num_frames = 60;
  int jump_frame = -1;  // from where on it is somebody 3 m away
  int missed_from = -1, missed_to = -1;
};

/// A body that a still camera sees and that moves exactly as the model says.
BundleProblem MakeWalk(const Walk& walk, std::uint64_t seed) {
  Random random(seed);
  BundleProblem problem;
  BundleProblem::Human human;
  Eigen::Vector3d velocity_m_s(1, 0, 0.3);
  std::vector<Eigen::Vector3d> points_W;
  for (std::size_t i = 0; i < human.model->body_points.size(); ++i) {
    points_W.push_back(Eigen::Vector3d(0, 0, 6) + random.Normal3(0.25));
  }
  for (int k = 0; k < walk.num_frames; ++k) {
    problem.frames.push_back({FrameId{k}, 0.1 * k, Se3(), true});
    if (k == walk.jump_frame) {
      for (Eigen::Vector3d& point : points_W) point.x() += 3;
    }
    for (std::size_t i = 0; i < points_W.size(); ++i) {
      if (k > 0) points_W[i] += 0.1 * velocity_m_s + random.Normal3(walk.motion_sigma_m);
      if (k >= walk.missed_from && k < walk.missed_to) continue;
      BundleProblem::JointState joint;
      joint.frame = k;
      joint.joint = human.model->body_points[i];
      joint.p_W = points_W[i] + random.Normal3(walk.sigma_m);
      joint.point = BundleProblem::PointMeasurement{joint.p_W, walk.sigma_m};
      human.joints.push_back(joint);
    }
    velocity_m_s += random.Normal3(walk.acceleration_m_s2 * 0.1);
  }
  problem.humans.push_back(human);
  return problem;
}

MotionNoise Learn(const Walk& walk, std::uint64_t seed) {
  const BundleProblem problem = MakeWalk(walk, seed);
  return EstimateMotionNoise({}, problem, problem.humans[0]);
}

TEST(TrackNoiseTest, LearnsHowSomebodyMoves) {
  for (const double acceleration_m_s2 : {0.5, 2.0, 6.0}) {
    for (const double motion_sigma_m : {0.02, 0.06}) {
      Walk walk;
      walk.acceleration_m_s2 = acceleration_m_s2;
      walk.motion_sigma_m = motion_sigma_m;
      double log_acceleration = 0, log_motion = 0;
      constexpr int kRuns = 10;
      for (std::uint64_t seed = 1; seed <= kRuns; ++seed) {
        const MotionNoise noise = Learn(walk, seed);
        log_acceleration += std::log(noise.acceleration_m_s2) / kRuns;
        log_motion += std::log(noise.motion_sigma_m) / kRuns;
      }
      // The geometric mean of ten; the prior (3 m/s^2, 3 cm) draws each a little.
      EXPECT_NEAR(std::exp(log_acceleration) / acceleration_m_s2, 1, 0.35);
      EXPECT_NEAR(std::exp(log_motion) / motion_sigma_m, 1, 0.15);
    }
  }
}

TEST(TrackNoiseTest, ATrackThatSaysNothingKeepsThePrior) {
  const MotionNoise prior = TrackNoiseOptions().prior;
  Walk walk;
  walk.num_frames = 1;
  // The bounds cut the prior, which shifts its mean by up to a third.
  const MotionNoise single = Learn(walk, 1);
  EXPECT_NEAR(single.acceleration_m_s2, prior.acceleration_m_s2, 0.3 * prior.acceleration_m_s2);
  EXPECT_NEAR(single.motion_sigma_m, prior.motion_sigma_m, 0.3 * prior.motion_sigma_m);
  walk.num_frames = 30;
  walk.sigma_m = 2;  // far away: half a metre to and fro says nothing about 5 cm
  const MotionNoise distant = Learn(walk, 1);
  EXPECT_GT(distant.acceleration_m_s2, 0.3 * prior.acceleration_m_s2);
  EXPECT_LT(distant.acceleration_m_s2, 3 * prior.acceleration_m_s2);
  // Nobody at all.
  BundleProblem problem;
  problem.humans.resize(1);
  EXPECT_GT(EstimateMotionNoise({}, problem, problem.humans[0]).acceleration_m_s2, 1);
  EXPECT_TRUE(FindTrackBreaks({}, problem, problem.humans[0]).empty());
}

TEST(TrackNoiseTest, OneWrongJointDoesNotSpeakForATrack) {
  BundleProblem problem = MakeWalk({}, 3);
  const MotionNoise before = EstimateMotionNoise({}, problem, problem.humans[0]);
  problem.humans[0].joints[40].point->p_C.z() += 5;
  const MotionNoise after = EstimateMotionNoise({}, problem, problem.humans[0]);
  EXPECT_LT(after.motion_sigma_m, 1.5 * before.motion_sigma_m);
}

TEST(TrackNoiseTest, FindsWhereATrackBecameSomebodyElse) {
  Walk walk;
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    walk.jump_frame = -1;
    walk.acceleration_m_s2 = 3;  // wild, but one person
    BundleProblem problem = MakeWalk(walk, seed);
    EXPECT_TRUE(FindTrackBreaks({}, problem, problem.humans[0]).empty()) << seed;
    walk.jump_frame = 30;
    problem = MakeWalk(walk, seed);
    EXPECT_EQ(FindTrackBreaks({}, problem, problem.humans[0]), std::set<int>{30}) << seed;
    // Mistaken for each other while neither was seen.
    walk.missed_from = 30;
    walk.missed_to = 31;
    problem = MakeWalk(walk, seed);
    EXPECT_EQ(FindTrackBreaks({}, problem, problem.humans[0]).count(31), 1U) << seed;
    walk.missed_from = walk.missed_to = -1;
  }
}

TEST(TrackNoiseTest, ABreakDoesNotCountAsAcceleration) {
  Walk walk;
  walk.jump_frame = 30;
  BundleProblem problem = MakeWalk(walk, 4);
  BundleProblem::Human& human = problem.humans[0];
  const double with_jump = EstimateMotionNoise({}, problem, human).acceleration_m_s2;
  human.track_breaks = FindTrackBreaks({}, problem, human);
  const double without_jump = EstimateMotionNoise({}, problem, human).acceleration_m_s2;
  EXPECT_LT(without_jump, 1.0);
  EXPECT_GT(with_jump, 1.5 * without_jump);
}

}  // namespace
}  // namespace airdos
