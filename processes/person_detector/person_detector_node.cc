#include "processes/person_detector/person_detector_node.h"

#include "processes/node/message/channels.h"
#include "processes/node/message/image_codec.h"
#include "processes/person_detector/person_detector_messages.h"

namespace airdos {

PersonDetectorNode::PersonDetectorNode(const PersonDetectorOptions& options)
    : FrameNode("person_detector"),
      is_right_gray_(options.right == PersonDetectorOptions::Right::kRows),
      detector_(options) {
  Join(channel::kCameraLeft, &PersonDetectorInputs::left_image);
  Join(channel::kCameraRight, &PersonDetectorInputs::right_image);
  DeclareOutput(channel::kPersonKeypointsLeft);
  DeclareOutput(channel::kPersonKeypointsRight);
  DeclareOutput(channel::kPersonMask);
  // An image in which people are found takes several times as long as one in which they are
  // followed.
  if (options.detect_every > 1) SetMaxBehind(1);
}

void PersonDetectorNode::StartSession(const Header&) { detector_.Reset(); }

cv::Mat PersonDetectorNode::Pixels(const std::string& channel,
                                   const std::optional<image_t>& message, bool is_gray) {
  if (!message) return {};
  std::string reason;
  const std::optional<cv::Mat> image =
      is_gray ? DecodeGray(*message, &reason) : DecodeColor(*message, &reason);
  if (!image) Reject(channel, reason);
  return image.value_or(cv::Mat());
}

void PersonDetectorNode::ProcessFrame(const Header& header, PersonDetectorInputs inputs) {
  const cv::Mat left = Pixels(channel::kCameraLeft, inputs.left_image, false);
  const cv::Mat right = Pixels(channel::kCameraRight, inputs.right_image, is_right_gray_);
  const DetectedPeople people = detector_.Process(left, right);
  Publish(channel::kPersonKeypointsLeft, ToPersonKeypoints(header, people.left));
  Publish(channel::kPersonKeypointsRight, ToPersonKeypoints(header, people.right));
  Publish(channel::kPersonMask, ToPersonMask(header, people.mask));
}

std::unique_ptr<Node> MakePersonDetectorNode(ConfigReader* config) {
  return std::make_unique<PersonDetectorNode>(ReadPersonDetectorOptions(config));
}

}  // namespace airdos
