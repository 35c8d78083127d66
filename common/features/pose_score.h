#ifndef AIRDOS_COMMON_FEATURES_POSE_SCORE_H_
#define AIRDOS_COMMON_FEATURES_POSE_SCORE_H_

#include <vector>

#include "common/features/pose_estimator.h"
#include "common/geometry/se3.h"

namespace airdos {

/// Log probability density of a pose under the prior, up to a constant that makes it 0 at the mean.
/// Heavy-tailed (Student's t, 3 degrees of freedom), because carriers do jerk now and then.
double LogPrior(const PosePrior& prior, const Se3& T_W_C);

/// How well a pose explains a frame, for choosing among several poses: the sum of `trust` (0..1,
/// one per observation) over the observations that agree with it, plus LogPrior().
/// One fully trusted observation counts one unit of log probability and no more, because
/// observations of the same moving thing have correlated errors.
double ScorePose(const PoseEstimate& estimate, const std::vector<double>& trust,
                 const PosePrior& prior);

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_POSE_SCORE_H_
