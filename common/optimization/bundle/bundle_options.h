#ifndef AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_OPTIONS_H_
#define AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_OPTIONS_H_

#include <optional>

#include "common/geometry/se3.h"
#include "common/optimization/bundle/bundle_problem.h"

namespace airdos {

/// The minimizer: our own solver, designed for these graphs (structured_minimizer.h), or Ceres.
enum class BundleSolver { kStructured, kCeres };

/// Settings of SolveBundle().
struct BundleOptions {
  bool use_people = true;
  bool compute_covariance = true;  ///< of the newest frame
  bool use_rigidity = true;
  bool use_motion = true;
  MotionForm motion_form = MotionForm::kVelocity;  ///< where a person's own is not given

  // Solver. Only iterations are limited, never time: the result must not depend on the machine.
  BundleSolver solver = BundleSolver::kStructured;
  bool steps_by_track = true;  ///< kStructured: see MinimizerOptions; if false, steps as Ceres'
  int max_iterations = 6;      ///< of the first pass
  int max_iterations_after_rejection = 4;  ///< of the pass after it; 0: nothing is rejected
  double function_tolerance = 1e-4;        ///< relative change of cost that ends a pass

  // Huber kernels, in standard deviations of the residual's norm.
  double huber_static_sigmas = 2.5;
  double huber_dynamic_sigmas = 2.0;
  double huber_smoothness_sigmas = 0;  ///< on changes of a person's velocity; 0: none

  // Outliers: a factor whose whitened error is larger is rejected before the second pass.
  double reject_static_sigmas = 4.0;
  double reject_joint_sigmas = 4.0;
  double reject_rigidity_sigmas = 4.0;
  double reject_motion_sigmas = 4.0;

  // People. Motion and acceleration where a person's own noise is not given.
  double rigidity_sigma_m = 0.015;
  double motion_sigma_m = 0.04;
  double motion_max_gap_s = 0.5;          ///< no motion factor across a longer gap in a track
  double person_acceleration_m_s2 = 2.0;  ///< sigma of the change of velocity (kVelocity)
  double person_speed_m_s = 1.0;          ///< sigma of a track's first velocity; 0: unknown
  double free_rotation_sigma_rad = 0.1;   ///< about a two-point part's own axis (kSe3Parts)
  double segment_length_sigma_m = 0.01;   ///< of a known length, beside what it is known by
};

inline constexpr double kUnobservedSigma = 100;  // m or rad, where nothing says anything

/// Outcome of SolveBundle().
struct BundleSummary {
  bool has_converged = false;  ///< the last pass met its tolerance within its iterations
  int num_iterations = 0;      ///< of all passes
  double initial_cost = 0;     ///< half the sum of squared whitened residuals, kernels applied
  double final_cost = 0;
  /// Marginal covariance of the newest frame's pose, from the Gauss-Newton Hessian at the solution
  /// with kernels applied: tangent of common/geometry/se3.h, translation (m) and rotation (rad) in
  /// C. Directions that nothing observes get kUnobservedSigma. Nothing if it was not asked for, the
  /// frame is fixed, or the Hessian could not be factorised.
  std::optional<Matrix6d> newest_covariance;
  int num_people = 0;  ///< with factors
  int num_rigidity = 0;
  int num_motion = 0;
  int num_rigidity_rejected = 0;
  int num_motion_rejected = 0;
  int num_reprojection_rejected = 0;  ///< landmarks and joints
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BUNDLE_BUNDLE_OPTIONS_H_
