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

/// What was found out, assumed or is doubtful about files that were read: one line for the user.
struct Remark {
  bool is_warning = false;  ///< false: a note on how a file was understood
  std::string text;
};
using Remarks = std::vector<Remark>;

/// Order in which the file's quaternions stand.
enum class QuaternionOrder { kNone, kXyzw, kWxyz };

struct Trajectory {
  bool has_times = false;  ///< false: rows without times, time_s is the row's number from 0
  std::vector<TrajectoryPose> poses;
  bool has_rotations = true;      ///< false: positions only, the rotations are identity
  std::size_t num_lost_rows = 0;  ///< rows that are no pose: not a number, or zeros where lost
  QuaternionOrder order = QuaternionOrder::kNone;  ///< kNone: matrices, or nothing
  std::string path{};                              ///< empty: not from a file
  Remarks remarks{};

  std::size_t num_rows() const { return poses.size() + num_lost_rows; }
};

/// "estimate FILE", for messages.
std::string NameOf(const char* role, const Trajectory& trajectory);

/// The rigid motion from `a` to `b`, in the axes of body a.
TrajectoryPose RelativePose(const TrajectoryPose& a, const TrajectoryPose& b);

/// T_A_B of T_B_A, at the same time.
TrajectoryPose Inverse(const TrajectoryPose& pose);

/// Poses of estimate and ground truth that belong together, in order of time.
struct MatchedTrajectories {
  std::vector<TrajectoryPose> estimate;
  std::vector<TrajectoryPose> ground_truth;  ///< of the same size
};

/// Matches by time where both have times: each pose of the trajectory with fewer poses gets the
/// nearest of the other if it is at most `max_time_difference_s` away (the definition of evo). Rows
/// by number where neither has times: row k belongs to row k only where both have as many rows,
/// else this is an InputError. So is one with and one without times.
MatchedTrajectories Associate(const Trajectory& estimate, const Trajectory& ground_truth,
                              double max_time_difference_s);

/// Path length (m) from the first pose to each pose.
std::vector<double> PathLengths(const std::vector<TrajectoryPose>& poses);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_
