#include "common/human/disparity_refiner.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace airdos {
namespace {

struct Patch {
  int u;  // centre
  int v;
  int half;
  double mean;
  double norm;  // square root of the sum of squared deviations from the mean
};

bool IsInside(const cv::Mat& image, int u, int v, int half) {
  return u - half >= 0 && v - half >= 0 && u + half < image.cols && v + half < image.rows;
}

Patch MakePatch(const cv::Mat& image, int u, int v, int half) {
  std::int64_t sum = 0;
  std::int64_t sum_squares = 0;
  for (int y = v - half; y <= v + half; ++y) {
    const unsigned char* row = image.ptr<unsigned char>(y) + (u - half);
    int row_sum = 0;  // 32 bits, so that the compiler can vectorise the sum
    int row_squares = 0;
    for (int x = 0; x <= 2 * half; ++x) {
      row_sum += row[x];
      row_squares += row[x] * row[x];
    }
    sum += row_sum;
    sum_squares += row_squares;
  }
  const double area = std::pow(2 * half + 1, 2);
  const double mean = static_cast<double>(sum) / area;
  const double variance = static_cast<double>(sum_squares) - area * mean * mean;
  return {u, v, half, mean, std::sqrt(std::max(variance, 0.0))};
}

double Correlation(const cv::Mat& a_image, const Patch& a, const cv::Mat& b_image, const Patch& b) {
  std::int64_t sum = 0;
  for (int y = -a.half; y <= a.half; ++y) {
    const unsigned char* a_row = a_image.ptr<unsigned char>(a.v + y) + (a.u - a.half);
    const unsigned char* b_row = b_image.ptr<unsigned char>(b.v + y) + (b.u - a.half);
    int row_sum = 0;
    for (int x = 0; x <= 2 * a.half; ++x) row_sum += a_row[x] * b_row[x];
    sum += row_sum;
  }
  const double area = std::pow(2 * a.half + 1, 2);
  const double norm = a.norm * b.norm;
  return norm > 0 ? (static_cast<double>(sum) - area * a.mean * b.mean) / norm : 0;
}

struct Peak {
  double offset_px;
  double correlation;
};

// The best match of the patch on its row in `to`, with the centre in columns `first` to `last`.
std::optional<Peak> BestOnRow(const cv::Mat& from, const Patch& patch, const cv::Mat& to, int first,
                              int last) {
  first = std::max(first, patch.half);
  last = std::min(last, to.cols - 1 - patch.half);
  if (last - first < 2) return std::nullopt;
  std::vector<double> correlation;
  for (int u = first; u <= last; ++u) {
    correlation.push_back(Correlation(from, patch, to, MakePatch(to, u, patch.v, patch.half)));
  }
  const auto best = std::max_element(correlation.begin(), correlation.end());
  if (best == correlation.begin() || best == correlation.end() - 1) return std::nullopt;
  const double curvature = *(best - 1) - 2 * *best + *(best + 1);
  const double fraction = curvature < 0 ? (*(best - 1) - *(best + 1)) / (2 * curvature) : 0;
  return Peak{first + static_cast<double>(best - correlation.begin()) + fraction, *best};
}

}  // namespace

std::optional<double> RefineDisparity(const DisparityRefinerOptions& options,
                                      const cv::Mat& left_gray, const cv::Mat& right_gray,
                                      const Eigen::Vector2d& uv_left_px, double expected_px,
                                      double search_px, double height_px) {
  if (left_gray.empty() || left_gray.size() != right_gray.size()) return std::nullopt;
  if (!uv_left_px.allFinite() || uv_left_px.cwiseAbs().maxCoeff() > 1e6) return std::nullopt;
  const int half = std::clamp(static_cast<int>(std::lround(options.patch_per_height * height_px)),
                              options.min_half_patch_px, options.max_half_patch_px);
  const int u = static_cast<int>(std::lround(uv_left_px.x()));
  const int v = static_cast<int>(std::lround(uv_left_px.y()));
  if (!IsInside(left_gray, u, v, half)) return std::nullopt;
  const Patch left = MakePatch(left_gray, u, v, half);
  if (left.norm < options.min_contrast * (2 * half + 1)) return std::nullopt;

  const int reach = static_cast<int>(std::ceil(search_px)) + 1;
  const int centre = static_cast<int>(std::lround(u - expected_px));
  const std::optional<Peak> there =
      BestOnRow(left_gray, left, right_gray, centre - reach, centre + reach);
  if (!there || there->correlation < options.min_correlation) return std::nullopt;
  const Patch right =
      MakePatch(right_gray, static_cast<int>(std::lround(there->offset_px)), v, half);
  const std::optional<Peak> back = BestOnRow(right_gray, right, left_gray, u - reach, u + reach);
  if (!back) return std::nullopt;
  const double there_px = u - there->offset_px;
  const double back_px = back->offset_px - right.u;
  if (std::abs(there_px - back_px) > options.max_return_error_px) return std::nullopt;
  if (std::abs(there_px - expected_px) > search_px) return std::nullopt;
  return (there_px + back_px) / 2;
}

}  // namespace airdos
