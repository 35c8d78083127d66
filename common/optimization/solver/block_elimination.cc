#include "common/optimization/solver/block_elimination.h"

#include <Eigen/Dense>
#include <algorithm>

#include "common/util/check.h"

namespace airdos {
namespace {

using ArrayMap = Eigen::Map<Eigen::ArrayXd>;
using ConstArrayMap = Eigen::Map<const Eigen::ArrayXd>;

constexpr int kUnset = -1;

}  // namespace

/// Works out the panels and updates from the sparsity pattern.
class BlockElimination::Analysis {
 public:
  Analysis(const BlockMatrix& H, const std::vector<int>& front_begins, BlockElimination* result)
      : H_(H),
        result_(*result),
        front_of_(H.num_blocks()),
        later_(front_begins.size() - 1),
        first_child_(front_begins.size() - 1, kUnset),
        next_child_(front_begins.size() - 1, kUnset),
        place_(H.num_blocks(), kUnset) {
    AIRDOS_CHECK(front_begins.back() == H.num_blocks());
    for (int f = 0; f + 1 < static_cast<int>(front_begins.size()); ++f) {
      for (int block = front_begins[f]; block < front_begins[f + 1]; ++block) front_of_[block] = f;
      Front front;
      front.begin = front_begins[f];
      front.end = front_begins[f + 1];
      result_.fronts_.push_back(front);
    }
    SetGroups();
    const int num_fronts = static_cast<int>(result_.fronts_.size());
    for (int f = 0; f < num_fronts; ++f) FindLaterBlocks(f);
    for (int f = 0; f < num_fronts; ++f) PlacePanel(f);
    result_.shares_offset_ = num_values_;
    num_values_ += (H.num_groups() - 1) * result_.share_size();
    PlaceEntries();
    for (int f = 0; f < num_fronts; ++f) FindUpdates(f);
  }

  int num_values() const { return num_values_; }

 private:
  void SetGroups() {
    for (int group = 0; group < H_.num_groups(); ++group) {
      for (int f = result_.group_begins_[group]; f < result_.group_begins_[group + 1]; ++f) {
        result_.fronts_[f].group = group;
      }
    }
    const int first_pose_front = result_.group_begins_[H_.num_groups() - 1];
    const int num_fronts = static_cast<int>(result_.fronts_.size());
    AIRDOS_CHECK(num_fronts - first_pose_front <= 1);
    if (first_pose_front < num_fronts) result_.poses_ = &result_.fronts_.back();
  }

  /// Couplings from H and the fill-in that earlier fronts leave.
  void FindLaterBlocks(int f) {
    const Front& front = result_.fronts_[f];
    std::vector<int>& later = later_[f];
    const auto add = [&](int block) {
      if (block < front.end || place_[block] == f) return;
      place_[block] = f;  // marks the block as found
      later.push_back(block);
    };
    for (int row = front.begin; row < front.end; ++row) {
      for (int e = H_.first_entry(row); e >= 0; e = H_.entries()[e].next) add(H_.entries()[e].col);
    }
    for (int child = first_child_[f]; child >= 0; child = next_child_[child]) {
      for (const int block : later_[child]) add(block);
    }
    std::sort(later.begin(), later.end());
    if (later.empty()) return;
    const int parent = front_of_[later.front()];
    next_child_[f] = first_child_[parent];
    first_child_[parent] = f;
  }

  void PlacePanel(int f) {
    Front& front = result_.fronts_[f];
    front.first_scalar = H_.begin(front.begin);
    front.rows = H_.begin(front.end) - front.first_scalar;
    front.width = front.rows;
    for (const int block : later_[f]) front.width += H_.dim(block);
    front.stride = front.width + front.width % 2;
    front.offset = num_values_;
    num_values_ += front.rows * front.stride;
  }

