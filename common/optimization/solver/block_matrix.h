#ifndef AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_MATRIX_H_
#define AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_MATRIX_H_

#include <Eigen/Core>
#include <vector>

namespace airdos {

/// A symmetric matrix of small dense blocks, of which those on and above the diagonal are held,
/// row-major. Rows and columns are the unknowns in the order of their elimination, in groups. The
/// matrix is a sum of layers, one per group: what the factors of that group say.
class BlockMatrix {
 public:
  struct Entry {
    int col = 0;
    int layer = 0;
    int offset = 0;  ///< of its values
    int next = -1;   ///< entry of the same row; -1: the last
  };

  /// One dimension per unknown; first unknown of each group, and the number of unknowns. The
  /// diagonal, each block in the layer of its group, is there from the start.
  BlockMatrix(const std::vector<int>& dims, const std::vector<int>& group_begins);

  /// Where the values of block (row, col) start, row <= col; makes the block if there is none. The
  /// blocks of a layer must be made one after the other.
  int Offset(int row, int col, int layer);

  int num_groups() const { return static_cast<int>(group_begins_.size()) - 1; }
  int group_begin(int group) const { return group_begins_[group]; }
  int num_blocks() const { return static_cast<int>(dims_.size()); }
  int dim(int block) const { return dims_[block]; }
  /// Place of a block's first scalar in a vector; `num_blocks()` gives the number of scalars.
  int begin(int block) const { return begins_[block]; }
  int num_scalars() const { return begins_.back(); }
  /// Those of the last group.
  int first_pose_scalar() const { return begins_[group_begins_[num_groups() - 1]]; }
  int num_pose_scalars() const { return num_scalars() - first_pose_scalar(); }

  const std::vector<Entry>& entries() const { return entries_; }
  /// The row's first entry, which is its diagonal.
  int first_entry(int row) const { return row; }

  void SetZero(int layer);
  double* values() { return values_.data(); }
  const double* values() const { return values_.data(); }
  /// The diagonal of the sum of the layers.
  void ReadDiagonal(Eigen::VectorXd* diagonal) const;

 private:
  struct Range {
    int begin = 0, end = 0;
  };

  std::vector<int> dims_;
  std::vector<int> group_begins_;
  std::vector<int> begins_;
  std::vector<Entry> entries_;  // the diagonal first
  std::vector<Range> layers_;   // values, but for the diagonal
  std::vector<double> values_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SOLVER_BLOCK_MATRIX_H_
