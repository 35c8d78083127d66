#include "common/optimization/window/sliding_window.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "tests/estimator/window_frames.h"

// What the optimizer passes from one module to the next, by values worked by hand.

namespace airdos {
namespace {

using Status = FrameEstimate::Status;

Se3 Faster(const Se3& before, const Se3& last, double ratio) {
  return Boxplus(last, ratio * Boxminus(last, before));
}

TEST(SlidingWindow, TheFirstFrameStandsWhereTheFrontEndSays) {
  FrameInput input = At(0, 0, Pose(3));
  input.T_W_C = Pose(5);
  SlidingWindowOptimizer known(StaticOnly(), kCamera);
  FrameResult result = known.Process(input);
  EXPECT_EQ(result.estimate.status, Status::kFirstFrame);
  ExpectPose(result.estimate.T_W_C, Pose(5));
  ExpectPose(result.estimate.T_W_C_with_people, Pose(5));
  ExpectPose(result.estimate.T_W_C_without_people, Pose(5));
  EXPECT_EQ(result.estimate.num_window_frames, 1);
  input.T_W_C.reset();
  ExpectPose(SlidingWindowOptimizer(StaticOnly(), kCamera).Process(input).estimate.T_W_C, Pose(3));
  input.T_O_C.reset();
  ExpectPose(SlidingWindowOptimizer(StaticOnly(), kCamera).Process(input).estimate.T_W_C, Se3());
}

TEST(SlidingWindow, WithoutLandmarksTheOdometryLeads) {
  SlidingWindowOptimizer optimizer(StaticOnly(), kCamera);
  std::vector<Se3> T_W_C;
  const auto process = [&](const FrameInput& input) {
    const FrameResult result = optimizer.Process(input);
    T_W_C.push_back(result.estimate.T_W_C);
    if (T_W_C.size() > 1) {
      EXPECT_EQ(result.estimate.status, Status::kPredicted);
      EXPECT_EQ(result.estimate.covariance, Matrix6d(1e4 * Matrix6d::Identity()));
    }
    EXPECT_EQ(result.estimate.num_window_frames, static_cast<int>(T_W_C.size()));
  };
  const Se3 T_W_O = Pose(-4);
  FrameInput input = At(0, 0, T_W_O.inverse() * Pose(0));
  input.T_W_C = Pose(0);
  process(input);
  process(At(1, 0.1, T_W_O.inverse() * Pose(1)));
  ExpectPose(T_W_C[1], Pose(1));
  process(At(2, 0.25));  // the front end says nothing: on as before, for 0.15 s
  ExpectPose(T_W_C[2], Faster(Pose(0), Pose(1), 1.5));
  process(At(3, 0.35, T_W_O.inverse() * Pose(3)));  // from the last frame that it told
  ExpectPose(T_W_C[3], Pose(3));
  input = At(4, 0.4, Pose(50));  // started again: another O, that says nothing of W
  input.odometry_start.value = 4;
  process(input);
  ExpectPose(T_W_C[4], Faster(T_W_C[2], Pose(3), 0.5));
  input = At(5, 0.5, Pose(50) * Pose(2));
  input.odometry_start.value = 4;
  process(input);
  ExpectPose(T_W_C[5], T_W_C[4] * Pose(2));
  process(At(6, 5));  // never more than twice the step before
  ExpectPose(T_W_C[6], Faster(T_W_C[4], T_W_C[5], 2));
  process(At(7, 4));  // a clock that goes back: it stays
  ExpectPose(T_W_C[7], T_W_C[6]);
  process(At(8, 4));  // and one that stands still says nothing of the speed
  ExpectPose(T_W_C[8], T_W_C[7]);
}

TEST(SlidingWindow, ANewLandmarkStandsWhereItIsSeenFromThePrediction) {
  SlidingWindowOptimizer optimizer(StaticOnly(), kCamera);
  FrameInput input = At(0, 0, Pose(2));
  input.T_W_C = Pose(5);
  optimizer.Process(input);
  input = At(1, 0.1, Pose(4));
  AddFeatures(Se3(), 3, 3, 0.5, &input);
  const FrameResult result = optimizer.Process(input);
  ASSERT_EQ(result.changes.landmarks.size(), 1U);
  const Se3 T_W_C = Pose(5) * Pose(2).inverse() * Pose(4);
  EXPECT_LT((result.changes.landmarks[0].p_W - T_W_C * Point(3)).norm(), 1e-9);
}

TEST(SlidingWindow, OdometryGoesOnFromWhereItsFrameIsKnownToBeNow) {
  SlidingWindowOptions options = StaticOnly();
  options.bundle.huber_static_sigmas = options.bundle.reject_static_sigmas = 1e9;
  SlidingWindowOptimizer optimizer(options, kCamera);
  FrameInput input = At(0, 0, Pose(0));
  AddFeatures(Pose(0), 0, 9, 0.5, &input);
  optimizer.Process(input);
  const Se3 T_O_C_1 = Pose(1) * Se3{ExpSo3({0.01, 0.02, 0}), {0.03, -0.02, 0.05}};
  input = At(1, 0.1, T_O_C_1);  // off, and sees nothing known
  AddFeatures(Pose(1), 10, 19, 0.5, &input);
  ExpectPose(optimizer.Process(input).estimate.T_W_C, T_O_C_1);
  input = At(2, 0.2);  // sees what both saw
  AddFeatures(Pose(2), 0, 19, 0.5, &input);
  const FrameResult result = optimizer.Process(input);
  EXPECT_LT(Boxminus(result.changes.frames[1].T_W_C, Pose(1)).norm(), 1e-6);
  const Se3 step = Pose(1).inverse() * Pose(3);
  input = At(3, 0.3, T_O_C_1 * step);
  AddFeatures(Pose(3), 25, 25, 0.5, &input);
  const FrameResult next = optimizer.Process(input);
  EXPECT_LT(Boxminus(next.estimate.T_W_C, Pose(3)).norm(), 1e-6);
  ASSERT_EQ(next.changes.landmarks.size(), 1U) << "seen from there";
  EXPECT_LT((next.changes.landmarks[0].p_W - Point(25)).norm(), 1e-5);
}

TEST(SlidingWindow, OdometryIsComparedOverTheWindowAndAFrame) {
  for (const int num_missed : {3, 4}) {
    SlidingWindowOptions options = StaticOnly();
    options.map.window_frames = 3;
    SlidingWindowOptimizer optimizer(options, kCamera);
    optimizer.Process(At(0, 0, Pose(1)));
    for (int i = 1; i <= num_missed; ++i) optimizer.Process(At(i, 0.1 * i));
    const FrameResult result = optimizer.Process(At(9, 0.9, Pose(2)));
    // Without a second pose the camera stood still so far.
    ExpectPose(result.estimate.T_W_C, num_missed == 3 ? Pose(2) : Pose(1));
  }
}

TEST(SlidingWindow, TheWindowIsReportedAsItIs) {
  SlidingWindowOptions options = StaticOnly();
  options.map.window_frames = 2;
  SlidingWindowOptimizer optimizer(options, kCamera);
  for (int i = 0; i < 3; ++i) {
    const FrameResult result = optimizer.Process(At(10 + i, 0.1 * i, Pose(i)));
    if (i < 2) continue;
    ASSERT_EQ(result.changes.frames.size(), 2U);
    for (int j = 0; j < 2; ++j) {
      const MapChanges::FramePose& frame = result.changes.frames[static_cast<std::size_t>(j)];
      EXPECT_EQ(frame.id.value, 11 + j);
      EXPECT_DOUBLE_EQ(frame.time_s, 0.1 * (1 + j));
      ExpectPose(frame.T_W_C, Pose(1 + j));
    }
  }
}

/// The covariance of a third frame that sees nothing, after two that are known exactly.
Matrix6d CovarianceOfThird(const std::vector<double>& times_s, SlidingWindowOptions options,
                           bool tells_sigma = true) {
  options.camera_motion.use_acceleration = true;
  options.camera_motion.sigma_factor = 0.6;
  SlidingWindowOptimizer optimizer(options, kCamera);
  FrameResult result;
  for (int i = 0; i < 3; ++i) {
    FrameInput input = At(i, times_s[static_cast<std::size_t>(i)], Pose(0));
    if (i < 2) AddFeatures(Pose(0), 0, 19, 1e-4, &input);
    if (i == 1 || tells_sigma) {
      input.motion_sigma_position_m = 0.05;
      input.motion_sigma_orientation_rad = 0.02;
    }
    result = optimizer.Process(input);
  }
  EXPECT_EQ(result.estimate.status, Status::kPredicted) << "nothing is seen in it";
  return result.estimate.covariance;
}

void ExpectSigmas(const Matrix6d& covariance, double position_m, double orientation_rad) {
  for (int i = 0; i < 6; ++i) {
    const double expected = i < 3 ? position_m : orientation_rad;
    EXPECT_NEAR(std::sqrt(covariance(i, i)), expected, 1e-3 * expected) << i;
  }
}

TEST(SlidingWindow, TheCarrierIsAsSteadyAsTheFrontEndSays) {
  // Over equal steps the sigma of the pose is what the front end gave, times the factor.
  ExpectSigmas(CovarianceOfThird({0, 0.125, 0.25}, StaticOnly()), 0.03, 0.012);
  // An acceleration of 0.03 / 0.25^2 for 0.1875 s between the middles of the steps, and 0.25 s.
  ExpectSigmas(CovarianceOfThird({0, 0.125, 0.375}, StaticOnly()), 0.03 * 0.75, 0.012 * 0.75);
  // Said of the frame before only: 0.03 / 0.125^2.
  ExpectSigmas(CovarianceOfThird({0, 0.125, 0.375}, StaticOnly(), false), 0.03 * 3, 0.012 * 3);
  // A step nearly ten times as long, and one of ten times, of which the sigma does not speak.
  const double h = 0.5 * (0.125 + 1.125);
  ExpectSigmas(CovarianceOfThird({0, 0.125, 1.25}, StaticOnly()), 0.03 * h / 1.125,
               0.012 * h / 1.125);
  const double factor = 1.25 * 0.5 * (0.125 + 1.25) / (0.125 * 0.125);
  ExpectSigmas(CovarianceOfThird({0, 0.125, 1.375}, StaticOnly()), 0.03 * factor, 0.012 * factor);
  // Over a clock that goes back there is no factor, and the carrier is as it was.
  ExpectSigmas(CovarianceOfThird({0, 0.125, 0.1}, StaticOnly()), 100, 100);
}

TEST(SlidingWindow, OnlyFramesOfTheWindowMoveSmoothly) {
  SlidingWindowOptions options = StaticOnly();
  options.map.window_frames = 2;
  options.map.key_frame_interval = 1;
  options.camera_motion.use_acceleration = true;
  SlidingWindowOptimizer optimizer(options, kCamera);
  for (int i = 0; i < 6; ++i) {
    FrameInput input = At(i, 0.1 * i, Pose(i));
    input.motion_sigma_position_m = input.motion_sigma_orientation_rad = 1e-5;
    AddFeatures(Pose(i), 0, 19, 0.5, &input);
    // The camera accelerates, and two frames say nothing of that.
    const FrameEstimate estimate = optimizer.Process(input).estimate;
    ExpectPose(estimate.T_W_C, Pose(i));
    EXPECT_EQ(estimate.num_window_frames, std::min(i + 1, 2)) << "key frames are not of it";
  }
}

/// Of a third frame that sees ten known landmarks, one of them falsely, and seven new ones.
FrameEstimate ThirdFrame(const SlidingWindowOptions& options) {
  SlidingWindowOptimizer optimizer(options, kCamera);
  FrameResult result;
  for (int i = 0; i < 3; ++i) {
    FrameInput input = At(i, 0.1 * i, Pose(i));
    AddFeatures(Pose(i), 0, i == 2 ? 16 : 9, 0.5, &input);
    if (i == 2) input.features[4].uvu_px.x() += 50;
    result = optimizer.Process(input);
  }
  return result.estimate;
}

TEST(SlidingWindow, CountsWhatHoldsTheNewestFrame) {
  const FrameEstimate estimate = ThirdFrame(StaticOnly());
  EXPECT_EQ(estimate.num_static_landmarks, 10) << "seven were seen only once";
  EXPECT_EQ(estimate.num_static_observations, 9);
  EXPECT_EQ(estimate.summary.num_reprojection_rejected, 1);
  EXPECT_EQ(estimate.status, Status::kConverged);
  EXPECT_EQ(estimate.id.value, 2);
  EXPECT_LT(estimate.covariance.norm(), 0.1);
  ExpectPose(estimate.T_W_C, Pose(2));
}

TEST(SlidingWindow, ItConvergedIfTheLastPassDid) {
  SlidingWindowOptions options = StaticOnly();
  options.bundle.function_tolerance = 1e-4;
  options.bundle.max_iterations = 1;
  EXPECT_EQ(ThirdFrame(options).status, Status::kConverged) << "after the false one was out";
  options.bundle.max_iterations_after_rejection = 0;
  EXPECT_EQ(ThirdFrame(options).status, Status::kNotConverged);
}

/// d (u_left, v, u_right) / d p_W by differences.
Eigen::Matrix3d Jacobian(const Se3& T_W_C, const Eigen::Vector3d& p_W) {
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = 1e-5 * Eigen::Vector3d::Unit(i);
    const auto uvu = [&T_W_C](const Eigen::Vector3d& p) {
      const Eigen::Vector3d c = T_W_C.inverse() * p;
      return Eigen::Vector3d(500 * c.x() / c.z(), 470 * c.y() / c.z(), 500 * (c.x() - 0.3) / c.z());
    };
    J.col(i) = (uvu(p_W + d) - uvu(p_W - d)) / 2e-5;
  }
  return J;
}

double WorstSigma(const Eigen::Matrix3d& information) {
  return 1 /
         std::sqrt(Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(information).eigenvalues()[0]);
}

std::map<std::int64_t, MapChanges::Landmark> ById(const FrameResult& result) {
  std::map<std::int64_t, MapChanges::Landmark> landmarks;
  for (const MapChanges::Landmark& landmark : result.changes.landmarks) {
    landmarks[landmark.id.value] = landmark;
  }
  return landmarks;
}

TEST(SlidingWindow, ALandmarkIsAsCertainAsItsWorstDirection) {
  SlidingWindowOptions options = StaticOnly();
  options.publish_moved_m = -1;  // everything, always
  SlidingWindowOptimizer optimizer(options, kCamera);
  FrameInput input = At(0, 0, Pose(0));
  AddFeatures(Pose(0), 0, 14, 0.5, &input);
  input.features.push_back({LandmarkId{90}, {400, 200, 399.4}, true, 0.5});  // 250 m
  input.features.push_back({LandmarkId{91}, {400, 200, 0}, false, 0.5});
  auto landmarks = ById(optimizer.Process(input));
  ASSERT_EQ(landmarks.size(), 16U) << "without 91, which has no place yet";
  const Eigen::Matrix3d J_0 = Jacobian(Pose(0), Point(7));
  EXPECT_NEAR(landmarks[7].sigma_m, WorstSigma(4 * J_0.transpose() * J_0), 1e-6);
  EXPECT_EQ(landmarks[7].num_observations, 1);
  EXPECT_LT((landmarks[7].p_W - Point(7)).norm(), 1e-9);
  EXPECT_EQ(landmarks[90].sigma_m, 100) << "never more";

  input = At(1, 0.1, Pose(4));
  AddFeatures(Pose(4), 0, 14, 0.25, &input);
  input.features[7].has_right = false;
  landmarks = ById(optimizer.Process(input));
  Eigen::Matrix3d J_1 = Jacobian(Pose(4), Point(7));
  J_1.row(2).setZero();
  EXPECT_NEAR(landmarks[7].sigma_m,
              WorstSigma(4 * J_0.transpose() * J_0 + 16 * J_1.transpose() * J_1), 1e-6);
  EXPECT_EQ(landmarks[7].num_observations, 2);
  EXPECT_EQ(landmarks.count(90), 1U);
}

/// The landmarks that are published of each of three frames. One starts wrong and comes right.
std::vector<std::map<std::int64_t, MapChanges::Landmark>> Published(double publish_moved_m) {
  SlidingWindowOptions options = StaticOnly();
  options.publish_moved_m = publish_moved_m;
  options.bundle.huber_static_sigmas = options.bundle.reject_static_sigmas = 1e9;
  SlidingWindowOptimizer optimizer(options, kCamera);
  std::vector<std::map<std::int64_t, MapChanges::Landmark>> published;
  for (int i = 0; i < 3; ++i) {
    FrameInput input = At(i, 0.1 * i, Pose(i));
    AddFeatures(Pose(i), 0, 14, 0.5, &input);
    if (i == 0) input.features[7].uvu_px.z() += 1;
    published.push_back(ById(optimizer.Process(input)));
  }
  return published;
}

TEST(SlidingWindow, ALandmarkIsReportedWhenItMovedSinceItWasReported) {
  const auto all = Published(-1);
  const auto moved_m = [&all](std::size_t a, std::size_t b) {
    return (all[a].at(7).p_W - all[b].at(7).p_W).norm();
  };
  ASSERT_GT(moved_m(0, 1), 0.01);
  ASSERT_GT(moved_m(0, 2), 1.1 * moved_m(0, 1));
  ASSERT_GT(moved_m(0, 2), 1.1 * moved_m(1, 2));
  EXPECT_EQ(Published(0.99 * moved_m(0, 1))[1].count(7), 1U);
  ASSERT_LT(moved_m(1, 2), 0.9 * moved_m(0, 1));
  EXPECT_EQ(Published(0.95 * moved_m(0, 1))[2].count(7), 0U) << "reported in the frame before";
  // Twice by less than the limit, together by more.
  const auto some = Published(0.95 * moved_m(0, 2));
  EXPECT_EQ(some[0].size(), 15U);
  EXPECT_EQ(some[1].count(7), 0U);
  EXPECT_EQ(some[2].count(7), 1U);
  EXPECT_EQ(Published(1.01 * moved_m(0, 2))[2].count(7), 0U);
}

}  // namespace
}  // namespace airdos
