#include "processes/frontend/frontend_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <string>
#include <utility>
#include <vector>

#include "airdos/stereo_calibration_t.hpp"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

constexpr std::int64_t kSession = 7;
// Copies, because the generated constants have no address for EXPECT_EQ to take.
constexpr int kInitializing = static_features_t::STATE_INITIALIZING;
constexpr int kTracking = static_features_t::STATE_TRACKING;
constexpr int kCoasting = static_features_t::STATE_COASTING;
const StereoCamera kCamera = SmallStereoCamera();

/// Each is rendered once, when a test first asks for it.
const StereoPair& Walk(int k) {
  static std::map<int, StereoPair> pairs;
  if (pairs.count(k) == 0) pairs[k] = RenderedScene(11).Render(kCamera, SwayingPath(k));
  return pairs.at(k);
}

Se3 Truth(int k) { return SwayingPath(0).inverse() * SwayingPath(k); }

template <class Message>
Message WithHeader(std::int64_t seq, std::int64_t session = kSession) {
  Message message{};
  message.utime = 5'000'000 + 100'000 * seq;
  message.seq = seq;
  message.session = session;
  return message;
}

image_t ImageOf(const cv::Mat& image, std::int64_t seq, std::int64_t session = kSession) {
  image_t message = WithHeader<image_t>(seq, session);
  message.width = image.cols;
  message.height = image.rows;
  message.encoding = image_t::ENCODING_RAW_GRAY8;
  message.data.assign(image.datastart, image.dataend);
  message.num_bytes = static_cast<std::int32_t>(message.data.size());
  return message;
}

image_t Left(int seq, std::int64_t session = kSession) {
  return ImageOf(Walk(seq).left, seq, session);
}
image_t Right(int seq, std::int64_t session = kSession) {
  return ImageOf(Walk(seq).right, seq, session);
}

stereo_calibration_t Calibration(std::int64_t session = kSession) {
  stereo_calibration_t message = WithHeader<stereo_calibration_t>(0, session);
  FromStereoCamera(kCamera, &message);
  return message;
}

person_mask_t NoMask(std::int64_t seq, std::int64_t session = kSession) {
  person_mask_t message = WithHeader<person_mask_t>(seq, session);
  message.encoding = person_mask_t::ENCODING_NONE;
  return message;
}

