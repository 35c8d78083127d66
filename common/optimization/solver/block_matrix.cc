#include "common/optimization/solver/block_matrix.h"

#include <algorithm>

#include "common/util/check.h"

namespace airdos {

BlockMatrix::BlockMatrix(const std::vector<int>& dims, const std::vector<int>& group_begins)
    : dims_(dims), group_begins_(group_begins), layers_(group_begins.size() - 1) {
  int num_scalars = 0;
  int num_values = 0;
  begins_.reserve(dims.size() + 1);
  entries_.reserve(8 * dims.size());
  for (int group = 0; group < num_groups(); ++group) {
    for (int block = group_begins[group]; block < group_begins[group + 1]; ++block) {
      begins_.push_back(num_scalars);
      entries_.push_back({block, group, num_values, -1});
      num_scalars += dims[block];
      num_values += dims[block] * dims[block];
    }
  }
  begins_.push_back(num_scalars);
  values_.resize(num_values);
}

int BlockMatrix::Offset(int row, int col, int layer) {
  AIRDOS_CHECK(row <= col);
  int entry = first_entry(row);
  while (entries_[entry].col != col || entries_[entry].layer != layer) {
    if (entries_[entry].next < 0) {
      const int offset = static_cast<int>(values_.size());
      entries_[entry].next = static_cast<int>(entries_.size());
      entries_.push_back({col, layer, offset, -1});
      values_.resize(values_.size() + dims_[row] * dims_[col]);
      Range& range = layers_[layer];
      if (range.begin == range.end) range = {offset, offset};
      AIRDOS_CHECK(range.end == offset);
      range.end = static_cast<int>(values_.size());
      return offset;
    }
    entry = entries_[entry].next;
  }
  return entries_[entry].offset;
}

void BlockMatrix::SetZero(int layer) {
  const auto clear = [this](int begin, int end) {
    std::fill(values_.begin() + begin, values_.begin() + end, 0.0);
  };
  clear(layers_[layer].begin, layers_[layer].end);
  const int first = group_begins_[layer], end = group_begins_[layer + 1];
  if (first == end) return;
  clear(entries_[first].offset, entries_[end - 1].offset + dims_[end - 1] * dims_[end - 1]);
}

void BlockMatrix::ReadDiagonal(Eigen::VectorXd* diagonal) const {
  diagonal->setZero();
  for (int row = 0; row < num_blocks(); ++row) {
    for (int e = first_entry(row); e >= 0; e = entries_[e].next) {
      if (entries_[e].col != row) continue;
      const double* const values = values_.data() + entries_[e].offset;
      for (int i = 0; i < dims_[row]; ++i) {
        (*diagonal)[begins_[row] + i] += values[i * (dims_[row] + 1)];
      }
    }
  }
}

}  // namespace airdos
