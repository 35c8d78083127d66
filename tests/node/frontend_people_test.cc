#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "processes/frontend/frontend_node.h"
#include "tests/node/frontend_walk.h"

// What the frontend makes of HUMAN_OBSERVATIONS and PERSON_KEYPOINTS_LEFT.

namespace airdos {
namespace {

const cv::Rect kTrunk_px(140, 60, 30, 60);

/// Both images and a message on each channel of people.
void SendAll(int k, const person_mask_t& mask, const human_observations_t& humans,
             const person_keypoints_t& keypoints, Node* node) {
  Send(channel::kCameraLeft, Left(k), node);
  Send(channel::kCameraRight, Right(k), node);
  Send(channel::kPersonMask, mask, node);
  Send(channel::kHumanObservations, humans, node);
  Send(channel::kPersonKeypointsLeft, keypoints, node);
}

TEST(FrontendPeople, AFrameWaitsForThemIfTheyAreUsed) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  Send(channel::kCameraLeft, Left(0), &node);
  Send(channel::kCameraRight, Right(0), &node);
  Send(channel::kPersonMask, NoMask(0), &node);
  EXPECT_FALSE(node.Step());
  EXPECT_NE(node.waiting_for().find(channel::kHumanObservations), std::string::npos);
  EXPECT_NE(node.waiting_for().find(channel::kPersonKeypointsLeft), std::string::npos);
  Send(channel::kHumanObservations, NoHumans(0), &node);
  EXPECT_FALSE(node.Step());
  Send(channel::kPersonKeypointsLeft, NoKeypoints(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
}

TEST(FrontendPeople, WithoutThemTheirChannelsAreNotRead) {
  FrontendOptions options = WithoutFeedback();
  options.use_people = false;
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  Send(channel::kCameraLeft, Left(0), &node);
  Send(channel::kCameraRight, Right(0), &node);
  Send(channel::kPersonMask, NoMask(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  EXPECT_EQ(node.channels().count(channel::kHumanObservations), 0u);
  EXPECT_EQ(node.channels().count(channel::kPersonKeypointsLeft), 0u);
}

TEST(FrontendPeople, AFrameWithoutTheirMessagesIsTrackedWithoutThem) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) {
    Send(channel::kCameraLeft, Left(k), &node);
    Send(channel::kCameraRight, Right(k), &node);
    Send(channel::kPersonMask, NoMask(k), &node);
    if (k != 2) SendNobody(k, &node);
  }
  const std::vector<static_features_t> output = StepAll(&node);
  ASSERT_EQ(output.size(), 4u);
  EXPECT_EQ(output[2].tracking_state, kTracking);
  EXPECT_EQ(node.channels().at(channel::kHumanObservations).num_missing, 1);
  EXPECT_EQ(node.channels().at(channel::kPersonKeypointsLeft).num_missing, 1);
}

/// Features of a frame on the trunk, with what masks there are.
struct OnTrunk {
  int num_features = 0;
  int num_masked = 0;
};
OnTrunk FeaturesOnTrunk(const FrontendOptions& options, const person_mask_t& mask,
                        float confidence) {
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  SendAll(0, mask, NoHumans(0), Keypoints(0, kTrunk_px, confidence), &node);
  const std::vector<static_features_t> output = StepAll(&node);
  EXPECT_EQ(output.size(), 1u);
  OnTrunk counts;
  for (std::size_t i = 0; i < output.at(0).u_left_px.size(); ++i) {
    const cv::Point2f place(output[0].u_left_px[i], output[0].v_px[i]);
    counts.num_features += cv::Rect2f(kTrunk_px).contains(place) ? 1 : 0;
  }
  counts.num_masked = output[0].num_masked;
  return counts;
}

TEST(FrontendPeople, WithoutAMaskTheirKeypointsSayWhereTheyAre) {
  const FrontendOptions options = WithoutFeedback();
  const OnTrunk drawn = FeaturesOnTrunk(options, NoMask(0), 0.9F);
  EXPECT_EQ(drawn.num_features, 0);
  EXPECT_GT(drawn.num_masked, 10);
  // Nor with masks.use=false, whatever the mask says.
  FrontendOptions without_masks = options;
  without_masks.use_masks = false;
  EXPECT_EQ(FeaturesOnTrunk(without_masks, Mask(0, 0, 320), 0.9F).num_features, 0);
  // Keypoints that are not believed mark nothing, and there are features to be had.
  const auto unsure = static_cast<float>(0.5 * options.min_keypoint_confidence);
  const OnTrunk believed = FeaturesOnTrunk(options, NoMask(0), unsure);
  EXPECT_GT(believed.num_features, 3);
  EXPECT_EQ(believed.num_masked, 0);
}

TEST(FrontendPeople, AMaskIsBelievedAndNotTheKeypoints) {
  // It marks somebody else: what is on the trunk is kept.
  const OnTrunk counts = FeaturesOnTrunk(WithoutFeedback(), Mask(0, 0, 60), 0.9F);
  EXPECT_GT(counts.num_features, 3);
  EXPECT_GT(counts.num_masked, 10);
}

TEST(FrontendPeople, NotUsedTheirKeypointsMarkNothing) {
  FrontendOptions options = WithoutFeedback();
  options.use_people = false;
  const OnTrunk counts = FeaturesOnTrunk(options, NoMask(0), 0.9F);
  EXPECT_GT(counts.num_features, 3);
  EXPECT_EQ(counts.num_masked, 0);
}

/// Frames 0..7 see everything, from frame 8 on a mask hides it all. Two people stand in the room;
/// `spoil` is called for each message about them.
template <class Spoil>
std::vector<static_features_t> RunHidden(const FrontendOptions& options, Spoil spoil) {
  FrontendNode node(options);
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 16; ++k) {
    human_observations_t humans = NoHumans(k);
    humans.humans = {Human(1, {-1, 0.1, 4}, k), Human(2, {1, 0, 5}, k)};
    humans.num_humans = 2;
    spoil(k, &humans);
    SendAll(k, k < 8 ? NoMask(k) : Mask(k, 0, 320), humans, NoKeypoints(k), &node);
  }
  return StepAll(&node);
}

std::vector<std::vector<std::uint8_t>> Bytes(const std::vector<static_features_t>& messages) {
  std::vector<std::vector<std::uint8_t>> bytes;
  for (const static_features_t& message : messages) bytes.push_back(Encode(message));
  return bytes;
}

const auto kNothingSpoiled = [](int, human_observations_t*) {};

TEST(FrontendPeople, TheyTellWhereTheCameraIsWhenNothingElseDoes) {
  FrontendOptions options = WithoutFeedback();
  const auto with = RunHidden(options, kNothingSpoiled);
  options.use_people = false;
  const auto without = RunHidden(options, kNothingSpoiled);
  ASSERT_EQ(with.size(), 16u);
  ASSERT_EQ(without.size(), 16u);
  EXPECT_EQ(with.back().tracking_state, kCoasting);
  // They stand still and are measured exactly, but by then a second has passed.
  EXPECT_LT(PositionError_m(with.back(), Truth(15)), 0.05);
  EXPECT_NE(Bytes(with), Bytes(without));
}

TEST(FrontendPeople, JointsOfABadCovarianceAreLeftOut) {
  // Whatever a bad joint says, it is as if it had not been said.
  const auto missing = Bytes(RunHidden(WithoutFeedback(), [](int k, human_observations_t* humans) {
    if (k < 5) return;
    human_observation_t& human = humans->humans[0];
    --human.num_joints;
    human.joint_id.erase(human.joint_id.begin());
    for (auto* values : {&human.u_left_px, &human.v_left_px, &human.u_right_px, &human.v_right_px,
                         &human.sigma_px, &human.x_C_m, &human.y_C_m, &human.z_C_m})
      values->erase(values->begin());
    human.covariance_C.erase(human.covariance_C.begin());
  }));
  EXPECT_NE(missing, Bytes(RunHidden(WithoutFeedback(), kNothingSpoiled)));
  const std::vector<std::vector<float>> bad = {
      {0, 0, 0, 0, 0, 0},                  // nothing is known exactly
      {1e-4F, 1e-2F, 0, 1e-4F, 0, 1e-4F},  // not positive
      {1e-4F, 0, 0, 1e-4F, 0.5F, 1e-4F},   // not positive
  };
  for (const std::vector<float>& covariance : bad) {
    const auto spoiled = RunHidden(WithoutFeedback(), [&](int k, human_observations_t* humans) {
      if (k >= 5) humans->humans[0].covariance_C[0] = covariance;
    });
    EXPECT_EQ(Bytes(spoiled), missing) << covariance[1];
  }
}

TEST(FrontendPeople, AMessageWithNumbersThatAreNoneIsRejected) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  human_observations_t humans = NoHumans(0);
  humans.humans = {Human(1, {-1, 0.1, 4}, 0)};
  humans.num_humans = 1;
  humans.humans[0].covariance_C[2][1] = std::numeric_limits<float>::quiet_NaN();
  SendAll(0, NoMask(0), humans, NoKeypoints(0), &node);
  EXPECT_EQ(node.channels().at(channel::kHumanObservations).num_rejected, 1);
  EXPECT_FALSE(node.Step());
  SendFrame(1, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
}

}  // namespace
}  // namespace airdos