/// A person fills the columns [begin, end).
person_mask_t Mask(std::int64_t seq, int begin_px, int end_px, cv::Size size) {
  cv::Mat mask(size, CV_8UC1, cv::Scalar(0));
  mask.colRange(begin_px, end_px) = cv::Scalar(255);
  person_mask_t message = WithHeader<person_mask_t>(seq);
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

/// The optimizer's word on one frame; it changes nothing.
map_update_t Update(std::int64_t seq, std::int64_t session = kSession) {
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

template <class Message>
void Send(const std::string& channel, const Message& message, Node* node) {
  const std::vector<std::uint8_t> bytes = Encode(message);
  node->Receive(channel, bytes.data(), bytes.size());
}

void SendFrame(int seq, Node* node, std::int64_t session = kSession) {
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

/// Works until nothing is ready.
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

TEST(FrontendNode, OneOutputForEachFrame) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 5; ++k) {
    SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u) << "frame " << k;
    EXPECT_EQ(output[0].seq, k);
    EXPECT_EQ(output[0].utime, 5'000'000 + 100'000 * k);
    EXPECT_EQ(output[0].session, kSession);
    EXPECT_EQ(output[0].tracking_state, k == 0 ? kInitializing : kTracking);
    // The bound of visual_odometry_test.
    EXPECT_LT(PositionError_m(output[0], Truth(k)), 0.015);
    EXPECT_GT(output[0].num_features, 60);
    EXPECT_EQ(output[0].num_masked, 0);
  }
  EXPECT_EQ(node.frames().num_done, 5);
  EXPECT_EQ(node.frames().num_incomplete, 0);
  EXPECT_EQ(node.num_pending(), 0u);
}

TEST(FrontendNode, FramesWaitForTheCalibration) {
  FrontendNode node(WithoutFeedback());
  SendFrame(0, &node);
  EXPECT_FALSE(node.Step());
  EXPECT_EQ(node.waiting_for(), channel::kCalibration);
  Send(channel::kCalibration, Calibration(), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
}

TEST(FrontendNode, WaitsForTheUpdateOfTwoFramesBack) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 5; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  Send(channel::kMapUpdate, Update(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  // Update 1 never comes: that of a later frame says so.
  Send(channel::kMapUpdate, Update(2), &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  EXPECT_EQ(node.waiting_for(), "");
}

TEST(FrontendNode, AnUpdateInPartsCountsOnceItIsWhole) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  map_update_t part = Update(0);
  part.num_parts = 2;
  part.part = 1;
  Send(channel::kMapUpdate, part, &node);
  EXPECT_FALSE(node.Step());
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  part.part = 0;
  Send(channel::kMapUpdate, part, &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
}

TEST(FrontendNode, WithoutAnUpdateItGoesOnAndWaitsAgainOnceOneComes) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 8; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  ASSERT_TRUE(node.CompleteOldest());
  const std::vector<static_features_t> completed = Take(&node);
  ASSERT_EQ(completed.size(), 1u);
  EXPECT_EQ(completed[0].tracking_state, kTracking);
  // The optimizer is silent: the next ones do not wait for it.
  ASSERT_TRUE(node.Step());
  ASSERT_TRUE(node.Step());
  EXPECT_EQ(Take(&node).back().seq, 4);
  // It is back, with frame 4: frames 5 and 6 may start, and 7 waits for frame 5.
  Send(channel::kMapUpdate, Update(4), &node);
  EXPECT_EQ(StepAll(&node).back().seq, 6);
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  EXPECT_EQ(node.frames().num_done, 7);
}

TEST(FrontendNode, UpdatesThatDoNotBelongHereAreRejected) {
  FrontendNode node(FrontendOptions{});
  const auto num_rejected = [&node] {
    return node.channels().at(channel::kMapUpdate).num_rejected;
  };
  Send(channel::kMapUpdate, Update(0), &node);  // before any frame
  EXPECT_EQ(num_rejected(), 1);
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  Send(channel::kMapUpdate, Update(1, kSession + 1), &node);
  EXPECT_EQ(num_rejected(), 2);
  EXPECT_EQ(node.channels().at(channel::kMapUpdate).last_reject, "of another session");
  Send(channel::kMapUpdate, Update(2), &node);  // of a frame that has no output yet
  EXPECT_EQ(num_rejected(), 3);
  EXPECT_FALSE(node.Step());
  Send(channel::kMapUpdate, Update(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  Send(channel::kMapUpdate, Update(0), &node);  // again, and too late
  EXPECT_EQ(num_rejected(), 4);
}

TEST(FrontendNode, TheOptimizersPosesAreTakenOverAtTheLag) {
  Se3 T_new_old;
  T_new_old.translation = {0.3, -0.2, 0.1};
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 6; ++k) {
    SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    // Update 0 is in force from frame 2 on, though it was there before frame 1.
    EXPECT_LT(PositionError_m(output[0], k < 2 ? Truth(k) : T_new_old * Truth(k)), 0.015)
        << "frame " << k;
    map_update_t update = Update(k);
    if (k == 0) AddFrame(0, T_new_old * Truth(0), &update);
    Send(channel::kMapUpdate, update, &node);
  }
}

TEST(FrontendNode, LandmarksThatTheOptimizerRemovedAreNotSeenAgain) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  std::vector<std::int64_t> removed;
  for (int k = 0; k < 5; ++k) {
    SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    map_update_t update = Update(k);
    if (k == 0) {
      for (const std::int64_t id : output[0].landmark_id) {
        if (id % 2 == 0) removed.push_back(id);
      }
      update.removed_landmark_id = removed;
      update.num_removed = static_cast<std::int32_t>(removed.size());
    }
    Send(channel::kMapUpdate, update, &node);
    int num_seen = 0;
    for (const std::int64_t id : output[0].landmark_id) {
      num_seen += std::find(removed.begin(), removed.end(), id) != removed.end() ? 1 : 0;
    }
    EXPECT_EQ(num_seen > 0, k < 2) << "frame " << k;
  }
}

TEST(FrontendNode, AFrameWithoutItsRightImageCoasts) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 5; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 5u);
  Send(channel::kCameraLeft, Left(5), &node);
  Send(channel::kPersonMask, NoMask(5), &node);
  EXPECT_FALSE(node.Step());
  EXPECT_EQ(node.waiting_for(), channel::kCameraRight);
  SendFrame(6, &node);  // which tells that the right image of frame 5 is lost
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 2u);
  EXPECT_EQ(output[0].seq, 5);
  EXPECT_EQ(output[0].tracking_state, kCoasting);
  EXPECT_EQ(output[0].num_features, 0);
  EXPECT_LT(PositionError_m(output[0], Truth(5)), 0.03);
  EXPECT_EQ(output[1].tracking_state, kTracking);
  EXPECT_LT(PositionError_m(output[1], Truth(6)), 0.015);
  EXPECT_EQ(node.channels().at(channel::kCameraRight).num_missing, 1);
  EXPECT_EQ(node.frames().num_incomplete, 1);
}

