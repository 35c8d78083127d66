#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_DOUBTS_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_DOUBTS_H_

#include <optional>
#include <string>

#include "common/evaluation/ground_truth_axes.h"
#include "common/evaluation/trajectory.h"

namespace airdos {

/// Calls Associate() and requires at least two pairs: otherwise throws InputError naming both time
/// ranges. Adds a remark if less than half of the shorter file matches, or if a pose is matched
/// more than once.
MatchedTrajectories MatchPoses(const Trajectory& estimate, const Trajectory& ground_truth,
                               double max_time_difference_s, Remarks* remarks);

/// A different interpretation of the poses of an estimate and its ground truth.
struct PoseReading {
  bool has_other_order_in_estimate = false;  ///< w x y z instead of x y z w, or vice versa
  bool has_other_order_in_truth = false;
  bool is_estimate_inverted = false;  ///< T_C_W instead of T_W_C
  bool is_truth_inverted = false;
};
/// An interpretation that fits better than the one that was assumed.
struct ReadingDoubt {
  PoseReading reading;
  double agreement = 0;  ///< of the motions (see DetectAxes()), in this reading
  double agreement_as_read = 0;
  bool do_both_inversions_fit = false;  ///< inverting the other file fits as well
};

/// Finds the reading in which the motions of both files agree clearly better than as read: with an
/// agreement of at least 0.9, and lacking less than 0.35 of what they lack as read. Readings with
/// two changes or mirrored axes are more likely to fit by chance: two changes are accepted only in
/// optical or NED axes, left-handed axes only from 0.97 on. Among readings that fit about equally
/// well, quaternion orders are preferred to inversions, and inverting the estimate to inverting the
/// ground truth (if both share the same world, either fits). Orders are tried only if there are
/// quaternions. Nothing if no reading qualifies.
std::optional<ReadingDoubt> FindBetterReading(const MatchedTrajectories& matched,
                                              QuaternionOrder estimate_order,
                                              QuaternionOrder truth_order);

/// The pair in another reading. `estimate_order` and `truth_order` are those of the first reading.
MatchedTrajectories ReadAs(const PoseReading& reading, QuaternionOrder estimate_order,
                           QuaternionOrder truth_order, MatchedTrajectories matched);

/// Whether the rotations of one file are constant (identity, for a file of positions) although it
/// moves and the other's rotations change by more than 2 deg.
bool HasPositionsOnly(const std::vector<TrajectoryPose>& poses,
                      const std::vector<TrajectoryPose>& others);

/// Whether at least ten positions fit after an alignment with scale: RMS error below 5 % of the RMS
/// distance of the true positions from their mean.
bool DoPositionsFit(const MatchedTrajectories& matched);

/// Number of estimated poses that equal the previous one in every digit although the ground truth
/// moves by more than 1 mm or 0.05 deg.
std::size_t CountFrozenPoses(const MatchedTrajectories& matched);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_DOUBTS_H_
