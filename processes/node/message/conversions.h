#ifndef AIRDOS_PROCESSES_NODE_MESSAGE_CONVERSIONS_H_
#define AIRDOS_PROCESSES_NODE_MESSAGE_CONVERSIONS_H_

#include <vector>

#include "airdos/stereo_calibration_t.hpp"
#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

// All conversions between messages and the types of common/ are in this file: messages have
// quaternions in the order w, x, y, z.

StereoCamera ToStereoCamera(const stereo_calibration_t& message);
void FromStereoCamera(const StereoCamera& camera, stereo_calibration_t* message);

/// A covariance travels as its upper triangle, row by row: xx xy xz yy yz zz.
std::vector<float> FromCovariance(const Eigen::Matrix3d& S);
/// `upper` has six values.
Eigen::Matrix3d ToCovariance(const std::vector<float>& upper);

inline Se3 ToSe3(const double position[3], const double orientation[4]) {
  return {Eigen::Quaterniond(orientation[0], orientation[1], orientation[2], orientation[3])
              .normalized(),
          Eigen::Vector3d(position[0], position[1], position[2])};
}

inline void FromSe3(const Se3& pose, double position[3], double orientation[4]) {
  for (int i = 0; i < 3; ++i) position[i] = pose.translation[i];
  orientation[0] = pose.rotation.w();
  orientation[1] = pose.rotation.x();
  orientation[2] = pose.rotation.y();
  orientation[3] = pose.rotation.z();
}

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_MESSAGE_CONVERSIONS_H_