TEST(FrontendNode, FeaturesOnPeopleAndAroundThemAreLeftOut) {
  constexpr int kBegin_px = 100;
  constexpr int kEnd_px = 200;
  FrontendOptions options = WithoutFeedback();
  options.mask_dilation_px = 12;
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) {
    Send(channel::kCameraLeft, Left(k), &node);
    Send(channel::kCameraRight, Right(k), &node);
    Send(channel::kPersonMask, Mask(k, kBegin_px, kEnd_px), &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    EXPECT_GT(output[0].num_masked, 20);
    EXPECT_GT(output[0].num_features, 30);
    for (const float u_px : output[0].u_left_px) {
      // Half a pixel: coordinates are those of the pixel's centre.
      EXPECT_TRUE(u_px < kBegin_px - 12 - 0.5 || u_px > kEnd_px - 1 + 12 + 0.5) << u_px;
    }
  }
}

TEST(FrontendNode, AFrameWhoseMaskIsMissingIsTrackedWithoutIt) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) {
    Send(channel::kCameraLeft, Left(k), &node);
    Send(channel::kCameraRight, Right(k), &node);
    if (k != 2) Send(channel::kPersonMask, Mask(k, 0, 150), &node);
  }
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 4u);
  EXPECT_GT(output[1].num_masked, 0);
  EXPECT_EQ(output[2].num_masked, 0);
  EXPECT_EQ(output[2].tracking_state, kTracking);
  EXPECT_GT(output[3].num_masked, 0);
  EXPECT_EQ(node.channels().at(channel::kPersonMask).num_missing, 1);
}

TEST(FrontendNode, AMaskOfAnotherSizeIsRejectedAndTheFrameTracked) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  SendFrame(0, &node);
  Send(channel::kCameraLeft, Left(1), &node);
  Send(channel::kCameraRight, Right(1), &node);
  Send(channel::kPersonMask, Mask(1, 0, 20, {40, 30}), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 2u);
  EXPECT_EQ(output[1].tracking_state, kTracking);
  EXPECT_EQ(output[1].num_masked, 0);
  EXPECT_EQ(node.channels().at(channel::kPersonMask).num_rejected, 1);
}

TEST(FrontendNode, WithoutMasksTheChannelIsNotRead) {
  FrontendOptions options = WithoutFeedback();
  options.use_masks = false;
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  Send(channel::kCameraLeft, Left(0), &node);
  Send(channel::kCameraRight, Right(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  EXPECT_EQ(node.channels().count(channel::kPersonMask), 0u);
}

TEST(FrontendNode, ACorruptJpegIsCountedAndTheFrameCoasts) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 4u);
  image_t corrupt = Left(4);
  corrupt.encoding = image_t::ENCODING_JPEG;
  corrupt.data.assign(500, 0x5a);
  corrupt.num_bytes = 500;
  Send(channel::kCameraLeft, corrupt, &node);
  Send(channel::kCameraRight, Right(4), &node);
  Send(channel::kPersonMask, NoMask(4), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 1u);
  EXPECT_EQ(output[0].tracking_state, kCoasting);
  EXPECT_EQ(node.channels().at(channel::kCameraLeft).num_rejected, 1);
  EXPECT_EQ(node.channels().at(channel::kCameraLeft).last_reject, "the image does not decode");
  EXPECT_EQ(node.channels().at(channel::kCameraRight).num_rejected, 0);
}

TEST(FrontendNode, AnImageOfAnotherSizeIsCountedAndTheFrameCoasts) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  SendFrame(0, &node);
  Send(channel::kCameraLeft, Left(1), &node);
  Send(channel::kCameraRight, ImageOf(cv::Mat(40, 60, CV_8UC1, cv::Scalar(9)), 1), &node);
  Send(channel::kPersonMask, NoMask(1), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 2u);
  EXPECT_EQ(output[1].tracking_state, kCoasting);
  EXPECT_EQ(node.channels().at(channel::kCameraRight).num_rejected, 1);
}

