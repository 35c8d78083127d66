#include "processes/human_tracker/human_tracker_node.h"

#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "common/util/error.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

constexpr char kConfigFile[] = AIRDOS_SOURCE_DIR "/launch_scripts/config/human_tracker.yaml";
const StereoCamera kCamera{640, 360, 700, 700, 320, 180, 0.25};

std::unique_ptr<Node> MakeNode() {
  ConfigReader config = ConfigReader::FromFile(kConfigFile);
  std::unique_ptr<Node> node = MakeHumanTrackerNode(&config);
  config.Finish();
  return node;
}

template <class Message>
Message WithHeader(std::int64_t seq, std::int64_t session) {
  return MessageOf<Message>({seq * 100000, seq, session});
}

template <class Message>
void Send(const std::string& channel, const Message& message, Node* node) {
  const std::vector<std::uint8_t> bytes = Encode(message);
  node->Receive(channel, bytes.data(), bytes.size());
}

void SendCalibration(std::int64_t session, Node* node) {
  auto message = WithHeader<stereo_calibration_t>(0, session);
  FromStereoCamera(kCamera, &message);
  Send(channel::kCalibration, message, node);
}

void SendImage(const std::string& channel, std::int64_t seq, std::int64_t session, bool is_broken,
               Node* node) {
  auto message = WithHeader<image_t>(seq, session);
  message.width = kCamera.width;
  message.height = kCamera.height;
  message.encoding = is_broken ? image_t::ENCODING_JPEG : image_t::ENCODING_RAW_GRAY8;
  message.data.assign(static_cast<std::size_t>(kCamera.width * kCamera.height), 100);
  message.num_bytes = static_cast<int32_t>(message.data.size());
  Send(channel, message, node);
}

// A person, upright, 5 m away, moved sideways by `x_m`; COCO-18.
void SendPerson(const std::string& channel, std::int64_t seq, std::int64_t session, double x_m,
                bool is_right, Node* node) {
  const std::vector<Eigen::Vector2d> joints = {
      {0, -.6},   {0, -.4},   {-.18, -.4}, {-.25, -.1}, {-.25, .15}, {.18, -.4},
      {.25, -.1}, {.25, .15}, {-.12, .1},  {-.12, .5},  {-.12, .9},  {.12, .1},
      {.12, .5},  {.12, .9},  {0, -.6},    {0, -.6},    {0, -.6},    {0, -.6}};
  auto message = WithHeader<person_keypoints_t>(seq, session);
  message.layout = person_keypoints_t::LAYOUT_COCO18;
  message.num_people = 1;
  message.num_joints = 18;
  message.u_px.resize(1);
  message.v_px.resize(1);
  message.confidence.resize(1);
  for (const Eigen::Vector2d& joint : joints) {
    const Eigen::Vector3d uvu = kCamera.ProjectStereo({joint.x() + x_m, joint.y(), 5});
    message.u_px[0].push_back(static_cast<float>(is_right ? uvu[2] : uvu[0]));
    message.v_px[0].push_back(static_cast<float>(uvu[1]));
    message.confidence[0].push_back(0.9F);
  }
  Send(channel, message, node);
}

void SendFrame(std::int64_t seq, std::int64_t session, double x_m, Node* node) {
  SendImage(channel::kCameraLeft, seq, session, false, node);
  SendImage(channel::kCameraRight, seq, session, false, node);
  SendPerson(channel::kPersonKeypointsLeft, seq, session, x_m, false, node);
  SendPerson(channel::kPersonKeypointsRight, seq, session, x_m, true, node);
}

std::vector<human_observations_t> Outputs(Node* node) {
  while (node->Step()) {
  }
  std::vector<human_observations_t> messages;
  for (const Envelope& envelope : node->TakeOutput()) {
    EXPECT_EQ(envelope.channel, channel::kHumanObservations);
    human_observations_t message;
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    EXPECT_EQ(Validate(message), "");
    messages.push_back(message);
  }
  return messages;
}

