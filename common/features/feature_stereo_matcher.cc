#include "common/features/feature_stereo_matcher.h"

#include <algorithm>
#include <cmath>

#include "common/features/patch.h"

namespace airdos {

FeatureStereoMatcher::FeatureStereoMatcher(const FeatureStereoMatcherOptions& options,
                                           const StereoCamera& camera, const ImagePyramid& left,
                                           const ImagePyramid& right,
                                           const std::vector<Feature>& right_features)
    : options_(options),
      left_(left),
      right_(right),
      right_features_(right_features),
      max_disparity_px_(camera.fx_px * camera.baseline_m / options.min_depth_m),
      rows_(static_cast<std::size_t>(right.level(0).rows)) {
  for (std::size_t i = 0; i < right_features.size(); ++i) {
    const int row = std::clamp(static_cast<int>(std::lround(right_features[i].uv_px.y())), 0,
                               static_cast<int>(rows_.size()) - 1);
    rows_[static_cast<std::size_t>(row)].push_back(static_cast<int>(i));
  }
}

std::optional<double> FeatureStereoMatcher::Match(const Feature& left) const {
  const double row_error_px = options_.max_row_error_px * left_.scale(left.level);
  const int row_begin = std::max(0, static_cast<int>(std::ceil(left.uv_px.y() - row_error_px)));
  const int row_end =
      std::min(static_cast<int>(rows_.size()) - 1, static_cast<int>(left.uv_px.y() + row_error_px));
  int best_distance = options_.max_hamming_bits + 1;
  const Feature* best = nullptr;
  for (int row = row_begin; row <= row_end; ++row) {
    for (const int index : rows_[static_cast<std::size_t>(row)]) {
      const Feature& right = right_features_[static_cast<std::size_t>(index)];
      const double disparity_px = left.uv_px.x() - right.uv_px.x();
      // A far point's disparity may come out negative by the grid of the levels before it is
      // refined.
      if (disparity_px < -left_.scale(left.level) || disparity_px > max_disparity_px_) continue;
      if (std::abs(right.level - left.level) > 1) continue;
      const int distance = HammingDistance(left.descriptor, right.descriptor);
      if (distance < best_distance) {
        best_distance = distance;
        best = &right;
      }
    }
  }
  if (best == nullptr) return std::nullopt;
  constexpr double kMaxShift_px = 2.5;
  return Refine(left.uv_px, left.level, best->uv_px.x(), kMaxShift_px);
}

std::optional<double> FeatureStereoMatcher::Refine(const Eigen::Vector2d& uv_left_px, int level,
                                                   double u_right_guess_px,
                                                   double max_shift_px) const {
  const Eigen::Vector2d uv_level(left_.ToLevel(uv_left_px.x(), level),
                                 left_.ToLevel(uv_left_px.y(), level));
  const std::optional<Patch> patch = Patch::Sample(left_.level(level), uv_level, 1.0);
  if (!patch) return std::nullopt;
  const Eigen::Vector2d start(right_.ToLevel(u_right_guess_px, level), uv_level.y());
  const auto alignment = patch->Align(right_.level(level), start, max_shift_px, /*along_row=*/true);
  if (!alignment || alignment->correlation < options_.min_correlation) return std::nullopt;
  const double u_right_px = right_.FromLevel(alignment->centre_px.x(), level);
  const double disparity_px = uv_left_px.x() - u_right_px;
  if (disparity_px < options_.min_disparity_px || disparity_px > max_disparity_px_)
    return std::nullopt;
  return u_right_px;
}

}  // namespace airdos
