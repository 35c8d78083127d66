#ifndef AIRDOS_COMMON_GEOMETRY_STEREO_CAMERA_H_
#define AIRDOS_COMMON_GEOMETRY_STEREO_CAMERA_H_

#include <Eigen/Core>
#include <optional>

namespace airdos {

/// A rectified pinhole stereo camera. C is the left camera (x right, y down, z forward); the right
/// camera's centre is at (baseline_m, 0, 0) in C.
struct StereoCamera {
  int width = 0;   ///< px
  int height = 0;  ///< px
  double fx_px = 0;
  double fy_px = 0;
  double cx_px = 0;
  double cy_px = 0;
  double baseline_m = 0;

  /// Whether every number is finite and plausible: positive sizes, focal lengths and baseline, and
  /// a principal point inside the image.
  bool IsValid() const;

  /// (u_left, v, u_right) in px of a point in C (paper, eq. 1). The point must be in front of the
  /// camera: p_C.z() > 0.
  Eigen::Vector3d ProjectStereo(const Eigen::Vector3d& p_C) const;
  /// (u_left, v) in px.
  Eigen::Vector2d Project(const Eigen::Vector3d& p_C) const;
  /// d(u_left, v, u_right) / d p_C, 3 x 3, in px per m.
  Eigen::Matrix3d ProjectStereoJacobian(const Eigen::Vector3d& p_C) const;

  /// The point in C of a stereo observation; nothing if the disparity is not positive.
  std::optional<Eigen::Vector3d> Triangulate(double u_left_px, double v_px,
                                             double u_right_px) const;
  /// Covariance of Triangulate() in m^2, if u_left, v and u_right are independent and have the
  /// given standard deviation.
  Eigen::Matrix3d TriangulationCovariance(const Eigen::Vector3d& p_C, double sigma_px) const;

  bool IsInImage(const Eigen::Vector2d& uv_px) const {
    return uv_px.x() >= 0 && uv_px.y() >= 0 && uv_px.x() < width && uv_px.y() < height;
  }

  friend bool operator==(const StereoCamera& a, const StereoCamera& b);
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_GEOMETRY_STEREO_CAMERA_H_