TEST(HumanTrackerNode, ImagesOfAnotherSizeThanTheCalibrationSaysAreRejected) {
  const auto node = MakeNode();
  SendCalibration(7, node.get());
  const std::string channels[] = {channel::kCameraLeft, channel::kCameraRight};
  for (int i = 0; i < 2; ++i) {
    auto image = WithHeader<image_t>(3, 7);
    image.width = kCamera.width - (i == 0 ? 1 : 0);
    image.height = kCamera.height - i;
    image.encoding = image_t::ENCODING_RAW_GRAY8;
    image.data.assign(static_cast<std::size_t>(image.width * image.height), 100);
    image.num_bytes = static_cast<std::int32_t>(image.data.size());
    Send(channels[i], image, node.get());
  }
  SendPerson(channel::kPersonKeypointsLeft, 3, 7, 0, false, node.get());
  SendPerson(channel::kPersonKeypointsRight, 3, 7, 0, true, node.get());
  EXPECT_EQ(Outputs(node.get()).size(), 1u) << "the frame goes on without them";
  for (const std::string& name : channels) {
    EXPECT_EQ(node->channels().at(name).num_rejected, 1);
    EXPECT_EQ(node->channels().at(name).last_reject, "its size is not that of the calibration");
  }
}

TEST(HumanTrackerNode, ReportsAPersonWhereItIs) {
  const auto node = MakeNode();
  SendCalibration(7, node.get());
  SendFrame(3, 7, 0.5, node.get());
  const auto messages = Outputs(node.get());
  ASSERT_EQ(messages.size(), 1U);
  EXPECT_EQ(messages[0].seq, 3);
  EXPECT_EQ(messages[0].session, 7);
  EXPECT_EQ(messages[0].utime, 300000);
  EXPECT_EQ(messages[0].num_detected_left, 1);
  EXPECT_EQ(messages[0].num_rejected, 0);
  ASSERT_EQ(messages[0].num_humans, 1);
  const human_observation_t& human = messages[0].humans[0];
  EXPECT_EQ(human.track_id, 3001) << "those of frames 0 to 2 may be known to others";
  ASSERT_EQ(human.num_joints, kNumJoints);
  for (int i = 0; i < human.num_joints; ++i) {
    EXPECT_NEAR(human.z_C_m[static_cast<std::size_t>(i)], 5, 1e-3);
    EXPECT_GT(human.covariance_C[static_cast<std::size_t>(i)][5], 0);
  }
  EXPECT_NEAR(human.x_C_m[kNeck], 0.5, 1e-3);
  EXPECT_NEAR(human.y_C_m[kNeck], -0.4, 1e-3);
}

TEST(HumanTrackerNode, KeepsTheIdAndForgetsItInANewSession) {
  const auto node = MakeNode();
  SendCalibration(7, node.get());
  SendCalibration(8, node.get());
  for (int seq = 0; seq < 3; ++seq) SendFrame(seq, 7, 0.02 * seq, node.get());
  SendFrame(0, 8, 0, node.get());
  const auto messages = Outputs(node.get());
  ASSERT_EQ(messages.size(), 4U);
  for (const auto& message : messages) ASSERT_EQ(message.num_humans, 1);
  EXPECT_EQ(messages[1].humans[0].track_id, messages[0].humans[0].track_id);
  EXPECT_EQ(messages[2].humans[0].track_id, messages[0].humans[0].track_id);
  EXPECT_EQ(messages[3].session, 8);
  EXPECT_EQ(messages[3].humans[0].track_id, 1);  // numbering starts afresh
}

TEST(HumanTrackerNode, OneMessageAFrameWhateverIsMissing) {
  const auto node = MakeNode();
  SendCalibration(7, node.get());
  SendFrame(0, 7, 0, node.get());
  SendImage(channel::kCameraLeft, 1, 7, false, node.get());  // nothing else of frame 1
  SendImage(channel::kCameraLeft, 2, 7, true, node.get());   // damaged images
  SendImage(channel::kCameraRight, 2, 7, true, node.get());
  SendPerson(channel::kPersonKeypointsLeft, 2, 7, 0, false, node.get());
  SendPerson(channel::kPersonKeypointsRight, 2, 7, 0, true, node.get());
  while (node->Step() || node->CompleteOldest()) {
  }
  const auto messages = Outputs(node.get());
  ASSERT_EQ(messages.size(), 3U);
  EXPECT_EQ(messages[0].num_humans, 1);
  EXPECT_EQ(messages[1].num_humans, 0);
  ASSERT_EQ(messages[2].num_humans, 1);
  EXPECT_EQ(messages[2].humans[0].track_id, messages[0].humans[0].track_id);
}

TEST(HumanTrackerNode, ConfigurationIsStrict) {
  ConfigReader config = ConfigReader::FromFile(kConfigFile);
  config.Override("pairing.max_mean_squared_sigmas=-1");
  EXPECT_THROW(MakeHumanTrackerNode(&config), InputError);
}

}  // namespace
}  // namespace airdos
