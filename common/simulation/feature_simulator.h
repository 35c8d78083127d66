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

/// A number of objects of the same kind.
struct ObjectGroup {
  bool is_person = true;
  Behaviour behaviour = Behaviour::kCruise;
  int count = 1;
  int num_points = 14;  ///< per object; a person has 14 to 18
};

/// How the camera moves: along a gently curved path, or panning back and forth while walking.
struct CameraPath {
  double speed_m_s = 1.0;
  double curve_rad_s = 0.05;  ///< largest steady turn rate; a quarter of it up and down
  double min_pan_deg = 0;     ///< turn per frame of a panning camera; 0 for no panning
  double max_pan_deg = 0;     ///< each sequence draws a value between the two
  double pan_limit_deg = 60;  ///< angle at which it turns back
};

/// What Simulate() simulates.
struct SimulationOptions {
  std::uint64_t seed = 1;
  int num_frames = 40;
  double step_s = 0.1;
  StereoCamera camera{640, 360, 400, 400, 320, 180, 0.25};
  CameraPath path;
  double nearest_m = 2;  ///< depth limits within which points are visible
  double farthest_m = 30;
  int static_per_frame = 30;  ///< maximum; tracked landmarks take precedence
  std::vector<ObjectGroup> objects;
  double object_nearest_m = 4;  ///< from the camera, in the middle of the sequence
  double object_farthest_m = 10;
  double min_seen_share = 0.9;  ///< of an object's points, over all frames; else it is re-placed
  double max_object_speed_m_s = 1.5;
  double object_acceleration_m_s2 = 0.2;  ///< see RootMotion
  bool has_point_noise = true;            ///< isotropic in camera axes; otherwise in pixels
  double point_sigma_m = 0.05;
  double pixel_sigma_px = 1.0;    ///< of each of u_left, v and u_right
  double odometry_sigma_m = 0.1;  ///< of each step of the start values, per axis
  double odometry_sigma_deg = 0.3;
};

/// A point as measured by the camera. With pixel noise, p_C is the triangulated point; otherwise,
/// uvu_px is where the measured point would be seen.
struct SimulatedMeasurement {
  int index = 0;   ///< static points: landmark; objects: point of the object
  int object = 0;  ///< unused for static points
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
};

/// One frame: the true pose, a start value, and measurements.
struct SimulatedFrame {
  double time_s = 0;
  Se3 T_W_C;           ///< truth; the first pose is the identity
  Se3 T_W_C_odometry;  ///< start value: exact at first, then with an error in each step
  std::vector<SimulatedMeasurement> static_points;  ///< sorted by index
  std::vector<SimulatedMeasurement> object_points;  ///< sorted by the apparent object, then point
};

/// A simulated world and its frames.
struct SimulatedSequence {
  SimulationOptions options;
  std::vector<Eigen::Vector3d> landmarks_W;  ///< truth
  std::vector<MovingObject> objects;         ///< truth
  std::vector<SimulatedFrame> frames;

  /// The object that appears under the number `object` in a frame: a different one after two people
  /// have been confused.
  std::size_t TrueObject(int object, int frame) const;
  std::vector<int> swap_frame;  ///< per object, when it is confused with another; -1 for never
};

/// Simulates a world at feature level (no images), reproducible by its seed: static points around
/// the path of a camera with a limited field of view, and objects that move through it. W is the
/// first camera's frame, y down. Throws InputError for invalid options.
SimulatedSequence Simulate(const SimulationOptions& options);

}  // namespace airdos

#endif  // AIRDOS_COMMON_SIMULATION_FEATURE_SIMULATOR_H_
