// The human tracker's node against the tracker that it wraps, run beside it on the same frames:
// every field of what goes in and comes out.
#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>
#include <vector>

#include "common/human/human_tracker.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "processes/node/message/header.h"

namespace airdos {
namespace {

constexpr std::int64_t kSession = 7;
constexpr std::int64_t kFirstSeq = 4;
const StereoCamera kCamera{641, 363, 700, 680, 310, 190, 0.25};

/// Of smooth noise that differs from channel to channel.
cv::Mat Picture(int shift_px) {
  cv::Mat wide(kCamera.height, kCamera.width + 100, CV_8UC3);
  cv::RNG random(5);
  random.fill(wide, cv::RNG::UNIFORM, 0, 256);
  cv::GaussianBlur(wide, wide, {0, 0}, 2);
  cv::normalize(wide, wide, 0, 255, cv::NORM_MINMAX);
  return wide.colRange(shift_px, shift_px + kCamera.width).clone();
}

cv::Mat GreyOf(const cv::Mat& bgr) {
  cv::Mat grey;
  cv::cvtColor(bgr, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Upright, at a place that moves; those without an arm have confidence 0 there.
std::vector<BodyKeypoint> Person(const Eigen::Vector3d& place_C, bool is_right, bool has_arm) {
  const std::vector<Eigen::Vector2d> joints = {
      {0, -.6},   {0, -.4},   {-.18, -.4}, {-.25, -.1}, {-.25, .15}, {.18, -.4},
      {.25, -.1}, {.25, .15}, {-.12, .1},  {-.12, .5},  {-.12, .9},  {.12, .1},
      {.12, .5},  {.12, .9},  {0, -.6},    {0, -.6},    {0, -.6},    {0, -.6}};
  std::vector<BodyKeypoint> keypoints;
  for (std::size_t j = 0; j < joints.size(); ++j) {
    const Eigen::Vector3d uvu =
        kCamera.ProjectStereo(place_C + Eigen::Vector3d(joints[j].x(), joints[j].y(), 0));
    const bool is_seen = has_arm || j < 2 || j > 4;
    keypoints.push_back({static_cast<float>(is_right ? uvu[2] + 0.25 : uvu[0]),
                         static_cast<float>(uvu[1] + (is_right ? 0.5 : 0)),
                         is_seen ? 0.75F + 0.01F * static_cast<float>(j) : 0.0F});
  }
  return keypoints;
}

using Detections = std::vector<std::vector<BodyKeypoint>>;

/// Two people, in another order in the right image; in the left one also somebody whom the right
/// one does not have, for all that is known a bush.
Detections People(int k, bool is_right) {
  const Eigen::Vector3d a(-0.75 + 0.03 * k, 0.125, 5), b(0.5, -0.125, 6.5 - 0.05 * k);
  if (is_right) return {Person(b, true, true), Person(a, true, false)};
  Detections left = {Person(a, false, false), Person(b, false, true)};
  if (k == 1) left.push_back(Person({1.75, 0, 7}, false, true));
  return left;
}

template <class Message>
Message WithHeader(int k) {
  return MessageOf<Message>({900000 + 100000 * k, kFirstSeq + k, kSession});
}

template <class Message>
void Send(const std::string& channel, const Message& message, Node* node) {
  ASSERT_EQ(Validate(message), "");
  const std::vector<std::uint8_t> bytes = Encode(message);
  node->Receive(channel, bytes.data(), bytes.size());
}

image_t ImageMessage(const cv::Mat& image, int k) {
  auto message = WithHeader<image_t>(k);
  message.width = image.cols;
  message.height = image.rows;
  message.encoding = image_t::ENCODING_RAW_BGR8;
  message.data.assign(image.datastart, image.dataend);
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  return message;
}

person_keypoints_t KeypointsMessage(const Detections& people, int k) {
  auto message = WithHeader<person_keypoints_t>(k);
  message.layout = person_keypoints_t::LAYOUT_COCO18;
  message.num_joints = 18;
  message.num_people = static_cast<std::int32_t>(people.size());
  for (const auto& person : people) {
    message.u_px.emplace_back();
    message.v_px.emplace_back();
    message.confidence.emplace_back();
    for (const BodyKeypoint& joint : person) {
      message.u_px.back().push_back(static_cast<float>(joint.u_px));
      message.v_px.back().push_back(static_cast<float>(joint.v_px));
      message.confidence.back().push_back(static_cast<float>(joint.confidence));
    }
  }
  return message;
}

std::vector<BodyKeypoints> Bodies(const Detections& people) {
  std::vector<BodyKeypoints> bodies;
  for (const auto& person : people) {
    BodyKeypoints body;
    for (std::size_t joint = 0; joint < body.size(); ++joint) {
      if (person[joint].confidence > 0) body[joint] = person[joint];
    }
    bodies.push_back(body);
  }
  return bodies;
}

void ExpectJoint(const human_observation_t& message, std::size_t i, const TriangulatedJoint& seen) {
  EXPECT_NEAR(message.u_left_px[i], seen.u_left_px, 1e-3);
  EXPECT_NEAR(message.u_right_px[i], seen.u_right_px, 1e-3);
  EXPECT_NEAR(message.v_left_px[i], seen.v_px, 1e-3);
  EXPECT_NEAR(message.v_right_px[i], seen.v_px, 1e-3);
  EXPECT_NEAR(message.sigma_px[i], seen.sigma_px, 1e-5);
  EXPECT_NEAR(message.x_C_m[i], seen.p_C.x(), 1e-5);
  EXPECT_NEAR(message.y_C_m[i], seen.p_C.y(), 1e-5);
  EXPECT_NEAR(message.z_C_m[i], seen.p_C.z(), 1e-5);
  const Eigen::Matrix3d& S = seen.covariance_C;
  const double packed[] = {S(0, 0), S(0, 1), S(0, 2), S(1, 1), S(1, 2), S(2, 2)};
  for (std::size_t j = 0; j < 6; ++j)
    EXPECT_NEAR(message.covariance_C[i][j], packed[j], 1e-6 * S.norm()) << j;
}

void ExpectHuman(const human_observation_t& message, const TrackedHuman& human) {
  EXPECT_EQ(message.track_id, human.id.value);
  std::size_t i = 0;
  for (std::size_t joint = 0; joint < human.joints.size(); ++joint) {
    if (!human.joints[joint]) continue;
    ASSERT_LT(i, message.joint_id.size());
    EXPECT_EQ(message.joint_id[i], static_cast<int>(joint));
    ExpectJoint(message, i++, *human.joints[joint]);
  }
  EXPECT_EQ(message.num_joints, static_cast<int>(i));
}

TEST(HumanTrackerValues, TheMessageIsWhatTheTrackerSays) {
  HumanTrackerNode node(HumanTrackerOptions{});
  // Whoever is seen from image 4 on has another number than anybody before could have.
  HumanTracker tracker(HumanTrackerOptions{}, HumanId{4001});
  auto calibration = WithHeader<stereo_calibration_t>(0);
  FromStereoCamera(kCamera, &calibration);
  Send(channel::kCalibration, calibration, &node);
  int num_without_arm = 0;
  for (int k = 0; k < 4; ++k) {
    SCOPED_TRACE(k);
    const cv::Mat left = Picture(3 * k), right = Picture(3 * k + 33);
    const Detections left_people = People(k, false), right_people = People(k, true);
    Send(channel::kCameraLeft, ImageMessage(left, k), &node);
    Send(channel::kCameraRight, ImageMessage(right, k), &node);
    Send(channel::kPersonKeypointsLeft, KeypointsMessage(left_people, k), &node);
    Send(channel::kPersonKeypointsRight, KeypointsMessage(right_people, k), &node);
    while (node.Step()) {
    }
    const std::vector<Envelope> output = node.TakeOutput();
    ASSERT_EQ(output.size(), 1u);
    human_observations_t message;
    ASSERT_TRUE(Decode(output[0].payload.data(), output[0].payload.size(), &message));
    const TrackedFrame tracked = tracker.Process(
        kCamera, {GreyOf(left), left, GreyOf(right), Bodies(left_people), Bodies(right_people)});
    EXPECT_EQ(message.utime, 900000 + 100000 * k);
    EXPECT_EQ(message.seq, kFirstSeq + k);
    EXPECT_EQ(message.session, kSession);
    EXPECT_EQ(message.num_detected_left, k == 1 ? 3 : 2);
    EXPECT_EQ(message.num_detected_right, 2);
    EXPECT_EQ(message.num_rejected, k == 1 ? 1 : 0);
    ASSERT_EQ(message.num_humans, 2);
    ASSERT_EQ(tracked.humans.size(), 2u);
    for (std::size_t i = 0; i < 2; ++i) {
      ExpectHuman(message.humans[i], tracked.humans[i]);
      num_without_arm += message.humans[i].num_joints < kNumJoints ? 1 : 0;
    }
  }
  EXPECT_GT(num_without_arm, 0) << "joints and places in the lists were the same";
}

}  // namespace
}  // namespace airdos
