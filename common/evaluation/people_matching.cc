#include "common/evaluation/people_matching.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <optional>

#include "common/human/assignment.h"
#include "common/human/body_keypoints.h"

namespace airdos {
namespace {

constexpr double kMaxJointDistance = 0.25;  // limits the influence of outliers
constexpr double kMinJointDepthM = 0.2;

}  // namespace

double ImageDistance(const Joints& measured_C, const Joints& truth_C, SideSwap swap) {
  const double true_depth_m = MiddleDepth(truth_C);
  double sum = 0;
  int num = 0;
  for (const auto& [joint, p_C] : measured_C) {
    const auto other = truth_C.find(SwappedJoint(joint, swap));
    if (other == truth_C.end()) continue;
    const Eigen::Vector3d& q_C = other->second;
    if (p_C.z() < kMinJointDepthM || q_C.z() < kMinJointDepthM) continue;
    const double distance_m = true_depth_m * (p_C.hnormalized() - q_C.hnormalized()).norm();
    sum += std::min(distance_m / kPersonHeightM, kMaxJointDistance);
    ++num;
  }
  return num > 0 ? sum / num : std::numeric_limits<double>::infinity();
}

double MiddleDepth(const Joints& joints_C) {
  std::vector<double> depths_m;
  for (const auto& [joint, p_C] : joints_C) depths_m.push_back(p_C.z());
  return Median(depths_m).value_or(0);
}

bool IsToBeSeen(const TruePersonState& person, const Joints& joints_C) {
  const double depth_m = MiddleDepth(joints_C);
  return depth_m >= kMinPersonDepthM && depth_m <= kMaxPersonDepthM &&
         person.num_visible_left.value_or(kMinVisibleJoints) >= kMinVisibleJoints &&
         person.num_visible_right.value_or(kMinVisibleJoints) >= kMinVisibleJoints;
}

Joints InCamera(const Joints& joints_A, const TrajectoryPose& T_A_C) {
  Joints joints_C;
  for (const auto& [joint, p_A] : joints_A) {
    joints_C[joint] = T_A_C.rotation.transpose() * (p_A - T_A_C.position_m);
  }
  return joints_C;
}

std::map<std::size_t, std::int64_t> MatchPeople(const std::vector<Joints>& measured_C,
                                                const std::map<std::int64_t, Joints>& truth_C) {
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(measured_C.size()),
                                                   static_cast<Eigen::Index>(truth_C.size()),
                                                   std::numeric_limits<double>::infinity());
  std::vector<std::int64_t> identities;
  for (const auto& [identity, joints_C] : truth_C) {
    const auto column = static_cast<Eigen::Index>(identities.size());
    identities.push_back(identity);
    if (MiddleDepth(joints_C) < kMinPersonDepthM) continue;
    for (std::size_t i = 0; i < measured_C.size(); ++i) {
      const double distance = std::min(ImageDistance(measured_C[i], joints_C, SideSwap::kNone),
                                       ImageDistance(measured_C[i], joints_C, SideSwap::kAll));
      if (distance < kMaxImageDistance) cost(static_cast<Eigen::Index>(i), column) = distance;
    }
  }
  std::map<std::size_t, std::int64_t> matches;
  const std::vector<std::optional<int>> partner = Assign(cost, 1);
  for (std::size_t i = 0; i < partner.size(); ++i) {
    if (partner[i]) matches[i] = identities[static_cast<std::size_t>(*partner[i])];
  }
  return matches;
}

}  // namespace airdos
