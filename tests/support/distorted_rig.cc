#include "tests/support/distorted_rig.h"

#include <algorithm>
#include <opencv2/calib3d.hpp>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "common/geometry/se3.h"

namespace airdos {
namespace {

cv::Matx33d CameraMatrix(const CameraIntrinsics& c) {
  return {c.fx_px, 0, c.cx_px, 0, c.fy_px, c.cy_px, 0, 0, 1};
}

CameraIntrinsics Lens(const StereoCamera& size, double focal_px, double off_centre_px,
                      const std::vector<double>& distortion) {
  return {size.width,
          size.height,
          focal_px,
          0.996 * focal_px,
          0.5 * size.width + off_centre_px,
          0.5 * size.height - 0.5 * off_centre_px,
          LensModel::kRadialTangential,
          distortion};
}

}  // namespace

DistortedRig::DistortedRig(const StereoCamera& original) : original_(original) {
  left_.R_rect = ExpSo3({0.011, -0.013, 0.007}).toRotationMatrix();
  right_.R_rect = ExpSo3({-0.006, 0.010, -0.008}).toRotationMatrix();
  for (double focal_px = original.fx_px;; focal_px *= 1.01) {
    left_.camera = Lens(original, focal_px, 5.5, {-0.17, 0.026, 0.0002, 0.00175});
    right_.camera = Lens(original, 0.99 * focal_px, -4, {-0.165, 0.024, -0.0003, 0.0011});
    if (MakeMap(&left_) && MakeMap(&right_)) break;
  }
  rig_.left = left_.camera;
  rig_.right = right_.camera;
  rig_.T_L_R = RelativePose(left_.R_rect, right_.R_rect, original.baseline_m);
  rig_.files = {"distorted rig"};
}

/// Whether all of it lies within the original.
bool DistortedRig::MakeMap(Side* side) const {
  std::vector<cv::Point2d> pixels, points;
  for (int v = 0; v < original_.height; ++v) {
    for (int u = 0; u < original_.width; ++u) pixels.emplace_back(u, v);
  }
  cv::undistortPoints(pixels, points, CameraMatrix(side->camera), side->camera.distortion,
                      cv::noArray(), cv::noArray(),
                      cv::TermCriteria(cv::TermCriteria::COUNT | cv::TermCriteria::EPS, 50, 1e-12));
  side->map.create(original_.height, original_.width, CV_32FC2);
  bool is_inside = true;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d ray = side->R_rect * Eigen::Vector3d(points[i].x, points[i].y, 1);
    const Eigen::Vector2d uv = original_.Project(ray);
    is_inside = is_inside && uv.minCoeff() >= 0 && uv.x() <= original_.width - 1 &&
                uv.y() <= original_.height - 1;
    side->map.at<cv::Vec2f>(static_cast<int>(i)) = {static_cast<float>(uv.x()),
                                                    static_cast<float>(uv.y())};
  }
  return is_inside;
}

cv::Mat DistortedRig::Left(const cv::Mat& original, int interpolation) const {
  cv::Mat image;
  cv::remap(original, image, left_.map, cv::noArray(), interpolation);
  return image;
}

cv::Mat DistortedRig::Right(const cv::Mat& original, int interpolation) const {
  cv::Mat image;
  cv::remap(original, image, right_.map, cv::noArray(), interpolation);
  return image;
}

Eigen::Vector2d DistortedRig::Left(const Eigen::Vector2d& original_px) const {
  return Distort(original_px, left_);
}

Eigen::Vector2d DistortedRig::Right(const Eigen::Vector2d& original_px) const {
  return Distort(original_px, right_);
}

Eigen::Vector2d DistortedRig::Distort(const Eigen::Vector2d& original_px, const Side& side) const {
  const Eigen::Vector3d ray((original_px.x() - original_.cx_px) / original_.fx_px,
                            (original_px.y() - original_.cy_px) / original_.fy_px, 1);
  const Eigen::Vector3d p = side.R_rect.transpose() * ray;
  std::vector<cv::Point2d> pixels;
  cv::projectPoints(std::vector<cv::Point3d>{{p.x(), p.y(), p.z()}}, cv::Vec3d(), cv::Vec3d(),
                    CameraMatrix(side.camera), side.camera.distortion, pixels);
  return {pixels[0].x, pixels[0].y};
}

}  // namespace airdos
