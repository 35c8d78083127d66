#include "processes/node/message/keypoint_messages.h"

#include <cstddef>

namespace airdos {

std::optional<KeypointLayout> LayoutOf(int layout) {
  switch (layout) {
    case person_keypoints_t::LAYOUT_COCO18:
      return KeypointLayout::kCoco18;
    case person_keypoints_t::LAYOUT_COCO17:
      return KeypointLayout::kCoco17;
    case person_keypoints_t::LAYOUT_HALPE26:
      return KeypointLayout::kHalpe26;
    default:
      return std::nullopt;
  }
}

std::int8_t ToMessageLayout(KeypointLayout layout) {
  switch (layout) {
    case KeypointLayout::kCoco17:
      return person_keypoints_t::LAYOUT_COCO17;
    case KeypointLayout::kHalpe26:
      return person_keypoints_t::LAYOUT_HALPE26;
    case KeypointLayout::kCoco18:
      break;
  }
  return person_keypoints_t::LAYOUT_COCO18;
}

std::vector<std::vector<BodyKeypoint>> ToDetections(const person_keypoints_t& message) {
  std::vector<std::vector<BodyKeypoint>> detections;
  for (std::size_t person = 0; person < message.u_px.size(); ++person) {
    std::vector<BodyKeypoint>& keypoints = detections.emplace_back();
    for (std::size_t joint = 0; joint < message.u_px[person].size(); ++joint) {
      keypoints.push_back({message.u_px[person][joint], message.v_px[person][joint],
                           message.confidence[person][joint]});
    }
  }
  return detections;
}

std::vector<BodyKeypoints> ToPeople(const person_keypoints_t& message) {
  std::vector<BodyKeypoints> people;
  const std::optional<KeypointLayout> layout = LayoutOf(message.layout);
  if (!layout) return people;
  for (const std::vector<BodyKeypoint>& keypoints : ToDetections(message)) {
    const std::optional<BodyKeypoints> body = MapToBody(*layout, keypoints);
    if (body) people.push_back(*body);
  }
  return people;
}

}  // namespace airdos
