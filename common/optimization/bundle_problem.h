#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_PROBLEM_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_PROBLEM_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/skeleton.h"
#include "common/util/ids.h"

namespace airdos {

/// How much a carrier may accelerate: one standard deviation, per axis.
struct AccelerationSigma {
  double linear_m_s2 = 2.0;
  double angular_rad_s2 = 5.0;
};

/// The unknowns and measurements of one bundle adjustment with people (paper, eq. 6). Indices point
/// into the vectors of the same struct. The order of the vectors decides the order in which factors
/// reach the solver, so whoever fills them sorts by id.
struct BundleProblem {
  struct Frame {
    FrameId id;
    double time_s = 0;  ///< capture time
    Se3 T_W_C;          ///< start value, then result
    bool is_fixed = false;
  };
  struct Landmark {
    LandmarkId id;
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< start value, then result
    bool is_fixed = false;
  };
  /// A static landmark seen in one frame (eq. 1).
  struct LandmarkObservation {
    int frame = 0;
    int landmark = 0;
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< u_left, v, u_right
    bool has_right = true;                             ///< if false, u_right is not a measurement
    double sigma_px = 1;
    bool is_eliminated = false;  ///< if true at the start it stays out; result: error too large
  };
  /// Three consecutive frames, oldest first, whose camera moves smoothly.
  struct CameraAcceleration {
    std::array<int, 3> frames = {};
    AccelerationSigma sigma;
  };
  /// One joint of one person in one frame (eq. 2).
  struct JointState {
    int frame = 0;
    int joint = 0;                                  ///< COCO-18, 0..13
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< start value, then result
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
    Eigen::Matrix3d covariance_px2 = Eigen::Matrix3d::Identity();  ///< of uvu_px
    bool is_eliminated = false;  ///< as above: its reprojection, not the joint
  };
  /// Result: how one rigid part (index into kParts) moved from the frame where the person was seen
  /// before to `frame`: p_k = R (p_km1 - centroid_W) + centroid_W + t, R and t in W.
  struct PartMotion {
    int frame = 0;
    int part = 0;
    Eigen::Vector3d centroid_W = Eigen::Vector3d::Zero();
    Se3 motion_W;
  };
  struct Human {
    HumanId id;
    std::vector<JointState> joints;   ///< sorted by (frame, joint), at most one of each
    std::vector<PartMotion> motions;  ///< result, sorted by (frame, part)
    std::array<std::optional<double>, kNumSegments>
        segment_length_m;  ///< start value, then result; factors only where given
    /// Lengths known from the track before this window, if it is older, and how well.
    std::array<std::optional<double>, kNumSegments> known_length_m;
    std::array<double, kNumSegments> known_length_sigma_m{};
    int num_rigidity_eliminated = 0;  ///< results
    int num_motion_eliminated = 0;
  };

  StereoCamera camera;
  std::vector<Frame> frames;  ///< sorted by id; at least one is fixed
  std::vector<Landmark> landmarks;
  std::vector<LandmarkObservation> observations;
  std::vector<CameraAcceleration> accelerations;
  std::vector<Human> humans;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_PROBLEM_H_
