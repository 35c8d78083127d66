#ifndef AIRDOS_COMMON_EVALUATION_ALIGNMENT_H_
#define AIRDOS_COMMON_EVALUATION_ALIGNMENT_H_

#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// What the estimate is aligned with before its positions are compared.
enum class Alignment { kNone, kSe3, kSim3 };

/// p_ground_truth = scale * rotation * p_estimate + translation_m
struct Similarity {
  double scale = 1;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d translation_m = Eigen::Vector3d::Zero();
};

/// The transform of the estimate's world that brings its positions closest to the ground truth's in
/// the least-squares sense (Umeyama 1991), with scale for kSim3. The scale is 1 if the estimate
/// never moves.
Similarity ComputeAlignment(const MatchedTrajectories& matched, Alignment alignment);

/// The estimate in the ground truth's world.
std::vector<TrajectoryPose> Apply(const Similarity& similarity,
                                  const std::vector<TrajectoryPose>& poses);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_ALIGNMENT_H_
