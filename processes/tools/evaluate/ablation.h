#ifndef AIRDOS_PROCESSES_TOOLS_EVALUATE_ABLATION_H_
#define AIRDOS_PROCESSES_TOOLS_EVALUATE_ABLATION_H_

#include <optional>
#include <string>
#include <vector>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/window/track_noise.h"
#include "common/simulation/feature_simulator.h"

namespace airdos {

/// The rows of the paper's table, by what they leave out.
enum class AblationRow { kBefore, kStatic, kWithoutMotion, kWithoutRigidity, kFull };
const char* NameOf(AblationRow row);
const std::vector<AblationRow>& AblationRows();

/// RMS errors over one sequence.
struct AblationErrors {
  double ate_unaligned_m = 0;  ///< positions, with the first pose set to the truth
  double ate_aligned_m = 0;    ///< after SE(3) alignment
  double rpe_m = 0;            ///< per frame
  double rpe_deg = 0;
  double dynamic_m = 0;  ///< of dynamic points, in the frame of the camera that sees them
  bool has_converged = true;
};

/// Settings of an Ablation.
struct AblationOptions {
  int max_iterations = 1000;  ///< per solve; enough to converge
  double function_tolerance = 1e-10;
  bool compute_covariance = false;  ///< of the newest pose
  double rigidity_sigma_m = 0.01;
  double stereo_rigidity_sigma_m = 0.02;  ///< for depths as uncertain as those of stereo
  TrackNoiseOptions noise;                ///< how the motion of each object is weighted
  int num_noise_passes = 2;  ///< adjustments to learn the noise from, before the last one
};

/// Bundle adjustment over a whole simulated sequence, with the same start values for all rows. The
/// noise of each object's motion is learnt from the sequence itself; only Evaluate() sees the
/// truth.
class Ablation {
 public:
  /// An adjusted problem.
  struct Solution {
    BundleProblem problem;
    BundleSummary summary;  ///< of the last solve
  };

  /// The sequence is not owned and must outlive this.
  Ablation(const AblationOptions& options, const SimulatedSequence& sequence);

  /// The problem with start values: first frame fixed, poses from odometry, points as measured.
  BundleProblem MakeProblem() const;
  Solution Solve(AblationRow row) const;
  /// The errors of a problem's values, including `dynamic_m` even if the points took no part in the
  /// adjustment.
  AblationErrors Evaluate(const BundleProblem& problem) const;
  /// Solves and evaluates.
  AblationErrors Run(AblationRow row) const;

 private:
  BundleOptions MakeBundleOptions(AblationRow row) const;
  /// Solves from the odometry and from the solution without people; returns the one with the lower
  /// cost.
  BundleProblem SolveWithPriorNoise(const BundleOptions& bundle) const;
  void LearnNoise(BundleProblem* problem) const;
  BundleSummary SolveMotion(BundleOptions bundle, BundleProblem* problem) const;
  BundleSummary SolveRigidity(const BundleOptions& bundle, BundleProblem* problem) const;

  AblationOptions options_;
  const SimulatedSequence& sequence_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_EVALUATE_ABLATION_H_