TEST(FrontendNode, ANewSessionStartsAfresh) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  Send(channel::kMapUpdate, Update(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);

  // As if the node had been started now, with the same payloads.
  FrontendNode fresh(FrontendOptions{});
  for (FrontendNode* either : {&node, &fresh}) {
    Send(channel::kCalibration, Calibration(kSession + 1), either);
    for (int k = 3; k < 5; ++k) SendFrame(k, either, kSession + 1);
  }
  const std::vector<static_features_t> output = StepAll(&node);
  const std::vector<static_features_t> expected = StepAll(&fresh);
  ASSERT_EQ(output.size(), 2u);  // neither waits for the feedback of the session before
  ASSERT_EQ(expected.size(), 2u);
  EXPECT_EQ(output[0].tracking_state, kInitializing);
  EXPECT_LT(PositionError_m(output[0], Se3()), 1e-12);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(Encode(output[i]), Encode(expected[i]));
}

/// All messages of a channel in their order.
using Stream = std::vector<Envelope>;

template <class Message>
Envelope Wrap(const char* channel, const Message& message) {
  return {channel, Encode(message)};
}

/// Hands in the streams one after the other, `chunk` messages at a time, and the optimizer's
/// answers as soon as they can be (`eager`) or when the node waits for them.
std::vector<std::vector<std::uint8_t>> Outputs(const std::vector<Stream>& streams,
                                               std::size_t chunk, bool eager) {
  FrontendNode node(FrontendOptions{});
  std::vector<std::vector<std::uint8_t>> outputs;
  std::size_t num_answered = 0;
  const auto work = [&] {
    bool has_worked = true;
    while (has_worked) {
      has_worked = node.Step();
      for (Envelope& envelope : node.TakeOutput()) outputs.push_back(std::move(envelope.payload));
      if (num_answered == outputs.size() || (!eager && has_worked)) continue;
      if (!eager && node.waiting_for().find(channel::kMapUpdate) == std::string::npos) continue;
      static_features_t features;
      const auto& bytes = outputs[num_answered++];
      EXPECT_TRUE(Decode(bytes.data(), bytes.size(), &features));
      map_update_t update = Update(features.seq);
      Se3 T_W_C = ToSe3(features.position_W_C, features.orientation_W_C);
      T_W_C.translation.x() += 0.002;
      AddFrame(features.seq, T_W_C, &update);
      Send(channel::kMapUpdate, update, &node);
      has_worked = true;
    }
  };
  std::vector<std::size_t> next(streams.size(), 0);
  for (bool is_more = true; is_more;) {
    is_more = false;
    for (std::size_t i = 0; i < streams.size(); ++i) {
      for (std::size_t n = 0; n < chunk && next[i] < streams[i].size(); ++n) {
        const Envelope& envelope = streams[i][next[i]++];
        node.Receive(envelope.channel, envelope.payload.data(), envelope.payload.size());
        work();
        is_more = true;
      }
    }
  }
  return outputs;
}

TEST(FrontendNode, TheOrderInWhichChannelsArriveDoesNotMatter) {
  constexpr int kNumFrames = 6;
  Stream left;
  Stream right;
  Stream mask;
  for (int k = 0; k < kNumFrames; ++k) {
    left.push_back(Wrap(channel::kCameraLeft, Left(k)));
    if (k != 3) right.push_back(Wrap(channel::kCameraRight, Right(k)));  // one is lost
    mask.push_back(Wrap(channel::kPersonMask, Mask(k, 10 * k, 10 * k + 60)));
  }
  const Stream calibration = {Wrap(channel::kCalibration, Calibration())};
  const auto expected = Outputs({calibration, left, right, mask}, 1, true);
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(kNumFrames));
  EXPECT_EQ(Outputs({mask, right, left, calibration}, 1, true), expected);
  EXPECT_EQ(Outputs({right, calibration, mask, left}, 2, true), expected);
  EXPECT_EQ(Outputs({left, mask, right, calibration}, 100, true), expected);
  EXPECT_EQ(Outputs({calibration, left, right, mask}, 1, false), expected);
  EXPECT_EQ(Outputs({mask, left, right, calibration}, 100, false), expected);
}

