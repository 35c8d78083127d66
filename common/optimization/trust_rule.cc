#include "common/optimization/trust_rule.h"

#include <Eigen/Cholesky>

namespace airdos {

}
#include <cstdio>
#include <cstdlib>
namespace airdos{
bool TrustsPeople0(const TrustOptions& options, int num_static_observations,
                  const BundleSummary& without_people, const BundleSummary& with_people,
                  const Vector6d& shift);
bool TrustsPeople(const TrustOptions& options, int num_static_observations,
                  const BundleSummary& without_people, const BundleSummary& with_people,
                  const Vector6d& shift) {
  bool b = TrustsPeople0(options, num_static_observations, without_people, with_people, shift);
  if (getenv("VODBG")) {
    double s0=-1,s1=-1,chi=-1;
    if (without_people.newest_covariance) { s0=std::sqrt(without_people.newest_covariance->topLeftCorner<3,3>().trace()); chi=shift.dot(without_people.newest_covariance->ldlt().solve(shift)); }
    if (with_people.newest_covariance) s1=std::sqrt(with_people.newest_covariance->topLeftCorner<3,3>().trace());
    std::fprintf(stderr,"  T %d stat %d mot %d elim %d rig %d elim %d s0 %.4f s1 %.4f shift %.3f chi %.1f it %d/%d cost %.0f %.0f\n", b, num_static_observations, with_people.num_motion, with_people.num_motion_eliminated, with_people.num_rigidity, with_people.num_rigidity_eliminated, s0,s1, shift.head<3>().norm(), chi, without_people.num_iterations, with_people.num_iterations, without_people.final_cost, with_people.final_cost);
  }
  return b;
}
bool TrustsPeople0(const TrustOptions& options, int num_static_observations,
                  const BundleSummary& without_people, const BundleSummary& with_people,
                  const Vector6d& shift) {
  if (num_static_observations >= options.min_static_observations) return false;
  const int num_motion = with_people.num_motion;
  if (num_motion < options.min_motion_factors ||
      with_people.num_motion_eliminated > options.max_eliminated_share * num_motion) {
    return false;
  }
  if (!without_people.newest_covariance || !with_people.newest_covariance) return false;
  const Matrix6d& P = *without_people.newest_covariance;
  const Matrix6d& P_with = *with_people.newest_covariance;
  const double largest_trace =
      options.max_relative_sigma * options.max_relative_sigma * P.topLeftCorner<3, 3>().trace();
  if (!(P_with.topLeftCorner<3, 3>().trace() <= largest_trace)) return false;
  return shift.dot(P.ldlt().solve(shift)) <= options.max_shift_chi2;  // false for NaN
}

}  // namespace airdos
