#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_ELIMINATION_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_ELIMINATION_H_

#include <Eigen/Core>
#include <vector>

#include "common/optimization/solver/block_matrix.h"
#include "common/optimization/solver/dense_kernels.h"

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
///
/// Groups are eliminated one by one and know only of themselves and of the last group, the poses.
/// What a group leaves to the poses, S_g d = -r_g, is held apart for each: its share. A group whose
/// share still holds need not be eliminated again.
class BlockElimination {
 public:
  /// `front_begins`: first block of each front, and the number of blocks. `group_begins`: first
  /// front of each group of H, and the number of fronts. H is looked at for its pattern only.
  /// `memory` (or null) lends its capacity, and must outlive this.
  BlockElimination(const BlockMatrix& H, const std::vector<int>& front_begins,
                   const std::vector<int>& group_begins, std::vector<double>* memory);
  ~BlockElimination();
  BlockElimination(const BlockElimination&) = delete;
  BlockElimination& operator=(const BlockElimination&) = delete;

  int num_groups() const { return static_cast<int>(group_begins_.size()) - 1; }
  /// Right sides and solutions: first the scalars of H, those of the last group being the poses'
  /// own; then for every other group its share of the poses' right side.
  int vector_size() const { return num_scalars_ + (num_groups() - 1) * num_pose_scalars_; }
  int share_begin(int group) const { return num_scalars_ + group * num_pose_scalars_; }

  /// Factorises a group's part of H + D and works out its share. Returns false where it is not
  /// positive definite.
  bool Eliminate(const BlockMatrix& H, const Eigen::VectorXd& D, int group);
  /// The same for the right side.
  void SolveForward(int group, Eigen::VectorXd* b) const;
  /// Factorises what is left: the poses, with the shares of all groups.
  bool FactorisePoses(const BlockMatrix& H, const Eigen::VectorXd& D);
  /// From right sides that went through SolveForward() to the solution. The shares stay.
  void SolveBackward(Eigen::VectorXd* b) const;
  /// The poses moved by `d` from where the group was linearized: its share of the right side
  /// follows.
  void MoveShare(int group, const Eigen::VectorXd& d, Eigen::VectorXd* b) const;

  /// All of the above.
  bool Factorise(const BlockMatrix& H, const Eigen::VectorXd& D);
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
    int group = 0;
  };
  /// Columns of a panel that are neighbours in every panel they go to.
  struct Run {
    int col = 0;  ///< of the panel
    int size = 0;
    int scalar = 0;  ///< of the solution
    int target = 0;  ///< of the right side
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

  void AddEntries(const BlockMatrix& H, int layer);
  void AddDiagonal(const Eigen::VectorXd& D, const Front& front);
  bool FactoriseFront(const Front& front);
  void SolveForward(const Front& front, double* x) const;
  void SolveBackward(const Front& front, double* x) const;
  int share_size() const { return poses_ == nullptr ? 0 : poses_->rows * poses_->stride; }
  int share_offset(int group) const { return shares_offset_ + group * share_size(); }

  int num_scalars_ = 0;
  int num_pose_scalars_ = 0;
  std::vector<Front> fronts_;
  std::vector<int> group_begins_;
  std::vector<Run> runs_;
  std::vector<Update> updates_;
  std::vector<PanelEntry> entries_;  // by layer
  std::vector<int> entry_begins_;
  const Front* poses_ = nullptr;  // the last front; null: none
  std::vector<double> panels_;    // of all fronts, then the groups' shares of the last one's
  int shares_offset_ = 0;
  std::vector<double>* memory_;           // or null; gets panels_ back
  mutable std::vector<double> gathered_;  // of a right side, for one front
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_ELIMINATION_H_
