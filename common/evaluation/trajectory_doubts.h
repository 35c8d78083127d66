#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_DOUBTS_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_DOUBTS_H_

#include <optional>
#include <string>

#include "common/evaluation/ground_truth_axes.h"
#include "common/evaluation/trajectory.h"

namespace airdos {

/// Associate(), and at least two pairs. Throws InputError that names both time ranges where there
/// are fewer; remarks where less than half of the shorter file matches, and where a pose is paired
/// with several.
MatchedTrajectories MatchPoses(const Trajectory& estimate, const Trajectory& ground_truth,
                               double max_time_difference_s, Remarks* remarks);

/// How the poses of a pair may be meant other than they were read.
struct PoseReading {
  bool has_other_order_in_estimate = false;  ///< w x y z where x y z w was read, and reversed
  bool has_other_order_in_truth = false;
  bool is_estimate_inverted = false;  ///< T_C_W where T_W_C was read
  bool is_truth_inverted = false;
};
struct ReadingDoubt {
  PoseReading reading;
  double agreement = 0;  ///< of the motions, see DetectAxes(), in this reading
  double agreement_as_read = 0;
  bool do_both_inversions_fit = false;  ///< that of the other file as well
};

/// Finds the reading in which the motions of both agree clearly better than as they were read: by
/// at least 0.9, and lacking less than 0.35 of what they lack as read. Where that needs two changes
/// or mirrored axes, chance fits more easily: two changes count in optical or NED axes only,
/// left-handed ones from 0.97 on. Of those that fit about as well, orders come before inversions
/// and the estimate's inversion before that of the truth (where both worlds are the same, either
/// fits). Orders are tried where there are quaternions. Nothing where no reading does.
std::optional<ReadingDoubt> FindBetterReading(const MatchedTrajectories& matched,
                                              QuaternionOrder estimate_order,
                                              QuaternionOrder truth_order);

/// The pair in another reading. `estimate_order` and `truth_order` are those that were read.
MatchedTrajectories ReadAs(const PoseReading& reading, QuaternionOrder estimate_order,
                           QuaternionOrder truth_order, MatchedTrajectories matched);

/// Whether the rotations of one file stay the same (identity of a file of positions) while the
/// other's turn by over 2 deg and it moves itself.
bool HasPositionsOnly(const std::vector<TrajectoryPose>& poses,
                      const std::vector<TrajectoryPose>& others);

/// Whether the positions fit after an alignment with scale: rms error below 5 % of the rms distance
/// of the true positions from their mean, of at least ten.
bool DoPositionsFit(const MatchedTrajectories& matched);

/// Poses of the estimate that repeat the one before to all digits while the truth moves by over
/// 1 mm or 0.05 deg.
std::size_t CountFrozenPoses(const MatchedTrajectories& matched);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_DOUBTS_H_
