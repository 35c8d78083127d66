#include "common/dataset/keypoints/foreign_layouts.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/util/check.h"

namespace airdos {
namespace {

constexpr std::size_t kNumCoco18 = 18;
constexpr std::size_t kCoco18Neck = 1;
constexpr std::size_t kCoco18RightShoulder = 2;
constexpr std::size_t kCoco18LeftShoulder = 5;
// For each joint of COCO-18 (nose, neck, right arm, left arm, right leg, left leg, right and left
// eye, right and left ear) its place in the other layout; -1 if it must be computed.
using Table = std::array<int, kNumCoco18>;
constexpr Table kOfCoco18 = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 16, 17};
// 8 is the middle of the hips, 19-24 are the feet.
constexpr Table kOfBody25 = {0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 11, 12, 13, 14, 15, 16, 17, 18};
// Left before right: 1-2 eyes, 3-4 ears, 5-6 shoulders, 7-8 elbows, 9-10 wrists, 11-12 hips, 13-14
// knees, 15-16 ankles.
constexpr Table kOfCoco17 = {0, -1, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15, 2, 1, 4, 3};
// BODY_25B is the same, then 17 the upper neck, which is not that of COCO-18, 18 head, 19-24 feet.
// As COCO-17, then 17 head, 18 neck, 19 hip, 20-25 feet.
constexpr Table kOfHalpe26 = {0, 18, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15, 2, 1, 4, 3};

struct Entry {
  ForeignLayout layout;
  const char* name;
  int num_joints;
  const Table* table;
};
constexpr std::array<Entry, 7> kEntries = {
    {{ForeignLayout::kCoco17, "COCO-17", 17, &kOfCoco17},
     {ForeignLayout::kCoco18, "COCO-18", 18, &kOfCoco18},
     {ForeignLayout::kBody25, "BODY_25", 25, &kOfBody25},
     {ForeignLayout::kBody25B, "BODY_25B", 25, &kOfCoco17},
     {ForeignLayout::kHalpe26, "Halpe-26", 26, &kOfHalpe26},
     {ForeignLayout::kWholeBody133, "COCO-WholeBody", 133, &kOfCoco17},
     {ForeignLayout::kHalpe136, "Halpe-136", 136, &kOfHalpe26}}};

const Entry& EntryOf(ForeignLayout layout) {
  const auto* const entry = std::find_if(kEntries.begin(), kEntries.end(),
                                         [=](const Entry& e) { return e.layout == layout; });
  AIRDOS_CHECK(entry != kEntries.end());
  return *entry;
}

bool IsSeen(const Keypoint& joint) {
  return std::isfinite(joint.u_px) && std::isfinite(joint.v_px) &&
         std::isfinite(joint.confidence) && joint.confidence > 0;
}

Keypoint JointAt(const std::vector<float>& numbers, std::size_t place) {
  return {numbers[3 * place], numbers[3 * place + 1], numbers[3 * place + 2]};
}

/// Mean distance (px) of the four joints from `first` on to joint 0, of those that are seen;
/// nothing if only one is.
std::optional<float> DistanceToNose(const std::vector<float>& numbers, std::size_t first) {
  const Keypoint nose = JointAt(numbers, 0);
  float sum_px = 0;
  int num_seen = 0;
  for (std::size_t place = first; place < first + 4; ++place) {
    const Keypoint joint = JointAt(numbers, place);
    if (!IsSeen(joint)) continue;
    sum_px += std::hypot(joint.u_px - nose.u_px, joint.v_px - nose.v_px);
    ++num_seen;
  }
  if (!IsSeen(nose) || num_seen < 2) return std::nullopt;
  return sum_px / static_cast<float>(num_seen);
}

}  // namespace

std::string NameOf(ForeignLayout layout) { return EntryOf(layout).name; }
int NumJoints(ForeignLayout layout) { return EntryOf(layout).num_joints; }

std::optional<ForeignLayout> LayoutOfCount(std::size_t count,
                                           const std::vector<ForeignLayout>& possible) {
  for (const ForeignLayout layout : possible) {
    if (count == 3 * static_cast<std::size_t>(NumJoints(layout))) return layout;
  }
  return std::nullopt;
}

bool AreInBody25B(const std::vector<std::vector<float>>& people) {
  int balance = 0;
  for (const std::vector<float>& numbers : people) {
    const std::optional<float> first = DistanceToNose(numbers, 1);
    const std::optional<float> last = DistanceToNose(numbers, 15);
    if (first && last && *first != *last) balance += *first < *last ? 1 : -1;
  }
  return balance > 0;
}

PersonKeypoints ToCoco18(ForeignLayout layout, const std::vector<float>& numbers) {
  const Entry& entry = EntryOf(layout);
  AIRDOS_CHECK(numbers.size() == 3 * static_cast<std::size_t>(entry.num_joints));
  PersonKeypoints person(kNumCoco18);
  for (std::size_t joint = 0; joint < kNumCoco18; ++joint) {
    if ((*entry.table)[joint] < 0) continue;
    const Keypoint read = JointAt(numbers, static_cast<std::size_t>((*entry.table)[joint]));
    if (IsSeen(read)) person[joint] = read;
  }
  if ((*entry.table)[kCoco18Neck] < 0) {
    const Keypoint& right = person[kCoco18RightShoulder];
    const Keypoint& left = person[kCoco18LeftShoulder];
    if (right.confidence > 0 && left.confidence > 0) {
      person[kCoco18Neck] = {(right.u_px + left.u_px) / 2, (right.v_px + left.v_px) / 2,
                             std::min(right.confidence, left.confidence)};
    }
  }
  return person;
}

}  // namespace airdos
