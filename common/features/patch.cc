#include "common/features/patch.h"

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace airdos {
namespace {

constexpr int kMaxIterations = 12;
constexpr double kConverged_px = 0.01;
constexpr double kMinDeviation =
    20;  // grey levels, over the whole square; a flatter patch cannot be located

/// Computes `num` samples of one row by bilinear interpolation; the caller has checked the borders.
void SampleRow(const cv::Mat& image, double u, double v, double step, int num, float* out) {
  const int v0 = static_cast<int>(std::floor(v));
  const float fv = static_cast<float>(v - v0);
  const uchar* row0 = image.ptr<uchar>(v0);
  const uchar* row1 = image.ptr<uchar>(v0 + 1);
  for (int i = 0; i < num; ++i) {
    const double ui = u + i * step;
    const int u0 = static_cast<int>(ui);
    const float fu = static_cast<float>(ui - u0);
    const float top =
        static_cast<float>(row0[u0]) + fu * static_cast<float>(row0[u0 + 1] - row0[u0]);
    const float bottom =
        static_cast<float>(row1[u0]) + fu * static_cast<float>(row1[u0 + 1] - row1[u0]);
    out[i] = top + fv * (bottom - top);
  }
}

bool IsInside(const cv::Mat& image, const Eigen::Vector2d& centre, double reach) {
  return centre.x() - reach >= 0 && centre.y() - reach >= 0 &&
         centre.x() + reach < image.cols - 1 && centre.y() + reach < image.rows - 1;
}

/// Samples of a square, one row per column, padded to whole vectors.
template <int kCount>
using Square = Eigen::Array<float, (kCount + 3) / 4 * 4, kCount>;

/// Bilinear, with one px between samples, so the fractions are the same everywhere and whole rows
/// can be interpolated at once. The caller has checked the borders; the padding repeats the last
/// pixel.
template <int kCount>
Square<kCount> SampleUnitSteps(const cv::Mat& image, double u, double v) {
  constexpr std::size_t kPadded = Square<kCount>::RowsAtCompileTime;
  const int u0 = static_cast<int>(u);
  const int v0 = static_cast<int>(v);
  const float fu = static_cast<float>(u - u0);
  const float fv = static_cast<float>(v - v0);
  Eigen::Array<float, kPadded, kCount + 1> rows;  // interpolated along u
  for (int y = 0; y <= kCount; ++y) {
    std::array<uchar, kPadded + 1> grey;
    std::memcpy(grey.data(), image.ptr<uchar>(v0 + y) + u0, kCount + 1);
    std::fill(grey.begin() + kCount + 1, grey.end(), grey[kCount]);
    float* row = rows.col(y).data();
    for (std::size_t x = 0; x < kPadded; ++x) {
      const auto here = static_cast<float>(grey[x]);
      row[x] = here + fu * (static_cast<float>(grey[x + 1]) - here);
    }
  }
  return rows.template leftCols<kCount>() +
         fv * (rows.template rightCols<kCount>() - rows.template leftCols<kCount>());
}

/// Subtracts the mean; the padding becomes 0.
Square<Patch::kSize> Centred(Square<Patch::kSize> samples) {
  samples.bottomRows<1>().setZero();
  samples -= samples.sum() / (Patch::kSize * Patch::kSize);
  samples.bottomRows<1>().setZero();
  return samples;
}

}  // namespace

std::optional<Patch> Patch::Sample(const cv::Mat& image, const Eigen::Vector2d& centre_px,
                                   double step_px) {
  constexpr int kWide = kSize + 2;
  const double reach = (kRadius + 1) * step_px;
  if (!IsInside(image, centre_px, reach)) return std::nullopt;
  const Eigen::Vector2d first = centre_px.array() - reach;
  Square<kWide> wide;
  if (step_px == 1) {
    wide = SampleUnitSteps<kWide>(image, first.x(), first.y());
  } else {
    wide.setZero();
    for (int y = 0; y < kWide; ++y)
      SampleRow(image, first.x(), first.y() + y * step_px, step_px, kWide, wide.col(y).data());
  }
  Patch patch;
  patch.gradient_u_ =
      0.5f * (wide.block<kPaddedSize, kSize>(2, 1) - wide.block<kPaddedSize, kSize>(0, 1));
  patch.gradient_v_ =
      0.5f * (wide.block<kPaddedSize, kSize>(1, 2) - wide.block<kPaddedSize, kSize>(1, 0));
  patch.gradient_u_.bottomRows<1>().setZero();
  patch.gradient_v_.bottomRows<1>().setZero();
  const double uv = (patch.gradient_u_ * patch.gradient_v_).sum();
  Eigen::Matrix2d hessian;
  hessian << patch.gradient_u_.square().sum(), uv, uv, patch.gradient_v_.square().sum();
  const Eigen::Vector2d offset_row(patch.gradient_u_.sum(), patch.gradient_v_.sum());
  patch.hessian_ = hessian - offset_row * offset_row.transpose() / kNumSamples;
  patch.centred_ = Centred(wide.block<kPaddedSize, kSize>(1, 1));
  patch.deviation_ = std::sqrt(patch.centred_.square().sum());
  if (patch.deviation_ < kMinDeviation) return std::nullopt;
  return patch;
}

std::optional<Patch::Alignment> Patch::Align(const cv::Mat& image, const Eigen::Vector2d& start_px,
                                             double max_shift_px, bool along_row) const {
  if (!(hessian_(0, 0) > 0) || (!along_row && !(hessian_.determinant() > 0))) return std::nullopt;
  const Eigen::Matrix2d inverse =
      along_row ? Eigen::Matrix2d::Zero() : Eigen::Matrix2d(hessian_.inverse());
  Eigen::Vector2d centre = start_px;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!IsInside(image, centre, kRadius)) return std::nullopt;
    const Samples now =
        Centred(SampleUnitSteps<kSize>(image, centre.x() - kRadius, centre.y() - kRadius));
    const Samples error = now - centred_;
    const double b_u = (gradient_u_ * error).sum();
    const double b_v = along_row ? 0 : (gradient_v_ * error).sum();
    const Eigen::Vector2d step = along_row ? Eigen::Vector2d(b_u / hessian_(0, 0), 0)
                                           : Eigen::Vector2d(inverse * Eigen::Vector2d(b_u, b_v));
    if (step.norm() < kConverged_px) {
      const float squares = now.square().sum();
      if (!(squares > 0)) return std::nullopt;
      return Alignment{centre, (now * centred_).sum() / (deviation_ * std::sqrt(squares))};
    }
    centre -= step;
    if (!((centre - start_px).norm() <= max_shift_px)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace airdos
