#include "processes/optimizer/optimizer_node.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <iostream>
#include <memory>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "common/util/digest.h"
#include "common/util/error.h"
#include "processes/node/message/header.h"
#include "processes/optimizer/optimizer_messages.h"
#include "tests/support/synthetic_scene.h"

namespace airdos {
namespace {

// A unary plus before a message constant: lcm-gen declares them without a definition, and EXPECT_EQ
// takes references.
constexpr char kConfig[] = AIRDOS_SOURCE_DIR "/launch_scripts/config/optimizer.yaml";

std::unique_ptr<Node> MakeNode(const std::string& people,
                               const std::vector<std::string>& overrides = {}) {
  ConfigReader config = ConfigReader::FromFile(kConfig);
  for (const std::string& text : overrides) config.Override(text);
  config.Override("people.mode=" + people);
  std::unique_ptr<Node> node = MakeOptimizerNode(&config);
  config.Finish();
  return node;
}

SyntheticScene Scene(int num_frames) {
  SyntheticSceneOptions options;
  options.num_frames = num_frames;
  options.num_people = 2;
  options.max_static_per_frame = 80;
  return MakeSyntheticScene(options);
}

template <class Message>
Message WithHeader(const FrameInput& input) {
  return MessageOf<Message>(
      {static_cast<std::int64_t>(std::llround(input.time_s * 1e6)), input.id.value, 7});
}

static_features_t Features(const FrameInput& input) {
  auto message = WithHeader<static_features_t>(input);
  message.tracking_state = +static_features_t::STATE_TRACKING;
  FromSe3(*input.T_O_C, message.position_O_C, message.orientation_O_C);
  FromSe3(input.T_W_C.value_or(*input.T_O_C), message.position_W_C, message.orientation_W_C);
  message.sigma_position_m = 0.05;
  message.sigma_orientation_rad = 0.05;
  message.num_features = static_cast<std::int32_t>(input.features.size());
  for (const StaticObservation& feature : input.features) {
    message.landmark_id.push_back(feature.id.value);
    message.u_left_px.push_back(static_cast<float>(feature.uvu_px.x()));
    message.v_px.push_back(static_cast<float>(feature.uvu_px.y()));
    message.u_right_px.push_back(static_cast<float>(feature.uvu_px.z()));
    message.has_right.push_back(feature.has_right ? 1 : 0);
    message.sigma_px.push_back(static_cast<float>(feature.sigma_px));
  }
  return message;
}

human_observations_t Humans(const FrameInput& input, const StereoCamera& camera) {
  auto message = WithHeader<human_observations_t>(input);
  for (const HumanObservation& human : input.humans) {
    human_observation_t out{};
    out.track_id = human.id.value;
    for (const JointObservation& joint : human.joints) {
      const auto p_C = camera.Triangulate(joint.uvu_px.x(), joint.uvu_px.y(), joint.uvu_px.z());
      if (!p_C) continue;
      out.joint_id.push_back(static_cast<std::int8_t>(joint.joint));
      out.u_left_px.push_back(static_cast<float>(joint.uvu_px.x()));
      out.v_left_px.push_back(static_cast<float>(joint.uvu_px.y()));
      out.u_right_px.push_back(static_cast<float>(joint.uvu_px.z()));
      out.v_right_px.push_back(static_cast<float>(joint.uvu_px.y()));
      const double sigma_px = std::sqrt(joint.covariance_px2(0, 0));
      out.sigma_px.push_back(static_cast<float>(sigma_px));
      out.x_C_m.push_back(static_cast<float>(p_C->x()));
      out.y_C_m.push_back(static_cast<float>(p_C->y()));
      out.z_C_m.push_back(static_cast<float>(p_C->z()));
      const Eigen::Matrix3d S = camera.TriangulationCovariance(*p_C, sigma_px);
      std::vector<float> row;
      for (const auto& [i, j] :
           {std::pair<int, int>{0, 0}, {0, 1}, {0, 2}, {1, 1}, {1, 2}, {2, 2}}) {
        row.push_back(static_cast<float>(S(i, j)));
      }
      out.covariance_C.push_back(row);
      ++out.num_joints;
    }
    message.humans.push_back(out);
    ++message.num_humans;
  }
  return message;
}

template <class Message>
void Send(const char* channel, const Message& message, Node* node) {
  const std::vector<std::uint8_t> bytes = Encode(message);
  node->Receive(channel, bytes.data(), bytes.size());
}

void SendCalibration(const SyntheticScene& scene, Node* node) {
  auto message = WithHeader<stereo_calibration_t>(scene.frames.front());
  FromStereoCamera(scene.camera, &message);
  Send(channel::kCalibration, message, node);
}

void Drain(Node* node, std::vector<Envelope>* output) {
  while (node->Step()) {
  }
  for (Envelope& envelope : node->TakeOutput()) output->push_back(std::move(envelope));
}

std::vector<Envelope> RunNode(const SyntheticScene& scene, const std::string& people,
                              const std::vector<std::string>& overrides = {}) {
  const std::unique_ptr<Node> node = MakeNode(people, overrides);
  std::vector<Envelope> output;
  SendCalibration(scene, node.get());
  for (const FrameInput& input : scene.frames) {
    Send(channel::kStaticFeatures, Features(input), node.get());
    Send(channel::kHumanObservations, Humans(input, scene.camera), node.get());
    Drain(node.get(), &output);
  }
  return output;
}

template <class Message>
std::vector<Message> Take(const std::vector<Envelope>& output, const std::string& channel) {
  std::vector<Message> messages;
  for (const Envelope& envelope : output) {
    if (envelope.channel != channel) continue;
    Message message;
    EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
    messages.push_back(message);
  }
  return messages;
}

/// Each frame has its estimate, near where the camera was when the scene was made.
void ExpectCameraWithin(double most_m, const SyntheticScene& scene,
                        const std::vector<Envelope>& output) {
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), scene.frames.size());
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    EXPECT_EQ(estimates[i].seq, static_cast<std::int64_t>(i));
    const Se3 T_W_C = ToSe3(estimates[i].position_W_C, estimates[i].orientation_W_C);
    EXPECT_LT((T_W_C.translation - scene.T_W_C[i].translation).norm(), most_m) << i;
    EXPECT_LT(T_W_C.rotation.angularDistance(scene.T_W_C[i].rotation), 0.02) << i;
  }
}

