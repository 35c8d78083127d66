#include "common/human/body_keypoints.h"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace airdos {
namespace {

constexpr std::array<std::pair<int, int>, 6> kMirrored = {{{kRightShoulder, kLeftShoulder},
                                                           {kRightElbow, kLeftElbow},
                                                           {kRightWrist, kLeftWrist},
                                                           {kRightHip, kLeftHip},
                                                           {kRightKnee, kLeftKnee},
                                                           {kRightAnkle, kLeftAnkle}}};

bool IsConcerned(int right_joint, SideSwap swap) {
  switch (swap) {
    case SideSwap::kNone:
      return false;
    case SideSwap::kAll:
      return true;
    case SideSwap::kLowerLegs:
      return right_joint == kRightKnee || right_joint == kRightAnkle;
    case SideSwap::kLowerArms:
      return right_joint == kRightElbow || right_joint == kRightWrist;
  }
  return false;
}

}  // namespace

int SwappedJoint(int joint, SideSwap swap) {
  for (const auto& [right, left] : kMirrored) {
    if (!IsConcerned(right, swap)) continue;
    if (joint == right) return left;
    if (joint == left) return right;
  }
  return joint;
}

BodyKeypoints SwapSides(const BodyKeypoints& person, SideSwap swap) {
  BodyKeypoints swapped;
  for (int joint = 0; joint < kNumJoints; ++joint) {
    swapped[static_cast<std::size_t>(joint)] =
        person[static_cast<std::size_t>(SwappedJoint(joint, swap))];
  }
  return swapped;
}

double KeypointNoise::Sigma(double confidence, double height_px) const {
  const double factor =
      std::clamp(1 + per_confidence * (full_confidence - confidence), 1.0, max_factor);
  return std::max(min_px, per_height * height_px) * factor;
}

std::optional<double> Median(std::vector<double> values) {
  if (values.empty()) return std::nullopt;
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>((values.size() - 1) / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace airdos
