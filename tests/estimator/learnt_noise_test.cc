#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <functional>
#include <set>
#include <vector>

#include "common/optimization/window/track_noise.h"

// What is learnt of a few measurements, against the posterior in closed form: all measurements at
// once and a fine grid, where the code has a filter and a coarse one.

namespace airdos {
namespace {

const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};

Se3 Pose(double x) { return {ExpSo3({0.3, -0.2 + 0.1 * x, 0.4}), {x, -0.5 * x, 0.25 * x}}; }

/// Frames at these times, each with a camera of its own.
BundleProblem Frames(const std::vector<double>& times_s) {
  BundleProblem problem;
  problem.camera = kCamera;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    problem.frames.push_back({FrameId{static_cast<std::int64_t>(10 + i)}, times_s[i],
                              Pose(static_cast<double>(i)), false});
  }
  problem.humans.resize(1);
  return problem;
}

void AddJoint(int frame, int joint, const Eigen::Vector3d& p_W, double sigma_m,
              BundleProblem* problem) {
  BundleProblem::JointState state;
  state.frame = frame;
  state.joint = joint;
  state.p_W.setConstant(1e3);  // the adjusted point is not looked at
  const Se3& T_W_C = problem->frames[static_cast<std::size_t>(frame)].T_W_C;
  state.point = BundleProblem::PointMeasurement{T_W_C.inverse() * p_W, sigma_m};
  problem->humans[0].joints.push_back(state);
}

double PosteriorMean(double prior, double prior_log_sigma, double least, double largest,
                     const std::function<double(double)>& log_likelihood) {
  constexpr int kSteps = 2400;
  double best = -1e300, sum = 0, weights = 0;
  for (const bool is_counting : {false, true}) {
    for (int i = 0; i <= kSteps; ++i) {
      const double log_sigma = std::log(least) + std::log(largest / least) * i / kSteps;
      const double value = log_likelihood(std::exp(log_sigma)) -
                           0.5 * std::pow((log_sigma - std::log(prior)) / prior_log_sigma, 2);
      if (!is_counting) {
        best = std::max(best, value);
        continue;
      }
      sum += std::exp(value - best) * log_sigma;
      weights += std::exp(value - best);
    }
  }
  return std::exp(sum / weights);
}

double LogNormal(const Eigen::VectorXd& error, const Eigen::MatrixXd& S) {
  return -0.5 * (error.dot(S.inverse() * error) + std::log(S.determinant()));
}

TrackNoiseOptions Options() {
  TrackNoiseOptions options;
  options.prior = {0.05, 2.0, 0.7};
  options.prior_log_sigma = 0.8;
  options.least = {0.005, 0.05, 0.1};
  options.largest = {0.6, 40, 20};
  return options;
}

MotionNoise Learn(const TrackNoiseOptions& options, const BundleProblem& problem) {
  return EstimateMotionNoise(options, problem, problem.humans[0]);
}

TEST(LearntNoise, WhatSaysNothingLeavesThePrior) {
  const MotionNoise noise = Learn(Options(), Frames({0}));
  const auto nothing = [](double) { return 0.0; };
  EXPECT_NEAR(noise.motion_sigma_m, PosteriorMean(0.05, 0.8, 0.005, 0.6, nothing), 1e-3);
  EXPECT_NEAR(noise.acceleration_m_s2, PosteriorMean(2, 0.8, 0.05, 40, nothing), 0.04);
  EXPECT_EQ(noise.angular_acceleration_rad_s2, 0.7) << "that is not learnt";
}

/// Neck and nose, whose two steps differ by `apart`, in the first and, twice as much, in the
/// second.
BundleProblem TwoPoints(const Eigen::Vector3d& apart) {
  BundleProblem problem = Frames({0, 0.1, 0.2});
  const Eigen::Vector3d step(0.1, 0.02, -0.05);
  for (int frame = 0; frame < 3; ++frame) {
    const double parted = frame == 0 ? 0 : frame == 1 ? 1 : 3;
    AddJoint(frame, kNose, Eigen::Vector3d(0, -0.2, 6) + frame * step, 0.01, &problem);
    AddJoint(frame, kNeck, Eigen::Vector3d(0, 0, 6) + frame * step + parted * apart, 0.02,
             &problem);
    AddJoint(frame, kLeftWrist, {3.0 * frame, 0, 6}, 0.01, &problem);  // limbs swing
  }
  return problem;
}

