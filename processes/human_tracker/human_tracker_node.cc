#include "processes/human_tracker/human_tracker_node.h"

#include <cstddef>
#include <cstdint>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "processes/human_tracker/human_tracker_messages.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/conversions.h"
#include "processes/node/message/header.h"
#include "processes/node/message/image_codec.h"
#include "processes/node/message/keypoint_messages.h"

namespace airdos {
namespace {

std::vector<BodyKeypoints> PeopleOf(const std::optional<person_keypoints_t>& message) {
  return message ? ToPeople(*message) : std::vector<BodyKeypoints>();
}

}  // namespace

HumanTrackerNode::HumanTrackerNode(const HumanTrackerOptions& options)
    : FrameNode("human_tracker"),
      options_(options),
      tracker_(std::make_unique<HumanTracker>(options)) {
  Join(channel::kCameraLeft, &HumanTrackerInputs::left_image);
  Join(channel::kCameraRight, &HumanTrackerInputs::right_image);
  Join(channel::kPersonKeypointsLeft, &HumanTrackerInputs::left_keypoints);
  Join(channel::kPersonKeypointsRight, &HumanTrackerInputs::right_keypoints);
  JoinCalibration();
  DeclareOutput(channel::kHumanObservations);
}

void HumanTrackerNode::StartSession(const Header& header) {
  watches_ = Watches();
  constexpr std::int64_t kMostPerFrame = 1000;  // Validate() accepts up to 200 people per image
  tracker_ = std::make_unique<HumanTracker>(options_,
                                            HumanId{FirstRunningNumber(header.seq, kMostPerFrame)});
}

void HumanTrackerNode::WatchKeypoints(const HumanTrackerInputs& inputs, const PeopleFrame& frame) {
  if (!inputs.left_image) return;
  const Header image = HeaderOf(*inputs.left_image);
  const auto watch = [&](const std::optional<person_keypoints_t>& keypoints, const char* channel,
                         PartnerWatch* numbers) {
    std::optional<Header> header;
    if (keypoints) header = HeaderOf(*keypoints);
    return numbers->Add(image, header, numbers_of(channel::kCameraLeft), numbers_of(channel));
  };
  for (const std::string& warning :
       {watch(inputs.left_keypoints, channel::kPersonKeypointsLeft, &watches_.left),
        watch(inputs.right_keypoints, channel::kPersonKeypointsRight, &watches_.right),
        inputs.left_keypoints && inputs.right_keypoints
            ? watches_.people.Add(frame.left, frame.right)
            : std::string()}) {
    if (!warning.empty()) Warn(warning);
  }
}

void HumanTrackerNode::ProcessFrame(const Header& header, HumanTrackerInputs inputs) {
  PeopleFrame frame;
  std::string reason;
  if (inputs.left_image) {
    const std::optional<cv::Mat> color = DecodeColor(*inputs.left_image, &reason);
    if (Fits(color, channel::kCameraLeft, reason)) {
      frame.left_color = *color;
      cv::cvtColor(*color, frame.left_gray, cv::COLOR_BGR2GRAY);
    }
  }
  if (inputs.right_image) {
    const std::optional<cv::Mat> gray = DecodeGray(*inputs.right_image, &reason);
    if (Fits(gray, channel::kCameraRight, reason)) frame.right_gray = *gray;
  }
  frame.left = PeopleOf(inputs.left_keypoints);
  frame.right = PeopleOf(inputs.right_keypoints);

  WatchKeypoints(inputs, frame);
  const TrackedFrame tracked = tracker_->Process(camera(), frame);
  Publish(channel::kHumanObservations, ToHumanObservations(header, frame, tracked));
}

std::unique_ptr<Node> MakeHumanTrackerNode(ConfigReader* config) {
  return std::make_unique<HumanTrackerNode>(ReadHumanTrackerOptions(config));
}

}  // namespace airdos
