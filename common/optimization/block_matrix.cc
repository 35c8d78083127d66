#include "common/optimization/block_matrix.h"

#include <algorithm>

#include "common/util/check.h"

namespace airdos {

BlockMatrix::BlockMatrix(const std::vector<int>& dims) : dims_(dims) {
  int num_scalars = 0;
  int num_values = 0;
  begins_.reserve(dims.size() + 1);
  entries_.reserve(8 * dims.size());
  for (int block = 0; block < num_blocks(); ++block) {
    begins_.push_back(num_scalars);
    entries_.push_back({block, num_values, -1});
    num_scalars += dims[block];
    num_values += dims[block] * dims[block];
  }
  begins_.push_back(num_scalars);
  values_.resize(num_values);
}

int BlockMatrix::Offset(int row, int col) {
  AIRDOS_CHECK(row <= col);
  int entry = first_entry(row);
  while (entries_[entry].col != col) {
    if (entries_[entry].next < 0) {
      const int offset = static_cast<int>(values_.size());
      entries_[entry].next = static_cast<int>(entries_.size());
      entries_.push_back({col, offset, -1});
      values_.resize(values_.size() + dims_[row] * dims_[col]);
      return offset;
    }
    entry = entries_[entry].next;
  }
  return entries_[entry].offset;
}

void BlockMatrix::SetZero() { std::fill(values_.begin(), values_.end(), 0.0); }

}  // namespace airdos
