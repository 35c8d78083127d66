#include "common/human/person_pairing.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <limits>

#include "common/human/assignment.h"

namespace airdos {
namespace {

// Standing people show most limbs at full length: the upper part of the distribution of
// (length in the image / typical length at that depth) is near one.
constexpr double kSizeQuantile = 0.75;
constexpr double kSizeSigmaLog = 0.3;
constexpr int kMinSegmentsForSize = 3;

double SwapPrior(SideSwap swap) {
  switch (swap) {
    case SideSwap::kNone:
      return 0;
    case SideSwap::kAll:
      return 0.3;
    case SideSwap::kLowerLegs:
    case SideSwap::kLowerArms:
      return 0.15;
  }
  return 0;
}

double SquaredLog(double ratio) { return std::pow(std::log(ratio) / kSizeSigmaLog, 2); }

// Compares the size of the person in the image with its disparity.
double SizeCost(const PersonPairingOptions& options, const StereoCamera& camera,
                const BodyKeypoints& person, double disparity_px) {
  const double px_per_m = disparity_px / camera.baseline_m;  // fx / depth
  std::vector<double> ratios;
  for (const Segment& segment : kSegments) {
    const BodyKeypoint& a = person[static_cast<std::size_t>(segment.joint_a)];
    const BodyKeypoint& b = person[static_cast<std::size_t>(segment.joint_b)];
    if (a.confidence < options.min_confidence || b.confidence < options.min_confidence) continue;
    const double length_px = (a.uv_px() - b.uv_px()).norm();
    ratios.push_back(length_px / (segment.typical_length_m * px_per_m));
  }
  if (static_cast<int>(ratios.size()) < kMinSegmentsForSize) return 0;
  const auto quantile = ratios.begin() + static_cast<std::ptrdiff_t>(
                                             kSizeQuantile * static_cast<double>(ratios.size()));
  std::nth_element(ratios.begin(), quantile, ratios.end());
  return SquaredLog(std::max(*quantile, 1e-3)) / 2;
}

struct JointPair {
  double disparity_px;
  double row_difference_px;
  double confidence_left;
  double confidence_right;
};

std::vector<JointPair> CommonJoints(const PersonPairingOptions& options, const BodyKeypoints& left,
                                    const BodyKeypoints& right) {
  std::vector<JointPair> common;
  for (std::size_t joint = 0; joint < left.size(); ++joint) {
    const BodyKeypoint& l = left[joint];
    const BodyKeypoint& r = right[joint];
    if (l.confidence < options.min_confidence || r.confidence < options.min_confidence) continue;
    common.push_back({l.u_px - r.u_px, l.v_px - r.v_px, l.confidence, r.confidence});
  }
  return common;
}

std::optional<PersonPair> FitWithSides(const PersonPairingOptions& options,
                                       const StereoCamera& camera, const BodyKeypoints& left,
                                       const BodyKeypoints& right) {
  const std::vector<JointPair> common = CommonJoints(options, left, right);
  if (static_cast<int>(common.size()) < options.min_joints) return std::nullopt;
  std::vector<double> disparities;
  for (const JointPair& joint : common) disparities.push_back(joint.disparity_px);
  const double disparity_px = *Median(disparities);
  const double focal_baseline = camera.fx_px * camera.baseline_m;
  if (disparity_px < focal_baseline / options.max_depth_m ||
      disparity_px > focal_baseline / options.min_depth_m) {
    return std::nullopt;
  }
  const double height_px = kPersonHeightM * disparity_px / camera.baseline_m;
  const double extent_px = options.body_extent_m * disparity_px * disparity_px / focal_baseline;
  double sum = 0;
  for (const JointPair& joint : common) {
    const double variance = std::pow(options.noise.Sigma(joint.confidence_left, height_px), 2) +
                            std::pow(options.noise.Sigma(joint.confidence_right, height_px), 2);
    const double error =
        std::pow(joint.row_difference_px, 2) / variance +
        std::pow(joint.disparity_px - disparity_px, 2) / (variance + extent_px * extent_px);
    sum += std::min(error, options.max_joint_squared_sigmas);
  }
  PersonPair pair;
  pair.disparity_px = disparity_px;
  pair.cost = sum / (2 * static_cast<double>(common.size())) +
              SizeCost(options, camera, left, disparity_px);
  return pair;
}

}  // namespace

std::optional<PersonPair> FitPersonPair(const PersonPairingOptions& options,
                                        const StereoCamera& camera, const BodyKeypoints& left,
                                        const BodyKeypoints& right) {
  std::optional<PersonPair> best;
  for (const SideSwap swap : kSideSwaps) {
    std::optional<PersonPair> pair = FitWithSides(options, camera, left, SwapSides(right, swap));
    if (!pair) continue;
    pair->right_swap = swap;
    pair->cost += SwapPrior(swap);
    if (!best || pair->cost < best->cost) best = pair;
  }
  return best;
}

PersonPairing PairPeople(const PersonPairingOptions& options, const StereoCamera& camera,
                         const std::vector<BodyKeypoints>& left,
                         const std::vector<BodyKeypoints>& right) {
  Eigen::MatrixXd cost = Eigen::MatrixXd::Constant(static_cast<Eigen::Index>(left.size()),
                                                   static_cast<Eigen::Index>(right.size()),
                                                   std::numeric_limits<double>::infinity());
  std::vector<std::vector<PersonPair>> fits(left.size(), std::vector<PersonPair>(right.size()));
  for (std::size_t l = 0; l < left.size(); ++l) {
    for (std::size_t r = 0; r < right.size(); ++r) {
      const std::optional<PersonPair> fit = FitPersonPair(options, camera, left[l], right[r]);
      if (!fit) continue;
      fits[l][r] = *fit;
      fits[l][r].left = static_cast<int>(l);
      fits[l][r].right = static_cast<int>(r);
      cost(static_cast<Eigen::Index>(l), static_cast<Eigen::Index>(r)) = fit->cost;
    }
  }
  PersonPairing pairing;
  std::vector<bool> is_right_paired(right.size(), false);
  const std::vector<std::optional<int>> partner = Assign(cost, options.max_mean_squared_sigmas);
  for (std::size_t l = 0; l < left.size(); ++l) {
    if (!partner[l]) {
      pairing.unpaired_left.push_back(static_cast<int>(l));
      continue;
    }
    const std::size_t r = static_cast<std::size_t>(*partner[l]);
    pairing.pairs.push_back(fits[l][r]);
    is_right_paired[r] = true;
  }
  for (std::size_t r = 0; r < right.size(); ++r) {
    if (!is_right_paired[r]) pairing.unpaired_right.push_back(static_cast<int>(r));
  }
  return pairing;
}

}  // namespace airdos
