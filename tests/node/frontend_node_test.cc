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
  EXPECT_EQ(a.motion.linear_start_m_s2, b.motion.linear_start_m_s2);
  EXPECT_EQ(a.motion.linear_floor_m_s2, b.motion.linear_floor_m_s2);
  EXPECT_EQ(a.motion.linear_ceiling_m_s2, b.motion.linear_ceiling_m_s2);
  EXPECT_EQ(a.motion.angular_start_rad_s2, b.motion.angular_start_rad_s2);
  EXPECT_EQ(a.motion.angular_floor_rad_s2, b.motion.angular_floor_rad_s2);
  EXPECT_EQ(a.motion.angular_ceiling_rad_s2, b.motion.angular_ceiling_rad_s2);
  EXPECT_EQ(a.motion.initial_speed_m_s, b.motion.initial_speed_m_s);
  EXPECT_EQ(a.motion.initial_turn_rad_s, b.motion.initial_turn_rad_s);
  EXPECT_EQ(a.motion.memory_s, b.motion.memory_s);
  EXPECT_EQ(a.people.acceleration_m_s2, b.people.acceleration_m_s2);
  EXPECT_EQ(a.people.initial_speed_m_s, b.people.initial_speed_m_s);
  EXPECT_EQ(a.people.wobble_m, b.people.wobble_m);
  EXPECT_EQ(a.people.max_joint_sigmas, b.people.max_joint_sigmas);
  EXPECT_EQ(a.people.max_missed_frames, b.people.max_missed_frames);
  EXPECT_EQ(a.people.min_seen_frames, b.people.min_seen_frames);
  EXPECT_EQ(a.max_static_for_people, b.max_static_for_people);
  EXPECT_EQ(options.use_people, defaults.use_people);
  EXPECT_EQ(options.min_keypoint_confidence, defaults.min_keypoint_confidence);
}

}  // namespace
}  // namespace airdos
