#include "common/features/pose_score.h"

#include <cmath>

#include "common/geometry/covariance.h"
#include "common/util/check.h"

namespace airdos {

double LogPrior(const PosePrior& prior, const Se3& T_W_C) {
  constexpr double kFreedom = 3;
  constexpr double kDimension = 6;
  const Vector6d innovation = Boxminus(T_W_C, prior.T_W_C);
  const double chi2 = SquaredMahalanobis(innovation, prior.covariance);
  return -0.5 * (kFreedom + kDimension) * std::log1p(chi2 / kFreedom);
}

double ScorePose(const PoseEstimate& estimate, const std::vector<double>& trust,
                 const PosePrior& prior) {
  AIRDOS_CHECK(estimate.is_inlier.size() == trust.size());
  double score = LogPrior(prior, estimate.T_W_C);
  for (std::size_t i = 0; i < trust.size(); ++i) {
    if (estimate.is_inlier[i]) score += trust[i];
  }
  return score;
}

}  // namespace airdos
