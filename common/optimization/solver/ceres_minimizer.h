#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_CERES_MINIMIZER_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_CERES_MINIMIZER_H_

#include <ceres/problem.h>

#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/optimization/solver/factor_graph.h"

namespace airdos {

/// Minimizes a FactorGraph with Ceres: the reference for StructuredMinimizer, and the fallback
/// should it ever be wrong.
class CeresMinimizer {
 public:
  /// The graph is not owned and must outlive this; no blocks or factors may be added afterwards.
  explicit CeresMinimizer(FactorGraph* graph);

  /// Levenberg-Marquardt, starting from the graph's values, which are overwritten with the result.
  MinimizerSummary Minimize(const MinimizerOptions& options);
  /// See StructuredMinimizer.
  std::optional<Matrix6d> PoseCovariance(int block, double prior_sigma);

 private:
  void DropRemovedFactors();

  FactorGraph* graph_;
  PoseManifold manifold_;
  ceres::Problem problem_;
  std::vector<ceres::ResidualBlockId> ids_;  // indexed by factor; null once removed
  bool has_tracks_ = false;
  bool has_landmarks_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_CERES_MINIMIZER_H_
