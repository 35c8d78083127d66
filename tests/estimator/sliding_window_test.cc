#include "common/optimization/sliding_window.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <vector>

#include "tests/support/synthetic_scene.h"

// What the optimizer passes from one module to the next, by values worked by hand.

namespace airdos {
namespace {

using Status = FrameEstimate::Status;

const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};

/// A pose of its own for each number, none along an axis.
Se3 Pose(double x) {
  return {ExpSo3({0.02 * x, -0.03 * x, 0.01 * x}), {0.1 * x, 0.05 * x * x, -0.02 * x}};
}

SlidingWindowOptions StaticOnly() {
  SlidingWindowOptions options;
  options.bundle.use_people = false;
  options.bundle.max_iterations = 50;
  options.bundle.max_iterations_after_elimination = 50;
  options.bundle.function_tolerance = 0;
  options.camera_motion.use_acceleration = false;
  return options;
}

FrameInput At(std::int64_t id, double time_s, const std::optional<Se3>& T_O_C = std::nullopt) {
  FrameInput input;
  input.id.value = id;
  input.time_s = time_s;
  input.T_O_C = T_O_C;
  return input;
}

/// Point i of a cloud before the camera.
Eigen::Vector3d Point(int i) {
  return {-1.2 + 0.6 * (i % 5), -0.8 + 0.5 * (i / 5 % 4), 3 + 0.7 * (i % 3) + 0.2 * (i % 7)};
}

void AddFeatures(const Se3& T_W_C, int first, int last, double sigma_px, FrameInput* input) {
  for (int i = first; i <= last; ++i) {
    input->features.push_back(
        {LandmarkId{i}, kCamera.ProjectStereo(T_W_C.inverse() * Point(i)), true, sigma_px});
  }
}

void ExpectPose(const Se3& pose, const Se3& expected) {
  EXPECT_LT(Boxminus(pose, expected).norm(), 1e-9);
}

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
  options.bundle.huber_static = options.bundle.eliminate_static = 1e9;
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
  EXPECT_EQ(estimate.summary.num_reprojection_eliminated, 1);
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
  options.bundle.max_iterations_after_elimination = 0;
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
  options.bundle.huber_static = options.bundle.eliminate_static = 1e9;
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

/// Where static points are few and joints exact, so that people are believed at times.
SyntheticScene WeakScene() {
  SyntheticSceneOptions options;
  options.seed = 2;
  options.num_frames = 18;
  options.num_people = 12;
  options.max_static_per_frame = 100;
  options.joint_sigma_px = 0.3;
  SyntheticScene scene = MakeSyntheticScene(options);
  for (std::size_t k = 13; k < 17; ++k) {
    scene.frames[k].features.clear();
    scene.frames[k].T_O_C->translation += Eigen::Vector3d(0.06, -0.05, 0.07);
  }
  return scene;
}

std::vector<FrameResult> RunAll(const SlidingWindowOptions& options, const SyntheticScene& scene) {
  SlidingWindowOptimizer optimizer(options, scene.camera);
  std::vector<FrameResult> results;
  for (const FrameInput& input : scene.frames) results.push_back(optimizer.Process(input));
  return results;
}

TEST(SlidingWindow, WhoIsBelievedGivesThePoseAndOldFramesAreNotForPeopleToMove) {
  const SyntheticScene scene = WeakScene();
  SlidingWindowOptions options;
  options.people.window_frames = 5;
  const std::vector<FrameResult> with = RunAll(options, scene);
  options.bundle.use_people = false;
  const std::vector<FrameResult> without = RunAll(options, scene);
  std::size_t first = 0;
  while (first < with.size() && !with[first].estimate.trusts_people) ++first;
  ASSERT_LT(first, with.size());
  ASSERT_GE(first, 13U);
  const FrameEstimate& estimate = with[first].estimate;
  ExpectPose(estimate.T_W_C, estimate.T_W_C_with_people);
  ExpectPose(estimate.T_W_C_without_people, without[first].estimate.T_W_C);
  EXPECT_GT(Boxminus(estimate.T_W_C_with_people, estimate.T_W_C_without_people).norm(), 1e-3);
  const auto position_variance = [](const FrameEstimate& of) {
    return Eigen::Matrix3d(of.covariance.topLeftCorner<3, 3>()).trace();
  };
  EXPECT_LT(position_variance(estimate), position_variance(without[first].estimate));
  EXPECT_EQ(estimate.num_static_observations, 0);
  EXPECT_NE(estimate.status, Status::kPredicted);
  EXPECT_NE(estimate.summary.initial_cost, without[first].estimate.summary.initial_cost);
  const std::size_t num_frames = with[first].changes.frames.size();
  ASSERT_EQ(num_frames, 12U);
  for (std::size_t i = 0; i < num_frames; ++i) {
    const double moved =
        Boxminus(with[first].changes.frames[i].T_W_C, without[first].changes.frames[i].T_W_C)
            .norm();
    if (i < num_frames - 5) {
      EXPECT_EQ(moved, 0) << i;
    } else {
      EXPECT_GT(moved, 0) << i;
    }
  }
}

TEST(SlidingWindow, WhereTheStaticSceneIsStrongTheSummaryIsItsOwn) {
  SyntheticSceneOptions scene_options;
  scene_options.num_frames = 6;
  scene_options.num_people = 3;
  scene_options.max_static_per_frame = 60;
  scene_options.sigma_px = scene_options.joint_sigma_px = 0.1;
  SyntheticScene scene = MakeSyntheticScene(scene_options);
  scene.frames[5].features[3].uvu_px.x() += 40;
  scene.frames[5].humans[0].joints[3].uvu_px.x() += 40;
  SlidingWindowOptions options;
  options.bundle.max_iterations = options.bundle.max_iterations_after_elimination = 30;
  const std::vector<FrameResult> with = RunAll(options, scene);
  options.bundle.use_people = false;
  const std::vector<FrameResult> without = RunAll(options, scene);
  const BundleSummary& both = with[5].estimate.summary;
  const BundleSummary& one = without[5].estimate.summary;
  EXPECT_EQ(one.num_reprojection_eliminated, 1);
  EXPECT_EQ(both.num_reprojection_eliminated, 2) << "the landmark and the joint";
  EXPECT_GT(both.num_iterations, one.num_iterations);
  EXPECT_EQ(both.initial_cost, one.initial_cost);
  EXPECT_EQ(both.final_cost, one.final_cost);
  EXPECT_EQ(both.has_converged, one.has_converged);
  EXPECT_EQ(both.num_people, 3);
  // One step each: as many iterations again.
  options.bundle.max_iterations = 1;
  options.bundle.max_iterations_after_elimination = 0;
  const int num_alone = RunAll(options, scene)[5].estimate.summary.num_iterations;
  options.bundle.use_people = true;
  EXPECT_EQ(RunAll(options, scene)[5].estimate.summary.num_iterations, 2 * num_alone);
  EXPECT_EQ(with[5].estimate.covariance, without[5].estimate.covariance);
}

/// Two frames with so many static points, and people.
SyntheticScene TwoFrames(int num_static) {
  SyntheticSceneOptions options;
  options.num_frames = 2;
  options.num_people = 3;
  SyntheticScene scene = MakeSyntheticScene(options);
  for (FrameInput& input : scene.frames) {
    std::vector<StaticObservation> both;
    for (const StaticObservation& feature : input.features) {
      const auto is_it = [&feature](const StaticObservation& o) { return o.id == feature.id; };
      const auto& first = scene.frames[0].features;
      const auto& second = scene.frames[1].features;
      if (std::any_of(first.begin(), first.end(), is_it) &&
          std::any_of(second.begin(), second.end(), is_it)) {
        both.push_back(feature);
      }
    }
    input.features = both;
  }
  for (FrameInput& input : scene.frames)
    input.features.resize(static_cast<std::size_t>(num_static));
  return scene;
}

/// The adjustment with people of the second frame, step by step.
Se3 PoseWithPeople(const SyntheticScene& scene, const SlidingWindowOptions& options,
                   bool are_landmarks_fixed) {
  WindowMap map(options.map);
  HumanTracks people(options.people);
  for (const FrameInput& input : scene.frames) {
    map.AddFrame(scene.camera, input,
                 scene.frames[0].T_W_C.value_or(*scene.frames[0].T_O_C) *
                     (scene.frames[0].T_O_C->inverse() * *input.T_O_C));
    people.AddFrame(scene.camera, input);
  }
  BundleProblem problem = map.BuildProblem(scene.camera);
  BundleOptions bundle = options.bundle;
  bundle.use_people = false;
  SolveBundle(bundle, &problem);
  for (BundleProblem::Landmark& landmark : problem.landmarks)
    landmark.is_fixed = are_landmarks_fixed;
  people.AddTo(&problem);
  SolveBundle(options.bundle, &problem);
  return problem.frames.back().T_W_C;
}

TEST(SlidingWindow, PeopleDoNotMoveTheLandmarksOfAStrongScene) {
  SlidingWindowOptions options;
  options.learn_track_noise = false;
  options.camera_motion.use_acceleration = false;
  options.bundle.eliminate_static = 1e9;  // all of them count
  options.trust.min_static_observations = 20;
  for (const int num_static : {20, 19}) {
    const SyntheticScene scene = TwoFrames(num_static);
    const FrameEstimate estimate = RunAll(options, scene)[1].estimate;
    ASSERT_EQ(estimate.num_static_observations, num_static);
    const Se3 fixed = PoseWithPeople(scene, options, true);
    const Se3 free = PoseWithPeople(scene, options, false);
    ASSERT_GT(Boxminus(fixed, free).norm(), 1e-6);
    ExpectPose(estimate.T_W_C_with_people, num_static == 20 ? fixed : free);
  }
}

TEST(SlidingWindow, NoMotionLeadsToWhereATrackBecameSomebodyElses) {
  SlidingWindowOptions options = StaticOnly();
  options.bundle.use_people = true;
  SlidingWindowOptimizer optimizer(options, kCamera);
  BundleSummary summary;
  for (int i = 0; i < 6; ++i) {
    FrameInput input = At(i, 0.1 * i, Pose(0));
    AddFeatures(Pose(0), 0, 19, 0.5, &input);
    HumanObservation person{HumanId{1}, {}};
    for (const int joint : {kNeck, kRightShoulder, kLeftShoulder}) {
      const Eigen::Vector3d p_C(-1.5 + 0.2 * joint + (i < 3 ? 0 : 3), 0.1, 4);
      person.joints.push_back({joint, kCamera.ProjectStereo(p_C), Eigen::Matrix3d::Identity()});
    }
    input.humans.push_back(person);
    summary = optimizer.Process(input).estimate.summary;
  }
  EXPECT_EQ(summary.num_motion, 3 * 4) << "of five steps one is none";
}

TEST(SlidingWindow, PeopleAreDescribedWhenTheyComeAndWhenTheyLeave) {
  SyntheticSceneOptions scene_options;
  scene_options.num_frames = 7;
  scene_options.num_people = 3;
  scene_options.sigma_px = scene_options.joint_sigma_px = 0;
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  SlidingWindowOptions options;
  options.map.window_frames = 4;  // cuts the people's eight
  const std::vector<FrameResult> results = RunAll(options, scene);
  for (std::size_t k = 0; k < results.size(); ++k) {
    std::map<std::int64_t, std::size_t> num_of_frame;
    for (const HumanState& state : results[k].changes.humans) {
      ++num_of_frame[state.frame.value];
      ASSERT_FALSE(state.joints.empty());
      const auto& truth_W = scene.joints_W[static_cast<std::size_t>(state.id.value - 1)]
                                          [static_cast<std::size_t>(state.frame.value)];
      EXPECT_DOUBLE_EQ(state.time_s,
                       scene.frames[static_cast<std::size_t>(state.frame.value)].time_s);
      for (const HumanState::JointPosition& joint : state.joints) {
        // Triangulated from exact pixels, and placed by a camera that is a few mm off.
        const auto j = static_cast<std::size_t>(joint.joint);
        EXPECT_LT((joint.p_W_measured - truth_W[j]).norm(), 0.01);
      }
    }
    std::map<std::int64_t, std::size_t> expected;
    expected[static_cast<std::int64_t>(k)] = scene.frames[k].humans.size();
    if (k >= 3) expected[static_cast<std::int64_t>(k - 3)] = scene.frames[k - 3].humans.size();
    EXPECT_EQ(num_of_frame, expected) << k;
  }
}

}  // namespace
}  // namespace airdos