// The same wrong bytes twice would be the same as well: so both runs are held against the scene.
TEST(OptimizerNodeTest, TwoRunsGiveTheSameBytes) {
  SyntheticSceneOptions weak;  // people count where the static scene is weak
  weak.num_frames = 16;
  weak.num_people = 6;
  weak.max_static_per_frame = 8;
  for (const SyntheticScene& scene : {Scene(14), MakeSyntheticScene(weak)}) {
    for (const std::string people : {"off", "on"}) {
      const std::vector<Envelope> a = RunNode(scene, people), b = RunNode(scene, people);
      ASSERT_EQ(a.size(), b.size());
      ExpectCameraWithin(scene.frames.size() == 14 ? 0.03 : 0.3, scene, a);
      Digest digest;
      for (std::size_t i = 0; i < a.size(); ++i) {
        EXPECT_EQ(a[i].channel, b[i].channel);
        EXPECT_EQ(a[i].payload, b[i].payload);
        digest.Add(a[i].payload.data(), a[i].payload.size());
      }
      std::cout << "people " << people << ": " << digest.Hex() << "\n";  // to compare processes by
    }
  }
}

TEST(OptimizerNodeTest, EachFrameGetsOneEstimateAndAWholeUpdate) {
  const SyntheticScene scene = Scene(14);
  const std::vector<Envelope> output = RunNode(scene, "on");
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), scene.frames.size());
  EXPECT_EQ(estimates.front().status, +state_estimate_t::STATUS_FIRST_FRAME);
  for (std::size_t i = 0; i < estimates.size(); ++i) {
    EXPECT_EQ(estimates[i].seq, static_cast<std::int64_t>(i));
    EXPECT_EQ(estimates[i].session, 7);
    const Se3 T_W_C = ToSe3(estimates[i].position_W_C, estimates[i].orientation_W_C);
    EXPECT_LT((T_W_C.translation - scene.T_W_C[i].translation).norm(), 0.03);
  }
  const auto updates = Take<map_update_t>(output, channel::kMapUpdate);
  std::set<std::int64_t> seqs;
  for (const map_update_t& update : updates) {
    EXPECT_EQ(update.num_parts, 1);
    EXPECT_TRUE(seqs.insert(update.seq).second);
    ASSERT_GT(update.num_frames, 0);
    EXPECT_EQ(update.frames.back().seq, update.seq);
    EXPECT_EQ(update.frames.back().utime, update.utime);
  }
  EXPECT_EQ(seqs.size(), scene.frames.size());
}

