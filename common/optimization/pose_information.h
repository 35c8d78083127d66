#ifndef AIRDOS_COMMON_OPTIMIZATION_POSE_INFORMATION_H_
#define AIRDOS_COMMON_OPTIMIZATION_POSE_INFORMATION_H_

#include <vector>

#include "common/geometry/se3.h"
#include "common/optimization/bundle_problem.h"

namespace airdos {

/// What the static scene says about the newest frame of a solved BundleProblem, from the
/// Gauss-Newton Hessian at the solution with the landmarks eliminated (Schur complement). Tangent
/// of common/geometry/se3.h: translation (m), rotation (rad), in C.
struct PoseInformation {
  /// Marginal over landmarks and all other free poses, landmarks and camera accelerations together.
  Matrix6d covariance = Matrix6d::Zero();
  /// Information of the newest frame's landmark observations alone, given the landmarks and the
  /// other poses: what the newest image itself can see of the pose.
  Matrix6d observation_information = Matrix6d::Zero();
};

/// People's factors are left out: the covariance is on the safe side where they were trusted.
/// Eliminated observations are left out, others count with their Huber weight (`huber_sigma`).
/// Directions nobody observed come out with a standard deviation of kUnobservedSigma.
PoseInformation NewestPoseInformation(const BundleProblem& problem, double huber_sigma);

inline constexpr double kUnobservedSigma = 100;  // m or rad

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_POSE_INFORMATION_H_
