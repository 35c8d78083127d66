#include "common/evaluation/trajectory.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

TrajectoryPose PoseFromTum(const std::vector<double>& n, const std::string& where) {
  const Eigen::Quaterniond q(n[7], n[4], n[5], n[6]);
  if (std::abs(q.norm() - 1) > 1e-2) throw InputError(where + "the quaternion is not of length 1");
  TrajectoryPose pose;
  pose.time_s = n[0];
  pose.rotation = q.normalized().toRotationMatrix();
  pose.position_m = {n[1], n[2], n[3]};
  return pose;
}

TrajectoryPose PoseFromKitti(const std::vector<double>& n, const std::string& where) {
  TrajectoryPose pose;
  pose.rotation << n[0], n[1], n[2], n[4], n[5], n[6], n[8], n[9], n[10];
  pose.position_m = {n[3], n[7], n[11]};
  constexpr double kRoundingOfFiles = 1e-2;
  if (!(pose.rotation * pose.rotation.transpose()).isIdentity(kRoundingOfFiles) ||
      pose.rotation.determinant() < 0) {
    throw InputError(where + "columns 1-3, 5-7 and 9-11 are no rotation");
  }
  return pose;
}

/// The pose that is nearest in time (times never decrease); the earlier one of two that are as
/// near.
const TrajectoryPose& Nearest(const std::vector<TrajectoryPose>& poses, double time_s) {
  const auto after =
      std::lower_bound(poses.begin(), poses.end(), time_s,
                       [](const TrajectoryPose& pose, double time) { return pose.time_s < time; });
  if (after == poses.begin()) return *after;
  const auto before = std::prev(after);
  if (after == poses.end()) return *before;
  return time_s - before->time_s <= after->time_s - time_s ? *before : *after;
}

MatchedTrajectories AssociateByRow(const Trajectory& estimate, const Trajectory& ground_truth) {
  if (estimate.poses.size() > ground_truth.poses.size()) {
    throw InputError("the estimate has " + std::to_string(estimate.poses.size()) +
                     " rows, the ground truth only " + std::to_string(ground_truth.poses.size()));
  }
  MatchedTrajectories matched = {estimate.poses, ground_truth.poses};
  matched.ground_truth.resize(estimate.poses.size());
  return matched;
}

}  // namespace

Trajectory ReadTrajectory(const std::string& path) {
  Trajectory trajectory;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::vector<double> numbers = ParseNumbers(path, line, 0);
    const std::string where = path + ":" + std::to_string(line.number) + ": ";
    if (trajectory.poses.empty()) trajectory.has_times = numbers.size() == 8;
    if (numbers.size() != (trajectory.has_times ? 8 : 12)) {
      throw InputError(where + "must hold 8 numbers (TUM) or 12 (KITTI) in each row, holds " +
                       std::to_string(numbers.size()));
    }
    if (trajectory.has_times) {
      trajectory.poses.push_back(PoseFromTum(numbers, where));
    } else {
      trajectory.poses.push_back(PoseFromKitti(numbers, where));
      trajectory.poses.back().time_s = static_cast<double>(trajectory.poses.size()) - 1;
    }
    const std::size_t n = trajectory.poses.size();
    if (n > 1 && trajectory.poses[n - 1].time_s < trajectory.poses[n - 2].time_s) {
      throw InputError(where + "time '" + line.words[0] + "' lies before that of the row above");
    }
  }
  if (trajectory.poses.empty()) throw InputError(path + ": holds no pose");
  return trajectory;
}

void SetTimes(const std::string& times_path, Trajectory* trajectory) {
  std::vector<double> times_s;
  for (const TextLine& line : ReadTextLines(times_path)) {
    const std::vector<double> numbers = ParseNumbers(times_path, line, 0);
    const bool is_later = times_s.empty() || numbers[0] > times_s.back();
    if (numbers.size() != 1 || !is_later) {
      throw InputError(times_path + ":" + std::to_string(line.number) +
                       ": must hold one time (s), later than the one before");
    }
    times_s.push_back(numbers[0]);
  }
  if (times_s.size() < trajectory->poses.size()) {
    throw InputError(times_path + ": holds " + std::to_string(times_s.size()) + " times for " +
                     std::to_string(trajectory->poses.size()) + " poses");
  }
  for (std::size_t i = 0; i < trajectory->poses.size(); ++i) {
    trajectory->poses[i].time_s = times_s[i];
  }
  trajectory->has_times = true;
}

TrajectoryPose RelativePose(const TrajectoryPose& a, const TrajectoryPose& b) {
  TrajectoryPose relative;
  relative.time_s = b.time_s - a.time_s;
  relative.rotation = a.rotation.transpose() * b.rotation;
  relative.position_m = a.rotation.transpose() * (b.position_m - a.position_m);
  return relative;
}

MatchedTrajectories Associate(const Trajectory& estimate, const Trajectory& ground_truth,
                              double max_time_difference_s) {
  if (estimate.has_times != ground_truth.has_times) {
    throw InputError(std::string("the ") + (estimate.has_times ? "ground truth" : "estimate") +
                     " has KITTI rows without times, the other file has times: give them with "
                     "--times, or compare KITTI with KITTI rows");
  }
  if (!estimate.has_times) return AssociateByRow(estimate, ground_truth);

  const bool is_truth_longer = ground_truth.poses.size() > estimate.poses.size();
  const std::vector<TrajectoryPose>& shorter =
      is_truth_longer ? estimate.poses : ground_truth.poses;
  const std::vector<TrajectoryPose>& longer = is_truth_longer ? ground_truth.poses : estimate.poses;
  MatchedTrajectories matched;
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
