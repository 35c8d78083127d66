#ifndef AIRDOS_COMMON_FEATURES_FEATURE_EXTRACTOR_H_
#define AIRDOS_COMMON_FEATURES_FEATURE_EXTRACTOR_H_

#include <opencv2/core.hpp>
#include <opencv2/features2d.hpp>
#include <vector>

#include "common/features/feature.h"
#include "common/features/image_pyramid.h"

namespace airdos {

/// Settings of the FeatureExtractor.
struct FeatureExtractorOptions {
  int num_levels = 8;
  int fast_threshold = 8;  ///< grey levels; low, since crowds leave only faint texture
  int cell_size_px = 32;   ///< of the grid for spreading features, at each level
  int max_features_per_cell = 5;
};

/// Extracts FAST corners with ORB descriptors (Rublee et al. 2011), at most max_features_per_cell
/// per cell of each level so that they cover the whole image. Sorted by level, then cell
/// (row-major), then response, so the order is deterministic.
class FeatureExtractor {
 public:
  explicit FeatureExtractor(const FeatureExtractorOptions& options);

  /// `mask` is CV_8UC1 and has the size of the image, or is empty. Corners on non-zero pixels are
  /// left out and counted in `num_masked`.
  std::vector<Feature> Extract(const ImagePyramid& pyramid, const cv::Mat& mask,
                               int* num_masked) const;

  /// Of the pyramids that it is made for.
  int num_levels() const { return options_.num_levels; }

 private:
  std::vector<cv::KeyPoint> DetectLevel(const ImagePyramid& pyramid, int level, const cv::Mat& mask,
                                        int* num_masked) const;

  FeatureExtractorOptions options_;
  cv::Ptr<cv::ORB> orb_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_FEATURE_EXTRACTOR_H_
