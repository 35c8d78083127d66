#ifndef AIRDOS_TESTS_ESTIMATOR_WINDOW_FRAMES_H_
#define AIRDOS_TESTS_ESTIMATOR_WINDOW_FRAMES_H_

#include <gtest/gtest.h>

#include <cstdint>
#include <optional>

#include "common/optimization/window/sliding_window.h"

// What the tests of the sliding window feed it with: a camera on a path of its own before a small
// cloud of points, all exact.

namespace airdos {

inline const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};

/// A pose of its own for each number, none along an axis.
inline Se3 Pose(double x) {
  return {ExpSo3({0.02 * x, -0.03 * x, 0.01 * x}), {0.1 * x, 0.05 * x * x, -0.02 * x}};
}

inline SlidingWindowOptions StaticOnly() {
  SlidingWindowOptions options;
  options.bundle.use_people = false;
  options.bundle.max_iterations = 50;
  options.bundle.max_iterations_after_rejection = 50;
  options.bundle.function_tolerance = 0;
  options.camera_motion.use_acceleration = false;
  return options;
}

inline FrameInput At(std::int64_t id, double time_s,
                     const std::optional<Se3>& T_O_C = std::nullopt) {
  FrameInput input;
  input.id.value = id;
  input.time_s = time_s;
  input.T_O_C = T_O_C;
  return input;
}

/// Point i of a cloud before the camera.
inline Eigen::Vector3d Point(int i) {
  return {-1.2 + 0.6 * (i % 5), -0.8 + 0.5 * (i / 5 % 4), 3 + 0.7 * (i % 3) + 0.2 * (i % 7)};
}

inline void AddFeatures(const Se3& T_W_C, int first, int last, double sigma_px, FrameInput* input) {
  for (int i = first; i <= last; ++i) {
    input->features.push_back(
        {LandmarkId{i}, kCamera.ProjectStereo(T_W_C.inverse() * Point(i)), true, sigma_px});
  }
}

inline void ExpectPose(const Se3& pose, const Se3& expected) {
  EXPECT_LT(Boxminus(pose, expected).norm(), 1e-9);
}

}  // namespace airdos

#endif  // AIRDOS_TESTS_ESTIMATOR_WINDOW_FRAMES_H_
