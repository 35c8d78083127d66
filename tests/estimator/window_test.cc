#include <gtest/gtest.h>

#include <chrono>
#include <cstdlib>
#include <iostream>

#include "common/optimization/sliding_window.h"
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

TEST(SlidingWindowTest, OutliersAreThrownOut) {
  SyntheticSceneOptions options;
  options.num_frames = 30;
  options.outlier_ratio = 0.05;
  const SyntheticScene scene = MakeSyntheticScene(options);
  const std::vector<FrameResult> results = RunAll(StaticOnly(), scene);
  const double error_m = RmsPositionError(Poses(results), scene.T_W_C);
  EXPECT_LT(error_m, 0.015);
  EXPECT_GT(results.back().estimate.summary.num_reprojection_eliminated, 10);
}

TEST(SlidingWindowTest, DISABLED_Timing) {
  SyntheticSceneOptions options;
  options.num_frames = 60;
  options.outlier_ratio = 0.02;
  const SyntheticScene scene = MakeSyntheticScene(options);
  SlidingWindowOptimizer optimizer(StaticOnly(), scene.camera);
  for (const FrameInput& input : scene.frames) {
    const auto start = std::chrono::steady_clock::now();
    const FrameResult r = optimizer.Process(input);
    const double ms =
        std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
    std::cout << input.id.value << " " << ms << " ms it " << r.estimate.summary.num_iterations
              << " lm " << r.estimate.num_static_landmarks << " obs "
              << r.estimate.num_static_observations << " elim "
              << r.estimate.summary.num_reprojection_eliminated << " cost "
              << r.estimate.summary.initial_cost << " -> " << r.estimate.summary.final_cost
              << " changed " << r.changes.landmarks.size() << " removed "
              << r.changes.removed.size() << " sigma "
              << std::sqrt(r.estimate.covariance.topLeftCorner<3, 3>().trace()) << " err "
              << (r.estimate.T_W_C.translation -
                  scene.T_W_C[static_cast<std::size_t>(input.id.value)].translation)
                     .norm()
              << "\n";
  }
}

}  // namespace
}  // namespace airdos