TEST(FrontendNode, PngAndRawGiveTheSameBytes) {
  FrontendNode raw(WithoutFeedback());
  FrontendNode png(WithoutFeedback());
  for (FrontendNode* node : {&raw, &png}) Send(channel::kCalibration, Calibration(), node);
  for (int k = 0; k < 2; ++k) {
    SendFrame(k, &raw);
    for (const auto& [channel, image] :
         {std::pair{channel::kCameraLeft, Walk(k).left}, {channel::kCameraRight, Walk(k).right}}) {
      image_t message = ImageOf(image, k);
      message.encoding = image_t::ENCODING_PNG;
      cv::imencode(".png", image, message.data);
      message.num_bytes = static_cast<std::int32_t>(message.data.size());
      Send(channel, message, &png);
    }
    Send(channel::kPersonMask, NoMask(k), &png);
  }
  const std::vector<static_features_t> a = StepAll(&raw);
  const std::vector<static_features_t> b = StepAll(&png);
  ASSERT_EQ(a.size(), 2u);
  ASSERT_EQ(b.size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(Encode(a[i]), Encode(b[i]));
}

TEST(FrontendOptions, TheFileHasEveryKeyAndTheDefaults) {
  ConfigReader config = ConfigReader::FromFile(std::string(AIRDOS_SOURCE_DIR) +
                                               "/launch_scripts/config/frontend.yaml");
  const FrontendOptions options = ReadFrontendOptions(&config);
  config.Finish();
  const FrontendOptions defaults;
  EXPECT_EQ(options.use_masks, defaults.use_masks);
  EXPECT_EQ(options.mask_dilation_px, defaults.mask_dilation_px);
  EXPECT_EQ(options.feedback_lag, defaults.feedback_lag);
  const VisualOdometryOptions& a = options.odometry;
  const VisualOdometryOptions& b = defaults.odometry;
  EXPECT_EQ(a.extractor.num_levels, b.extractor.num_levels);
  EXPECT_EQ(a.extractor.fast_threshold, b.extractor.fast_threshold);
  EXPECT_EQ(a.extractor.cell_size_px, b.extractor.cell_size_px);
  EXPECT_EQ(a.extractor.max_features_per_cell, b.extractor.max_features_per_cell);
  EXPECT_EQ(a.stereo.min_depth_m, b.stereo.min_depth_m);
  EXPECT_EQ(a.stereo.min_disparity_px, b.stereo.min_disparity_px);
  EXPECT_EQ(a.stereo.max_hamming, b.stereo.max_hamming);
  EXPECT_EQ(a.stereo.max_row_error_px, b.stereo.max_row_error_px);
  EXPECT_EQ(a.stereo.min_correlation, b.stereo.min_correlation);
  EXPECT_EQ(a.map.max_landmarks, b.map.max_landmarks);
  EXPECT_EQ(a.map.max_frames_unconfirmed, b.map.max_frames_unconfirmed);
  EXPECT_EQ(a.map.min_found_ratio, b.map.min_found_ratio);
  EXPECT_EQ(a.wide_radius_px, b.wide_radius_px);
  EXPECT_EQ(a.wide_max_hamming, b.wide_max_hamming);
  EXPECT_EQ(a.narrow_max_hamming, b.narrow_max_hamming);
  EXPECT_EQ(a.min_inliers_tracking, b.min_inliers_tracking);
  EXPECT_EQ(a.min_inliers_weak, b.min_inliers_weak);
  EXPECT_EQ(a.min_correlation, b.min_correlation);
  EXPECT_EQ(a.aligned_sigma_px, b.aligned_sigma_px);
  EXPECT_EQ(a.corner_sigma_px, b.corner_sigma_px);
  EXPECT_EQ(a.max_observations, b.max_observations);
  EXPECT_EQ(a.observation_cell_px, b.observation_cell_px);
  EXPECT_EQ(a.prior_min_sigma_position_m, b.prior_min_sigma_position_m);
  EXPECT_EQ(a.prior_max_sigma_position_m, b.prior_max_sigma_position_m);
  EXPECT_EQ(a.prior_min_sigma_orientation_rad, b.prior_min_sigma_orientation_rad);
  EXPECT_EQ(a.prior_max_sigma_orientation_rad, b.prior_max_sigma_orientation_rad);
}

}  // namespace
}  // namespace airdos
