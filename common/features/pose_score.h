#ifndef AIRDOS_COMMON_FEATURES_POSE_SCORE_H_
#define AIRDOS_COMMON_FEATURES_POSE_SCORE_H_

#include <vector>

#include "common/features/pose_estimator.h"
#include "common/geometry/se3.h"

namespace airdos {

/// Logarithm of the probability density of a pose under the prior, up to a constant, which makes it
/// 0 at the mean. Heavy tailed (Student, 3 degrees of freedom): carriers do jerk now and then.
double LogPrior(const PosePrior& prior, const Se3& T_W_C);

/// How well a pose explains a frame, to choose between several: the trust in the observations that
/// agree with it, each counted by `trust` (0..1, one per observation), and LogPrior().
/// One sure observation is worth one unit of log probability and no more, because the observations
/// of one moving thing err together.
double ScorePose(const PoseEstimate& estimate, const std::vector<double>& trust,
                 const PosePrior& prior);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_POSE_SCORE_H_
