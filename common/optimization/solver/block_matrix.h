#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_MATRIX_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_MATRIX_H_

#include <Eigen/Core>
#include <vector>

namespace airdos {

/// A symmetric matrix of small dense row-major blocks, of which only those on and above the
/// diagonal are stored. Its rows and columns are the unknowns in elimination order, in groups. It
/// is the sum of layers, one per group, each holding the contributions of that group's factors.
class BlockMatrix {
 public:
  /// An off-diagonal block, in a linked list per row.
  struct Entry {
    int col = 0;
    int layer = 0;
    int offset = 0;  ///< of its values in the layer
    int next = -1;   ///< next entry of the same row; -1 for the last
  };

  /// `dims`: size of each unknown. `group_begins`: first unknown of each group, then the number of
  /// unknowns. The diagonal blocks, each in the layer of its group, exist from the start.
  BlockMatrix(const std::vector<int>& dims, const std::vector<int>& group_begins);

  /// Offset of the values of block (row, col), row <= col; creates the block if it does not exist.
  /// All blocks of a layer must be created before those of the next.
  int Offset(int row, int col, int layer);

  int num_groups() const { return static_cast<int>(group_begins_.size()) - 1; }
  int group_begin(int group) const { return group_begins_[group]; }
  int num_blocks() const { return static_cast<int>(dims_.size()); }
  int dim(int block) const { return dims_[block]; }
  /// Index of a block's first scalar in a vector; `num_blocks()` gives the number of scalars.
  int begin(int block) const { return begins_[block]; }
  int num_scalars() const { return begins_.back(); }
  /// Index of the first scalar of the last group, the poses.
  int first_pose_scalar() const { return begins_[group_begins_[num_groups() - 1]]; }
  int num_pose_scalars() const { return num_scalars() - first_pose_scalar(); }

  const std::vector<Entry>& entries() const { return entries_; }
  /// The first entry of a row, which is its diagonal block.
  int first_entry(int row) const { return row; }

  void SetZero(int layer);
  double* values() { return values_.data(); }
  const double* values() const { return values_.data(); }
  /// Reads the diagonal of the sum of all layers.
  void ReadDiagonal(Eigen::VectorXd* diagonal) const;

 private:
  struct Range {
    int begin = 0, end = 0;
  };

  std::vector<int> dims_;
  std::vector<int> group_begins_;
  std::vector<int> begins_;
  std::vector<Entry> entries_;  // the diagonal blocks first
  std::vector<Range> layers_;   // values other than the diagonal's
  std::vector<double> values_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_MATRIX_H_
