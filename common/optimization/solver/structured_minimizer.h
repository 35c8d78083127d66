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
/// equations have the shape of an arrow; everything but the poses is eliminated piece by piece:
///
///      landmarks | track 1     : l | ... | track n     : l | poses
///    [ o         |                 |     |                 | x x ]
///    [   o       |                 |     |                 | x x ]  3 x 3 blocks, one a landmark
///    [     o     |                 |     |                 | x x ]
///    [ ----------+-----------------+-----+-----------------+---- ]
///    [           | 1 a         : l |     |                 | x   ]  slices 1, 2, 3 ... in time,
///    [           | a 2 b       : l |     |                 | x x ]  each coupled with its
///    [           |   b 3 .     : l |     |                 |   x ]  neighbours by motion (a, b)
///    [           | l l l .     : L |     |                 |     ]  and with what the track shares
///    [ ----------+-----------------+-----+-----------------+---- ]
///    [                              ...                          ]
///    [ ----------+-----------------+-----+-----------------+---- ]
///    [ symmetric                                           | P P ]  poses, dense, at the end
///    [                                                     | P P ]
///
/// What a track shares (l, L) are its segment lengths, or one motion over all of it; x couples a
/// slice with the pose of its frame.
// clang-format on
///
/// elimination_order.h says in which order a track is eliminated; block_elimination.h, how. With n
/// people over w frames, b scalars of torso and velocity in a slice (21), l of lengths (14), the
/// multiply-adds of one step are about
///
///   n w (b / 2) (2 b + l + 6 w')^2 + landmarks (6 w)^2 / 2 * 3 + (6 w)^3 / 6
///
/// with w' the frames of the piece that a slice carries the poses of: a few for most slices, w for
/// one. So it is linear in people, and grows with the window by w to w log w while 6 w < 2 b + l,
/// towards w^3 beyond.
///
/// The steps are those of Ceres' LevenbergMarquardtStrategy and TrustRegionMinimizer but for
/// rounding: the same damping (Jacobi-scaled clamped diagonal), radius, tolerances and counting of
/// iterations. An iteration allocates nothing; the result depends on the graph only, not on
/// addresses.
///
/// With `steps_by_track` it parts from Ceres in two things, made for a window that is solved again
/// with every frame and starts near its solution (warm):
///  - A track (or the landmarks) whose cost a step makes worse is put back, if that lowers its
///    cost, and damped more until its steps succeed. One joint on the kink of its segment's length
///    then does not shrink the steps of all others.
///  - A track whose cost followed the linear prediction, or hardly changed, keeps its linearization
///    and its elimination. It has become a quadratic prior on the poses, S d = -r, of which only r
///    moves on with them; its unknowns follow by back-substitution. Costs are always evaluated in
///    full, so that no step is taken that raises the cost, and the stop is decided by the true
///    cost.
/// What leaves the window is fixed, not marginalised: as key frames that hold the landmarks
/// (WindowMap), and as known segment lengths of people (HumanTracks).
class StructuredMinimizer {
 public:
  /// The graph is not owned and must outlive this; blocks and factors must not be added later.
  /// `memory` (or null) lends its capacity: handed from solve to solve it saves the system the work
  /// of clearing pages.
  explicit StructuredMinimizer(FactorGraph* graph, std::vector<double>* memory = nullptr);

  /// Levenberg-Marquardt from the graph's values, which become the result. Where the cost at the
  /// start is not finite nothing moves. From one call to the next factors may be removed, but
  /// values must stay as they are.
  MinimizerSummary Minimize(const MinimizerOptions& options);

  /// Marginal covariance of a free pose at the graph's values: of the inverse Gauss-Newton Hessian
  /// with losses applied, after adding 1 / prior_sigma^2 to the diagonal. Nothing if that cannot be
  /// factorised.
  std::optional<Matrix6d> PoseCovariance(int block, double prior_sigma);

  /// One undamped step of Gauss and Newton with `damping` on the diagonal, in the order of order();
  /// values stay. Nothing if the system cannot be factorised.
  std::optional<Eigen::VectorXd> LinearStep(const Eigen::VectorXd& damping);
  /// The blocks of the graph that are solved for, as they stand in the linear system.
  const std::vector<int>& order() const { return order_; }

 private:
  /// The trust region, as a radius, and how it follows the success of steps.
  struct TrustRegion {
    double radius = 1e4;
    double decrease_factor = 2;
    void Accept(double quality);
    void Reject();
  };

  struct Norms {
    double values = 0;  ///< of the saved values
    double step = 0;    ///< of how far the graph's values are from them
  };

  int num_groups() const { return linearizer_->num_groups(); }
  int ScalarBegin(int group) const { return H_->begin(group_begins_[group]); }
  int NumScalars(int group) const { return ScalarBegin(group + 1) - ScalarBegin(group); }
  /// All groups but those that are kept. Returns the cost.
  double Linearize();
  void LinearizeAll();
  double MaxGradient() const;
  void SetDamping(double radius);
  bool ComputeStep();
  void SaveValues();
  void RestoreValues(int group);
  void RestoreValues();
  /// Costs of the groups at the graph's values into `new_costs_`; returns their sum.
  double Evaluate();
  /// Puts tracks back that are better off where they were. Returns what that saves.
  double RestoreWorseTracks();
  /// A group's values in the graph: the saved ones moved by the step.
  void ApplyStep(int group);
  Norms MeasureStep() const;
  /// After a step: by how much the group's cost should have fallen. Its unknowns are now where its
  /// own equations want them, and its share of the poses' equations follows these.
  double PredictAndMoveShare(int group);
  /// Groups that did so but for this share of their cost are not linearized and eliminated again:
  /// in the next steps they are a quadratic prior on the poses, which their unknowns follow.
  void KeepPredictedGroups(double tolerance);

  FactorGraph* graph_;
  std::vector<int> order_;
  std::optional<BlockMatrix> H_;
  std::optional<GraphLinearizer> linearizer_;
  std::optional<BlockElimination> elimination_;
  PoseManifold manifold_;

  Eigen::VectorXd gradient_, diagonal_, scale_, damping_, step_;
  std::vector<double> saved_;  // values of the blocks in order_
  // Landmarks, each track, poses: first block, value in saved_ and scalar; cost; extra damping.
  std::vector<int> group_begins_;
  std::vector<std::size_t> value_begins_;
  std::vector<char> is_kept_;
  std::vector<double> costs_, new_costs_, caution_, caution_step_;
  double model_cost_change_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_STRUCTURED_MINIMIZER_H_
