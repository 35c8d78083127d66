#include "common/features/patch.h"

#include <Eigen/LU>
#include <cmath>

namespace airdos {
namespace {

constexpr int kMaxIterations = 12;
constexpr double kConverged_px = 0.01;
constexpr double kMinDeviation =
    20;  // a patch flatter than this (grey levels, whole square) has no position

/// Fills `num` samples of one row with bilinear interpolation; the caller has checked the borders.
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

}  // namespace

std::optional<Patch> Patch::Sample(const cv::Mat& image, const Eigen::Vector2d& centre_px,
                                   double step_px) {
  constexpr int kWide = kSize + 2;
  const double reach = (kRadius + 1) * step_px;
  if (!IsInside(image, centre_px, reach)) return std::nullopt;
  std::array<float, kWide * kWide> wide;
  for (int y = 0; y < kWide; ++y) {
    SampleRow(image, centre_px.x() - reach, centre_px.y() - reach + y * step_px, step_px, kWide,
              &wide[static_cast<std::size_t>(y * kWide)]);
  }
  Patch patch;
  double sum = 0;
  double sum_gu = 0;
  double sum_gv = 0;
  Eigen::Matrix2d hessian = Eigen::Matrix2d::Zero();
  for (int y = 0; y < kSize; ++y) {
    for (int x = 0; x < kSize; ++x) {
      const auto i = static_cast<std::size_t>(y * kSize + x);
      const auto w = static_cast<std::size_t>((y + 1) * kWide + x + 1);
      patch.value_[i] = wide[w];
      const float gu = 0.5f * (wide[w + 1] - wide[w - 1]);
      const float gv = 0.5f * (wide[w + kWide] - wide[w - kWide]);
      patch.gradient_u_[i] = gu;
      patch.gradient_v_[i] = gv;
      sum += patch.value_[i];
      sum_gu += gu;
      sum_gv += gv;
      hessian(0, 0) += gu * gu;
      hessian(0, 1) += gu * gv;
      hessian(1, 1) += gv * gv;
    }
  }
  const Eigen::Vector2d offset_row(sum_gu, sum_gv);
  hessian(1, 0) = hessian(0, 1);
  patch.hessian_ = hessian - offset_row * offset_row.transpose() / kNumSamples;
  patch.mean_ = static_cast<float>(sum / kNumSamples);
  double squares = 0;
  for (const float value : patch.value_) squares += (value - patch.mean_) * (value - patch.mean_);
  patch.deviation_ = static_cast<float>(std::sqrt(squares));
  if (patch.deviation_ < kMinDeviation) return std::nullopt;
  return patch;
}

std::optional<Patch::Alignment> Patch::Align(const cv::Mat& image, const Eigen::Vector2d& start_px,
                                             double max_shift_px, bool along_row) const {
  if (!(hessian_(0, 0) > 0) || (!along_row && !(hessian_.determinant() > 0))) return std::nullopt;
  const Eigen::Matrix2d inverse =
      along_row ? Eigen::Matrix2d::Zero() : Eigen::Matrix2d(hessian_.inverse());
  Eigen::Vector2d centre = start_px;
  std::array<float, kNumSamples> now;
  for (int iteration = 0; iteration < kMaxIterations; ++iteration) {
    if (!IsInside(image, centre, kRadius)) return std::nullopt;
    double sum = 0;
    for (int y = 0; y < kSize; ++y) {
      float* row = &now[static_cast<std::size_t>(y * kSize)];
      SampleRow(image, centre.x() - kRadius, centre.y() - kRadius + y, 1.0, kSize, row);
      for (int x = 0; x < kSize; ++x) sum += row[x];
    }
    const float mean = static_cast<float>(sum / kNumSamples);
    float b_u = 0;
    float b_v = 0;
    float cross = 0;
    float squares = 0;
    for (std::size_t i = 0; i < kNumSamples; ++i) {
      const float centred = now[i] - mean;
      const float error = centred - (value_[i] - mean_);
      b_u += gradient_u_[i] * error;
      b_v += gradient_v_[i] * error;
      cross += centred * (value_[i] - mean_);
      squares += centred * centred;
    }
    const Eigen::Vector2d step = along_row ? Eigen::Vector2d(b_u / hessian_(0, 0), 0)
                                           : Eigen::Vector2d(inverse * Eigen::Vector2d(b_u, b_v));
    if (step.norm() < kConverged_px) {
      if (!(squares > 0)) return std::nullopt;
      return Alignment{centre, cross / (deviation_ * std::sqrt(squares))};
    }
    centre -= step;
    if (!((centre - start_px).norm() <= max_shift_px)) return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace airdos
