#include "common/calibration/stereo_rectifier.h"

#include <algorithm>
#include <cmath>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>

#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

cv::Matx33d CameraMatrix(const CameraIntrinsics& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

cv::Matx33d CameraMatrix(const StereoCamera& camera) {
  return {camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1};
}

/// p_R = R p_L + t, as OpenCV wants it.
std::pair<cv::Matx33d, cv::Vec3d> RightFromLeft(const StereoRig& rig) {
  const Se3 T_R_L = rig.T_L_R.inverse();
  const Eigen::Matrix3d R = T_R_L.rotation.toRotationMatrix();
  const Eigen::Vector3d t = T_R_L.translation;
  return {{R(0, 0), R(0, 1), R(0, 2), R(1, 0), R(1, 1), R(1, 2), R(2, 0), R(2, 1), R(2, 2)},
          {t.x(), t.y(), t.z()}};
}

}  // namespace

StereoRectifier::StereoRectifier(const StereoRig& rig, const RectifierOptions& options) {
  if (rig.are_images_rectified) {
    is_identity_ = true;
    camera_ = *rig.rectified;
    return;
  }
  left_.camera = rig.left;
  right_.camera = rig.right;
  const cv::Size size(rig.left.width, rig.left.height);
  const auto [R, t] = RightFromLeft(rig);
  cv::Mat R1, R2, P1, P2, Q;
  if (rig.left.lens == LensModel::kFisheye) {
    cv::fisheye::stereoRectify(CameraMatrix(rig.left), rig.left.distortion, CameraMatrix(rig.right),
                               rig.right.distortion, size, R, t, R1, R2, P1, P2, Q,
                               cv::CALIB_ZERO_DISPARITY, size, options.alpha);
  } else {
    cv::stereoRectify(CameraMatrix(rig.left), rig.left.distortion, CameraMatrix(rig.right),
                      rig.right.distortion, size, R, t, R1, R2, P1, P2, Q, cv::CALIB_ZERO_DISPARITY,
                      options.alpha, size);
  }
  SetRotation(R1, &left_);
  SetRotation(R2, &right_);
  camera_ = {size.width,
             size.height,
             P1.at<double>(0, 0),
             P1.at<double>(1, 1),
             P1.at<double>(0, 2),
             P1.at<double>(1, 2),
             -P2.at<double>(0, 3) / P2.at<double>(0, 0)};
  if (rig.left.lens == LensModel::kFisheye) LimitFieldOfView(options.max_field_of_view_deg);
  RequireImage();
  MakeMaps(&left_);
  MakeMaps(&right_);
}

// OpenCV chooses the focal length by the borders of the original, which for lenses of 150 degrees
// and more lie (nearly) at infinity.
void StereoRectifier::LimitFieldOfView(double max_deg) {
  const double half_size_px = 0.5 * std::max(camera_.width, camera_.height);
  const double min_focal_length_px = half_size_px / std::tan(0.5 * max_deg * M_PI / 180);
  if (camera_.fx_px >= min_focal_length_px && camera_.IsValid()) return;
  camera_.fx_px = camera_.fy_px = min_focal_length_px;
  camera_.cx_px = 0.5 * (camera_.width - 1);
  camera_.cy_px = 0.5 * (camera_.height - 1);
  notes_.push_back(
      Format("the lens sees more than the %.4g degrees that the rectified images show", max_deg));
}

void StereoRectifier::SetRotation(const cv::Matx33d& R, Side* side) {
  side->R = R;
  side->R_rect = Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(R.val);
}

void StereoRectifier::RequireImage() const {
  if (!camera_.IsValid()) {
    throw InputError(
        "the calibration leaves no rectified image: its distortion coefficients or its rotation "
        "are wrong");
  }
}

void StereoRectifier::MakeMaps(Side* side) const {
  const cv::Size size(camera_.width, camera_.height);
  cv::Mat x, y;
  if (side->camera.lens == LensModel::kFisheye) {
    cv::fisheye::initUndistortRectifyMap(CameraMatrix(side->camera), side->camera.distortion,
                                         side->R, CameraMatrix(camera_), size, CV_32FC1, x, y);
  } else {
    cv::initUndistortRectifyMap(CameraMatrix(side->camera), side->camera.distortion, side->R,
                                CameraMatrix(camera_), size, CV_32FC1, x, y);
  }
  cv::convertMaps(x, y, side->map, side->map_fraction, CV_16SC2);
}

cv::Mat StereoRectifier::Apply(const cv::Mat& image, const Side& side) const {
  if (image.cols != camera_.width || image.rows != camera_.height) {
    throw InputError("an image of " + std::to_string(image.cols) + "x" +
                     std::to_string(image.rows) + " px, the calibration is for " +
                     std::to_string(camera_.width) + "x" + std::to_string(camera_.height) + " px");
  }
  if (is_identity_) return image;
  cv::Mat rectified;
  cv::remap(image, rectified, side.map, side.map_fraction, cv::INTER_LINEAR, cv::BORDER_CONSTANT);
  return rectified;
}

Eigen::Vector2d StereoRectifier::Rectify(const Eigen::Vector2d& uv_px, const Side& side) const {
  if (is_identity_) return uv_px;
  const std::vector<cv::Point2d> from = {{uv_px.x(), uv_px.y()}};
  std::vector<cv::Point2d> to;
  if (side.camera.lens == LensModel::kFisheye) {
    cv::fisheye::undistortPoints(from, to, CameraMatrix(side.camera), side.camera.distortion,
                                 side.R, CameraMatrix(camera_));
  } else {
    cv::undistortPoints(from, to, CameraMatrix(side.camera), side.camera.distortion, side.R,
                        CameraMatrix(camera_));
  }
  return {to[0].x, to[0].y};
}

}  // namespace airdos
