#include "common/features/feature_grid.h"

#include <algorithm>

namespace airdos {

FeatureGrid::FeatureGrid(const std::vector<Feature>& features, int width_px, int height_px)
    : num_columns_(static_cast<int>(width_px / kCellSize_px) + 1),
      num_rows_(static_cast<int>(height_px / kCellSize_px) + 1),
      cells_(static_cast<std::size_t>(num_columns_ * num_rows_)) {
  for (std::size_t i = 0; i < features.size(); ++i) {
    const int column = Clamp(features[i].uv_px.x(), num_columns_);
    const int row = Clamp(features[i].uv_px.y(), num_rows_);
    cells_[static_cast<std::size_t>(row * num_columns_ + column)].push_back(
        {features[i].uv_px, static_cast<int>(i), features[i].level});
  }
}

int FeatureGrid::Clamp(double coordinate_px, int count) {
  return static_cast<int>(std::clamp(coordinate_px / kCellSize_px, 0.0, count - 1.0));
}

}  // namespace airdos
