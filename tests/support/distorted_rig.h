#ifndef AIRDOS_TESTS_SUPPORT_DISTORTED_RIG_H_
#define AIRDOS_TESTS_SUPPORT_DISTORTED_RIG_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>

#include "common/calibration/stereo_rig.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Turns images of a rectified camera into those that two real ones would have taken from the same
/// places: with lenses that bend lines, each turned by half a degree about each axis. Their focal
/// length is the shortest with which every pixel shows something that the original does.
class DistortedRig {
 public:
  explicit DistortedRig(const StereoCamera& original);

  const StereoRig& rig() const { return rig_; }
  /// `interpolation`: cv::INTER_*; masks have values that must not be mixed.
  cv::Mat Left(const cv::Mat& original, int interpolation) const;
  cv::Mat Right(const cv::Mat& original, int interpolation) const;
  /// Where a point of the original image comes to lie, u and v in px.
  Eigen::Vector2d Left(const Eigen::Vector2d& original_px) const;
  Eigen::Vector2d Right(const Eigen::Vector2d& original_px) const;

 private:
  struct Side {
    CameraIntrinsics camera;
    Eigen::Matrix3d R_rect;  // p_original = R_rect * p_camera
    cv::Mat map;             // of each pixel: u and v in the original, px (CV_32FC2)
  };
  bool MakeMap(Side* side) const;
  Eigen::Vector2d Distort(const Eigen::Vector2d& original_px, const Side& side) const;

  StereoCamera original_;
  Side left_;
  Side right_;
  StereoRig rig_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_DISTORTED_RIG_H_
