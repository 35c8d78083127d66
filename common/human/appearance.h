#ifndef AIRDOS_COMMON_HUMAN_APPEARANCE_H_
#define AIRDOS_COMMON_HUMAN_APPEARANCE_H_

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "common/human/body_keypoints.h"

namespace airdos {

/// What somebody wears: one histogram each of brightness and two chromaticities (r - g and r + g -
/// 2 b over r + g + b, which light and shade leave alone), on the torso and on the thighs. A
/// histogram that was not seen is all zero.
struct Appearance {
  static constexpr int kNumBins = 10;
  static constexpr int kNumHistograms = 6;  ///< torso, then thighs: brightness and chromaticities
  std::array<std::array<float, kNumBins>, kNumHistograms> histograms{};

  /// Moves towards a newer one by `rate`, 0 to 1; histograms only one side has seen are taken
  /// whole.
  void Update(const Appearance& newer, double rate);
};

/// Reads the pixels (CV_8UC3, blue first, or CV_8UC1) within the torso and on the thighs of a
/// person in the left image. Nothing where no body region lies in the image.
std::optional<Appearance> MeasureAppearance(const cv::Mat& image, const BodyKeypoints& person,
                                            double min_confidence);

/// Mean Bhattacharyya distance over the histograms that both have, 0 (equal) to 1; nothing where
/// they share none.
std::optional<double> AppearanceDistance(const Appearance& a, const Appearance& b);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_APPEARANCE_H_
