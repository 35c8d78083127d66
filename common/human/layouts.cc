#include "common/human/layouts.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

namespace airdos {
namespace {

// For each body joint, in the order of Joint, its index in the layout; -1 if it must be computed.
using Table = std::array<int, kNumJoints>;
constexpr Table kCoco18Table = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13};
// 0 nose 1-2 eyes 3-4 ears 5/6 shoulders 7/8 elbows 9/10 wrists 11/12 hips 13/14 knees 15/16
// ankles, left before right.
constexpr Table kCoco17Table = {0, -1, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15};
// As COCO-17, then 17 head, 18 neck, 19 hip, 20-25 feet.
constexpr Table kHalpe26Table = {0, 18, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15};

const Table& TableOf(KeypointLayout layout) {
  switch (layout) {
    case KeypointLayout::kCoco17:
      return kCoco17Table;
    case KeypointLayout::kHalpe26:
      return kHalpe26Table;
    case KeypointLayout::kCoco18:
      break;
  }
  return kCoco18Table;
}

BodyKeypoint Cleaned(const BodyKeypoint& keypoint) {
  if (!std::isfinite(keypoint.u_px) || !std::isfinite(keypoint.v_px)) return {};
  if (!(keypoint.confidence > 0)) return {};
  return {keypoint.u_px, keypoint.v_px, std::min(keypoint.confidence, 1.0)};
}

BodyKeypoint MiddleOf(const BodyKeypoint& a, const BodyKeypoint& b) {
  if (a.confidence <= 0 || b.confidence <= 0) return {};
  return {(a.u_px + b.u_px) / 2, (a.v_px + b.v_px) / 2, std::min(a.confidence, b.confidence)};
}

}  // namespace

int NumKeypoints(KeypointLayout layout) {
  switch (layout) {
    case KeypointLayout::kCoco17:
      return 17;
    case KeypointLayout::kHalpe26:
      return 26;
    case KeypointLayout::kCoco18:
      break;
  }
  return 18;
}

std::optional<BodyKeypoints> MapToBody(KeypointLayout layout,
                                       const std::vector<BodyKeypoint>& detection) {
  if (static_cast<int>(detection.size()) != NumKeypoints(layout)) return std::nullopt;
  const Table& table = TableOf(layout);
  BodyKeypoints person;
  for (std::size_t joint = 0; joint < person.size(); ++joint) {
    if (table[joint] >= 0) {
      person[joint] = Cleaned(detection[static_cast<std::size_t>(table[joint])]);
    }
  }
  if (table[kNeck] < 0) person[kNeck] = MiddleOf(person[kRightShoulder], person[kLeftShoulder]);
  return person;
}

}  // namespace airdos
