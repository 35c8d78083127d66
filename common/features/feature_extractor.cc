#include "common/features/feature_extractor.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <opencv2/imgproc.hpp>

namespace airdos {
namespace {

constexpr int kBorder_px = 20;  // on each level; for the rotated ORB pattern and its smoothing
constexpr int kOrientationRadius_px = 15;
constexpr int kOrientationWidth = 2 * (kOrientationRadius_px + 1);  // px; one whole vector register

/// For each row of the disc of radius kOrientationRadius_px: 1 inside, 0 outside.
using DiscRows = std::array<std::array<std::int16_t, kOrientationWidth>, kOrientationRadius_px + 1>;

DiscRows MakeDiscRows() {
  DiscRows rows{};
  for (int y = 0; y <= kOrientationRadius_px; ++y) {
    const int half_width = static_cast<int>(
        std::sqrt(static_cast<double>(kOrientationRadius_px * kOrientationRadius_px - y * y)));
    for (int x = -half_width; x <= half_width; ++x)
      rows[static_cast<std::size_t>(y)][static_cast<std::size_t>(x + kOrientationRadius_px)] = 1;
  }
  return rows;
}

/// Direction of the intensity centroid of the disc around (x, y), in degrees. Sums by column, which
/// the compiler vectorises; every sum fits into 16 bits.
float IntensityCentroidAngle_deg(const cv::Mat& image, int x, int y) {
  static const DiscRows kDiscRows = MakeDiscRows();
  std::array<std::int16_t, kOrientationWidth> sums{};     // of each column's grey values
  std::array<std::int16_t, kOrientationWidth> moments{};  // the same, weighted by row
  for (int dy = 0; dy <= kOrientationRadius_px; ++dy) {
    const uchar* above = image.ptr<uchar>(y - dy) + x - kOrientationRadius_px;
    const uchar* below = image.ptr<uchar>(y + dy) + x - kOrientationRadius_px;
    const std::int16_t* inside = kDiscRows[static_cast<std::size_t>(dy)].data();
    const auto weight = static_cast<std::int16_t>(dy);
    const auto both = static_cast<std::int16_t>(dy > 0 ? -1 : 0);  // row 0 is a single row
    for (std::size_t i = 0; i < kOrientationWidth; ++i) {
      const auto upper = static_cast<std::int16_t>(above[i] & both);
      const auto lower = static_cast<std::int16_t>(below[i]);
      sums[i] = static_cast<std::int16_t>(sums[i] + inside[i] * (lower + upper));
      moments[i] = static_cast<std::int16_t>(moments[i] + inside[i] * weight * (lower - upper));
    }
  }
  int moment_x = 0;
  int moment_y = 0;
  for (int i = 0; i < kOrientationWidth; ++i) {
    moment_x += (i - kOrientationRadius_px) * sums[static_cast<std::size_t>(i)];
    moment_y += moments[static_cast<std::size_t>(i)];
  }
  return cv::fastAtan2(static_cast<float>(moment_y), static_cast<float>(moment_x));
}

bool IsStronger(const cv::KeyPoint& a, const cv::KeyPoint& b) {
  if (a.response != b.response) return a.response > b.response;
  if (a.pt.y != b.pt.y) return a.pt.y < b.pt.y;
  return a.pt.x < b.pt.x;
}

bool IsMasked(const ImagePyramid& pyramid, int level, const cv::Mat& mask,
              const cv::KeyPoint& corner) {
  if (mask.empty()) return false;
  const int u = std::min(cvRound(pyramid.FromLevel(corner.pt.x, level)), mask.cols - 1);
  const int v = std::min(cvRound(pyramid.FromLevel(corner.pt.y, level)), mask.rows - 1);
  return mask.at<uchar>(v, u) != 0;
}

/// The strongest corners of each cell, strongest first, in one contiguous array.
class CellSelection {
 public:
  CellSelection(int num_cells, int max_per_cell)
      : max_per_cell_(static_cast<std::size_t>(max_per_cell)),
        counts_(static_cast<std::size_t>(num_cells)),
        corners_(counts_.size() * max_per_cell_) {}