  /// Maps the blocks of H to the panels, and those of the poses to the share of their layer.
  void PlaceEntries() {
    std::vector<std::vector<PanelEntry>> by_layer(H_.num_groups());
    for (const Front& front : result_.fronts_) {
      for (int row = front.begin; row < front.end; ++row) {
        place_[row] = H_.begin(row) - front.first_scalar;
      }
      int col = front.rows;
      for (const int block : later_[&front - result_.fronts_.data()]) {
        place_[block] = col;
        col += H_.dim(block);
      }
      for (int row = front.begin; row < front.end; ++row) {
        for (int e = H_.first_entry(row); e >= 0; e = H_.entries()[e].next) {
          const BlockMatrix::Entry& entry = H_.entries()[e];
          AIRDOS_CHECK(entry.layer == front.group || &front == result_.poses_);
          const int panel =
              entry.layer == front.group ? front.offset : result_.share_offset(entry.layer);
          const int target = panel + (H_.begin(row) - front.first_scalar) * front.stride;
          by_layer[entry.layer].push_back({entry.offset, target + place_[entry.col], H_.dim(row),
                                           H_.dim(entry.col), front.stride});
        }
      }
    }
    for (const std::vector<PanelEntry>& entries : by_layer) {
      result_.entry_begins_.push_back(static_cast<int>(result_.entries_.size()));
      result_.entries_.insert(result_.entries_.end(), entries.begin(), entries.end());
    }
    result_.entry_begins_.push_back(static_cast<int>(result_.entries_.size()));
  }

  /// Columns in panel `target` of the blocks in `later`, from `first` on, that the panel holds
  /// itself.
  std::vector<int> PlacesIn(int target, const std::vector<int>& later, std::size_t first) const {
    const Front& front = result_.fronts_[target];
    std::vector<int> places(later.size(), kUnset);
    std::size_t i = first;
    for (; i < later.size() && later[i] < front.end; ++i) {
      places[i] = H_.begin(later[i]) - front.first_scalar;
    }
    int col = front.rows;
    for (const int block : later_[target]) {
      if (i == later.size()) break;
      if (block == later[i]) places[i++] = col;
      col += H_.dim(block);
    }
    AIRDOS_CHECK(i == later.size());  // otherwise the target lacks a coupling
    return places;
  }

  void FindUpdates(int f) {
    Front& front = result_.fronts_[f];
    const std::vector<int>& later = later_[f];
    std::vector<int> targets;
    std::vector<std::vector<int>> places;  // indexed by target
    std::vector<int> target_of(later.size());
    for (std::size_t i = 0; i < later.size(); ++i) {
      const int target = front_of_[later[i]];
      if (targets.empty() || targets.back() != target) {
        targets.push_back(target);
        places.push_back(PlacesIn(target, later, i));
      }
      target_of[i] = static_cast<int>(targets.size()) - 1;
    }
    front.runs_begin = front.runs_end = static_cast<int>(result_.runs_.size());
    std::vector<std::size_t> firsts;  // the first block of each run
    int col = front.rows;
    for (std::size_t i = 0; i < later.size(); ++i) {
      bool is_neighbour = i > 0 && target_of[i] == target_of[i - 1];
      for (int t = 0; is_neighbour && t <= target_of[i]; ++t) {
        is_neighbour = places[t][i] == places[t][i - 1] + H_.dim(later[i - 1]);
      }
      if (is_neighbour) {
        result_.runs_.back().size += H_.dim(later[i]);
      } else {
        const int scalar = H_.begin(later[i]);
        const bool is_pose = &result_.fronts_[targets[target_of[i]]] == result_.poses_;
        const int share = result_.share_begin(front.group) - H_.first_pose_scalar();
        result_.runs_.push_back({col, H_.dim(later[i]), scalar, is_pose ? share + scalar : scalar});
        firsts.push_back(i);
      }
      col += H_.dim(later[i]);
    }
    front.runs_end = static_cast<int>(result_.runs_.size());
    AddUpdates(firsts, targets, target_of, places, &front);
  }

  void AddUpdates(const std::vector<std::size_t>& firsts, const std::vector<int>& targets,
                  const std::vector<int>& target_of, const std::vector<std::vector<int>>& places,
                  Front* front) {
    front->updates_begin = static_cast<int>(result_.updates_.size());
    for (std::size_t a = 0; a < firsts.size(); ++a) {
      const Run& run_a = result_.runs_[front->runs_begin + a];
      const int t = target_of[firsts[a]];
      const Front& target = result_.fronts_[targets[t]];
      // Groups do not update each other; they update only the poses.
      AIRDOS_CHECK(&target == result_.poses_ || target.group == front->group);
      const int panel =
          &target == result_.poses_ ? result_.share_offset(front->group) : target.offset;
      const int row = panel + places[t][firsts[a]] * target.stride;
      for (std::size_t b = a; b < firsts.size(); ++b) {
        const Run& run_b = result_.runs_[front->runs_begin + b];
        result_.updates_.push_back(
            {run_a.col,
             run_b.col,
             row + places[t][firsts[b]],
             {front->rows, front->stride, run_a.size, run_b.size, target.stride, a == b}});
      }
    }
    front->updates_end = static_cast<int>(result_.updates_.size());
  }

