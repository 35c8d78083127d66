#ifndef AIRDOS_COMMON_FEATURES_FEATURE_GRID_H_
#define AIRDOS_COMMON_FEATURES_FEATURE_GRID_H_

#include <Eigen/Core>
#include <vector>

#include "common/features/feature.h"

namespace airdos {

/// Finds the features near a point of the image.
class FeatureGrid {
 public:
  FeatureGrid(const std::vector<Feature>& features, int width_px, int height_px);

  /// A range of pyramid levels, both ends included.
  struct Levels {
    int first = 0;
    int last = 0;
  };

  /// Calls `visit(index)` for each feature on the given levels within a square of half-width
  /// `radius_px`. The order depends only on the features.
  template <class Visit>
  void ForEachNear(const Eigen::Vector2d& uv_px, double radius_px, const Levels& levels,
                   Visit visit) const {
    const int column_begin = Clamp(uv_px.x() - radius_px, num_columns_);
    const int column_end = Clamp(uv_px.x() + radius_px, num_columns_);
    const int row_begin = Clamp(uv_px.y() - radius_px, num_rows_);
    const int row_end = Clamp(uv_px.y() + radius_px, num_rows_);
    for (int row = row_begin; row <= row_end; ++row) {
      for (int column = column_begin; column <= column_end; ++column) {
        for (const Entry& entry : cells_[static_cast<std::size_t>(row * num_columns_ + column)]) {
          if (entry.level < levels.first || entry.level > levels.last) continue;
          if ((entry.uv_px - uv_px).cwiseAbs().maxCoeff() <= radius_px) visit(entry.index);
        }
      }
    }
  }

 private:
  static constexpr double kCellSize_px = 16;
  static int Clamp(double coordinate_px, int count);

  /// What a search reads of a feature, contiguous in memory.
  struct Entry {
    Eigen::Vector2d uv_px;
    int index;
    int level;
  };

  int num_columns_;
  int num_rows_;
  std::vector<std::vector<Entry>> cells_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_FEATURE_GRID_H_
