#ifndef AIRDOS_COMMON_FEATURES_CELL_COUNTER_H_
#define AIRDOS_COMMON_FEATURES_CELL_COUNTER_H_

#include <Eigen/Core>
#include <map>
#include <utility>

namespace airdos {

/// Counts points per square cell of the image.
class CellCounter {
 public:
  explicit CellCounter(int cell_size_px) : cell_size_px_(cell_size_px) {}
  bool IsFull(const Eigen::Vector2d& uv_px, int limit) const {
    const auto it = counts_.find(CellOf(uv_px));
    return it != counts_.end() && it->second >= limit;
  }
  /// Counts a point; false, without counting it, if its cell is full.
  bool Take(const Eigen::Vector2d& uv_px, int limit) {
    int& count = counts_[CellOf(uv_px)];
    return count < limit && ++count > 0;
  }

 private:
  std::pair<int, int> CellOf(const Eigen::Vector2d& uv_px) const {
    return {static_cast<int>(uv_px.x()) / cell_size_px_,
            static_cast<int>(uv_px.y()) / cell_size_px_};
  }
  int cell_size_px_;
  std::map<std::pair<int, int>, int> counts_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_CELL_COUNTER_H_
