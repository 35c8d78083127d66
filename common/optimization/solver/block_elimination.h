#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_ELIMINATION_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_ELIMINATION_H_

#include <Eigen/Core>
#include <vector>

#include "common/optimization/solver/block_matrix.h"
#include "common/optimization/solver/dense_kernels.h"

namespace airdos {

/// Solves (H + D) x = b for a BlockMatrix H by Cholesky factorisation, front by front. D is
/// diagonal. Each front is one dense panel:
///
///          own   later unknowns that it is coupled with, directly or by what went before
///        +-----+--------------------------------------+
///   own  |  A  |                  B                   |   A = U^T U,  W = U^-T B,
///        +-----+--------------------------------------+   later panels -= W^T W
///
/// Which unknowns these are, and where each part of W^T W goes, is worked out once from the
/// sparsity pattern of H, so every coupling is accounted for. Solving allocates nothing, and the
/// order of summation depends on the pattern only.
///
/// Groups are eliminated one at a time. A group is coupled only with itself and with the last
/// group, the poses. The Schur complement that a group contributes to the poses, S_g d = -r_g, is
/// stored per group: its share. A group whose share is still valid need not be eliminated again.
class BlockElimination {
 public:
  /// `front_begins`: first block of each front, then the number of blocks. `group_begins`: first
  /// front of each group of H, then the number of fronts. Only the pattern of H is read.
  /// `memory` (may be null) lends its capacity and must outlive this object.
  BlockElimination(const BlockMatrix& H, const std::vector<int>& front_begins,
                   const std::vector<int>& group_begins, std::vector<double>* memory);
  ~BlockElimination();
  BlockElimination(const BlockElimination&) = delete;
  BlockElimination& operator=(const BlockElimination&) = delete;

  int num_groups() const { return static_cast<int>(group_begins_.size()) - 1; }
  /// Length of right-hand sides and solutions: first the scalars of H, of which the last group's
  /// are the poses' own; then, for each other group, its share of the poses' right-hand side.
  int vector_size() const { return num_scalars_ + (num_groups() - 1) * num_pose_scalars_; }
  int share_begin(int group) const { return num_scalars_ + group * num_pose_scalars_; }

  /// Factorises a group's part of H + D and computes its share. Returns false if that part is not
  /// positive definite.
  bool Eliminate(const BlockMatrix& H, const Eigen::VectorXd& D, int group);
  /// Forward substitution of a group's part of the right-hand side.
  void SolveForward(int group, Eigen::VectorXd* b) const;
  /// Factorises what remains: the poses, including the shares of all groups.
  bool FactorisePoses(const BlockMatrix& H, const Eigen::VectorXd& D);
  /// Turns a right-hand side that has been through SolveForward() into the solution. The shares
  /// stay.
  void SolveBackward(Eigen::VectorXd* b) const;
  /// Updates a group's share of the right-hand side for poses that have moved by `d` since the
  /// group was linearized.
  void MoveShare(int group, const Eigen::VectorXd& d, Eigen::VectorXd* b) const;

  /// Eliminates all groups and factorises the poses.
  bool Factorise(const BlockMatrix& H, const Eigen::VectorXd& D);
  void Solve(Eigen::VectorXd* b) const;
  /// The diagonal block of (H + D)^-1 for `size` scalars of the last front, starting at scalar
  /// `begin`.
  Eigen::MatrixXd InverseBlock(int begin, int size) const;

  /// Multiply-adds in one factorisation.
  double num_operations() const;

 private:
  /// A set of unknowns that are eliminated together, and its panel.
  struct Front {
    int begin = 0, end = 0;  ///< blocks
    int offset = 0;          ///< of its panel in panels_
    int rows = 0, width = 0, stride = 0;
    int first_scalar = 0;
    int runs_begin = 0, runs_end = 0;
    int updates_begin = 0, updates_end = 0;
    int group = 0;
  };
  /// Columns that stay adjacent in every panel that they update.
  struct Run {
    int col = 0;  ///< first column in the panel
    int size = 0;
    int scalar = 0;  ///< first scalar in the solution
    int target = 0;  ///< first scalar in the right-hand side
  };
  /// One product W^T W that is subtracted from a later panel.
  struct Update {
    int col_a = 0, col_b = 0;
    int target = 0;  ///< offset in panels_
    ProductShape shape;
  };
  /// Where a block of H goes in its panel.
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
  std::vector<PanelEntry> entries_;  // sorted by layer
  std::vector<int> entry_begins_;
  const Front* poses_ = nullptr;  // the last front; null if there are no poses
  std::vector<double> panels_;    // of all fronts, then the groups' shares of the poses' panel
  int shares_offset_ = 0;
  std::vector<double>* memory_;           // may be null; panels_ is handed back to it
  mutable std::vector<double> gathered_;  // part of a right-hand side, for one front
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_ELIMINATION_H_
