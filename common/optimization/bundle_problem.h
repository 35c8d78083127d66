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
  };
  /// A static landmark seen in one frame (eq. 1).
  struct LandmarkObservation {
    int frame = 0;
    int landmark = 0;
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();  ///< u_left, v, u_right
    bool has_right = true;                             ///< if false, u_right is not a measurement
    double sigma_px = 1;
    bool is_eliminated = false;  ///< result: its error was too large
  };
  /// One joint of one person in one frame (eq. 2).
  struct JointState {
    int frame = 0;
    int joint = 0;                                  ///< COCO-18, 0..13
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();  ///< start value, then result
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
    double sigma_px = 1;
    bool is_eliminated = false;  ///< result: its reprojection was thrown out
  };
  struct Human {
    HumanId id;
    std::vector<JointState> joints;  ///< sorted by (frame, joint)
    std::array<std::optional<double>, kNumSegments>
        segment_length_m;             ///< start value (mean of the track), then result
    int num_rigidity_eliminated = 0;  ///< results
    int num_motion_eliminated = 0;
  };

  StereoCamera camera;
  std::vector<Frame> frames;  ///< sorted by id; at least one is fixed
  std::vector<Landmark> landmarks;
  std::vector<LandmarkObservation> observations;
  std::vector<Human> humans;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_PROBLEM_H_
