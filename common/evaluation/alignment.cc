#include "common/evaluation/alignment.h"

#include <Eigen/Geometry>

#include "common/util/check.h"

namespace airdos {
namespace {

Eigen::Matrix3Xd Positions(const std::vector<TrajectoryPose>& poses) {
  Eigen::Matrix3Xd positions(3, static_cast<Eigen::Index>(poses.size()));
  for (std::size_t i = 0; i < poses.size(); ++i) {
    positions.col(static_cast<Eigen::Index>(i)) = poses[i].position_m;
  }
  return positions;
}

}  // namespace

Similarity ComputeAlignment(const MatchedTrajectories& matched, Alignment alignment) {
  AIRDOS_CHECK(matched.estimate.size() == matched.ground_truth.size());
  Similarity similarity;
  if (alignment == Alignment::kNone || matched.estimate.empty()) return similarity;
  const Eigen::Matrix3Xd estimate = Positions(matched.estimate);
  const Eigen::Vector3d mean = estimate.rowwise().mean();
  const bool moves = (estimate.colwise() - mean).squaredNorm() > 0;
  const bool with_scale = alignment == Alignment::kSim3 && moves;
  const Eigen::Matrix4d T = Eigen::umeyama(estimate, Positions(matched.ground_truth), with_scale);
  const Eigen::Matrix3d scaled_rotation = T.topLeftCorner<3, 3>();
  if (with_scale) similarity.scale = scaled_rotation.col(0).norm();
  if (similarity.scale > 0) similarity.rotation = scaled_rotation / similarity.scale;
  similarity.translation_m = T.topRightCorner<3, 1>();
  return similarity;
}

std::vector<TrajectoryPose> Apply(const Similarity& similarity,
                                  const std::vector<TrajectoryPose>& poses) {
  std::vector<TrajectoryPose> moved = poses;
  for (TrajectoryPose& pose : moved) {
    pose.rotation = similarity.rotation * pose.rotation;
    pose.position_m =
        similarity.scale * (similarity.rotation * pose.position_m) + similarity.translation_m;
  }
  return moved;
}

}  // namespace airdos