TEST(OptimizerNodeTest, WhatItSaysIsNeverRejected) {
  // One impossible person must not cost the reader the whole update.
  SyntheticSceneOptions options;
  options.num_people = 8;
  options.joint_sigma_px = 6;
  const SyntheticScene scene = MakeSyntheticScene(options);
  const std::vector<Envelope> output = RunNode(scene, "on");
  for (const auto& estimate : Take<state_estimate_t>(output, channel::kStateEstimate)) {
    EXPECT_EQ(Validate(estimate), "");
  }
  for (const map_update_t& update : Take<map_update_t>(output, channel::kMapUpdate)) {
    EXPECT_EQ(Validate(update), "");
    for (const human_state_t& human : update.humans) {
      for (const float length_m : human.length_m) EXPECT_GT(length_m, 0);
    }
  }
}

TEST(OptimizerNodeTest, LargeUpdatesAreSplit) {
  MapChanges changes;
  changes.frames.resize(12);
  for (std::int64_t i = 0; i < 9000; ++i) {
    changes.landmarks.push_back({LandmarkId{i}, Eigen::Vector3d::Zero(), 0.1, 2});
  }
  changes.removed.resize(3);
  const std::vector<map_update_t> parts = ToMapUpdates({1, 2, 3}, changes);
  int num_landmarks = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(parts[i].part, static_cast<int>(i));
    EXPECT_EQ(parts[i].num_parts, static_cast<int>(parts.size()));
    EXPECT_LT(parts[i].getEncodedSize(), 120000);
    num_landmarks += parts[i].num_landmarks;
  }
  EXPECT_EQ(parts.size(), 4U);
  EXPECT_EQ(num_landmarks, 9000);
  EXPECT_EQ(ToMapUpdates({1, 2, 3}, MapChanges()).size(), 1U);
}

TEST(OptimizerNodeTest, PartsDoNotOverlap) {
  MapChanges changes;
  std::vector<MapChanges::Landmark> repeated;
  for (std::int64_t i = 0; i < 12; ++i) changes.frames.push_back({FrameId{i}, 0, Se3()});
  for (std::int64_t i = 0; i < 3000; ++i) {
    changes.landmarks.push_back({LandmarkId{i}, Eigen::Vector3d::Zero(), 0.1, 2});
    changes.removed.push_back(LandmarkId{100000 + i});
    repeated.push_back({LandmarkId{200000 + i}, Eigen::Vector3d::Zero(), 0.1, 2});
  }
  for (std::int64_t i = 0; i < 100; ++i) {
    changes.humans.emplace_back();
    changes.humans.back().id = HumanId{i};
  }
  const std::vector<map_update_t> parts = ToMapUpdates({1, 2, 3}, changes, repeated);
  ASSERT_GT(parts.size(), 2U);
  std::vector<std::int64_t> said;
  for (const map_update_t& part : parts) {
    for (const frame_pose_t& frame : part.frames) said.push_back(300000 + frame.seq);
    for (const human_state_t& human : part.humans) said.push_back(400000 + human.track_id);
    for (const auto& ids : {part.landmark_id, part.removed_landmark_id, part.repeated_landmark_id})
      said.insert(said.end(), ids.begin(), ids.end());
  }
  EXPECT_EQ(said.size(), 12U + 3 * 3000U + 100U);
  EXPECT_EQ(std::set<std::int64_t>(said.begin(), said.end()).size(), said.size()) << "each once";
}

