#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_FILE_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_FILE_H_

#include <string>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// Reads a trajectory and recognises its format from the content: TUM rows (`t x y z qx qy qz qw`),
/// KITTI rows (3 x 4, row-major), EuRoC's CSV files (ns, w before x), TartanAir's rows without
/// times, times with positions only, and columns named by a heading; separated by blanks, commas or
/// semicolons; times in s, ms, us or ns. Rows without a pose (nan; zeros far from the neighbouring
/// poses) are skipped and counted. Whatever was recognised or assumed is added to `remarks`. Throws
/// InputError naming file and line for everything else.
Trajectory ReadTrajectory(const std::string& path);

/// Sets the times of poses without times from a file with one time per line and as many lines as
/// the trajectory has rows.
void SetTimes(const std::string& times_path, Trajectory* trajectory);

/// The same for whichever of the two has no times. If the number of times fits only one of them,
/// the message names it.
void SetTimesOfPair(const std::string& times_path, Trajectory* estimate, Trajectory* ground_truth);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_FILE_H_
