#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_TRUST_RULE_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_TRUST_RULE_H_

#include "common/geometry/se3.h"
#include "common/optimization/bundle/bundle_options.h"

namespace airdos {

/// Thresholds of TrustsPeople().
struct TrustOptions {
  /// People are not believed if the newest frame has at least this many static observations.
  int min_static_observations = 15;
  /// They must contribute at least this many motion factors ...
  int min_motion_factors = 20;
  /// ... of which no more than this share was rejected ...
  double max_rejected_share = 0.25;
  /// ... make the position more certain: sigma with people / sigma without at most this ...
  double max_relative_sigma = 0.9;
  /// ... and must not move the pose further than its covariance allows: bound of the squared
  /// Mahalanobis distance, chi-squared with 6 degrees of freedom, one in a thousand.
  double max_shift_chi2 = 22.5;
};

/// Whether to believe the pose estimated with people rather than the one from the static scene.
/// With enough static landmarks, wrong motion models make the camera worse (measured), so people
/// count only where the static scene is weak, and only if they agree among themselves and with it:
///
///   num_static < min_static
///   and  num_motion >= min_motion  and  num_motion_rejected <= max_share * num_motion
///   and  tr P'_t <= max_relative_sigma^2 tr P_t
///   and  d^T P^-1 d <= max_shift_chi2
///
/// P and P' are the covariances of the newest pose without and with people, index t denotes the
/// position, and d = Boxminus(with people, without people). Unless both covariances are known,
/// people are not believed.
bool TrustsPeople(const TrustOptions& options, int num_static_observations,
                  const BundleSummary& without_people, const BundleSummary& with_people,
                  const Vector6d& shift);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_TRUST_RULE_H_
