#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_FILE_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_FILE_H_

#include <string>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// Reads a trajectory in whatever form it has, found out from its content: TUM rows
/// (`t x y z qx qy qz qw`), KITTI rows (3 x 4, row major), EuRoC's csv files (ns, w before x),
/// TartanAir's rows without times, times with positions only, and columns that a heading names;
/// between blanks, commas or semicolons; times in s, ms, us or ns. Rows without a pose (nan; zeros
/// far from the poses around them) are left out and counted. What was found out or assumed is in
/// `remarks`. Throws InputError naming file and line for everything else.
Trajectory ReadTrajectory(const std::string& path);

/// Gives the poses of rows without times the times of a file with one time a line, as many as the
/// trajectory has rows.
void SetTimes(const std::string& times_path, Trajectory* trajectory);

/// The same for those of a pair that have none. If the times fit one only, the message says which.
void SetTimesOfPair(const std::string& times_path, Trajectory* estimate, Trajectory* ground_truth);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_FILE_H_
