#include "tests/node/frontend_walk.h"

#include <gtest/gtest.h>

#include <map>

#include "processes/node/message/header.h"

namespace airdos {
namespace {

const StereoCamera kCamera = SmallStereoCamera();

template <class Message>
Message WithHeader(std::int64_t seq, std::int64_t session) {
  return MessageOf<Message>({5'000'000 + 100'000 * seq, seq, session});
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

human_observations_t NoHumans(std::int64_t seq, std::int64_t session) {
  return WithHeader<human_observations_t>(seq, session);
}

person_keypoints_t NoKeypoints(std::int64_t seq, std::int64_t session) {
  person_keypoints_t message = WithHeader<person_keypoints_t>(seq, session);
  message.layout = person_keypoints_t::LAYOUT_COCO18;
  message.num_joints = 18;
  return message;
}

human_observation_t Human(std::int64_t track, const Eigen::Vector3d& place_W, int seq) {
  human_observation_t human{};
  human.track_id = track;
  for (const int joint : kBodyJoints) {
    const Eigen::Vector3d offset(0.1 * (joint % 3 - 1), joint < 8 ? -0.5 : 0, 0.05 * (joint % 2));
    const Eigen::Vector3d p_C = Truth(seq).inverse() * (place_W + offset);
    human.joint_id.push_back(static_cast<std::int8_t>(joint));
    for (auto* pixels : {&human.u_left_px, &human.v_left_px, &human.u_right_px, &human.v_right_px})
      pixels->push_back(0);
    human.sigma_px.push_back(1);
    human.x_C_m.push_back(static_cast<float>(p_C.x()));
    human.y_C_m.push_back(static_cast<float>(p_C.y()));
    human.z_C_m.push_back(static_cast<float>(p_C.z()));
    human.covariance_C.push_back({1e-4F, 0, 0, 1e-4F, 0, 1e-4F});
  }
  human.num_joints = static_cast<std::int32_t>(human.joint_id.size());
  return human;
}

person_keypoints_t Keypoints(std::int64_t seq, const cv::Rect& trunk_px, float confidence) {
  person_keypoints_t message = NoKeypoints(seq);
  message.num_people = 1;
  std::vector<float> u_px(18, 0);
  std::vector<float> v_px(18, 0);
  std::vector<float> confidences(18, 0);
  const auto set = [&](int joint, int u, int v) {
    const auto i = static_cast<std::size_t>(joint);
    u_px[i] = static_cast<float>(u);
    v_px[i] = static_cast<float>(v);
    confidences[i] = confidence;
  };
  set(kRightShoulder, trunk_px.x, trunk_px.y);
  set(kLeftShoulder, trunk_px.x + trunk_px.width, trunk_px.y);
  set(kRightHip, trunk_px.x, trunk_px.y + trunk_px.height);
  set(kLeftHip, trunk_px.x + trunk_px.width, trunk_px.y + trunk_px.height);
  message.u_px = {u_px};
  message.v_px = {v_px};
  message.confidence = {confidences};
  return message;
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

void SendNobody(std::int64_t seq, Node* node, std::int64_t session) {
  Send(channel::kHumanObservations, NoHumans(seq, session), node);
  Send(channel::kPersonKeypointsLeft, NoKeypoints(seq, session), node);
}

void SendFrame(int seq, Node* node, std::int64_t session) {
  Send(channel::kCameraLeft, Left(seq, session), node);
  Send(channel::kCameraRight, Right(seq, session), node);
  Send(channel::kPersonMask, NoMask(seq, session), node);
  SendNobody(seq, node, session);
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

double PositionError_m(const static_features_t& message, const Se3& T_O_C) {
  return Boxminus(ToSe3(message.position_O_C, message.orientation_O_C), T_O_C).head<3>().norm();
}

FrontendOptions WithoutFeedback() {
  FrontendOptions options;
  options.feedback_lag_frames = 0;
  return options;
}

}  // namespace airdos
