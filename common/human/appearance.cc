#include "common/human/appearance.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace airdos {
namespace {

constexpr int kNumColumns = 8;  // sample grid over the torso: columns and rows
constexpr int kNumRows = 12;
constexpr int kNumThighSamples = 16;
constexpr int kNumChannels = 3;
// The chromaticities of clothes stay within these bounds; the first channel is brightness, 0..255.
constexpr std::array<double, kNumChannels> kChannelMin = {0, -0.35, -0.7};
constexpr std::array<double, kNumChannels> kChannelMax = {255, 0.35, 0.7};

// Splits one sample between its two nearest bins, so that noise changes a histogram smoothly.
void AddToHistogram(double value, int channel, std::array<float, Appearance::kNumBins>* histogram) {
  const std::size_t c = static_cast<std::size_t>(channel);
  const double unit =
      std::clamp((value - kChannelMin[c]) / (kChannelMax[c] - kChannelMin[c]), 0.0, 1.0);
  const double place = unit * (Appearance::kNumBins - 1);
  const std::size_t bin =
      static_cast<std::size_t>(std::min(static_cast<int>(place), Appearance::kNumBins - 2));
  const double share = place - static_cast<double>(bin);
  (*histogram)[bin] += static_cast<float>(1 - share);
  (*histogram)[bin + 1] += static_cast<float>(share);
}

// Adds a pixel to the three histograms starting at `first`; false outside the image.
bool AddPixel(const cv::Mat& image, const Eigen::Vector2d& uv_px, std::size_t first,
              Appearance* appearance) {
  if (!(uv_px.x() >= 0 && uv_px.y() >= 0 && uv_px.x() < image.cols && uv_px.y() < image.rows)) {
    return false;
  }
  const int u = static_cast<int>(uv_px.x());
  const int v = static_cast<int>(uv_px.y());
  std::array<double, 3> bgr;
  if (image.channels() == 3) {
    const cv::Vec3b& pixel = image.at<cv::Vec3b>(v, u);
    bgr = {static_cast<double>(pixel[0]), static_cast<double>(pixel[1]),
           static_cast<double>(pixel[2])};
  } else {
    bgr.fill(image.at<unsigned char>(v, u));
  }
  // The constant keeps the chromaticity of black, which is pure noise, near zero.
  const double sum = bgr[0] + bgr[1] + bgr[2] + 30;
  AddToHistogram((bgr[0] + bgr[1] + bgr[2]) / 3, 0, &appearance->histograms[first]);
  AddToHistogram((bgr[2] - bgr[1]) / sum, 1, &appearance->histograms[first + 1]);
  AddToHistogram((bgr[2] + bgr[1] - 2 * bgr[0]) / sum, 2, &appearance->histograms[first + 2]);
  return true;
}

bool Normalise(std::size_t first, int num_samples, Appearance* appearance) {
  // A region of which only a corner is in the image is not informative.
  const bool is_seen = num_samples >= kNumThighSamples / 2;
  for (std::size_t h = first; h < first + kNumChannels; ++h) {
    for (float& bin : appearance->histograms[h]) {
      bin = is_seen ? bin / static_cast<float>(num_samples) : 0.0F;
    }
  }
  return is_seen;
}

bool IsSeen(const std::array<float, Appearance::kNumBins>& histogram) {
  return std::any_of(histogram.begin(), histogram.end(), [](float bin) { return bin > 0; });
}

}  // namespace

void Appearance::Update(const Appearance& newer, double rate) {
  for (std::size_t h = 0; h < histograms.size(); ++h) {
    if (!IsSeen(newer.histograms[h])) continue;
    const float weight = IsSeen(histograms[h]) ? static_cast<float>(rate) : 1.0F;
    for (std::size_t bin = 0; bin < histograms[h].size(); ++bin) {
      histograms[h][bin] += weight * (newer.histograms[h][bin] - histograms[h][bin]);
    }
  }
}

std::optional<Appearance> MeasureAppearance(const cv::Mat& image, const BodyKeypoints& person,
                                            double min_confidence) {
  if (image.empty()) return std::nullopt;
  const auto has = [&](int joint) {
    return person[static_cast<std::size_t>(joint)].confidence >= min_confidence;
  };
  const auto at = [&](int joint) { return person[static_cast<std::size_t>(joint)].uv_px(); };
  Appearance appearance;
  int num_torso = 0;
  if (has(kRightShoulder) && has(kLeftShoulder) && has(kRightHip) && has(kLeftHip)) {
    for (int row = 0; row < kNumRows; ++row) {
      const double down = (row + 0.5) / kNumRows;
      const Eigen::Vector2d right =
          at(kRightShoulder) + down * (at(kRightHip) - at(kRightShoulder));
      const Eigen::Vector2d left = at(kLeftShoulder) + down * (at(kLeftHip) - at(kLeftShoulder));
      for (int column = 0; column < kNumColumns; ++column) {
        const double across = (column + 0.5) / kNumColumns;
        num_torso += AddPixel(image, right + across * (left - right), 0, &appearance) ? 1 : 0;
      }
    }
  }
  int num_thigh = 0;
  for (const auto& [hip, knee] : {std::pair{kRightHip, kRightKnee}, {kLeftHip, kLeftKnee}}) {
    if (!has(hip) || !has(knee)) continue;
    for (int sample = 0; sample < kNumThighSamples; ++sample) {
      const double down = (sample + 0.5) / kNumThighSamples;
      const Eigen::Vector2d uv_px = at(hip) + down * (at(knee) - at(hip));
      num_thigh += AddPixel(image, uv_px, kNumChannels, &appearance) ? 1 : 0;
    }
  }
  const bool has_torso = Normalise(0, num_torso, &appearance);
  const bool has_thighs = Normalise(kNumChannels, num_thigh, &appearance);
  if (!has_torso && !has_thighs) return std::nullopt;
  return appearance;
}

std::optional<double> AppearanceDistance(const Appearance& a, const Appearance& b) {
  double sum = 0;
  int num = 0;
  for (std::size_t h = 0; h < a.histograms.size(); ++h) {
    if (!IsSeen(a.histograms[h]) || !IsSeen(b.histograms[h])) continue;
    double overlap = 0;
    for (std::size_t bin = 0; bin < a.histograms[h].size(); ++bin) {
      overlap += std::sqrt(static_cast<double>(a.histograms[h][bin]) *
                           static_cast<double>(b.histograms[h][bin]));
    }
    sum += std::sqrt(std::max(0.0, 1 - overlap));
    ++num;
  }
  if (num == 0) return std::nullopt;
  return sum / num;
}

}  // namespace airdos
