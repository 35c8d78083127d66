#ifndef AIRDOS_COMMON_SIMULATION_FEATURE_SIMULATOR_H_
#define AIRDOS_COMMON_SIMULATION_FEATURE_SIMULATOR_H_

#include <Eigen/Core>
#include <cstdint>
#include <utility>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/simulation/moving_object.h"

namespace airdos {

/// Objects of one kind.
struct ObjectGroup {
  bool is_person = true;
  Behaviour behaviour = Behaviour::kCruise;
  int count = 1;
  int num_points = 14;  ///< of each; a person has 14 to 18
};

/// How the camera moves: along a gently curved path, or panning to and fro as it walks.
struct CameraPath {
  double speed_m_s = 1.0;
  double curve_rad_s = 0.05;  ///< largest steady turn; also up and down, a quarter of it
  double min_pan_deg = 0;     ///< turn from frame to frame of a panning camera; 0: it does not
  double max_pan_deg = 0;     ///< drawn once per sequence between the two
  double pan_limit_deg = 60;  ///< where it turns back
};

struct SimulationOptions {
  std::uint64_t seed = 1;
  int num_frames = 40;
  double step_s = 0.1;
  StereoCamera camera{640, 360, 400, 400, 320, 180, 0.25};
  CameraPath path;
  double nearest_m = 2;  ///< limits of depth within which points are seen
  double farthest_m = 30;
  int static_per_frame = 30;  ///< at most; tracked landmarks come before new ones
  std::vector<ObjectGroup> objects;
  double object_nearest_m = 4;  ///< from the camera, in the middle of the sequence
  double object_farthest_m = 10;
  double min_seen_share = 0.9;  ///< of an object's points over all frames, else it is placed anew
  double max_object_speed_m_s = 1.5;
  double object_acceleration_m_s2 = 0.2;  ///< see RootMotion
  bool has_point_noise = true;            ///< isotropic noise on points in camera axes; else pixels
  double point_sigma_m = 0.05;
  double pixel_sigma_px = 1.0;    ///< of u_left, v and u_right each
  double odometry_sigma_m = 0.1;  ///< of each step of the start values, per axis
  double odometry_sigma_deg = 0.3;
};

/// A point as the camera measures it. With pixel noise p_C is the triangulated point, else uvu_px
/// is where the measured point would be seen.
struct SimulatedMeasurement {
  int index = 0;   ///< static points: of the landmark; objects: of the point
  int object = 0;  ///< static points: not used
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
};

struct SimulatedFrame {
  double time_s = 0;
  Se3 T_W_C;           ///< truth; the first is the identity
  Se3 T_W_C_odometry;  ///< start value: the first is the truth, then each step has an error
  std::vector<SimulatedMeasurement> static_points;  ///< by index
  std::vector<SimulatedMeasurement> object_points;  ///< by object as it is taken for, then point
};

struct SimulatedSequence {
  SimulationOptions options;
  std::vector<Eigen::Vector3d> landmarks_W;  ///< truth
  std::vector<MovingObject> objects;         ///< truth
  std::vector<SimulatedFrame> frames;

  /// The object that is taken for number `object` at a frame: another one once two people have been
  /// mistaken for each other.
  std::size_t TrueObject(int object, int frame) const;
  std::vector<int> swap_frame;  ///< of each object; -1: it is always taken for itself
};

/// A world at the level of features (no images), repeatable by its seed: static points around the
/// path of a camera with a finite field of view, and objects that move through it. W is the first
/// camera's frame, y down. Throws InputError for options that make no sense.
SimulatedSequence Simulate(const SimulationOptions& options);

}  // namespace airdos

#endif  // AIRDOS_COMMON_SIMULATION_FEATURE_SIMULATOR_H_