  void Add(int cell, const cv::KeyPoint& corner) {
    std::size_t& count = counts_[static_cast<std::size_t>(cell)];
    cv::KeyPoint* const first = &corners_[static_cast<std::size_t>(cell) * max_per_cell_];
    if (count == max_per_cell_) {
      if (!IsStronger(corner, first[count - 1])) return;
      --count;
    }
    cv::KeyPoint* place = first + count;
    for (; place != first && IsStronger(corner, place[-1]); --place) *place = place[-1];
    *place = corner;
    ++count;
  }

  /// All selected corners, cell by cell.
  std::vector<cv::KeyPoint> All() const {
    std::vector<cv::KeyPoint> all;
    for (std::size_t cell = 0; cell < counts_.size(); ++cell) {
      const cv::KeyPoint* const first = &corners_[cell * max_per_cell_];
      all.insert(all.end(), first, first + counts_[cell]);
    }
    return all;
  }

 private:
  std::size_t max_per_cell_;
  std::vector<std::size_t> counts_;
  std::vector<cv::KeyPoint> corners_;
};

}  // namespace

FeatureExtractor::FeatureExtractor(const FeatureExtractorOptions& options)
    : options_(options),
      orb_(cv::ORB::create(1, static_cast<float>(ImagePyramid::kScaleFactor), /*nlevels=*/1,
                           kBorder_px)) {}

std::vector<cv::KeyPoint> FeatureExtractor::DetectLevel(const ImagePyramid& pyramid, int level,
                                                        const cv::Mat& mask,
                                                        int* num_masked) const {
  const cv::Mat& image = pyramid.level(level);
  const cv::Rect inner(kBorder_px, kBorder_px, image.cols - 2 * kBorder_px,
                       image.rows - 2 * kBorder_px);
  if (inner.width <= 0 || inner.height <= 0) return {};
  std::vector<cv::KeyPoint> corners;
  cv::FAST(image(inner), corners, options_.fast_threshold, true);

  const int num_columns = (image.cols + options_.cell_size_px - 1) / options_.cell_size_px;
  const int num_rows = (image.rows + options_.cell_size_px - 1) / options_.cell_size_px;
  CellSelection selection(num_columns * num_rows, options_.max_features_per_cell);
  for (cv::KeyPoint& corner : corners) {
    corner.pt += cv::Point2f(kBorder_px, kBorder_px);
    if (IsMasked(pyramid, level, mask, corner)) {
      ++*num_masked;
      continue;
    }
    const int cell = static_cast<int>(corner.pt.y) / options_.cell_size_px * num_columns +
                     static_cast<int>(corner.pt.x) / options_.cell_size_px;
    selection.Add(cell, corner);
  }
  std::vector<cv::KeyPoint> selected = selection.All();
  for (cv::KeyPoint& corner : selected) {
    corner.angle = IntensityCentroidAngle_deg(image, cvRound(corner.pt.x), cvRound(corner.pt.y));
  }
  return selected;
}

std::vector<Feature> FeatureExtractor::Extract(const ImagePyramid& pyramid, const cv::Mat& mask,
                                               int* num_masked) const {
  *num_masked = 0;
  std::vector<Feature> features;
  for (int level = 0; level < pyramid.num_levels(); ++level) {
    std::vector<cv::KeyPoint> corners = DetectLevel(pyramid, level, mask, num_masked);
    if (corners.empty()) continue;
    // Each level separately: given the whole image, ORB would build its own pyramid, of other
    // sizes.
    cv::Mat descriptors;
    orb_->compute(pyramid.level(level), corners, descriptors);
    for (std::size_t i = 0; i < corners.size(); ++i) {
      Feature feature;
      feature.uv_px = {pyramid.FromLevel(corners[i].pt.x, level),
                       pyramid.FromLevel(corners[i].pt.y, level)};
      feature.level = level;
      feature.response = corners[i].response;
      std::memcpy(feature.descriptor.data(), descriptors.ptr(static_cast<int>(i)),
                  sizeof(Descriptor));
      features.push_back(feature);
    }
  }
  return features;
}

}  // namespace airdos