/// Each point is off the mean step by half of what they part; the mean leaves half of the variance
/// of each; the steps share their ends, so that each counts half.
double TwoPointsLikelihood(double sigma_m, const Eigen::Vector3d& apart, bool has_second) {
  double sum = 0;
  for (const double measured : {0.01, 0.02}) {
    const Eigen::Matrix3d S =
        0.5 * (2 * measured * measured + sigma_m * sigma_m) * Eigen::Matrix3d::Identity();
    sum += 0.5 * LogNormal(0.5 * apart, S);
    if (has_second) sum += 0.5 * LogNormal(apart, S);
  }
  return sum;
}

TEST(LearntNoise, HowFarPointsStrayFromTheBody) {
  const Eigen::Vector3d apart(0.02, -0.01, 0.015);
  BundleProblem problem = TwoPoints(apart);
  const auto expected = [&apart](bool has_second) {
    return PosteriorMean(0.05, 0.8, 0.005, 0.6, [&](double sigma_m) {
      return TwoPointsLikelihood(sigma_m, apart, has_second);
    });
  };
  // The grid of 25 places is good to a percent.
  EXPECT_NEAR(Learn(Options(), problem).motion_sigma_m / expected(true), 1, 0.01);
  problem.humans[0].track_breaks = {2};
  EXPECT_NEAR(Learn(Options(), problem).motion_sigma_m / expected(false), 1, 0.01);
  problem.humans[0].track_breaks.clear();
  for (BundleProblem::JointState& joint : problem.humans[0].joints) {
    if (joint.frame == 2 && joint.joint == kNeck) joint.is_rejected = true;
  }
  EXPECT_NEAR(Learn(Options(), problem).motion_sigma_m / expected(false), 1, 0.01);
  EXPECT_GT(std::abs(expected(true) / expected(false) - 1), 0.05);
}

TEST(LearntNoise, TheMeanOfThreeLeavesTwoThirds) {
  BundleProblem problem = Frames({0, 0.1});
  const Eigen::Vector3d stray(0.06, -0.03, 0.03);
  for (int frame = 0; frame < 2; ++frame) {
    AddJoint(frame, kNose, {0, -0.2, 6}, 0.01, &problem);
    AddJoint(frame, kNeck, Eigen::Vector3d(0, 0, 6) + frame * stray, 0.01, &problem);
    AddJoint(frame, kRightHip, {0.1, 0.5, 6}, 0.01, &problem);
  }
  const double expected = PosteriorMean(0.05, 0.8, 0.005, 0.6, [&stray](double sigma_m) {
    const Eigen::Matrix3d S = 2. / 3 * (2e-4 + sigma_m * sigma_m) * Eigen::Matrix3d::Identity();
    return 0.5 * (2 * LogNormal(stray / 3, S) + LogNormal(2 * stray / 3, S));
  });
  EXPECT_NEAR(Learn(Options(), problem).motion_sigma_m / expected, 1, 0.01);
}

TEST(LearntNoise, OneWildStepCountsAsFarAsTheLimit) {
  const Eigen::Vector3d apart(2, 0, 0);
  BundleProblem problem = TwoPoints(apart);
  problem.humans[0].track_breaks = {2};
  TrackNoiseOptions options = Options();
  options.largest_chi2 = 9;
  const double expected = PosteriorMean(0.05, 0.8, 0.005, 0.6, [](double sigma_m) {
    double sum = 0;
    for (const double measured : {0.01, 0.02}) {
      const double variance = 0.5 * (2 * measured * measured + sigma_m * sigma_m);
      sum += -0.25 * (std::min(1 / variance, 9.0) + 3 * std::log(variance));
    }
    return sum;
  });
  EXPECT_NEAR(Learn(options, problem).motion_sigma_m / expected, 1, 0.01);
}

