#ifndef AIRDOS_COMMON_CALIBRATION_STEREO_RECTIFIER_H_
#define AIRDOS_COMMON_CALIBRATION_STEREO_RECTIFIER_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/calibration/stereo_rig.h"

namespace airdos {

struct RectifierOptions {
  /// 0: only pixels that both images see; 1: every pixel of the originals is kept, with black
  /// borders (cv::stereoRectify's alpha, the balance of cv::fisheye).
  double alpha = 0;
  /// Width and height of the rectified image show at most this angle: a pinhole image of a wide
  /// fisheye lens would spend nearly all of its pixels on the border.
  double max_field_of_view_deg = 120;
};

/// Rotates and undistorts the images of a rig (cv::stereoRectify, cv::fisheye::stereoRectify), so
/// that the same point has the same row in both. Where the rig's images are rectified already, they
/// pass as they are. The same images give the same bytes on every machine: the maps are rounded to
/// 1/32 px, and interpolation is in whole numbers.
class StereoRectifier {
 public:
  /// Throws InputError where the rig leaves no image (lens coefficients that fold it over).
  explicit StereoRectifier(const StereoRig& rig, const RectifierOptions& options = {});

  /// The rectified pair.
  const StereoCamera& camera() const { return camera_; }
  /// p_rect = R_rect * p, of the left and the right camera.
  Eigen::Matrix3d R_rect_left() const { return left_.R_rect; }
  Eigen::Matrix3d R_rect_right() const { return right_.R_rect; }
  /// What users should know about it, a line each: where the lens sees more than is kept.
  const std::vector<std::string>& notes() const { return notes_; }
  /// Of images of the rig's size, grey or colour. Throws InputError where the size is another.
  cv::Mat Left(const cv::Mat& image) const { return Apply(image, left_); }
  cv::Mat Right(const cv::Mat& image) const { return Apply(image, right_); }

  /// Where a pixel of the original left or right image comes to lie: u, v in px.
  Eigen::Vector2d RectifyLeft(const Eigen::Vector2d& uv_px) const { return Rectify(uv_px, left_); }
  Eigen::Vector2d RectifyRight(const Eigen::Vector2d& uv_px) const {
    return Rectify(uv_px, right_);
  }

 private:
  struct Side {
    CameraIntrinsics camera;
    cv::Matx33d R = cv::Matx33d::eye();                    // p_rect = R * p_camera
    Eigen::Matrix3d R_rect = Eigen::Matrix3d::Identity();  // the same
    cv::Mat map;                                           // fixed point, see cv::convertMaps
    cv::Mat map_fraction;
  };
  static void SetRotation(const cv::Matx33d& R, Side* side);
  void MakeMaps(Side* side) const;
  void LimitFieldOfView(double max_deg);
  void RequireImage() const;
  cv::Mat Apply(const cv::Mat& image, const Side& side) const;
  Eigen::Vector2d Rectify(const Eigen::Vector2d& uv_px, const Side& side) const;

  bool is_identity_ = false;
  StereoCamera camera_;
  std::vector<std::string> notes_;
  Side left_;
  Side right_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_STEREO_RECTIFIER_H_
