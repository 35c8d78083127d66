#include "common/optimization/block_elimination.h"

#include <Eigen/Dense>
#include <algorithm>

#include "common/util/check.h"

namespace airdos {
namespace {

using ArrayMap = Eigen::Map<Eigen::ArrayXd>;
using ConstArrayMap = Eigen::Map<const Eigen::ArrayXd>;

constexpr int kUnset = -1;

}  // namespace

/// Works out panels and updates from the pattern.
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
    const int num_fronts = static_cast<int>(result_.fronts_.size());
    for (int f = 0; f < num_fronts; ++f) FindLaterBlocks(f);
    for (int f = 0; f < num_fronts; ++f) PlacePanel(f);
    for (int f = 0; f < num_fronts; ++f) PlaceEntries(f);
    for (int f = 0; f < num_fronts; ++f) FindUpdates(f);
  }

  int num_values() const { return num_values_; }

  /// No group but the last one takes updates from another.
  bool AreGroupsIndependent(const std::vector<int>& group_begins) const {
    const int last_group = group_begins[group_begins.size() - 2];
    for (std::size_t g = 0; g + 2 < group_begins.size(); ++g) {
      for (int f = group_begins[g]; f < group_begins[g + 1]; ++f) {
        for (const int block : later_[f]) {
          const int target = front_of_[block];
          if (target >= group_begins[g + 1] && target < last_group) return false;
        }
      }
    }
    return true;
  }

 private:
  /// Couplings of H, and those that earlier fronts leave behind.
  void FindLaterBlocks(int f) {
    const Front& front = result_.fronts_[f];
    std::vector<int>& later = later_[f];
    const auto add = [&](int block) {
      if (block < front.end || place_[block] == f) return;
      place_[block] = f;  // marks it
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

  void PlaceEntries(int f) {
    Front& front = result_.fronts_[f];
    for (int row = front.begin; row < front.end; ++row) {
      place_[row] = H_.begin(row) - front.first_scalar;
    }
    int col = front.rows;
    for (const int block : later_[f]) {
      place_[block] = col;
      col += H_.dim(block);
    }
    front.entries_begin = static_cast<int>(result_.entries_.size());
    for (int row = front.begin; row < front.end; ++row) {
      const int target = front.offset + (H_.begin(row) - front.first_scalar) * front.stride;
      for (int e = H_.first_entry(row); e >= 0; e = H_.entries()[e].next) {
        const BlockMatrix::Entry& entry = H_.entries()[e];
        result_.entries_.push_back({entry.offset, target + place_[entry.col], H_.dim(row),
                                    H_.dim(entry.col), front.stride});
      }
    }
    front.entries_end = static_cast<int>(result_.entries_.size());
  }

  /// Columns of panel `target` of the blocks of `later` from the first on that it holds itself.
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
    AIRDOS_CHECK(i == later.size());  // else the target misses a coupling
    return places;
  }

  void FindUpdates(int f) {
    Front& front = result_.fronts_[f];
    const std::vector<int>& later = later_[f];
    std::vector<int> targets;
    std::vector<std::vector<int>> places;  // by target
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
    std::vector<std::size_t> firsts;  // first block of each run
    int col = front.rows;
    for (std::size_t i = 0; i < later.size(); ++i) {
      bool is_neighbour = i > 0 && target_of[i] == target_of[i - 1];
      for (int t = 0; is_neighbour && t <= target_of[i]; ++t) {
        is_neighbour = places[t][i] == places[t][i - 1] + H_.dim(later[i - 1]);
      }
      if (is_neighbour) {
        result_.runs_.back().size += H_.dim(later[i]);
      } else {
        result_.runs_.push_back({col, H_.dim(later[i]), H_.begin(later[i])});
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
      const int row = target.offset + places[t][firsts[a]] * target.stride;
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
  std::vector<int> front_of_;  // by block
  std::vector<std::vector<int>> later_;
  std::vector<int> first_child_, next_child_;  // fronts whose first later block is in this one
  std::vector<int> place_;
  int num_values_ = 0;
};

BlockElimination::BlockElimination(const BlockMatrix& H, const std::vector<int>& front_begins,
                                   const std::vector<int>& group_begins)
    : group_begins_(group_begins) {
  AIRDOS_CHECK(!front_begins.empty() && !group_begins.empty());
  const Analysis analysis(H, front_begins, this);
  if (!analysis.AreGroupsIndependent(group_begins_)) {  // not in any graph that we make
    group_begins_ = {0, group_begins_[group_begins_.size() - 2], group_begins_.back()};
  }
  panels_.resize(analysis.num_values());
  int largest = 0;
  for (const Front& front : fronts_) largest = std::max(largest, front.width);
  gathered_.resize(largest);
}

bool BlockElimination::Factorise(const BlockMatrix& H, const Eigen::VectorXd& D) {
  if (fronts_.empty()) return true;
  // The last group takes updates from all others.
  for (int group = static_cast<int>(group_begins_.size()) - 2, pass = 0; pass < 2; ++pass) {
    const int first = pass == 0 ? group : 0;
    const int last = pass == 0 ? group + 1 : group;
    for (int g = first; g < last; ++g) {
      const int begin = group_begins_[g], end = group_begins_[g + 1];
      if (begin == end) continue;
      AssembleFronts(H, D, begin, end);
      if (pass == 0) continue;
      for (int f = begin; f < end; ++f) {
        if (!FactoriseFront(fronts_[f])) return false;
      }
    }
  }
  for (int f = group_begins_[group_begins_.size() - 2]; f < group_begins_.back(); ++f) {
    if (!FactoriseFront(fronts_[f])) return false;
  }
  return true;
}

void BlockElimination::AssembleFronts(const BlockMatrix& H, const Eigen::VectorXd& D, int begin,
                                      int end) {
  const int last = end == static_cast<int>(fronts_.size()) ? static_cast<int>(panels_.size())
                                                           : fronts_[end].offset;
  std::fill(panels_.begin() + fronts_[begin].offset, panels_.begin() + last, 0.0);
  const double* const values = H.values();
  for (int e = fronts_[begin].entries_begin; e < fronts_[end - 1].entries_end; ++e) {
    const PanelEntry& entry = entries_[e];
    const double* source = values + entry.source;
    double* target = panels_.data() + entry.target;
    for (int row = 0; row < entry.rows; ++row) {
      for (int col = 0; col < entry.cols; ++col) target[col] = source[col];
      source += entry.cols;
      target += entry.stride;
    }
  }
  for (int f = begin; f < end; ++f) {
    const Front& front = fronts_[f];
    double* diagonal = panels_.data() + front.offset;
    for (int row = 0; row < front.rows; ++row) {
      *diagonal += D[front.first_scalar + row];
      diagonal += front.stride + 1;
    }
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
  double* const x = b->data();
  for (const Front& front : fronts_) SolveForward(front, x);
  for (auto front = fronts_.rbegin(); front != fronts_.rend(); ++front) SolveBackward(*front, x);
}

/// y = U^-T b, and what comes later -= W^T y.
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
    ArrayMap(x + runs_[r].scalar, runs_[r].size) -=
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