/// Covariance in W of the point of these pixels, by differences of the triangulation.
Eigen::Matrix3d CovarianceW(const Se3& T_W_C, const Eigen::Vector3d& uvu,
                            const Eigen::Matrix3d& covariance_px2) {
  Eigen::Matrix3d J;
  const auto point = [&T_W_C](const Eigen::Vector3d& at) {
    const double z = 500 * 0.3 / (at[0] - at[2]);
    return T_W_C * Eigen::Vector3d((at[0] - 310) / 500 * z, (at[1] - 250) / 470 * z, z);
  };
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = 1e-4 * Eigen::Vector3d::Unit(i);
    J.col(i) = (point(uvu + d) - point(uvu - d)) / 2e-4;
  }
  return J * covariance_px2 * J.transpose();
}

TEST(LearntNoise, PixelsCountByTheirCovarianceInTheWorld) {
  BundleProblem problem = Frames({0, 0.1});
  Eigen::Matrix3d covariance_px2;
  covariance_px2 << 0.12, 0.03, 0.1, 0.03, 0.07, 0.02, 0.1, 0.02, 0.14;
  const std::vector<Eigen::Vector3d> points_W = {Pose(0) * Eigen::Vector3d(-0.3, 0.2, 4),
                                                 Pose(0) * Eigen::Vector3d(0.5, 0.4, 5)};
  const Eigen::Vector3d apart = 0.06 * (Pose(0).rotation * Eigen::Vector3d(0.8, -0.5, 0.3));
  std::vector<Eigen::Matrix3d> covariances(2, Eigen::Matrix3d::Zero());
  for (int frame = 0; frame < 2; ++frame) {
    const Se3& T_W_C = problem.frames[static_cast<std::size_t>(frame)].T_W_C;
    for (std::size_t i = 0; i < 2; ++i) {
      const Eigen::Vector3d p_W = points_W[i] + frame * (i == 1 ? apart : Eigen::Vector3d::Zero());
      AddJoint(frame, i == 0 ? kNose : kNeck, p_W, 1, &problem);
      BundleProblem::JointState& joint = problem.humans[0].joints.back();
      joint.point.reset();
      joint.uvu_px = kCamera.ProjectStereo(T_W_C.inverse() * p_W);
      joint.covariance_px2 = covariance_px2;
      covariances[i] += CovarianceW(T_W_C, joint.uvu_px, covariance_px2);
    }
  }
  const double expected = PosteriorMean(0.05, 0.8, 0.005, 0.6, [&](double sigma_m) {
    double sum = 0;
    for (const Eigen::Matrix3d& covariance : covariances) {
      const Eigen::Matrix3d S =
          0.5 * (covariance + sigma_m * sigma_m * Eigen::Matrix3d::Identity());
      sum += 0.5 * LogNormal(0.5 * apart, S);
    }
    return sum;
  });
  EXPECT_NEAR(Learn(Options(), problem).motion_sigma_m / expected, 1, 0.01);
}

TEST(LearntNoise, TheTurnOfARigidThingIsNoNoise) {
  BundleProblem problem = Frames({0, 0.1, 0.2, 0.3});
  const std::vector<Eigen::Vector3d> points = {
      {0.5, 0, 0}, {-0.4, 0.1, 0.2}, {0, 0.6, -0.1}, {0.1, -0.3, 0.5}};
  const std::vector<int> joints = {kNose, kNeck, kRightShoulder, kLeftShoulder};
  for (int frame = 0; frame < 4; ++frame) {
    for (std::size_t i = 0; i < 4; ++i) {
      const Eigen::Vector3d turned = ExpSo3({0, 0.3 * frame, 0.1 * frame}) * points[i];
      AddJoint(frame, joints[i], turned + Eigen::Vector3d(0.1 * frame, 0, 6), 0.002, &problem);
    }
  }
  for (const MotionForm form :
       {MotionForm::kSe3Parts, MotionForm::kSe3Track, MotionForm::kSe3Smooth}) {
    problem.humans[0].motion_form = form;
    EXPECT_LT(Learn(Options(), problem).motion_sigma_m, 0.012);
  }
  for (const MotionForm form : {MotionForm::kVelocity, MotionForm::kVelocityTrack}) {
    problem.humans[0].motion_form = form;
    EXPECT_GT(Learn(Options(), problem).motion_sigma_m, 0.05);
  }
}

