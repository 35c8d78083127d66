#ifndef AIRDOS_TESTS_SUPPORT_SYNTHETIC_SCENE_H_
#define AIRDOS_TESTS_SUPPORT_SYNTHETIC_SCENE_H_

#include <array>
#include <cstdint>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/skeleton.h"
#include "common/optimization/window/frame_input.h"

namespace airdos {

/// A street seen from a moving stereo camera, with people walking through it. The world has the
/// axes of the first camera: x right, y down, z forward, m.
struct SyntheticSceneOptions {
  std::uint32_t seed = 1;
  int num_frames = 20;
  double step_s = 0.1;
  int num_static = 600;  ///< points along the way
  double nearest_m = 4, farthest_m = 30;
  int max_static_per_frame = 250;
  int num_people = 0;
  double speed_m_s = 1.0;  ///< of the camera, forward along a curve
  double person_speed_m_s = 1.2;
  double sigma_px = 0.5;           ///< noise of static observations; 0 if exact
  double joint_sigma_px = 1.0;     ///< noise of joints; 0 if exact
  double odometry_sigma_m = 0.01;  ///< noise of the frontend's steps, per axis
  double odometry_sigma_rad = 0.002;
  double outlier_ratio = 0;  ///< share of static observations
  double mono_ratio = 0;     ///< share of static observations without a right image
};

/// A simulated street and what is measured in it.
struct SyntheticScene {
  StereoCamera camera;
  std::vector<Se3> T_W_C;                        ///< truth; the first pose is the identity
  std::vector<FrameInput> frames;                ///< input for an optimizer
  std::vector<Eigen::Vector3d> static_points_W;  ///< landmark id = index
  /// joints_W[person][frame][joint]; person id = index + 1
  std::vector<std::vector<std::array<Eigen::Vector3d, kNumJoints>>> joints_W;
};

SyntheticScene MakeSyntheticScene(const SyntheticSceneOptions& options);

/// Joints of a walking person in local axes: origin below the middle of the hips, y down, walking
/// along +x. Limbs swing with `phase_rad`; segments keep their lengths.
std::array<Eigen::Vector3d, kNumJoints> WalkerJoints(double phase_rad);

/// RMS distance of positions, without alignment: both start at the same pose.
double RmsPositionError(const std::vector<Se3>& estimate, const std::vector<Se3>& truth);

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_SYNTHETIC_SCENE_H_
