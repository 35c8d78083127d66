#include "common/features/stereo_frame.h"

#include <algorithm>
#include <cmath>

#include "common/util/check.h"

namespace airdos {
namespace {

const StereoImagePair& Checked(const StereoCamera& camera, const StereoImagePair& images) {
  AIRDOS_CHECK(images.left.cols == camera.width && images.left.rows == camera.height);
  AIRDOS_CHECK(images.right.size() == images.left.size());
  return images;
}

/// Without a mask: there is none for the right image. What moves there finds no partner.
std::vector<Feature> ExtractAll(const FeatureExtractor& extractor, const ImagePyramid& pyramid) {
  int num_masked = 0;
  return extractor.Extract(pyramid, cv::Mat(), &num_masked);
}

}  // namespace

StereoFrame::StereoFrame(const StereoCamera& camera, const StereoImagePair& images,
                         const FeatureExtractor& extractor,
                         const FeatureStereoMatcherOptions& stereo)
    : camera_(camera),
      images_(Checked(camera, images)),
      left_(std::make_shared<ImagePyramid>(images.left, extractor.num_levels())),
      right_(images.right, extractor.num_levels()),
      left_features_(extractor.Extract(*left_, images.mask, &num_masked_)),
      right_features_(ExtractAll(extractor, right_)),
      grid_(left_features_, camera.width, camera.height),
      stereo_(stereo, camera, *left_, right_, right_features_) {}

bool StereoFrame::IsMasked(const Eigen::Vector2d& uv_px) const {
  const cv::Mat& mask = images_.mask;
  if (mask.empty()) return false;
  const int u = std::clamp(static_cast<int>(std::lround(uv_px.x())), 0, mask.cols - 1);
  const int v = std::clamp(static_cast<int>(std::lround(uv_px.y())), 0, mask.rows - 1);
  return mask.at<uchar>(v, u) != 0;
}

}  // namespace airdos
