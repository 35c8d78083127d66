#ifndef AIRDOS_COMMON_FEATURES_PATCH_H_
#define AIRDOS_COMMON_FEATURES_PATCH_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace airdos {

/// A square of grey values around a point, to be found in another image with subpixel accuracy:
/// Lucas-Kanade in its inverse compositional form (Baker and Matthews 2004), with translation and
/// brightness offset.
class Patch {
 public:
  static constexpr int kRadius = 5;
  static constexpr int kSize = 2 * kRadius + 1;

  /// Samples `image` (CV_8UC1) around `centre_px`, with `step_px` between samples. Nothing if the
  /// square plus a border of one sample is not inside the image.
  static std::optional<Patch> Sample(const cv::Mat& image, const Eigen::Vector2d& centre_px,
                                     double step_px);

  /// Where a patch was found.
  struct Alignment {
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
    double correlation = 0;  ///< zero-mean normalised, -1..1
  };
  /// Finds the patch near `start_px`, with one px between samples; `along_row` keeps the row fixed.
  /// Nothing if it leaves the image, moves by more than `max_shift_px` or does not converge.
  std::optional<Alignment> Align(const cv::Mat& image, const Eigen::Vector2d& start_px,
                                 double max_shift_px, bool along_row) const;

 private:
  static constexpr int kNumSamples = kSize * kSize;
  static constexpr int kPaddedSize = kSize + 1;  // a multiple of four: rows of whole vectors
  /// One row of the patch per column of the array; the last element is 0.
  using Samples = Eigen::Array<float, kPaddedSize, kSize>;

  Samples centred_;     // grey values minus their mean
  Samples gradient_u_;  // per px of the image to search
  Samples gradient_v_;
  Eigen::Matrix2d hessian_;  // of the translation, with the brightness offset eliminated
  float deviation_ = 0;      // square root of the sum of squared differences from the mean
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_PATCH_H_
