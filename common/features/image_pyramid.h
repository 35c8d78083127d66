#ifndef AIRDOS_COMMON_FEATURES_IMAGE_PYRAMID_H_
#define AIRDOS_COMMON_FEATURES_IMAGE_PYRAMID_H_

#include <opencv2/core.hpp>
#include <vector>

namespace airdos {

/// A grey image at several scales. Level 0 is the image; each further level is smaller by
/// kScaleFactor. Pixel coordinates refer to pixel centres on every level, so a point at (u, v) of
/// level 0 lies at ((u + 0.5) / scale - 0.5, …).
class ImagePyramid {
 public:
  static constexpr double kScaleFactor = 1.2;

  ImagePyramid() = default;
  /// `image` must be CV_8UC1 and is shared, not copied. Levels narrower than 64 px are left out.
  ImagePyramid(const cv::Mat& image, int num_levels);

  int num_levels() const { return static_cast<int>(levels_.size()); }
  const cv::Mat& level(int index) const { return levels_[static_cast<std::size_t>(index)]; }
  /// Size of one pixel of this level in px of level 0.
  double scale(int index) const { return scales_[static_cast<std::size_t>(index)]; }

  double ToLevel(double coordinate_px, int index) const {
    return (coordinate_px + 0.5) / scale(index) - 0.5;
  }
  double FromLevel(double coordinate_px, int index) const {
    return (coordinate_px + 0.5) * scale(index) - 0.5;
  }

 private:
  std::vector<cv::Mat> levels_;
  std::vector<double> scales_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_IMAGE_PYRAMID_H_