TEST(OptimizerNodeTest, AFrameWithoutFeaturesIsPredicted) {
  const SyntheticScene scene = Scene(12);
  const std::unique_ptr<Node> node = MakeNode("on");
  std::vector<Envelope> output;
  SendCalibration(scene, node.get());
  for (const FrameInput& input : scene.frames) {
    // Frames 6 and 7: the front end's message never comes; 8: the human tracker's.
    const std::int64_t k = input.id.value;
    if (k != 6 && k != 7) Send(channel::kStaticFeatures, Features(input), node.get());
    if (k != 8) Send(channel::kHumanObservations, Humans(input, scene.camera), node.get());
    Drain(node.get(), &output);
  }
  while (node->CompleteOldest()) {
  }
  Drain(node.get(), &output);
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), scene.frames.size());
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const Se3 T_W_C = ToSe3(estimates[k].position_W_C, estimates[k].orientation_W_C);
    EXPECT_LT((T_W_C.translation - scene.T_W_C[k].translation).norm(), 0.05) << k;
  }
  EXPECT_EQ(estimates[9].status, +state_estimate_t::STATUS_CONVERGED);
  EXPECT_EQ(node->frames().num_incomplete, 3);
}

TEST(OptimizerNodeTest, AFrontEndThatWasStartedAgainGoesOnInTheSameWorld) {
  const SyntheticScene scene = Scene(16);
  constexpr std::size_t kRestart = 8;
  const std::unique_ptr<Node> node = MakeNode("on");
  std::vector<Envelope> output;
  SendCalibration(scene, node.get());
  for (const FrameInput& input : scene.frames) {
    static_features_t features = Features(input);
    if (input.id.value >= static_cast<std::int64_t>(kRestart)) {
      const Se3 T_Onew_C = scene.frames[kRestart].T_O_C->inverse() * *input.T_O_C;
      FromSe3(T_Onew_C, features.position_O_C, features.orientation_O_C);
      FromSe3(T_Onew_C, features.position_W_C, features.orientation_W_C);
      features.odometry_start_seq = kRestart;
      for (std::int64_t& id : features.landmark_id) id += 1000000;
    }
    Send(channel::kStaticFeatures, features, node.get());
    Send(channel::kHumanObservations, Humans(input, scene.camera), node.get());
    Drain(node.get(), &output);
  }
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), scene.frames.size());
  for (std::size_t k = 0; k < estimates.size(); ++k) {
    const Se3 T_W_C = ToSe3(estimates[k].position_W_C, estimates[k].orientation_W_C);
    EXPECT_LT((T_W_C.translation - scene.T_W_C[k].translation).norm(), 0.05) << k;
  }
  EXPECT_EQ(estimates.back().status, +state_estimate_t::STATUS_CONVERGED);
}

TEST(OptimizerNodeTest, StartedAgainItGoesOnWhereTheFrontEndKnowsTheWorld) {
  const SyntheticScene scene = Scene(16);
  constexpr std::size_t kRestart = 6;
  const std::unique_ptr<Node> node = MakeNode("on");
  std::vector<Envelope> output;
  SendCalibration(scene, node.get());
  for (std::size_t k = kRestart; k < scene.frames.size(); ++k) {
    FrameInput input = scene.frames[k];
    input.T_W_C = scene.T_W_C[k];  // as earlier answers told it
    const Se3 T_other_O = Boxplus(Se3(), Vector6d::Constant(0.3));
    input.T_O_C = T_other_O * *input.T_O_C;
    // Of its first frame it hears the human tracker only.
    if (k > kRestart) Send(channel::kStaticFeatures, Features(input), node.get());
    Send(channel::kHumanObservations, Humans(input, scene.camera), node.get());
    Drain(node.get(), &output);
  }
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), scene.frames.size() - kRestart);
  EXPECT_EQ(estimates[0].status, +state_estimate_t::STATUS_INVALID);
  EXPECT_EQ(Validate(estimates[0]), "");
  EXPECT_EQ(estimates[1].status, +state_estimate_t::STATUS_FIRST_FRAME);
  for (std::size_t i = 1; i < estimates.size(); ++i) {
    const Se3 T_W_C = ToSe3(estimates[i].position_W_C, estimates[i].orientation_W_C);
    EXPECT_LT((T_W_C.translation - scene.T_W_C[kRestart + i].translation).norm(), 0.05) << i;
  }
  EXPECT_EQ(Take<map_update_t>(output, channel::kMapUpdate).size(), estimates.size());
}

