#ifndef AIRDOS_COMMON_OPTIMIZATION_BLOCK_ELIMINATION_H_
#define AIRDOS_COMMON_OPTIMIZATION_BLOCK_ELIMINATION_H_

#include <Eigen/Core>
#include <vector>

#include "common/optimization/block_matrix.h"
#include "common/optimization/dense_kernels.h"

namespace airdos {

/// Solves (H + D) x = b for a BlockMatrix H by Cholesky factorisation, front by front. D is
/// diagonal. Every front is one dense panel:
///
///          own   later unknowns that it is coupled with, directly or by what went before
///        +-----+--------------------------------------+
///   own  |  A  |                  B                   |   A = U^T U,  W = U^-T B,
///        +-----+--------------------------------------+   later panels -= W^T W
///
/// Which unknowns these are, and where each part of W^T W goes, is worked out once from the pattern
/// of H: whatever its factors couple is accounted for. Solving allocates nothing, and its order of
/// sums depends on the pattern only.
class BlockElimination {
 public:
  /// `front_begins`: first block of each front, and the number of blocks. `group_begins`: first
  /// front of each group, and the number of fronts; a group is put together and eliminated at once,
  /// so that it stays in the cache. H is looked at for its pattern only.
  BlockElimination(const BlockMatrix& H, const std::vector<int>& front_begins,
                   const std::vector<int>& group_begins);

  /// Factorises H + D. Returns false where that is not positive definite.
  bool Factorise(const BlockMatrix& H, const Eigen::VectorXd& D);
  /// Solves for a right side with the last factorisation; in place.
  void Solve(Eigen::VectorXd* b) const;
  /// The part of (H + D)^-1 that belongs to `size` unknowns of the last front from scalar `begin`.
  Eigen::MatrixXd InverseBlock(int begin, int size) const;

  /// Multiply-adds of one factorisation.
  double num_operations() const;

 private:
  struct Front {
    int begin = 0, end = 0;  ///< blocks
    int offset = 0;          ///< of the panel
    int rows = 0, width = 0, stride = 0;
    int first_scalar = 0;
    int runs_begin = 0, runs_end = 0;
    int updates_begin = 0, updates_end = 0;
    int entries_begin = 0, entries_end = 0;
  };
  /// Columns of a panel that are neighbours in every panel they go to.
  struct Run {
    int col = 0;  ///< of the panel
    int size = 0;
    int scalar = 0;  ///< in a vector
  };
  struct Update {
    int col_a = 0, col_b = 0;
    int target = 0;  ///< offset
    ProductShape shape;
  };
  /// A block of H in its panel.
  struct PanelEntry {
    int source = 0, target = 0;  ///< offsets
    int rows = 0, cols = 0, stride = 0;
  };
  class Analysis;

  /// H + D into the panels of the fronts [begin, end).
  void AssembleFronts(const BlockMatrix& H, const Eigen::VectorXd& D, int begin, int end);
  bool FactoriseFront(const Front& front);
  void SolveForward(const Front& front, double* x) const;
  void SolveBackward(const Front& front, double* x) const;

  std::vector<Front> fronts_;
  std::vector<int> group_begins_;
  std::vector<Run> runs_;
  std::vector<Update> updates_;
  std::vector<PanelEntry> entries_;
  std::vector<double> panels_;
  mutable std::vector<double> gathered_;  // of a right side, for one front
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BLOCK_ELIMINATION_H_
