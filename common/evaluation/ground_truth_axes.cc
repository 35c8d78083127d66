#include "common/evaluation/ground_truth_axes.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>

#include "common/geometry/se3.h"

namespace airdos {
namespace {

constexpr double kDegPerRad = 180.0 / 3.14159265358979323846;
constexpr double kMinRotationRmsDeg = 0.5;
constexpr double kMinAgreement = 0.7;
constexpr double kMinLead = 0.1;

/// Sums for the cosine between two series of vectors.
class Agreement {
 public:
  void Add(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    product_ += a.dot(b);
    square_a_ += a.squaredNorm();
    square_b_ += b.squaredNorm();
  }
  double value() const {
    const double norm = std::sqrt(square_a_ * square_b_);
    return norm > 0 ? product_ / norm : 0;
  }

 private:
  double product_ = 0;
  double square_a_ = 0;
  double square_b_ = 0;
};

Eigen::Vector3d RotationVector(const TrajectoryPose& pose) {
  return LogSo3(Eigen::Quaterniond(pose.rotation).normalized());
}

AxesAgreement Compare(const MatchedTrajectories& matched, GroundTruthAxes axes,
                      std::size_t stride) {
  Agreement rotation;
  Agreement translation;
  for (std::size_t i = 0; i + stride < matched.estimate.size(); ++i) {
    const TrajectoryPose estimate = RelativePose(matched.estimate[i], matched.estimate[i + stride]);
    const TrajectoryPose truth =
        ToOptical(RelativePose(matched.ground_truth[i], matched.ground_truth[i + stride]), axes);
    rotation.Add(RotationVector(estimate), RotationVector(truth));
    translation.Add(estimate.position_m, truth.position_m);
  }
  return {rotation.value(), translation.value()};
}

double RotationRmsDeg(const std::vector<TrajectoryPose>& poses, std::size_t stride) {
  double sum = 0;
  double count = 0;
  for (std::size_t i = 0; i + stride < poses.size(); ++i, ++count) {
    sum += RotationVector(RelativePose(poses[i], poses[i + stride])).squaredNorm();
  }
  return count > 0 ? kDegPerRad * std::sqrt(sum / count) : 0;
}

}  // namespace

TrajectoryPose ToOptical(const TrajectoryPose& pose, GroundTruthAxes axes) {
  if (axes == GroundTruthAxes::kOptical) return pose;
  Eigen::Matrix3d S;  // optical x = NED y, optical y = NED z, optical z = NED x
  S << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  TrajectoryPose optical = pose;
  optical.rotation = S.transpose() * pose.rotation * S;
  optical.position_m = S.transpose() * pose.position_m;
  return optical;
}

AxesDecision DetectAxes(const MatchedTrajectories& matched) {
  constexpr std::size_t kLongestStride = 10;
  const std::size_t stride =
      std::clamp<std::size_t>(matched.estimate.size() / 4, 1, kLongestStride);
  AxesDecision decision;
  decision.optical = Compare(matched, GroundTruthAxes::kOptical, stride);
  decision.ned = Compare(matched, GroundTruthAxes::kNed, stride);
  decision.rotation_rms_deg = RotationRmsDeg(matched.ground_truth, stride);
  decision.by_translation = decision.rotation_rms_deg < kMinRotationRmsDeg;
  const double optical =
      decision.by_translation ? decision.optical.translation : decision.optical.rotation;
  const double ned = decision.by_translation ? decision.ned.translation : decision.ned.rotation;
  decision.axes = ned > optical ? GroundTruthAxes::kNed : GroundTruthAxes::kOptical;
  decision.is_known =
      std::max(optical, ned) >= kMinAgreement && std::abs(optical - ned) >= kMinLead;
  return decision;
}

std::string AxesDecision::Explain() const {
  const char* const what = by_translation ? "displacements" : "rotations";
  const double optical_value = by_translation ? optical.translation : optical.rotation;
  const double ned_value = by_translation ? ned.translation : ned.rotation;
  char text[200];
  std::snprintf(text, sizeof text,
                "%s of estimate and ground truth in body axes agree by %.3f if it is optical, %.3f "
                "if it is NED (1 = same, 0 = unrelated)",
                what, optical_value, ned_value);
  return text;
}

}  // namespace airdos
