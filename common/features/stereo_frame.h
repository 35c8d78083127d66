#ifndef AIRDOS_COMMON_FEATURES_STEREO_FRAME_H_
#define AIRDOS_COMMON_FEATURES_STEREO_FRAME_H_

#include <Eigen/Core>
#include <memory>
#include <opencv2/core.hpp>
#include <vector>

#include "common/features/feature.h"
#include "common/features/feature_extractor.h"
#include "common/features/feature_grid.h"
#include "common/features/feature_stereo_matcher.h"
#include "common/features/image_pyramid.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/people_filter.h"
#include "common/util/ids.h"

namespace airdos {

/// The images of one frame, rectified: CV_8UC1 of the camera's size.
struct StereoImagePair {
  FrameId id;
  double time_s = 0;  ///< capture time
  cv::Mat left;
  cv::Mat right;
  cv::Mat mask;  ///< of the left image, not 0 = no static feature may come from here; or empty
  std::vector<PersonMeasurement> people;  ///< in view; empty where people are not to be used
};

/// One frame as the odometry looks at it, computed once: both images at several scales, the corners
/// of the static scene in the left one and all corners of the right one, in px of level 0, and what
/// finds them. Camera and images must outlive it.
class StereoFrame {
 public:
  /// Images of another size than the camera's are a programmer's error.
  StereoFrame(const StereoCamera& camera, const StereoImagePair& images,
              const FeatureExtractor& extractor, const FeatureStereoMatcherOptions& stereo);
  // The matcher refers to the members beside it.
  StereoFrame(const StereoFrame&) = delete;
  StereoFrame& operator=(const StereoFrame&) = delete;

  FrameId id() const { return images_.id; }
  const StereoCamera& camera() const { return camera_; }
  /// Shared: landmarks keep the image in which they were seen first.
  const std::shared_ptr<const ImagePyramid>& left() const { return left_; }
  const std::vector<Feature>& left_features() const { return left_features_; }
  const FeatureGrid& grid() const { return grid_; }  ///< of left_features()
  const FeatureStereoMatcher& stereo() const { return stereo_; }
  /// Corners that were left out because they lie on people.
  int num_masked() const { return num_masked_; }
  /// Whether the pixel of the left image, or the one at the border next to it, lies on people.
  bool IsMasked(const Eigen::Vector2d& uv_px) const;

 private:
  const StereoCamera& camera_;
  const StereoImagePair& images_;
  std::shared_ptr<const ImagePyramid> left_;
  ImagePyramid right_;
  int num_masked_ = 0;
  std::vector<Feature> left_features_;
  std::vector<Feature> right_features_;
  FeatureGrid grid_;
  FeatureStereoMatcher stereo_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_STEREO_FRAME_H_
