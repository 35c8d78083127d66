#ifndef AIRDOS_COMMON_OPTIMIZATION_BLOCK_MATRIX_H_
#define AIRDOS_COMMON_OPTIMIZATION_BLOCK_MATRIX_H_

#include <vector>

namespace airdos {

/// A symmetric matrix of small dense blocks, of which those on and above the diagonal are held,
/// row-major. Rows and columns are the unknowns in the order of their elimination.
class BlockMatrix {
 public:
  struct Entry {
    int col = 0;
    int offset = 0;  ///< of its values
    int next = -1;   ///< entry of the same row; -1: the last
  };

  /// One dimension per unknown. The diagonal is there from the start.
  explicit BlockMatrix(const std::vector<int>& dims);

  /// Where the values of block (row, col) start, row <= col; makes the block if there is none.
  int Offset(int row, int col);
  int diagonal_offset(int block) const { return entries_[block].offset; }

  int num_blocks() const { return static_cast<int>(dims_.size()); }
  int dim(int block) const { return dims_[block]; }
  /// Place of a block's first scalar in a vector; `num_blocks()` gives the number of scalars.
  int begin(int block) const { return begins_[block]; }
  int num_scalars() const { return begins_.back(); }

  const std::vector<Entry>& entries() const { return entries_; }
  /// The row's first entry, which is its diagonal.
  int first_entry(int row) const { return row; }

  void SetZero();
  double* values() { return values_.data(); }
  const double* values() const { return values_.data(); }

 private:
  std::vector<int> dims_;
  std::vector<int> begins_;
  std::vector<Entry> entries_;  // the diagonal first
  std::vector<double> values_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_BLOCK_MATRIX_H_