/// The neck alone, at these times and places along a line.
BundleProblem Path(const std::vector<double>& times_s, const std::vector<double>& places_m) {
  BundleProblem problem = Frames(times_s);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    AddJoint(static_cast<int>(i), kNeck, {places_m[i], 0.4, 6 - 0.5 * places_m[i]}, 0.02, &problem);
  }
  return problem;
}

/// With a spread of the points that is known.
TrackNoiseOptions PathOptions() {
  TrackNoiseOptions options = Options();
  options.least.motion_sigma_m = options.largest.motion_sigma_m = 0.3;
  options.camera_sigma_m = 0.03;
  return options;
}

constexpr double kMeasured = 0.02 * 0.02 + 0.03 * 0.03;
constexpr double kStray = 0.3 * 0.3 / 6;  // of the centre of six body points, a step

/// Two steps at once: p_k = p_km1 + h v_k + stray, v_k = v_km1 + h a, v_0 ~ N(0, 2 m/s).
double PathLikelihood(double sigma_m_s2, double h_1, double h_2, const Eigen::Vector2d& moved_m) {
  const double v_1 = 4 + std::pow(sigma_m_s2 * h_1, 2);
  const double v_2 = v_1 + std::pow(sigma_m_s2 * h_2, 2);
  Eigen::Matrix2d S;
  S(0, 0) = 2 * kMeasured + h_1 * h_1 * v_1 + kStray;
  S(0, 1) = S(1, 0) = kMeasured + h_1 * h_1 * v_1 + h_1 * h_2 * v_1 + kStray;
  S(1, 1) = 2 * kMeasured + h_1 * h_1 * v_1 + 2 * h_1 * h_2 * v_1 + h_2 * h_2 * v_2 + 2 * kStray;
  // x, y and z of the line (1, 0, -0.5).
  return LogNormal(moved_m, S) + LogNormal(Eigen::Vector2d::Zero(), S) +
         LogNormal(-0.5 * moved_m, S);
}

double OneStepLikelihood(double sigma_m_s2, double h, double moved_m) {
  const double S = 2 * kMeasured + h * h * (4 + std::pow(sigma_m_s2 * h, 2)) + kStray;
  return -0.5 * (1.25 * moved_m * moved_m / S + 3 * std::log(S));
}

TEST(LearntNoise, HowMuchSomebodyAccelerates) {
  const auto expected = [](const std::function<double(double)>& log_likelihood) {
    return PosteriorMean(2, 0.8, 0.05, 40, log_likelihood);
  };
  // 1 m/s, then 4.5 m/s.
  const BundleProblem problem = Path({0, 0.125, 0.375}, {0, 0.125, 1.25});
  const double both = expected([](double sigma) {
    return PathLikelihood(sigma, 0.125, 0.25, {0.125, 1.25});
  });
  EXPECT_NEAR(Learn(PathOptions(), problem).acceleration_m_s2 / both, 1, 0.01);
  // After a break or more than half a second the filter starts anew.
  const double one = expected([](double sigma) { return OneStepLikelihood(sigma, 0.125, 0.125); });
  BundleProblem broken = problem;
  broken.humans[0].track_breaks = {2};
  EXPECT_NEAR(Learn(PathOptions(), broken).acceleration_m_s2 / one, 1, 0.01);
  const BundleProblem gap = Path({0, 0.125, 0.6875}, {0, 0.125, 1.25});
  EXPECT_NEAR(Learn(PathOptions(), gap).acceleration_m_s2 / one, 1, 0.01);
  const BundleProblem no_gap = Path({0, 0.125, 0.625}, {0, 0.125, 2});
  const double longest = expected([](double sigma) {
    return PathLikelihood(sigma, 0.125, 0.5, {0.125, 2});
  });
  EXPECT_NEAR(Learn(PathOptions(), no_gap).acceleration_m_s2 / longest, 1, 0.01);
}

