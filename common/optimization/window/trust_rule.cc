#include "common/optimization/window/trust_rule.h"

#include "common/geometry/covariance.h"

namespace airdos {

bool TrustsPeople(const TrustOptions& options, int num_static_observations,
                  const BundleSummary& without_people, const BundleSummary& with_people,
                  const Vector6d& shift) {
  if (num_static_observations >= options.min_static_observations) return false;
  const int num_motion = with_people.num_motion;
  if (num_motion < options.min_motion_factors ||
      with_people.num_motion_rejected > options.max_rejected_share * num_motion) {
    return false;
  }
  if (!without_people.newest_covariance || !with_people.newest_covariance) return false;
  const Matrix6d& P = *without_people.newest_covariance;
  const Matrix6d& P_with = *with_people.newest_covariance;
  const double largest_trace =
      options.max_relative_sigma * options.max_relative_sigma * P.topLeftCorner<3, 3>().trace();
  if (!(P_with.topLeftCorner<3, 3>().trace() <= largest_trace)) return false;
  return SquaredMahalanobis(shift, P) <= options.max_shift_chi2;  // false for NaN
}

}  // namespace airdos
