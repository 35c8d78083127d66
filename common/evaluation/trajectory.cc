#include "common/evaluation/trajectory.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/util/error.h"

namespace airdos {
namespace {

/// The pose nearest in time (times never decrease); the earlier one if two are equally near.
const TrajectoryPose& Nearest(const std::vector<TrajectoryPose>& poses, double time_s) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), time_s,
                       [](const TrajectoryPose& pose, double time) { return pose.time_s < time; });
  if (after == poses.begin()) return *after;
  const auto before = std::prev(after);
  if (after == poses.end()) return *before;
  return time_s - before->time_s <= after->time_s - time_s ? *before : *after;
}

void CheckRowsAgree(const Trajectory& estimate, const Trajectory& ground_truth) {
  if (estimate.num_rows() == ground_truth.num_rows()) return;
  throw InputError(
      NameOf("estimate", estimate) + ": has " + std::to_string(estimate.num_rows()) + " rows, " +
      NameOf("ground truth", ground_truth) + " has " + std::to_string(ground_truth.num_rows()) +
      ": without times row k belongs to row k only if the counts agree; provide a trajectory with "
      "times (TUM), the times of each with --times, or rows of nan for the frames without a pose");
}

}  // namespace

std::string NameOf(const char* role, const Trajectory& trajectory) {
  return role + (trajectory.path.empty() ? "" : " " + trajectory.path);
}

TrajectoryPose RelativePose(const TrajectoryPose& a, const TrajectoryPose& b) {
  TrajectoryPose relative;
  relative.time_s = b.time_s - a.time_s;
  relative.rotation = a.rotation.transpose() * b.rotation;
  relative.position_m = a.rotation.transpose() * (b.position_m - a.position_m);
  return relative;
}

TrajectoryPose Inverse(const TrajectoryPose& pose) {
  TrajectoryPose inverse = pose;
  inverse.rotation = pose.rotation.transpose();
  inverse.position_m = -(pose.rotation.transpose() * pose.position_m);
  return inverse;
}

MatchedTrajectories Associate(const Trajectory& estimate, const Trajectory& ground_truth,
                              double max_time_difference_s) {
  if (estimate.has_times != ground_truth.has_times) {
    throw InputError(
        (estimate.has_times ? NameOf("ground truth", ground_truth) : NameOf("estimate", estimate)) +
        ": has rows without times (KITTI), the other file has times: give them with "
        "--times, or compare KITTI with KITTI rows");
  }
  if (!estimate.has_times) {
    CheckRowsAgree(estimate, ground_truth);
    max_time_difference_s = 0;  // by row number: some rows may have no pose
  }
  const bool is_truth_longer = ground_truth.poses.size() > estimate.poses.size();
  const std::vector<TrajectoryPose>& shorter =
      is_truth_longer ? estimate.poses : ground_truth.poses;
  const std::vector<TrajectoryPose>& longer = is_truth_longer ? ground_truth.poses : estimate.poses;
  MatchedTrajectories matched;
  if (longer.empty()) return matched;
  for (const TrajectoryPose& pose : shorter) {
    const TrajectoryPose& partner = Nearest(longer, pose.time_s);
    if (std::abs(partner.time_s - pose.time_s) > max_time_difference_s) continue;
    matched.estimate.push_back(is_truth_longer ? pose : partner);
    matched.ground_truth.push_back(is_truth_longer ? partner : pose);
  }
  return matched;
}

std::vector<double> PathLengths(const std::vector<TrajectoryPose>& poses) {
  std::vector<double> lengths_m(poses.size(), 0.0);
  for (std::size_t i = 1; i < poses.size(); ++i) {
    lengths_m[i] = lengths_m[i - 1] + (poses[i].position_m - poses[i - 1].position_m).norm();
  }
  return lengths_m;
}

}  // namespace airdos
