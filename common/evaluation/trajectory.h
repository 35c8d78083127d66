#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_

#include <Eigen/Core>
#include <cstddef>
#include <string>
#include <utility>
#include <vector>

namespace airdos {

/// Pose of the camera (body) in its world at one time. The rotation is kept as in the file: the
/// matrices of a KITTI file are orthogonal only to the digits written, and rounding them again
/// would change small relative rotations.
struct TrajectoryPose {
  double time_s = 0;
  Eigen::Matrix3d rotation = Eigen::Matrix3d::Identity();
  Eigen::Vector3d position_m = Eigen::Vector3d::Zero();
};

/// A line for the user about files that were read: something recognised, assumed or doubtful.
struct Remark {
  bool is_warning = false;  ///< false for a note on how a file was interpreted
  std::string text;
};
/// In the order in which they came up.
using Remarks = std::vector<Remark>;

/// Order of a quaternion's components in a file.
enum class QuaternionOrder { kNone, kXyzw, kWxyz };

/// The poses of a file, in the order of its rows.
struct Trajectory {
  bool has_times = false;  ///< if false, time_s is the row number, starting at 0
  std::vector<TrajectoryPose> poses;
  bool has_rotations = true;      ///< if false, positions only; the rotations are identity
  std::size_t num_lost_rows = 0;  ///< rows without a pose: NaN, or zeros when lost
  QuaternionOrder order = QuaternionOrder::kNone;  ///< kNone for matrices, or no rotations
  std::string path{};                              ///< empty if not from a file
  Remarks remarks{};

  std::size_t num_rows() const { return poses.size() + num_lost_rows; }
};

/// "estimate FILE", for messages.
std::string NameOf(const char* role, const Trajectory& trajectory);

/// The rigid motion from `a` to `b`, in the axes of body a.
TrajectoryPose RelativePose(const TrajectoryPose& a, const TrajectoryPose& b);

/// T_A_B, given T_B_A, at the same time.
TrajectoryPose Inverse(const TrajectoryPose& pose);

/// Corresponding poses of estimate and ground truth, in temporal order.
struct MatchedTrajectories {
  std::vector<TrajectoryPose> estimate;
  std::vector<TrajectoryPose> ground_truth;  ///< of equal size
};

/// Matches by time if both have times: each pose of the trajectory with fewer poses gets the
/// nearest one of the other if that is at most `max_time_difference_s` away (as evo does). If
/// neither has times, row k is matched with row k, which requires equal numbers of rows. Throws
/// InputError if these differ, or if only one has times.
MatchedTrajectories Associate(const Trajectory& estimate, const Trajectory& ground_truth,
                              double max_time_difference_s);

/// Path length (m) from the first pose to each pose.
std::vector<double> PathLengths(const std::vector<TrajectoryPose>& poses);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_H_
