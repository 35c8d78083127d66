#include "processes/frontend/frontend_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include "processes/node/message/conversions.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

// Every field differs from every other, so that no two can be exchanged unseen.
const Header kHeader{1500000, 42, 9};
constexpr std::int64_t kOdometryStart = 31;
const Se3 kT_W_C{ExpSo3({0.1, -0.2, 0.3}), {1, 2, 3}};
const Se3 kT_O_C{ExpSo3({-0.3, 0.1, 0.2}), {4, 5, 6}};

OdometryFrame Frame() {
  OdometryFrame frame;
  frame.state = TrackingState::kTracking;
  frame.T_W_C = kT_W_C;
  frame.T_O_C = kT_O_C;
  frame.prior_sigma_position_m = 0.07;
  frame.prior_sigma_orientation_rad = 0.08;
  frame.num_people = 11;
  frame.num_detected = 12;
  frame.num_masked = 13;
  frame.num_matched = 14;
  frame.sightings.push_back({LandmarkId{101}, {21.5, 22.5, 20.25}, true, 0.5});
  frame.sightings.push_back({LandmarkId{102}, {31.5, 32.5, 0}, false, 0.75});
  return frame;
}

void ExpectPose(const double position[3], const double orientation[4], const Se3& pose) {
  EXPECT_LT(Boxminus(ToSe3(position, orientation), pose).norm(), 1e-12);
}

TEST(FrontendMessages, TheFramesFieldsGoToTheirNames) {
  const static_features_t message = ToStaticFeatures(kHeader, kOdometryStart, Frame());
  EXPECT_EQ(message.utime, 1500000);
  EXPECT_EQ(message.seq, 42);
  EXPECT_EQ(message.session, 9);
  EXPECT_EQ(message.odometry_start_seq, 31);
  ExpectPose(message.position_W_C, message.orientation_W_C, kT_W_C);
  ExpectPose(message.position_O_C, message.orientation_O_C, kT_O_C);
  EXPECT_EQ(message.sigma_position_m, 0.07);
  EXPECT_EQ(message.sigma_orientation_rad, 0.08);
  EXPECT_EQ(message.num_detected, 12);
  EXPECT_EQ(message.num_masked, 13);
  EXPECT_EQ(message.num_matched, 14);
  EXPECT_EQ(Validate(message), "");
}

TEST(FrontendMessages, EachSightingIsAFeature) {
  const static_features_t message = ToStaticFeatures(kHeader, kOdometryStart, Frame());
  ASSERT_EQ(message.num_features, 2);
  EXPECT_EQ(message.landmark_id, (std::vector<std::int64_t>{101, 102}));
  EXPECT_EQ(message.u_left_px, (std::vector<float>{21.5, 31.5}));
  EXPECT_EQ(message.v_px, (std::vector<float>{22.5, 32.5}));
  EXPECT_EQ(message.u_right_px, (std::vector<float>{20.25, 0}));
  EXPECT_EQ(message.has_right, (std::vector<std::int8_t>{1, 0}));
  EXPECT_EQ(message.sigma_px, (std::vector<float>{0.5, 0.75}));
}

TEST(FrontendMessages, EachStateHasItsNumber) {
  const auto state_of = [](TrackingState state) {
    OdometryFrame frame;
    frame.state = state;
    return static_cast<int>(ToStaticFeatures(kHeader, kOdometryStart, frame).tracking_state);
  };
  EXPECT_EQ(state_of(TrackingState::kInitializing), +static_features_t::STATE_INITIALIZING);
  EXPECT_EQ(state_of(TrackingState::kTracking), +static_features_t::STATE_TRACKING);
  EXPECT_EQ(state_of(TrackingState::kWeak), +static_features_t::STATE_WEAK);
  EXPECT_EQ(state_of(TrackingState::kCoasting), +static_features_t::STATE_COASTING);
}

TEST(FrontendMessages, AFrameWithoutPoseHasItsHeaderAndNothingElse) {
  const static_features_t message = UnknownStaticFeatures(kHeader, kOdometryStart);
  EXPECT_EQ(message.tracking_state, +static_features_t::STATE_INVALID);
  EXPECT_EQ(message.utime, 1500000);
  EXPECT_EQ(message.seq, 42);
  EXPECT_EQ(message.session, 9);
  EXPECT_EQ(message.odometry_start_seq, 31);
  EXPECT_EQ(message.num_features, 0);
  EXPECT_EQ(message.num_detected, 0);
  EXPECT_EQ(Validate(message), "");
}

// ---- people

