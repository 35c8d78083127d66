#include "tests/node/frontend_messages.h"

#include <gtest/gtest.h>

#include <map>

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();

template <class Message>
Message WithHeader(std::int64_t seq, std::int64_t session) {
  Message message{};
  message.utime = 5'000'000 + 100'000 * seq;
  message.seq = seq;
  message.session = session;
  return message;
}

}  // namespace

const StereoPair& Walk(int k) {
  static std::map<int, StereoPair> pairs;
  if (pairs.count(k) == 0) pairs[k] = RenderedScene(11).Render(kCamera, SwayingPath(k));
  return pairs.at(k);
}

Se3 Truth(int k) { return SwayingPath(0).inverse() * SwayingPath(k); }

image_t ImageOf(const cv::Mat& image, std::int64_t seq, std::int64_t session) {
  image_t message = WithHeader<image_t>(seq, session);
  message.width = image.cols;
  message.height = image.rows;
  message.encoding = image_t::ENCODING_RAW_GRAY8;
  message.data.assign(image.datastart, image.dataend);
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  return message;
}

image_t Left(int seq, std::int64_t session) { return ImageOf(Walk(seq).left, seq, session); }

image_t Right(int seq, std::int64_t session) { return ImageOf(Walk(seq).right, seq, session); }

stereo_calibration_t Calibration(std::int64_t session) {
  stereo_calibration_t message = WithHeader<stereo_calibration_t>(0, session);
  FromStereoCamera(kCamera, &message);
  return message;
}

person_mask_t NoMask(std::int64_t seq, std::int64_t session) {
  person_mask_t message = WithHeader<person_mask_t>(seq, session);
  message.encoding = person_mask_t::ENCODING_NONE;
  return message;
}

person_mask_t Mask(std::int64_t seq, int begin_px, int end_px, cv::Size size) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  mask.colRange(begin_px, end_px) = cv::Scalar(255);
  person_mask_t message = WithHeader<person_mask_t>(seq, kSession);
  message.width = size.width;
  message.height = size.height;
  message.encoding = person_mask_t::ENCODING_RAW_GRAY8;
  message.data.assign(mask.datastart, mask.dataend);
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  return message;
}

person_mask_t Mask(std::int64_t seq, int begin_px, int end_px) {
  return Mask(seq, begin_px, end_px, {kCamera.width, kCamera.height});
}

map_update_t Update(std::int64_t seq, std::int64_t session) {
  map_update_t message = WithHeader<map_update_t>(seq, session);
  message.num_parts = 1;
  return message;
}

void AddFrame(std::int64_t seq, const Se3& T_W_C, map_update_t* message) {
  frame_pose_t frame{};
  frame.seq = seq;
  frame.utime = 5'000'000 + 100'000 * seq;
  FromSe3(T_W_C, frame.position_W_C, frame.orientation_W_C);
  message->frames.push_back(frame);
  ++message->num_frames;
}

void SendFrame(int seq, Node* node, std::int64_t session) {
  Send(channel::kCameraLeft, Left(seq, session), node);
  Send(channel::kCameraRight, Right(seq, session), node);
  Send(channel::kPersonMask, NoMask(seq, session), node);
}

std::vector<static_features_t> Take(Node* node) {
  std::vector<static_features_t> messages;
  for (const Envelope& envelope : node->TakeOutput()) {
    EXPECT_EQ(envelope.channel, channel::kStaticFeatures);
    static_features_t message;
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    EXPECT_EQ(Validate(message), "");
    messages.push_back(message);
  }
  return messages;
}

std::vector<static_features_t> StepAll(Node* node) {
  while (node->Step()) {
  }
  return Take(node);
}

double PositionError_m(const static_features_t& message, const Se3& T_W_C) {
  return Boxminus(ToSe3(message.position_W_C, message.orientation_W_C), T_W_C).head<3>().norm();
}

FrontendOptions WithoutFeedback() {
  FrontendOptions options;
  options.feedback_lag = 0;
  return options;
}

}  // namespace airdos
