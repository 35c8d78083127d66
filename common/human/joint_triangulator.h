#ifndef AIRDOS_COMMON_HUMAN_JOINT_TRIANGULATOR_H_
#define AIRDOS_COMMON_HUMAN_JOINT_TRIANGULATOR_H_

#include <Eigen/Core>
#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "common/geometry/stereo_camera.h"
#include "common/human/body_keypoints.h"
#include "common/human/disparity_refiner.h"

namespace airdos {

/// One joint in one stereo frame. C is the left camera.
struct TriangulatedJoint {
  double u_left_px = 0;
  double v_px = 0;  ///< row in both images, fused from both detections
  double u_right_px = 0;
  double sigma_px = 1;  ///< of each of the three
  double confidence = 0;
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_C = Eigen::Matrix3d::Zero();  ///< m^2
};
/// One person, indexed by Joint.
using JointObservations = std::array<std::optional<TriangulatedJoint>, kNumJoints>;

/// Settings of TriangulatePerson() and its relatives.
struct JointTriangulatorOptions {
  double min_confidence = 0.1;
  double min_depth_m = 0.5;
  double max_depth_m = 40;
  double max_row_error_sigmas = 4;       ///< sigmas between v_left and v_right
  double body_extent_m = 0.3;            ///< standard deviation of the depth of a person's joints
  double max_extent_error_sigmas = 3.5;  ///< sigmas between a joint's disparity and the person's
  double max_limb_ratio = 1.6;           ///< longest believable limb, of kSegments' typical length
  double min_limb_ratio = 0.35;          ///< shortest
  double limb_sigmas = 3;                ///< a limb is impossible only if noise does not explain it
  bool is_refined = true;               ///< measure the disparity in the images where that succeeds
  double refined_sigma_px = 0.4;        ///< standard deviation of a refined disparity
  double surface_depth_m = 0.05;        ///< how far the joint lies behind the surface that is seen
  double min_refined_confidence = 0.4;  ///< hidden joints are not on the surface that is seen
  KeypointNoise noise;
  DisparityRefinerOptions refiner;
};

/// The images of a stereo frame, as far as available.
struct StereoImages {
  cv::Mat left_gray;  ///< CV_8UC1; empty if there is none
  cv::Mat right_gray;
};

/// The joints in C of a person seen in both images with agreeing sides. A joint is left out if its
/// rows disagree, if its depth is out of range or far from the person's, or if it makes a limb
/// impossible. `disparity_px` is the person's.
JointObservations TriangulatePerson(const JointTriangulatorOptions& options,
                                    const StereoCamera& camera, const StereoImages& images,
                                    const BodyKeypoints& left, const BodyKeypoints& right,
                                    double disparity_px);

/// The same for a person whom only the left image shows, near an expected disparity: joints whose
/// disparity cannot be measured in the images are left out. `sigma_factor` widens the standard
/// deviation of the left keypoints.
JointObservations TriangulateLeftOnly(const JointTriangulatorOptions& options,
                                      const StereoCamera& camera, const StereoImages& images,
                                      const BodyKeypoints& left, double disparity_px,
                                      double sigma_factor);

/// Removes joints until every limb has a plausible length: first the joints with the most
/// impossible limbs, then those with the fewest good ones, then the least confident. Returns how
/// many were removed.
int RemoveImpossibleLimbs(const JointTriangulatorOptions& options, JointObservations* joints);

int NumObserved(const JointObservations& joints);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_JOINT_TRIANGULATOR_H_