void AddJoint(int joint, const Eigen::Vector3f& p_C, const std::vector<float>& covariance,
              human_observation_t* human) {
  human->joint_id.push_back(static_cast<std::int8_t>(joint));
  human->x_C_m.push_back(p_C.x());
  human->y_C_m.push_back(p_C.y());
  human->z_C_m.push_back(p_C.z());
  human->covariance_C.push_back(covariance);
  ++human->num_joints;
}

const std::vector<float> kCovariance = {0.25F, 0.0625F, -0.03125F, 0.5F, 0.125F, 1};

TEST(FrontendMessages, AJointKeepsItsPlaceAndItsWholeCovariance) {
  human_observations_t message{};
  message.humans.resize(2);
  message.humans[0].track_id = 17;
  message.humans[1].track_id = 18;
  AddJoint(5, {0.5F, -0.75F, 4}, kCovariance, &message.humans[1]);
  const std::vector<HumanMeasurement> people = ToHumanMeasurements(message);
  ASSERT_EQ(people.size(), 2u);
  EXPECT_EQ(people[0].id.value, 17);
  EXPECT_TRUE(people[0].joints.empty());
  EXPECT_EQ(people[1].id.value, 18);
  ASSERT_EQ(people[1].joints.size(), 1u);
  EXPECT_EQ(people[1].joints[0].joint, 5);
  EXPECT_EQ(people[1].joints[0].p_C, Eigen::Vector3d(0.5, -0.75, 4));
  Eigen::Matrix3d expected;
  expected << 0.25, 0.0625, -0.03125, 0.0625, 0.5, 0.125, -0.03125, 0.125, 1;
  EXPECT_EQ(people[1].joints[0].covariance_C, expected);
}

TEST(FrontendMessages, JointsThatAreNoneAreLeftOut) {
  constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();
  human_observations_t message{};
  message.humans.resize(1);
  human_observation_t& human = message.humans[0];
  for (int joint = 0; joint < 6; ++joint) AddJoint(joint, {1, 2, 3}, kCovariance, &human);
  human.x_C_m[0] = kNaN;
  human.z_C_m[1] = std::numeric_limits<float>::infinity();
  human.covariance_C[2][4] = kNaN;
  human.covariance_C[3][1] = 0.5F;  // more than its variances allow
  human.covariance_C[4][3] = -1;
  const std::vector<HumanMeasurement> people = ToHumanMeasurements(message);
  ASSERT_EQ(people.size(), 1u);
  ASSERT_EQ(people[0].joints.size(), 1u);
  EXPECT_EQ(people[0].joints[0].joint, 5);
}

// ---- corrections

TEST(FrontendMessages, TheOptimizersPartsAddUpToOneCorrection) {
  map_update_t part{};
  part.frames.resize(1);
  part.frames[0].seq = 40;
  FromSe3(kT_W_C, part.frames[0].position_W_C, part.frames[0].orientation_W_C);
  part.landmark_id = {101};
  part.x_W_m = {1.5};
  part.y_W_m = {2.5};
  part.z_W_m = {3.5};
  part.removed_landmark_id = {7, 8};
  map_update_t other{};
  other.frames.resize(1);
  other.frames[0].seq = 41;
  FromSe3(kT_O_C, other.frames[0].position_W_C, other.frames[0].orientation_W_C);
  other.landmark_id = {102};
  other.x_W_m = {4.5};
  other.y_W_m = {5.5};
  other.z_W_m = {6.5};
  other.removed_landmark_id = {9};
  other.repeated_landmark_id = {55};  // what was said before is no correction
  MapCorrection correction;
  correction.newest = FrameId{42};
  AddTo(part, &correction);
  AddTo(other, &correction);
  EXPECT_EQ(correction.newest.value, 42);
  ASSERT_EQ(correction.frames.size(), 2u);
  EXPECT_EQ(correction.frames[0].first.value, 40);
  EXPECT_LT(Boxminus(correction.frames[0].second, kT_W_C).norm(), 1e-12);
  EXPECT_EQ(correction.frames[1].first.value, 41);
  EXPECT_LT(Boxminus(correction.frames[1].second, kT_O_C).norm(), 1e-12);
  ASSERT_EQ(correction.landmarks_W_m.size(), 2u);
  EXPECT_EQ(correction.landmarks_W_m[0].first.value, 101);
  EXPECT_EQ(correction.landmarks_W_m[0].second, Eigen::Vector3d(1.5, 2.5, 3.5));
  EXPECT_EQ(correction.landmarks_W_m[1].first.value, 102);
  EXPECT_EQ(correction.landmarks_W_m[1].second, Eigen::Vector3d(4.5, 5.5, 6.5));
  EXPECT_EQ(correction.removed,
            (std::vector<LandmarkId>{LandmarkId{7}, LandmarkId{8}, LandmarkId{9}}));
}

}  // namespace
}  // namespace airdos
