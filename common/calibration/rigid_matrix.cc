#include "common/calibration/rigid_matrix.h"

#include <Eigen/LU>
#include <Eigen/SVD>

#include "common/util/error.h"

namespace airdos {

Eigen::Matrix3d ToRotation(const Eigen::Matrix3d& matrix, const std::string& where) {
  constexpr double kMaxError = 0.01;  // of an entry; files have five digits or more
  const double error =
      (matrix * matrix.transpose() - Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff();
  if (!(error <= kMaxError)) throw InputError(where + " is not a rotation matrix");
  if (matrix.determinant() < 0) throw InputError(where + " is a reflection, not a rotation");
  const Eigen::JacobiSVD<Eigen::Matrix3d> svd(matrix, Eigen::ComputeFullU | Eigen::ComputeFullV);
  return svd.matrixU() * svd.matrixV().transpose();
}

Se3 ToSe3(const Eigen::Matrix4d& matrix, const std::string& where) {
  Se3 transform;
  transform.rotation = Eigen::Quaterniond(ToRotation(matrix.topLeftCorner<3, 3>(), where));
  transform.translation = matrix.topRightCorner<3, 1>();
  return transform;
}

}  // namespace airdos
