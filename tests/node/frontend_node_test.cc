#include "processes/frontend/frontend_node.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

#include "tests/node/frontend_walk.h"

namespace airdos {
namespace {

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

TEST(FrontendNode, StartedInMidSessionItReusesNoLandmarkAndSaysWhereItsOdometryStarts) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 3; k < 6; ++k) SendFrame(k, &node);
  std::vector<static_features_t> output = StepAll(&node);
  if (node.CompleteOldest()) output = Take(&node);  // nobody knows that frame 2 will not come
  ASSERT_FALSE(output.empty());
  EXPECT_EQ(output.back().odometry_start_seq, 3);
  ASSERT_GT(output.back().num_features, 0);
  EXPECT_GT(output.back().landmark_id.front(), 3000000);
  EXPECT_LT(output.back().landmark_id.back(), 6000000);
}

TEST(FrontendNode, FramesWaitForTheCalibration) {
  FrontendNode node(WithoutFeedback());
  SendFrame(0, &node);
  EXPECT_FALSE(node.Step());
  EXPECT_EQ(node.waiting_for(), channel::kCalibration);
  Send(channel::kCalibration, Calibration(), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
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
      Se3 T_W_C = ToSe3(features.position_O_C, features.orientation_O_C);
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
  Stream humans;
  Stream keypoints;
  for (int k = 0; k < kNumFrames; ++k) {
    left.push_back(Wrap(channel::kCameraLeft, Left(k)));
    if (k != 3) right.push_back(Wrap(channel::kCameraRight, Right(k)));  // one is lost
    mask.push_back(Wrap(channel::kPersonMask, Mask(k, 10 * k, 10 * k + 60)));
    human_observations_t people = NoHumans(k);
    people.num_humans = 1;
    people.humans = {Human(3, {0.1 * k, 0, 4}, k)};
    if (k != 4) humans.push_back(Wrap(channel::kHumanObservations, people));
    keypoints.push_back(
        Wrap(channel::kPersonKeypointsLeft, Keypoints(k, {150 + 5 * k, 50, 20, 40}, 0.9F)));
  }
  const Stream calibration = {Wrap(channel::kCalibration, Calibration())};
  const auto expected = Outputs({calibration, left, right, mask, humans, keypoints}, 1, true);
  ASSERT_EQ(expected.size(), static_cast<std::size_t>(kNumFrames));
  for (int k = 0; k < kNumFrames; ++k) {
    static_features_t features;
    const auto& bytes = expected[static_cast<std::size_t>(k)];
    ASSERT_TRUE(Decode(bytes.data(), bytes.size(), &features));
    EXPECT_EQ(features.seq, k);
    EXPECT_GT(features.num_features, 50) << k;
    // Frame 3 has no right image.
    const bool has_right = std::count(features.has_right.begin(), features.has_right.end(), 1) > 0;
    EXPECT_EQ(has_right, k != 3) << k;
  }
  EXPECT_EQ(Outputs({keypoints, mask, right, left, calibration, humans}, 1, true), expected);
  EXPECT_EQ(Outputs({humans, right, keypoints, calibration, mask, left}, 2, true), expected);
  EXPECT_EQ(Outputs({left, mask, right, calibration, humans, keypoints}, 100, true), expected);
  EXPECT_EQ(Outputs({calibration, left, right, mask, humans, keypoints}, 1, false), expected);
  EXPECT_EQ(Outputs({keypoints, mask, left, right, calibration, humans}, 100, false), expected);
}

}  // namespace
}  // namespace airdos