  const BlockMatrix& H_;
  BlockElimination& result_;
  std::vector<int> front_of_;  // indexed by block
  std::vector<std::vector<int>> later_;
  std::vector<int> first_child_, next_child_;  // elimination tree
  std::vector<int> place_;
  int num_values_ = 0;
};

BlockElimination::BlockElimination(const BlockMatrix& H, const std::vector<int>& front_begins,
                                   const std::vector<int>& group_begins,
                                   std::vector<double>* memory)
    : num_scalars_(H.num_scalars()),
      num_pose_scalars_(H.num_pose_scalars()),
      group_begins_(group_begins),
      memory_(memory) {
  AIRDOS_CHECK(num_groups() == H.num_groups());
  const Analysis analysis(H, front_begins, this);
  if (memory_ != nullptr) panels_.swap(*memory_);
  panels_.resize(analysis.num_values());
  int largest = 0;
  for (const Front& front : fronts_) largest = std::max(largest, front.width);
  gathered_.resize(largest);
}

BlockElimination::~BlockElimination() {
  if (memory_ != nullptr) memory_->swap(panels_);
}

bool BlockElimination::Eliminate(const BlockMatrix& H, const Eigen::VectorXd& D, int group) {
  const int begin = group_begins_[group], end = group_begins_[group + 1];
  const auto clear = [this](int first, int size) {
    std::fill_n(panels_.begin() + first, size, 0.0);
  };
  clear(share_offset(group), share_size());
  if (begin == end) return true;
  const Front& last = fronts_[end - 1];
  clear(fronts_[begin].offset, last.offset + last.rows * last.stride - fronts_[begin].offset);
  AddEntries(H, group);
  for (int f = begin; f < end; ++f) {
    AddDiagonal(D, fronts_[f]);
  }
  for (int f = begin; f < end; ++f) {
    if (!FactoriseFront(fronts_[f])) return false;
  }
  return true;
}

bool BlockElimination::FactorisePoses(const BlockMatrix& H, const Eigen::VectorXd& D) {
  if (poses_ == nullptr) return true;
  const int size = share_size();
  ArrayMap sum(panels_.data() + poses_->offset, size);
  sum.setZero();
  for (int group = 0; group + 1 < num_groups(); ++group) {
    sum += ConstArrayMap(panels_.data() + share_offset(group), size);
  }
  AddEntries(H, num_groups() - 1);
  AddDiagonal(D, *poses_);
  return FactoriseFront(*poses_);
}

bool BlockElimination::Factorise(const BlockMatrix& H, const Eigen::VectorXd& D) {
  for (int group = 0; group + 1 < num_groups(); ++group) {
    if (!Eliminate(H, D, group)) return false;
  }
  return FactorisePoses(H, D);
}

void BlockElimination::AddEntries(const BlockMatrix& H, int layer) {
  for (int e = entry_begins_[layer]; e < entry_begins_[layer + 1]; ++e) {
    const PanelEntry& entry = entries_[e];
    const double* source = H.values() + entry.source;
    double* target = panels_.data() + entry.target;
    for (int row = 0; row < entry.rows; ++row) {
      for (int col = 0; col < entry.cols; ++col) target[col] += source[col];
      source += entry.cols;
      target += entry.stride;
    }
  }
}

void BlockElimination::AddDiagonal(const Eigen::VectorXd& D, const Front& front) {
  double* diagonal = panels_.data() + front.offset;
  for (int row = 0; row < front.rows; ++row) {
    *diagonal += D[front.first_scalar + row];
    diagonal += front.stride + 1;
  }
}

bool BlockElimination::FactoriseFront(const Front& front) {
  double* const panel = panels_.data() + front.offset;
  if (!FactorisePanel(panel, front.rows, front.width, front.stride)) return false;
  for (int u = front.updates_begin; u < front.updates_end; ++u) {
    const Update& update = updates_[u];
    SubtractProduct(panel + update.col_a, panel + update.col_b, update.shape,
                    panels_.data() + update.target);
  }
  return true;
}

void BlockElimination::Solve(Eigen::VectorXd* b) const {
  for (int group = 0; group + 1 < num_groups(); ++group) SolveForward(group, b);
  SolveBackward(b);
}

void BlockElimination::SolveForward(int group, Eigen::VectorXd* b) const {
  for (int f = group_begins_[group]; f < group_begins_[group + 1]; ++f) {
    SolveForward(fronts_[f], b->data());
  }
}

void BlockElimination::SolveBackward(Eigen::VectorXd* b) const {
  if (poses_ != nullptr) {
    for (int group = 0; group + 1 < num_groups(); ++group) {
      b->segment(poses_->first_scalar, poses_->rows) +=
          b->segment(share_begin(group), num_pose_scalars_);
    }
    SolveForward(*poses_, b->data());
  }
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) {
    SolveBackward(*front, b->data());
  }
}

