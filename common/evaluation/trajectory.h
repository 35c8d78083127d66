#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace airdos {

/// Pose of the camera (body) in its world at one time. The rotation is kept as the file has it: a
/// KITTI file's matrices are orthogonal only to the digits that were written, and rounding them
/// again would change small relative rotations.
struct TrajectoryPose {
  double time_s = 0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

struct Trajectory {
  bool has_times = false;  ///< false: KITTI rows, time_s is the row's number
  std::vector<TrajectoryPose> poses;
};

/// Reads TUM rows (`t x y z qx qy qz qw`, t in s, increasing) or KITTI rows (3 x 4, row major),
/// told apart by the count of numbers in the first row. Throws InputError naming file and line.
Trajectory ReadTrajectory(const std::string& path);

/// Gives the poses of KITTI rows the times (s) of a file with one time a line.
void SetTimes(const std::string& times_path, Trajectory* trajectory);

/// The rigid motion from `a` to `b`, in the axes of body a.
TrajectoryPose RelativePose(const TrajectoryPose& a, const TrajectoryPose& b);

/// Poses of estimate and ground truth that belong together, in order of time.
struct MatchedTrajectories {
  std::vector<TrajectoryPose> estimate;
  std::vector<TrajectoryPose> ground_truth;  ///< of the same size
};

/// Matches by time where both have times: each pose of the trajectory with fewer poses gets the
/// nearest of the other if it is at most `max_time_difference_s` away (the definition of evo). Rows
/// by number where neither has times; the estimate may then end earlier, not later. One with and
/// one without times is an InputError.
MatchedTrajectories Associate(const Trajectory& estimate, const Trajectory& ground_truth,
                              double max_time_difference_s);

/// Path length (m) from the first pose to each pose.
std::vector<double> PathLengths(const std::vector<TrajectoryPose>& poses);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_
