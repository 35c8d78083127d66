#ifndef AIRDOS_COMMON_HUMAN_APPEARANCE_H_
#define AIRDOS_COMMON_HUMAN_APPEARANCE_H_

#include <array>
#include <opencv2/core.hpp>
#include <optional>

#include "common/human/body_keypoints.h"

namespace airdos {

/// What a person wears: histograms of brightness and of two chromaticities ((r - g) and (r + g - 2
/// b), both divided by r + g + b, so that they do not depend on light and shade), on the torso and
/// on the thighs. A histogram that was not observed is all zeros.
struct Appearance {
  static constexpr int kNumBins = 10;
  static constexpr int kNumHistograms = 6;  ///< torso, then thighs: brightness and chromaticities
  std::array<std::array<float, kNumBins>, kNumHistograms> histograms{};

  /// Blends in a newer appearance with weight `rate`, 0 to 1. Histograms that only one side has
  /// observed are taken over unchanged.
  void Update(const Appearance& newer, double rate);
};

/// Reads the pixels (CV_8UC3 in BGR order, or CV_8UC1) on the torso and thighs of a person in the
/// left image. Nothing if no body region is in the image.
std::optional<Appearance> MeasureAppearance(const cv::Mat& image, const BodyKeypoints& person,
                                            double min_confidence);

/// Mean Bhattacharyya distance over the histograms that both have, from 0 (equal) to 1; nothing if
/// they share none.
std::optional<double> AppearanceDistance(const Appearance& a, const Appearance& b);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_APPEARANCE_H_
