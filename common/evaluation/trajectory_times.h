#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_TIMES_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_TIMES_H_

#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// A time of a file in the file's own unit, and its line.
struct FileTime {
  double time = 0;
  int line = 0;
};

/// Seconds of the unit that the times are written in (1, 1e-3, 1e-6 or 1e-9): the largest in which
/// the median interval is 0.0005 to 2 s and no time is later than the year 2100. 1 where there is
/// none, or where the times can be seconds of few key frames.
double UnitOfTimes(const std::vector<FileTime>& times);

/// Checks the times of a file's rows and converts them to seconds. Throws InputError where they
/// decrease, or where more than a tenth repeats the time of the row above (written with too few
/// digits). Remarks on another unit than s, on single repetitions (a warning above 0.5 %), on times
/// that count rows and on intervals that nobody records with.
std::vector<double> TimesInSeconds(const std::string& path, const std::vector<FileTime>& times,
                                   Remarks* remarks);

/// Median (s) of the intervals between poses; 0 of less than two.
double MedianInterval(const std::vector<TrajectoryPose>& poses);
/// The interval (s) that a tenth of the intervals do not exceed.
double ShortInterval(const std::vector<TrajectoryPose>& poses);

/// Both time ranges, and why they may not fit: another unit, other clocks, times that lie too far
/// apart. For trajectories with times.
std::string CompareTimes(const Trajectory& estimate, const Trajectory& ground_truth,
                         double max_time_difference_s);

/// Frames of the estimate, where its rate is lower than that of the ground truth, whose rows are
/// then no frames: its rows, and where its intervals are regular, those missing between them.
/// 0: the rates agree. Half as many rows again count as a higher rate.
std::size_t FramesOfSlowerEstimate(const Trajectory& estimate, const Trajectory& ground_truth);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_TIMES_H_