void BlockElimination::MoveShare(int group, const Eigen::VectorXd& d, Eigen::VectorXd* b) const {
  if (poses_ == nullptr) return;
  const double* row = panels_.data() + share_offset(group);
  const double* const moved = d.data() + poses_->first_scalar;
  double* const share = b->data() + share_begin(group);
  for (int i = 0; i < poses_->rows; ++i) {
    const int num = poses_->rows - i - 1;
    const ConstArrayMap right(row + i + 1, num);
    share[i] -= row[i] * moved[i] + (right * ConstArrayMap(moved + i + 1, num)).sum();
    ArrayMap(share + i + 1, num) -= right * moved[i];
    row += poses_->stride;
  }
}

/// y = U^-T b, then subtracts W^T y from the later unknowns' part.
void BlockElimination::SolveForward(const Front& front, double* x) const {
  const double* const panel = panels_.data() + front.offset;
  const int num_later = front.width - front.rows;
  std::fill_n(gathered_.begin(), num_later, 0.0);
  ArrayMap later(gathered_.data(), num_later);
  for (int row = 0; row < front.rows; ++row) {
    const double* const values = panel + row * front.stride;
    double& y = x[front.first_scalar + row];
    y /= values[row];
    const int num = front.rows - row - 1;
    ArrayMap(x + front.first_scalar + row + 1, num) -= y * ConstArrayMap(values + row + 1, num);
    later += y * ConstArrayMap(values + front.rows, num_later);
  }
  for (int r = front.runs_begin; r < front.runs_end; ++r) {
    ArrayMap(x + runs_[r].target, runs_[r].size) -=
        later.segment(runs_[r].col - front.rows, runs_[r].size);
  }
}

/// x = U^-1 (y - W x_later).
void BlockElimination::SolveBackward(const Front& front, double* x) const {
  const double* const panel = panels_.data() + front.offset;
  const int num_later = front.width - front.rows;
  ArrayMap later(gathered_.data(), num_later);
  for (int r = front.runs_begin; r < front.runs_end; ++r) {
    later.segment(runs_[r].col - front.rows, runs_[r].size) =
        ArrayMap(x + runs_[r].scalar, runs_[r].size);
  }
  for (int row = front.rows - 1; row >= 0; --row) {
    const double* const values = panel + row * front.stride;
    const int num = front.rows - row - 1;
    double& value = x[front.first_scalar + row];
    value -= (later * ConstArrayMap(values + front.rows, num_later)).sum();
    value -=
        (ArrayMap(x + front.first_scalar + row + 1, num) * ConstArrayMap(values + row + 1, num))
            .sum();
    value /= values[row];
  }
}

Eigen::MatrixXd BlockElimination::InverseBlock(int begin, int size) const {
  const Front& front = fronts_.back();
  const int first = begin - front.first_scalar;
  AIRDOS_CHECK(first >= 0 && first + size <= front.rows);
  using Panel = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  const Eigen::Map<const Panel, 0, Eigen::OuterStride<>> U(
      panels_.data() + front.offset, front.rows, front.rows, Eigen::OuterStride<>(front.stride));
  Eigen::MatrixXd unit = Eigen::MatrixXd::Zero(front.rows, size);
  unit.middleRows(first, size).setIdentity();
  U.triangularView<Eigen::Upper>().transpose().solveInPlace(unit);
  return unit.transpose() * unit;
}

double BlockElimination::num_operations() const {
  double num = 0;
  for (const Front& front : fronts_) {
    const double later = front.width - front.rows;
    num += front.rows * (front.rows * (front.rows / 6.0 + later / 2) + later * later / 2);
  }
  return num;
}

}  // namespace airdos
