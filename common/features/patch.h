#ifndef AIRDOS_COMMON_FEATURES_PATCH_H_
#define AIRDOS_COMMON_FEATURES_PATCH_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace airdos {

/// A square of grey values around a point, which can be found again in another image to a fraction
/// of a pixel: Lucas-Kanade in the inverse compositional form (Baker and Matthews 2004),
/// translation and brightness offset.
class Patch {
 public:
  static constexpr int kRadius = 5;
  static constexpr int kSize = 2 * kRadius + 1;

  /// Samples `image` (CV_8UC1) around `centre_px`, with `step_px` between samples. Nothing where
  /// the square, with one more sample all around, is not inside the image.
  static std::optional<Patch> Sample(const cv::Mat& image, const Eigen::Vector2d& centre_px,
                                     double step_px);

  struct Alignment {
    Eigen::Vector2d centre_px = Eigen::Vector2d::Zero();
    double correlation = 0;  ///< zero-mean normalised, -1..1
  };
  /// Finds the patch near `start_px` with one px between samples; `along_row` keeps the row.
  /// Nothing where it leaves the image, moves by more than `max_shift_px` or does not settle.
  std::optional<Alignment> Align(const cv::Mat& image, const Eigen::Vector2d& start_px,
                                 double max_shift_px, bool along_row) const;

 private:
  static constexpr int kNumSamples = kSize * kSize;
  static constexpr int kPaddedSize = kSize + 1;  // a multiple of four: rows of whole vectors
  /// Column by column of the array a row of the patch, the last element 0.
  using Samples = Eigen::Array<float, kPaddedSize, kSize>;

  Samples centred_;     // grey values less their mean
  Samples gradient_u_;  // per px of the image in which it will be searched
  Samples gradient_v_;
  Eigen::Matrix2d hessian_;  // of translation, brightness offset eliminated
  float deviation_ = 0;      // square root of the sum of squared differences from the mean
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_PATCH_H_
