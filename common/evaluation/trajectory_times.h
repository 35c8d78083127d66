#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_TIMES_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_TIMES_H_

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// A time in the file's own unit, with its line number.
struct FileTime {
  double time = 0;
  int line = 0;
};

/// The unit of the times in seconds (1, 1e-3, 1e-6 or 1e-9): the largest for which the median
/// interval is 0.0005 to 2 s and no time is later than the year 2100. 1 if there is none, or if the
/// times may be seconds of infrequent key frames.
double UnitOfTimes(const std::vector<FileTime>& times);

/// Checks the times of a file's rows and converts them to seconds. Throws InputError if they
/// decrease, or if more than 10 % repeat the time of the previous row (written with too few
/// digits). Adds remarks on units other than s, on single repetitions (a warning above 0.5 %), on
/// times that are row numbers, and on implausible intervals.
std::vector<double> TimesInSeconds(const std::string& path, const std::vector<FileTime>& times,
                                   Remarks* remarks);

/// Median interval between poses (s); 0 for fewer than two.
double MedianInterval(const std::vector<TrajectoryPose>& poses);
/// The 10th percentile of the intervals (s).
double ShortInterval(const std::vector<TrajectoryPose>& poses);

/// Describes both time ranges and why they may not match: another unit, different clocks, times too
/// far apart. For trajectories with times.
std::string CompareTimes(const Trajectory& estimate, const Trajectory& ground_truth,
                         double max_time_difference_s);

/// Number of frames of an estimate with a lower rate than the ground truth, whose rows are then not
/// frames: its rows and, if its intervals are regular, the rows missing between them. 0 if the
/// rates agree. A ground truth with 1.5 times as many rows counts as having a higher rate.
std::size_t FramesOfSlowerEstimate(const Trajectory& estimate, const Trajectory& ground_truth);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_TIMES_H_
