#include <gtest/gtest.h>

#include <iostream>
#include <random>
#include <set>

#include "common/optimization/window/sliding_window.h"
#include "tests/support/synthetic_scene.h"

namespace airdos {
namespace {

SlidingWindowOptions StaticOnly() {
  SlidingWindowOptions options;
  options.bundle.use_people = false;
  return options;
}

std::vector<FrameResult> RunAll(const SlidingWindowOptions& options, const SyntheticScene& scene) {
  SlidingWindowOptimizer optimizer(options, scene.camera);
  std::vector<FrameResult> results;
  for (const FrameInput& input : scene.frames) results.push_back(optimizer.Process(input));
  return results;
}

std::vector<Se3> Poses(const std::vector<FrameResult>& results) {
  std::vector<Se3> poses;
  for (const FrameResult& result : results) poses.push_back(result.estimate.T_W_C);
  return poses;
}

// The same scene for a seed with every compiler: bounds below were set on it.
TEST(SyntheticSceneTest, AWalkersDepthIsDrawnBeforeItsSide) {
  SyntheticSceneOptions options;
  options.num_static = 0;
  options.num_people = 1;
  std::mt19937 same(options.seed);
  const double z = std::uniform_real_distribution<double>(6, 12)(same);
  const double x = std::uniform_real_distribution<double>(-3, 3)(same);
  const auto joints_W = MakeSyntheticScene(options).joints_W.at(0).at(0);
  const Eigen::Vector3d hips_W = 0.5 * (joints_W[kRightHip] + joints_W[kLeftHip]);
  EXPECT_NEAR(hips_W.x(), x, 1e-12);
  EXPECT_NEAR(hips_W.z(), z, 1e-12);
}

TEST(SlidingWindowTest, ExactMeasurementsGiveTheExactPath) {
  SyntheticSceneOptions options;
  options.sigma_px = 0;
  options.num_frames = 15;
  const SyntheticScene scene = MakeSyntheticScene(options);
  SlidingWindowOptions window = StaticOnly();
  window.camera_motion.use_acceleration = false;  // it would pull the curve straight
  window.bundle.max_iterations = 20;
  window.bundle.function_tolerance = 0;
  const std::vector<FrameResult> results = RunAll(window, scene);
  EXPECT_EQ(results.front().estimate.status, FrameEstimate::Status::kFirstFrame);
  EXPECT_LT(RmsPositionError(Poses(results), scene.T_W_C), 1e-7);
}

TEST(SlidingWindowTest, NoiseGivesASmallError) {
  for (const std::uint32_t seed : {1U, 2U, 3U}) {
    SyntheticSceneOptions options;
    options.seed = seed;
    options.num_frames = 40;
    options.mono_ratio = 0.1;
    const SyntheticScene scene = MakeSyntheticScene(options);
    const double error_m = RmsPositionError(Poses(RunAll(StaticOnly(), scene)), scene.T_W_C);
    EXPECT_LT(error_m, 0.01);  // 4 m of way; odometry alone drifts by several cm
    std::cout << "rms error, m: " << error_m << "\n";
  }
}

TEST(SlidingWindowTest, AJumpOfTheClockDoesNotPullTheCameraBack) {
  SyntheticSceneOptions options;
  options.num_frames = 20;
  options.max_static_per_frame = 12;
  SyntheticScene scene = MakeSyntheticScene(options);
  for (std::size_t k = 0; k < scene.frames.size(); ++k) {
    scene.frames[k].motion_sigma_position_m = 0.03;
    scene.frames[k].motion_sigma_orientation_rad = 0.03;
    if (k >= 12) scene.frames[k].time_s += 60;
  }
  const double error_m = RmsPositionError(Poses(RunAll(StaticOnly(), scene)), scene.T_W_C);
  std::cout << "rms error, m: " << error_m << "\n";
  EXPECT_LT(error_m, 0.03);
}

TEST(SlidingWindowTest, OutliersAreThrownOut) {
  SyntheticSceneOptions options;
  options.num_frames = 30;
  options.outlier_ratio = 0.05;
  const SyntheticScene scene = MakeSyntheticScene(options);
  const std::vector<FrameResult> results = RunAll(StaticOnly(), scene);
  const double error_m = RmsPositionError(Poses(results), scene.T_W_C);
  EXPECT_LT(error_m, 0.015);
  EXPECT_GT(results.back().estimate.summary.num_reprojection_rejected, 10);
}

TEST(SlidingWindowTest, PeopleCarryTheCameraWhereTheStaticSceneIsGone) {
  double sum_without_m = 0, sum_m = 0;
  int num_trusted = 0;
  for (std::uint32_t seed = 1; seed <= 4; ++seed) {
    SyntheticSceneOptions options;
    options.seed = seed;
    options.num_frames = 18;
    options.num_people = 12;
    options.max_static_per_frame = 100;
    options.joint_sigma_px = 0.3;
    SyntheticScene scene = MakeSyntheticScene(options);
    std::mt19937 generator(seed);
    std::normal_distribution<double> normal(0, 0.1);
    for (std::size_t k = 13; k < 17; ++k) {  // the front end coasts, and badly
      scene.frames[k].features.clear();
      scene.frames[k].T_O_C->translation +=
          Eigen::Vector3d{normal(generator), normal(generator), normal(generator)};
    }
    const std::vector<FrameResult> results = RunAll(SlidingWindowOptions(), scene);
    for (std::size_t k = 13; k < 17; ++k) {
      const FrameEstimate& estimate = results[k].estimate;
      const Eigen::Vector3d& truth = scene.T_W_C[k].translation;
      sum_without_m += (estimate.T_W_C_without_people.translation - truth).norm();
      sum_m += (estimate.T_W_C.translation - truth).norm();
      num_trusted += estimate.trusts_people ? 1 : 0;
    }
  }
  std::cout << "mean error, m: trusted " << sum_m / 16 << ", without people " << sum_without_m / 16
            << "; people trusted in " << num_trusted << " of 16\n";
  EXPECT_GE(num_trusted, 8);
  EXPECT_LT(sum_m, 0.7 * sum_without_m);
}

TEST(SlidingWindowTest, PeopleAreNotBelievedOverAStrongStaticScene) {
  SyntheticSceneOptions options;
  options.num_frames = 14;
  options.num_people = 4;
  options.max_static_per_frame = 80;
  const SyntheticScene scene = MakeSyntheticScene(options);
  const std::vector<FrameResult> with = RunAll(SlidingWindowOptions(), scene);
  const std::vector<FrameResult> without = RunAll(StaticOnly(), scene);
  for (std::size_t k = 0; k < with.size(); ++k) {
    EXPECT_FALSE(with[k].estimate.trusts_people);
    EXPECT_EQ(Boxminus(with[k].estimate.T_W_C, without[k].estimate.T_W_C).norm(), 0);
  }
  // Each person of the newest frame, and of the oldest of the people's window once that is full.
  EXPECT_EQ(with[3].changes.humans.size(), scene.frames[3].humans.size());
  EXPECT_EQ(with[10].changes.humans.size(),
            scene.frames[10].humans.size() + scene.frames[3].humans.size());
}

TEST(SlidingWindowTest, DegenerateScenesDoNotCrash) {
  for (const int num_static : {0, 1, 2}) {
    SyntheticSceneOptions options;
    options.num_frames = 16;
    options.max_static_per_frame = num_static;
    options.num_people = 1;
    const SyntheticScene scene = MakeSyntheticScene(options);
    for (const FrameResult& result : RunAll(SlidingWindowOptions(), scene)) {
      EXPECT_TRUE(result.estimate.T_W_C.matrix().allFinite());
      EXPECT_TRUE(result.estimate.covariance.allFinite());
    }
  }
  SyntheticSceneOptions far;
  far.num_frames = 16;
  far.nearest_m = 500;  // disparity of a third of a pixel
  far.farthest_m = 2000;
  const SyntheticScene scene = MakeSyntheticScene(far);
  for (const FrameResult& result : RunAll(StaticOnly(), scene)) {
    EXPECT_TRUE(result.estimate.T_W_C.matrix().allFinite());
  }
}

TEST(SlidingWindowTest, APointThatIsNotStaticIsRemoved) {
  SyntheticSceneOptions options;
  options.num_frames = 12;
  SyntheticScene scene = MakeSyntheticScene(options);
  const LandmarkId mover = scene.frames[3].features[10].id;
  for (FrameInput& input : scene.frames) {
    for (StaticObservation& feature : input.features) {
      if (feature.id == mover) feature.uvu_px.x() += 8.0 * static_cast<double>(input.id.value);
    }
  }
  bool is_removed = false;
  for (const FrameResult& result : RunAll(StaticOnly(), scene)) {
    for (const LandmarkId id : result.changes.removed) is_removed = is_removed || id == mover;
  }
  EXPECT_TRUE(is_removed);
}

TEST(SlidingWindowTest, OnlyWhatMovedIsReported) {
  SyntheticSceneOptions options;
  options.sigma_px = 0;
  options.num_frames = 12;
  const SyntheticScene scene = MakeSyntheticScene(options);
  SlidingWindowOptions window = StaticOnly();
  window.camera_motion.use_acceleration = false;
  window.bundle.function_tolerance = 0;
  window.bundle.max_iterations = 20;
  const std::vector<FrameResult> results = RunAll(window, scene);
  EXPECT_EQ(results[0].changes.landmarks.size(), scene.frames[0].features.size());
  // Each new one, and those of the frame before, which were placed before that was adjusted.
  std::set<LandmarkId> old, newest, reported;
  for (std::size_t k = 0; k < 12; ++k) {
    for (const StaticObservation& feature : scene.frames[k].features) {
      if (k < 10) old.insert(feature.id);
      if (k == 11) newest.insert(feature.id);
    }
  }
  for (const StaticObservation& feature : scene.frames[10].features) newest.erase(feature.id);
  for (const auto& landmark : results[11].changes.landmarks) {
    reported.insert(landmark.id);
    EXPECT_EQ(old.count(landmark.id), 0U) << landmark.id.value;
  }
  for (const LandmarkId id : newest) EXPECT_EQ(reported.count(id), 1U - old.count(id)) << id.value;
  EXPECT_EQ(results[11].changes.frames.size(), 12U);
}

TEST(WindowMapTest, MemoryIsBounded) {
  SyntheticSceneOptions scene_options;
  scene_options.num_frames = 80;
  scene_options.num_static = 400;
  scene_options.max_static_per_frame = 60;
  scene_options.speed_m_s = 4;
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  WindowMapOptions options;
  options.max_key_frames = 4;
  options.forget_after_frames = 5;
  WindowMap map(options);
  for (FrameInput input : scene.frames) {
    // New ids all the time, as a front end gives them that goes on for ever.
    for (StaticObservation& feature : input.features) {
      feature.id.value += 1000 * (input.id.value / 10);
    }
    map.AddFrame(scene.camera, input, *input.T_O_C);
    EXPECT_LE(map.frames().size(), 16U);
    EXPECT_LE(map.window().size(), 12U);
    EXPECT_LT(map.landmarks().size(), 600U);
  }
  EXPECT_EQ(map.frames().size(), 16U);  // 12 of the window and 4 key frames
  EXPECT_EQ(map.window().size(), 12U);
  // Frames 68 to 79 see ids of their own decade; key frames and five frames more keep some.
  EXPECT_LT(map.landmarks().begin()->first.value, 7000);
  EXPECT_GE(map.landmarks().begin()->first.value, 4000);
}

TEST(TrustRuleTest, EachConditionCounts) {
  const TrustOptions options;
  BundleSummary without, with;
  without.newest_covariance = 0.01 * Matrix6d::Identity();
  with.newest_covariance = 0.001 * Matrix6d::Identity();
  with.num_motion = 100;
  const Vector6d shift = 0.1 * Vector6d::Unit(0);
  EXPECT_TRUE(TrustsPeople(options, 10, without, with, shift));
  EXPECT_FALSE(TrustsPeople(options, 30, without, with, shift));      // enough static landmarks
  EXPECT_FALSE(TrustsPeople(options, 10, without, with, 5 * shift));  // 25 > 22.5
  BundleSummary other = with;
  other.num_motion = 10;
  EXPECT_FALSE(TrustsPeople(options, 10, without, other, shift));  // hardly anybody
  other = with;
  other.num_motion_rejected = 30;
  EXPECT_FALSE(TrustsPeople(options, 10, without, other, shift));  // they disagree
  other = with;
  other.newest_covariance = 0.0085 * Matrix6d::Identity();         // 0.85 is more than 0.9 squared
  EXPECT_FALSE(TrustsPeople(options, 10, without, other, shift));  // they do not help
  other.newest_covariance.reset();
  EXPECT_FALSE(TrustsPeople(options, 10, without, other, shift));
}

}  // namespace
}  // namespace airdos
