#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_PROBLEM_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_PROBLEM_H_

#include <Eigen/Core>
#include <array>
#include <memory>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/skeleton.h"
#include "common/optimization/bundle/articulated_model.h"
#include "common/optimization/factors/acceleration_sigma.h"
#include "common/util/ids.h"

namespace airdos {

/// How the motion of people and other moving objects is modelled (paper, eq. 4 and 5).
enum class MotionForm {
  kVelocity,       ///< torso and head share one velocity per frame pair, smoothed over time
  kVelocityTrack,  ///< torso and head share one velocity over the whole window
  kSe3Parts,       ///< the paper's: one rigid motion per rigid part and frame pair
  kSe3Track,       ///< for rigid objects: one rigid motion per part for the whole track
  kSe3Smooth,      ///< for rigid objects: one per part and frame pair, smoothed over time
};

/// How far a track's points deviate from its motion model: one standard deviation per axis.
struct MotionNoise {
  double motion_sigma_m = 0.05;    ///< of a point against the body's motion, per frame pair
  double acceleration_m_s2 = 2.0;  ///< of the change of velocity (kVelocity, kSe3Smooth)
  double angular_acceleration_rad_s2 = 1.0;  ///< likewise (kSe3Smooth)
};

/// The unknowns and measurements of one bundle adjustment with people (paper, eq. 6). Indices refer
/// to the vectors of this struct. The order of the vectors determines the order of the factors in
/// the solver, so whoever fills them sorts by id.
struct BundleProblem {
  /// A stereo frame and its camera pose.
  struct Frame {
    FrameId id;
    double time_s = 0;  ///< capture time
    Se3 T_W_C;          ///< start value, then result
    bool is_fixed = false;
  };
  /// A static point.
  struct Landmark {
    LandmarkId id;
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< start value, then result
    bool is_fixed = false;
  };
  /// A point measured in camera coordinates instead of pixels.
  struct PointMeasurement {
    Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
    double sigma_m = 0.05;  ///< the same in each axis
  };
  /// A static landmark seen in one frame (eq. 1).
  struct LandmarkObservation {
    int frame = 0;
    int landmark = 0;
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< u_left, v, u_right
    bool has_right = true;                             ///< if false, u_right is not a measurement
    double sigma_px = 1;
    bool is_rejected = false;  ///< if true initially, stays out; result: rejected
    /// If set, the pixels are not used.
    std::optional<PointMeasurement> point = std::nullopt;
  };
  /// Three consecutive frames, oldest first, over which the camera moves smoothly.
  struct CameraAcceleration {
    std::array<int, 3> frames = {};
    AccelerationSigma sigma;
  };
  /// One joint of one person, or point of another moving object, in one frame (eq. 2).
  struct JointState {
    int frame = 0;
    int joint = 0;                                  ///< point of the model: COCO-18, 0..13
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< start value, then result
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_px2 = Eigen::Matrix3d::Identity();  ///< of uvu_px
    bool is_rejected = false;  ///< as above: its reprojection, not the joint
    /// If set, the pixels are not used.
    std::optional<PointMeasurement> point = std::nullopt;
  };
  /// How one rigid part (index into the model's parts) moved between the person's previous sighting
  /// and `frame`: p_k = R (p_km1 - centroid_W) + centroid_W + t, R and t in W.
  struct PartMotion {
    int frame = 0;
    int part = 0;
    Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();
    Se3 motion_W;
  };
  /// A person, or any other moving object with its own model.
  struct Human {
    using Lengths = std::vector<std::optional<double>>;  ///< one per segment of the model
    HumanId id;
    std::vector<JointState> joints;   ///< sorted by (frame, joint), at most one of each
    std::vector<PartMotion> motions;  ///< result, sorted by (frame, part)
    /// Initial value, then result; only segments with a value get factors.
    Lengths segment_length_m = Lengths(kNumSegments);
    /// Lengths known from before this window, if the track is older, and their standard deviations.
    Lengths known_length_m = Lengths(kNumSegments);
    std::vector<double> known_length_sigma_m = std::vector<double>(kNumSegments);
    int num_rigidity_rejected = 0;  ///< results
    int num_motion_rejected = 0;
    std::shared_ptr<const ArticulatedModel> model = CocoBodyModel();
    std::optional<MotionForm> motion_form;    ///< if not set, the one of the options
    std::optional<MotionNoise> motion_noise;  ///< if not set, the one of the options
    /// Frames at which the track switched to another person: no motion factor links them to the
    /// previous sighting, and the velocity may change.
    std::set<int> track_breaks;
    /// Initial values for kSe3Track, at most one per part; `frame` is not used. If there is none,
    /// it is computed from the points.
    std::vector<PartMotion> start_motions;
  };

  StereoCamera camera;
  std::vector<Frame> frames;  ///< sorted by id; at least one is fixed
  std::vector<Landmark> landmarks;
  std::vector<LandmarkObservation> observations;
  std::vector<CameraAcceleration> accelerations;
  std::vector<Human> humans;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_PROBLEM_H_
