#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_STRUCTURED_MINIMIZER_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_STRUCTURED_MINIMIZER_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/geometry/se3.h"
#include "common/optimization/solver/block_elimination.h"
#include "common/optimization/solver/block_matrix.h"
#include "common/optimization/solver/factor_graph.h"
#include "common/optimization/solver/graph_linearizer.h"

namespace airdos {

// clang-format off
/// Levenberg-Marquardt for graphs of cameras, static landmarks and moving objects. The normal
/// equations have an arrow structure; everything but the poses is eliminated piece by piece:
///
///      landmarks | track 1     : l | ... | track n     : l | poses
///    [ o         |                 |     |                 | x x ]
///    [   o       |                 |     |                 | x x ]  3 x 3 blocks, one per landmark
///    [     o     |                 |     |                 | x x ]
///    [ ----------+-----------------+-----+-----------------+---- ]
///    [           | 1 a         : l |     |                 | x   ]  slices 1, 2, 3 ... in time,
///    [           | a 2 b       : l |     |                 | x x ]  each coupled with its
///    [           |   b 3 .     : l |     |                 |   x ]  neighbours by motion (a, b)
///    [           | l l l .     : L |     |                 |     ]  and with the track's shared l
///    [ ----------+-----------------+-----+-----------------+---- ]
///    [                              ...                          ]
///    [ ----------+-----------------+-----+-----------------+---- ]
///    [ symmetric                                           | P P ]  poses, dense, at the end
///    [                                                     | P P ]
///
/// A track shares (l, L) its segment lengths, or one motion for the whole track; x couples a slice
/// with the pose of its frame.
// clang-format on
///
/// elimination_order.h explains in which order a track is eliminated, block_elimination.h how. With
/// n people over w frames, b scalars of torso and velocity per slice (21) and l of lengths (14),
/// one step takes about
///
///   n w (b / 2) (2 b + l + 6 w')^2 + landmarks (6 w)^2 / 2 * 3 + (6 w)^3 / 6
///
/// multiply-adds, where w' is the number of frames whose poses a slice's piece carries: a few for
/// most slices, w for one of them. The cost is therefore linear in the number of people. In the
/// window it grows like w to w log w while 6 w < 2 b + l, and towards w^3 beyond.
///
/// Up to rounding, the steps are those of Ceres' LevenbergMarquardtStrategy and
/// TrustRegionMinimizer: the same damping (Jacobi-scaled clamped diagonal), radius, tolerances and
/// iteration count. An iteration allocates nothing; the result depends on the graph only, not on
/// addresses.
///
/// With `steps_by_track` it departs from Ceres in two ways, designed for a window that is solved
/// again on every frame and starts close to its solution (warm start):
///  - A track whose cost a step increases is put back, if that lowers its cost,
///    and damped more until its steps succeed. A single joint at the kink of its segment's length
///    then does not shrink everybody else's steps.
///  - A track whose cost followed the linear prediction, or hardly changed, keeps its linearization
///    and its elimination. It acts as a quadratic prior on the poses, S d = -r, of which only r is
///    updated as they move; its unknowns follow by back-substitution. Costs are always evaluated in
///    full: no step that raises the cost is accepted, and the true cost decides when to stop.
/// What leaves the window is fixed, not marginalised: as key frames that hold the landmarks
/// (WindowMap), and as known segment lengths of people (HumanTracks).
class StructuredMinimizer {
 public:
  /// The graph is not owned and must outlive this; no blocks or factors may be added afterwards.
  /// `memory` (may be null) lends its capacity: passing it from solve to solve saves the system
  /// from clearing pages.
  explicit StructuredMinimizer(FactorGraph* graph, std::vector<double>* memory = nullptr);

  /// Levenberg-Marquardt, starting from the graph's values, which are overwritten with the result.
  /// If the initial cost is not finite, nothing moves. Factors may be removed between calls, but
  /// values must not be changed.
  MinimizerSummary Minimize(const MinimizerOptions& options);

  /// Marginal covariance of a free pose at the graph's values, from the inverse of the Gauss-Newton
  /// Hessian with losses applied and 1 / prior_sigma^2 added to its diagonal. Nothing if that
  /// matrix cannot be factorised.
  std::optional<Matrix6d> PoseCovariance(int block, double prior_sigma);

  /// One undamped Gauss-Newton step with `damping` added to the diagonal, in the order of order();
  /// the values do not change. Nothing if the system cannot be factorised.
  std::optional<Eigen::VectorXd> LinearStep(const Eigen::VectorXd& damping);
  /// The blocks of the graph that are solved for, in the order of the linear system.
  const std::vector<int>& order() const { return order_; }

 private:
  /// The trust-region radius, and how it adapts to the success of steps.
  struct TrustRegion {
    double radius = 1e4;
    double decrease_factor = 2;
    void Accept(double quality);
    void Reject();
  };

  /// Norms for the test of the parameter tolerance.
  struct Norms {
    double values = 0;  ///< of the saved values
    double step = 0;    ///< of the graph's values minus the saved ones
  };

  int num_groups() const { return linearizer_->num_groups(); }
  int ScalarBegin(int group) const { return H_->begin(group_begins_[group]); }
  int NumScalars(int group) const { return ScalarBegin(group + 1) - ScalarBegin(group); }
  /// Linearizes all groups but those that are kept. Returns the cost.
  double Linearize();
  void LinearizeAll();
  double MaxGradient() const;
  void SetDamping(double radius);
  bool ComputeStep();
  void SaveValues();
  void RestoreValues(int group);
  void RestoreValues();
  /// Writes the groups' costs at the graph's values to `new_costs_`; returns their sum.
  double Evaluate();
  /// Puts back the tracks that were better off before the step. Returns by how much that lowers the
  /// cost.
  double RestoreWorseTracks();
  /// Sets a group's values in the graph to the saved ones moved by the step.
  void ApplyStep(int group);
  Norms MeasureStep() const;
  /// Returns by how much the step should have lowered the group's cost. Then moves the group's
  /// linearization: its unknowns are where its own equations put them, and its share of the poses'
  /// equations is updated to match.
  double PredictAndMoveShare(int group);
  /// Groups whose cost followed the prediction to within this fraction are not linearized and
  /// eliminated again: in the next steps they are a quadratic prior on the poses, which their
  /// unknowns follow.
  void KeepPredictedGroups(double tolerance);

  FactorGraph* graph_;
  std::vector<int> order_;
  std::optional<BlockMatrix> H_;
  std::optional<GraphLinearizer> linearizer_;
  std::optional<BlockElimination> elimination_;
  PoseManifold manifold_;

  Eigen::VectorXd gradient_, diagonal_, scale_, damping_, step_;
  std::vector<double> saved_;  // values of the blocks of order_
  // Per group (landmarks, each track, poses): first block, first value in saved_, whether it is
  // kept, cost, extra damping.
  std::vector<int> group_begins_;
  std::vector<std::size_t> value_begins_;
  std::vector<char> is_kept_;
  std::vector<double> costs_, new_costs_, caution_, caution_step_;
  double model_cost_change_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_STRUCTURED_MINIMIZER_H_
