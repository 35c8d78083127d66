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
  std::vector<HumanMeasurement> people;  ///< in view; empty where people are not to be used
};

/// What the odometry needs of one frame, computed once: the pyramids of both images, their features
/// (in the left image only those off people), and the structures for matching them. Coordinates are
/// in px of level 0. Camera and images must outlive it.
class StereoFrame {
 public:
  /// The images must have the size of the camera (checked).
  StereoFrame(const StereoCamera& camera, const StereoImagePair& images,
              const FeatureExtractor& extractor, const FeatureStereoMatcherOptions& stereo);
  // The matcher refers to other members.
  StereoFrame(const StereoFrame&) = delete;
  StereoFrame& operator=(const StereoFrame&) = delete;

  FrameId id() const { return images_.id; }
  const StereoCamera& camera() const { return camera_; }
  /// Shared, because landmarks keep the image in which they were first seen.
  const std::shared_ptr<const ImagePyramid>& left() const { return left_; }
  const std::vector<Feature>& left_features() const { return left_features_; }
  const FeatureGrid& grid() const { return grid_; }  ///< of left_features()
  const FeatureStereoMatcher& stereo() const { return stereo_; }
  /// Number of corners left out because they lie on people.
  int num_masked() const { return num_masked_; }
  /// Whether this pixel of the left image lies on people. Outside the image, the nearest pixel
  /// counts.
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
