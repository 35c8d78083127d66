#include "processes/map_recorder/map_recorder_messages.h"

#include <gtest/gtest.h>

#include "common/geometry/se3.h"
#include "processes/node/message/conversions.h"

namespace airdos {
namespace {

// Every field differs from every other, so that no two can be exchanged unseen.
const Se3 kT_W_C{ExpSo3({0.1, -0.2, 0.3}), {1, 2, 3}};
const Se3 kOther{ExpSo3({-0.3, 0.1, 0.2}), {4, 5, 6}};

FourDMap MapOf(const map_update_t& message) {
  MapDelta changes;
  AddTo(message, &changes);
  FourDMap map;
  changes.Apply(&map);
  return map;
}

TEST(MapRecorderMessages, TheTrustedPoseIsTheLiveOne) {
  state_estimate_t message{};
  message.utime = 1500000;
  message.status = state_estimate_t::STATUS_NOT_CONVERGED;
  FromSe3(kT_W_C, message.position_W_C, message.orientation_W_C);
  FromSe3(kOther, message.position_with_people_W_C, message.orientation_with_people_W_C);
  FromSe3(kOther, message.position_without_people_W_C, message.orientation_without_people_W_C);
  for (const bool with_people : {false, true}) {
    message.trusted = with_people ? state_estimate_t::TRUSTED_WITH_PEOPLE
                                  : state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
    const MapFrame frame = ToMapFrame(message);
    EXPECT_EQ(frame.utime, 1500000);
    EXPECT_EQ(frame.status, +state_estimate_t::STATUS_NOT_CONVERGED);
    EXPECT_EQ(frame.is_trusted_with_people, with_people);
    ASSERT_TRUE(frame.live);
    EXPECT_LT(Boxminus(*frame.live, kT_W_C).norm(), 1e-12);
    EXPECT_FALSE(frame.refined);
    EXPECT_FALSE(frame.ground_truth);
  }
}

TEST(MapRecorderMessages, PosesOfTheWindowAreRefinedOnes) {
  map_update_t message{};
  message.utime = 9;
  message.seq = 50;
  message.frames.resize(2);
  for (int i = 0; i < 2; ++i) {
    frame_pose_t& frame = message.frames[static_cast<std::size_t>(i)];
    frame.seq = 40 + i;
    frame.utime = 4000 + i;
    FromSe3(i == 0 ? kT_W_C : kOther, frame.position_W_C, frame.orientation_W_C);
  }
  const FourDMap map = MapOf(message);
  ASSERT_EQ(map.frames.size(), 2u);
  const MapFrame& first = map.frames.at({40});
  EXPECT_EQ(first.utime, 4000);
  EXPECT_FALSE(first.live);
  ASSERT_TRUE(first.refined);
  EXPECT_LT(Boxminus(*first.refined, kT_W_C).norm(), 1e-12);
  EXPECT_EQ(map.frames.at({41}).utime, 4001);
  EXPECT_LT(Boxminus(*map.frames.at({41}).refined, kOther).norm(), 1e-12);
}

TEST(MapRecorderMessages, LandmarksComeAndGo) {
  map_update_t message{};
  message.landmark_id = {101, 102};
  message.x_W_m = {1.5, 4.5};
  message.y_W_m = {2.5, 5.5};
  message.z_W_m = {3.5, 6.5};
  message.sigma_m = {0.25F, 0.5F};
  message.num_observations = {7, 8};
  message.removed_landmark_id = {55};
  message.repeated_landmark_id = {66};  // nothing new
  MapDelta changes;
  changes.SetLandmark({55}, {});
  AddTo(message, &changes);
  FourDMap map;
  map.landmarks[{55}] = {};
  changes.Apply(&map);
  ASSERT_EQ(map.landmarks.size(), 2u);
  EXPECT_EQ(map.landmarks.at({101}).p_W, Eigen::Vector3f(1.5F, 2.5F, 3.5F));
  EXPECT_EQ(map.landmarks.at({101}).sigma_m, 0.25F);
  EXPECT_EQ(map.landmarks.at({101}).num_observations, 7);
  EXPECT_EQ(map.landmarks.at({102}).p_W, Eigen::Vector3f(4.5F, 5.5F, 6.5F));
  EXPECT_EQ(map.landmarks.at({102}).sigma_m, 0.5F);
  EXPECT_EQ(map.landmarks.at({102}).num_observations, 8);
}

TEST(MapRecorderMessages, APersonIsWrittenAtTheFrameOfTheState) {
  map_update_t message{};
  message.seq = 50;
  message.utime = 5000;
  message.humans.resize(1);
  human_state_t& state = message.humans[0];
  state.track_id = 17;
  state.seq = 48;
  state.utime = 4800;
  state.joint_id = {4, 11};
  state.x_W_m = {1, 2};
  state.y_W_m = {3, 4};
  state.z_W_m = {5, 6};
  state.x_W_measured_m = {7, 8};
  state.y_W_measured_m = {9, 10};
  state.z_W_measured_m = {11, 12};
  state.segment_id = {6};
  state.length_m = {0.375F};
  state.part_id = {3};
  state.translation_m = {{13, 14, 15}};
  state.rotation = {{0.5F, -0.5F, 0.5F, 0.5F}};
  const FourDMap map = MapOf(message);
  ASSERT_EQ(map.humans.size(), 1u);
  const MapHuman& human = map.humans.at({FrameId{48}, HumanId{17}});
  EXPECT_EQ(human.utime, 4800);
  ASSERT_EQ(human.joints.size(), 2u);
  EXPECT_EQ(human.joints.at(4).p_W, Eigen::Vector3f(1, 3, 5));
  EXPECT_EQ(human.joints.at(4).p_W_measured, Eigen::Vector3f(7, 9, 11));
  EXPECT_EQ(human.joints.at(11).p_W, Eigen::Vector3f(2, 4, 6));
  EXPECT_EQ(human.joints.at(11).p_W_measured, Eigen::Vector3f(8, 10, 12));
  ASSERT_EQ(human.segment_lengths_m.size(), 1u);
  EXPECT_EQ(human.segment_lengths_m.at(6), 0.375F);
  ASSERT_EQ(human.part_motions.size(), 1u);
  EXPECT_EQ(human.part_motions.at(3).t_W, Eigen::Vector3f(13, 14, 15));
  const Eigen::Quaternionf& R = human.part_motions.at(3).R_W;
  EXPECT_EQ(R.w(), 0.5F);
  EXPECT_EQ(R.x(), -0.5F);
  EXPECT_EQ(R.y(), 0.5F);
  EXPECT_EQ(R.z(), 0.5F);
}

}  // namespace
}  // namespace airdos
