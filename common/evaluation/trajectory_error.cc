#include "common/evaluation/trajectory_error.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "common/geometry/se3.h"
#include "common/util/check.h"

namespace airdos {
namespace {

constexpr double kDegPerRad = 180.0 / 3.14159265358979323846;
constexpr double kSegmentLengthsM[] = {5, 10, 20, 50, 100, 200, 300, 400, 500, 600, 700, 800};

}  // namespace

double RotationAngleDeg(const Eigen::Matrix3d& R) {
  return kDegPerRad * LogSo3(Eigen::Quaterniond(R).normalized()).norm();
}

std::vector<double> PositionErrors(const std::vector<TrajectoryPose>& estimate,
                                   const std::vector<TrajectoryPose>& ground_truth) {
  AIRDOS_CHECK(estimate.size() == ground_truth.size());
  std::vector<double> errors_m;
  for (std::size_t i = 0; i < estimate.size(); ++i) {
    errors_m.push_back((estimate[i].position_m - ground_truth[i].position_m).norm());
  }
  return errors_m;
}

RelativeError ErrorOfMotion(const MatchedTrajectories& matched, std::size_t i, std::size_t j) {
  const TrajectoryPose error =
      RelativePose(RelativePose(matched.ground_truth[i], matched.ground_truth[j]),
                   RelativePose(matched.estimate[i], matched.estimate[j]));
  RelativeError result;
  result.translation_m = error.position_m.norm();
  result.rotation_deg = RotationAngleDeg(error.rotation);
  return result;
}

std::vector<RelativeError> ErrorsPerFrame(const MatchedTrajectories& matched) {
  const std::vector<double> path_m = PathLengths(matched.ground_truth);
  std::vector<RelativeError> errors;
  for (std::size_t i = 0; i + 1 < path_m.size(); ++i) {
    errors.push_back(ErrorOfMotion(matched, i, i + 1));
    errors.back().path_m = path_m[i + 1] - path_m[i];
  }
  return errors;
}

std::size_t CountLostFrames(const MatchedTrajectories& matched, std::size_t num_frames) {
  const std::size_t num_posed = matched.estimate.size();
  std::size_t num_lost = num_frames > num_posed ? num_frames - num_posed : 0;
  for (const RelativeError& error : ErrorsPerFrame(matched)) {
    const bool is_lost =
        error.translation_m > kLostTranslationM || error.rotation_deg > kLostRotationDeg;
    if (is_lost) ++num_lost;
  }
  return num_lost;
}

std::vector<RelativeError> ErrorsOverLength(const MatchedTrajectories& matched, double length_m) {
  const std::vector<double> path_m = PathLengths(matched.ground_truth);
  std::vector<RelativeError> errors;
  for (std::size_t i = 0; i < path_m.size(); ++i) {
    const auto end = std::lower_bound(path_m.begin(), path_m.end(), path_m[i] + length_m);
    if (end == path_m.end()) break;
    errors.push_back(ErrorOfMotion(matched, i, static_cast<std::size_t>(end - path_m.begin())));
    errors.back().path_m = *end - path_m[i];
  }
  return errors;
}

std::vector<SegmentDrift> SegmentDrifts(const MatchedTrajectories& matched) {
  std::vector<SegmentDrift> drifts;
  for (const double length_m : kSegmentLengthsM) {
    const std::vector<RelativeError> errors = ErrorsOverLength(matched, length_m);
    if (errors.empty()) break;
    SegmentDrift drift;
    drift.length_m = length_m;
    drift.num_segments = errors.size();
    const double divisor = length_m * static_cast<double>(errors.size());
    for (const RelativeError& error : errors) {
      drift.translation_percent += 100 * error.translation_m / divisor;
      drift.rotation_deg_per_m += error.rotation_deg / divisor;
    }
    drifts.push_back(drift);
  }
  return drifts;
}

double EndPointDriftPercent(const MatchedTrajectories& matched) {
  const std::vector<double> path_m = PathLengths(matched.ground_truth);
  if (path_m.empty() || path_m.back() <= 0) return 0;
  return 100 * ErrorOfMotion(matched, 0, path_m.size() - 1).translation_m / path_m.back();
}

}  // namespace airdos
