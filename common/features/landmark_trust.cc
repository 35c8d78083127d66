#include "common/features/landmark_trust.h"

#include <cmath>

namespace airdos {
namespace {

constexpr double kMemoryFrames = 20;     // older frames of a landmark count less and less
constexpr double kBaseWeight = 2;        // weight of the base probability, in verdicts
constexpr double kMaxDepthRatio = 1.25;  // between neighbours that may belong to the same thing

void Count(double* one, double* other) {
  *one += 1;
  const double sum = *one + *other;
  if (sum <= kMemoryFrames) return;
  *one *= kMemoryFrames / sum;
  *other *= kMemoryFrames / sum;
}

}  // namespace

void LandmarkTrust::Agree() { Count(&num_agreed_, &num_disagreed_); }
void LandmarkTrust::Disagree() { Count(&num_disagreed_, &num_agreed_); }

std::pair<int, int> TrustField::CellOf(const Eigen::Vector2d& uv_px) {
  return {static_cast<int>(std::floor(uv_px.x() / kRadius_px)),
          static_cast<int>(std::floor(uv_px.y() / kRadius_px))};
}

void TrustField::Add(const Eigen::Vector2d& uv_px, double depth_m, bool is_static) {
  cells_[CellOf(uv_px)].push_back({uv_px, depth_m, is_static});
}

double TrustField::At(const Eigen::Vector2d& uv_px, double depth_m) const {
  double weight = kBaseWeight;
  double weight_static = kBaseWeight * base_probability_;
  const auto [column, row] = CellOf(uv_px);
  for (int x = column - 1; x <= column + 1; ++x) {
    for (int y = row - 1; y <= row + 1; ++y) {
      const auto cell = cells_.find({x, y});
      if (cell == cells_.end()) continue;
      for (const Verdict& verdict : cell->second) {
        const double distance_px = (verdict.uv_px - uv_px).norm();
        const double depth_ratio = verdict.depth_m / depth_m;
        if (distance_px > kRadius_px || depth_ratio > kMaxDepthRatio ||
            depth_ratio < 1 / kMaxDepthRatio)
          continue;
        const double near = 1 - distance_px / kRadius_px;
        weight += near;
        if (verdict.is_static) weight_static += near;
      }
    }
  }
  return weight_static / weight;
}

}  // namespace airdos
