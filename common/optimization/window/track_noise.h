#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_TRACK_NOISE_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_TRACK_NOISE_H_

#include <set>

#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// Settings of EstimateMotionNoise().
struct TrackNoiseOptions {
  /// The noise assumed for a track until it provides evidence itself, and how far tracks differ
  /// from it: the sigma of the logarithm of each value.
  MotionNoise prior{0.03, 3.0, 1.0};
  double prior_log_sigma = 1.0;
  /// Frame-to-frame uncertainty of the camera that sees the track: standard deviation of the
  /// track's centre per axis. At 0, errors of the camera are attributed to the person, which is the
  /// safe side; too large a value makes people appear steadier than they are.
  double camera_sigma_m = 0;
  /// Limits of the result.
  MotionNoise least{0.01, 0.1, 0.1};
  MotionNoise largest{0.3, 20.0, 20.0};
  /// Limit of a squared whitened error: one wrong joint must not decide the result for a track.
  double largest_chi2 = 25;
};

/// Estimates the process noise of one track from how it moved: the scatter of its points about the
/// body's motion, and the accelerations of the body's centre. Both maximise the posterior
///
///   p(sigma) ~ prod_k N(innovation_k; 0, S_k(sigma)) * N(log sigma; log prior, prior_log_sigma)
///
/// (more precisely: are its mean over a grid of log sigma), so a short or distant track keeps the
/// prior. The innovations are those of a constant-velocity filter of the centre of the body points,
/// which accounts for the covariance of each measurement. Points are taken as measured, from the
/// poses in `problem`: call it after an adjustment. A track that is too short to be informative
/// gets the prior.
MotionNoise EstimateMotionNoise(const TrackNoiseOptions& options, const BundleProblem& problem,
                                const BundleProblem::Human& human);

/// Settings of FindTrackBreaks().
struct TrackBreakOptions {
  double acceleration_m_s2 = 6;  ///< sigma of the filter; nobody exceeds it for long
  double camera_sigma_m = 0.1;   ///< of the poses from frame to frame, at the person
  double largest_chi2 = 30;      ///< of the centre's innovation, 3 degrees of freedom
};

/// The frames at which a track jumps further than any person can: two people were mistaken for each
/// other there. Uses the points as measured and the poses in `problem`, which may be initial
/// values. The filter restarts at each such frame. A gap in the track is not evidence of a jump.
std::set<int> FindTrackBreaks(const TrackBreakOptions& options, const BundleProblem& problem,
                              const BundleProblem::Human& human);

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_TRACK_NOISE_H_