TEST(LearntNoise, AHiddenPointDoesNotMoveTheBody) {
  std::vector<double> times_s;
  for (int i = 0; i < 12; ++i) times_s.push_back(0.1 * i);
  BundleProblem problem = Frames(times_s);
  for (int frame = 0; frame < 12; ++frame) {
    AddJoint(frame, kNose, {0, -0.5, 6}, 0.01, &problem);
    if (frame % 2 == 0) AddJoint(frame, kNeck, {0.2, 0.5, 6.3}, 0.01, &problem);
  }
  TrackNoiseOptions options = Options();
  options.largest_chi2 = 1e9;
  EXPECT_LT(Learn(options, problem).acceleration_m_s2, 0.5);
  EXPECT_TRUE(FindTrackBreaks({}, problem, problem.humans[0]).empty());
}

/// Standing; from the sighting `at` on, `moved_m` away.
std::set<int> Breaks(const std::vector<double>& times_s, std::size_t at, double moved_m) {
  BundleProblem problem = Frames(times_s);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    const double place_m = i < at ? 0 : moved_m;
    AddJoint(static_cast<int>(i), kNeck, {place_m, 0.4, 6}, 0.02, &problem);
  }
  return FindTrackBreaks({}, problem, problem.humans[0]);
}

TEST(TrackBreaks, ATrackBreaksWhereNobodyCanGo) {
  // The first innovation: 2 R + h^2 (2^2 + (6 h)^2), R = 0.02^2 + 0.1^2; its bound is 30.
  const double R = 0.0104;
  const double limit_m = std::sqrt(30 * (2 * R + 0.01 * (4 + 0.36)));
  EXPECT_TRUE(Breaks({0, 0.1, 0.2}, 1, 0.999 * limit_m).empty());
  EXPECT_EQ(Breaks({0, 0.1, 0.2}, 1, 1.001 * limit_m), std::set<int>{1});
  // Over a step twice as long as usual the velocity walks by sqrt(2), not by 2.
  const double longer_m = std::sqrt(30 * (2 * R + 0.04 * (4 + 2 * 0.36)));
  EXPECT_TRUE(Breaks({0, 0.2, 0.3}, 1, 0.999 * longer_m).empty());
  EXPECT_EQ(Breaks({0, 0.2, 0.3}, 1, 1.001 * longer_m), std::set<int>{1});
  // The shortest step is the usual one, not the last.
  EXPECT_TRUE(Breaks({0, 0.1, 0.3}, 1, 0.999 * limit_m).empty());
  EXPECT_EQ(Breaks({0, 0.1, 0.3}, 1, 1.001 * limit_m), std::set<int>{1});
}

TEST(TrackBreaks, JustAfterAGapItMayHaveBeenBefore) {
  EXPECT_EQ(Breaks({0, 0.1, 0.2, 0.3}, 3, 9), std::set<int>{3});
  EXPECT_EQ(Breaks({0, 0.1, 0.3, 0.4}, 3, 9), (std::set<int>{2, 3}));
  EXPECT_EQ(Breaks({0, 0.1, 0.24, 0.34}, 3, 9), std::set<int>{3}) << "that is no gap";
  EXPECT_TRUE(Breaks({0, 0.1, 0.7, 0.8}, 2, 9).empty()) << "over a long gap anybody goes far";
  EXPECT_EQ(Breaks({0, 0.125, 0.625}, 2, 99), std::set<int>{2}) << "exactly half a second";
}

}  // namespace
}  // namespace airdos