// Found by fuzzing: two poses within the bounds of a message, and the way between them beyond.
TEST(OptimizerNodeTest, WhatIsBeyondAllBoundsIsNotSaid) {
  const SyntheticScene scene = Scene(4);
  const std::unique_ptr<Node> node = MakeNode("off");
  std::vector<Envelope> output;
  SendCalibration(scene, node.get());
  for (FrameInput input : scene.frames) {
    const std::int64_t k = input.id.value;
    input.features.clear();
    input.T_O_C->translation.x() = k == 0 ? -9e6 : 9e6;
    input.T_W_C = Se3();
    Send(channel::kStaticFeatures, Features(input), node.get());
    Drain(node.get(), &output);
  }
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), 4U);
  EXPECT_EQ(estimates[0].status, +state_estimate_t::STATUS_FIRST_FRAME);
  EXPECT_EQ(estimates[1].status, +state_estimate_t::STATUS_INVALID);
  EXPECT_EQ(estimates[2].status, +state_estimate_t::STATUS_FIRST_FRAME) << "where W was last";
  for (const state_estimate_t& estimate : estimates) EXPECT_EQ(Validate(estimate), "");
  EXPECT_EQ(Take<map_update_t>(output, channel::kMapUpdate).size(), 4U);
}

TEST(OptimizerNodeTest, EmptyFramesDoNotStopIt) {
  SyntheticScene scene = Scene(5);
  for (FrameInput& input : scene.frames) {
    input.features.clear();
    input.humans.clear();
  }
  // The front end's steps are passed on: as they are, or as smooth as its carrier moves, which for
  // this path makes some millimetres.
  for (const bool is_smooth : {false, true}) {
    const std::string smooth =
        std::string("camera_motion.use_acceleration=") + (is_smooth ? "true" : "false");
    const auto estimates =
        Take<state_estimate_t>(RunNode(scene, "on", {smooth}), channel::kStateEstimate);
    ASSERT_EQ(estimates.size(), 5U);
    EXPECT_EQ(estimates.front().status, +state_estimate_t::STATUS_FIRST_FRAME);
    EXPECT_EQ(estimates.back().status, +state_estimate_t::STATUS_PREDICTED);
    const Se3 T_W_C = ToSe3(estimates.back().position_W_C, estimates.back().orientation_W_C);
    EXPECT_LT(Boxminus(T_W_C, *scene.frames.back().T_O_C).norm(), is_smooth ? 0.005 : 1e-9);
  }
}

TEST(OptimizerNodeTest, ANewSessionStartsANewMap) {
  const SyntheticScene scene = Scene(4);
  const std::unique_ptr<Node> node = MakeNode("off");
  std::vector<Envelope> output;
  for (const std::int64_t session : {1, 2}) {
    auto calibration = WithHeader<stereo_calibration_t>(scene.frames.front());
    FromStereoCamera(scene.camera, &calibration);
    calibration.session = session;
    Send(channel::kCalibration, calibration, node.get());
    for (const FrameInput& input : scene.frames) {
      static_features_t features = Features(input);
      features.session = session;
      Send(channel::kStaticFeatures, features, node.get());
      Drain(node.get(), &output);
    }
  }
  const auto estimates = Take<state_estimate_t>(output, channel::kStateEstimate);
  ASSERT_EQ(estimates.size(), 8U);
  EXPECT_EQ(estimates[4].status, +state_estimate_t::STATUS_FIRST_FRAME);
}

TEST(OptimizerNodeTest, AnUnknownModeIsNamed) {
  try {
    MakeNode("sometimes");
    FAIL();
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("people.mode"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("sometimes"), std::string::npos);
  }
}

}  // namespace
}  // namespace airdos
