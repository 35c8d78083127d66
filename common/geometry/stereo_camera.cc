#include "common/geometry/stereo_camera.h"

#include <Eigen/LU>
#include <cmath>

namespace airdos {

bool StereoCamera::IsValid() const {
  for (const double value : {fx_px, fy_px, cx_px, cy_px, baseline_m}) {
    if (!std::isfinite(value) || value <= 0) return false;
  }
  return width > 0 && height > 0 && cx_px < width && cy_px < height;
}

Eigen::Vector3d StereoCamera::ProjectStereo(const Eigen::Vector3d& p_C) const {
  const double inverse_z = 1.0 / p_C.z();
  const double u_left = fx_px * p_C.x() * inverse_z + cx_px;
  return {u_left, fy_px * p_C.y() * inverse_z + cy_px, u_left - fx_px * baseline_m * inverse_z};
}

Eigen::Vector2d StereoCamera::Project(const Eigen::Vector3d& p_C) const {
  return {fx_px * p_C.x() / p_C.z() + cx_px, fy_px * p_C.y() / p_C.z() + cy_px};
}

Eigen::Matrix3d StereoCamera::ProjectStereoJacobian(const Eigen::Vector3d& p_C) const {
  const double inverse_z = 1.0 / p_C.z();
  const double inverse_z2 = inverse_z * inverse_z;
  Eigen::Matrix3d J;
  J << fx_px * inverse_z, 0, -fx_px * p_C.x() * inverse_z2,  //
      0, fy_px * inverse_z, -fy_px * p_C.y() * inverse_z2,   //
      fx_px * inverse_z, 0, -fx_px * (p_C.x() - baseline_m) * inverse_z2;
  return J;
}

std::optional<Eigen::Vector3d> StereoCamera::Triangulate(double u_left_px, double v_px,
                                                         double u_right_px) const {
  const double disparity_px = u_left_px - u_right_px;
  if (!(disparity_px > 0)) return std::nullopt;
  const double z = fx_px * baseline_m / disparity_px;
  return Eigen::Vector3d((u_left_px - cx_px) * z / fx_px, (v_px - cy_px) * z / fy_px, z);
}

Eigen::Matrix3d StereoCamera::TriangulationCovariance(const Eigen::Vector3d& p_C,
                                                      double sigma_px) const {
  const Eigen::Matrix3d J_inverse = ProjectStereoJacobian(p_C).inverse();
  return sigma_px * sigma_px * J_inverse * J_inverse.transpose();
}

bool operator==(const StereoCamera& a, const StereoCamera& b) {
  return a.width == b.width && a.height == b.height && a.fx_px == b.fx_px && a.fy_px == b.fy_px &&
         a.cx_px == b.cx_px && a.cy_px == b.cy_px && a.baseline_m == b.baseline_m;
}

}  // namespace airdos
