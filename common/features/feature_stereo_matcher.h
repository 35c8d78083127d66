#ifndef AIRDOS_COMMON_FEATURES_FEATURE_STEREO_MATCHER_H_
#define AIRDOS_COMMON_FEATURES_FEATURE_STEREO_MATCHER_H_

#include <optional>
#include <vector>

#include "common/features/feature.h"
#include "common/features/image_pyramid.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// What a match of a feature in left and right image must fulfil.
struct FeatureStereoMatcherOptions {
  double min_depth_m = 0.5;       ///< nothing nearer is matched
  double min_disparity_px = 0.7;  ///< with less, the depth says nothing
  int max_hamming_bits = 75;
  double max_row_error_px = 1.5;  ///< of a rectified pair, at the feature's level
  double min_correlation = 0.92;  ///< of the aligned patch
};

/// Where the features of the left image are in the right image of a rectified pair.
class FeatureStereoMatcher {
 public:
  FeatureStereoMatcher(const FeatureStereoMatcherOptions& options, const StereoCamera& camera,
                       const ImagePyramid& left, const ImagePyramid& right,
                       const std::vector<Feature>& right_features);

  /// By descriptor along the row, then to a fraction of a pixel: u_right in px of level 0.
  std::optional<double> Match(const Feature& left) const;
  /// To a fraction of a pixel from a guess that is off by at most `max_shift_px` of the level.
  std::optional<double> Refine(const Eigen::Vector2d& uv_left_px, int level,
                               double u_right_guess_px, double max_shift_px) const;

 private:
  const FeatureStereoMatcherOptions options_;
  const ImagePyramid& left_;
  const ImagePyramid& right_;
  const std::vector<Feature>& right_features_;
  double max_disparity_px_;
  std::vector<std::vector<int>> rows_;  // right features by row of level 0
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_FEATURE_STEREO_MATCHER_H_
