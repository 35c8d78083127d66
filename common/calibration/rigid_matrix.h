#ifndef AIRDOS_COMMON_CALIBRATION_RIGID_MATRIX_H_
#define AIRDOS_COMMON_CALIBRATION_RIGID_MATRIX_H_

#include <string>

#include "common/geometry/se3.h"

namespace airdos {

/// The rotation nearest to a matrix that was written with few digits. Throws InputError beginning
/// with `where` if the matrix is no rotation (off by more than 0.01, or a reflection).
Eigen::Matrix3d ToRotation(const Eigen::Matrix3d& matrix, const std::string& where);

/// The same for a rigid transform; the translation is kept.
Se3 ToSe3(const Eigen::Matrix4d& matrix, const std::string& where);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CALIBRATION_RIGID_MATRIX_H_
