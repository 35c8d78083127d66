#ifndef AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_VIEW_H_
#define AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_VIEW_H_

#include <memory>
#include <vector>

#include "common/features/visual_odometry.h"

namespace airdos {

/// What is computed once for a frame. Internal to VisualOdometry.
struct VisualOdometry::View {
  const StereoCamera& camera;
  const StereoImagePair& images;
  std::shared_ptr<const ImagePyramid> left;
  ImagePyramid right;
  std::vector<Feature> left_features;
  std::vector<Feature> right_features;
  std::unique_ptr<FeatureGrid> grid;
  std::unique_ptr<FeatureStereoMatcher> stereo;
  int num_masked = 0;

  View(const StereoCamera& camera_in, const StereoImagePair& images_in,
       const VisualOdometryOptions& options, const FeatureStereoMatcherOptions& stereo_options,
       const FeatureExtractor& extractor)
      : camera(camera_in),
        images(images_in),
        left(std::make_shared<ImagePyramid>(images_in.left, options.extractor.num_levels)),
        right(images_in.right, options.extractor.num_levels) {
    int num_masked_right = 0;
    left_features = extractor.Extract(*left, images.mask, &num_masked);
    right_features = extractor.Extract(right, cv::Mat(), &num_masked_right);
    grid = std::make_unique<FeatureGrid>(left_features, camera.width, camera.height);
    stereo = std::make_unique<FeatureStereoMatcher>(stereo_options, camera, *left, right,
                                                    right_features);
  }
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_VIEW_H_
