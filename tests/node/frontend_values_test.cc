// The frontend's node against the odometry that it wraps, run beside it on the same frames: every
// field of what goes in and comes out.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>
#include <utility>
#include <vector>

#include "common/features/visual_odometry.h"
#include "processes/frontend/frontend_node.h"
#include "tests/node/frontend_walk.h"

namespace airdos {
namespace {

constexpr int kNumFrames = 7;
constexpr double kRounding = 2e-7;

/// Column of the mask's first person pixel, and behind its last.
constexpr int kMaskBegin_px = 250, kMaskEnd_px = 280;

FrontendOptions Options() {
  FrontendOptions options;
  options.feedback_lag_frames = 2;
  options.mask_dilation_px = 5;
  options.odometry.max_static_for_people = 10000;  // people always have a say
  options.odometry.people.wobble_m = 0.01;
  return options;
}

/// Full, and not the same in any two places; of person `track`, joint `i`.
Eigen::Matrix3d Covariance(int track, int i) {
  const double s = 1e-4 * (1 + 0.25 * track + 0.125 * i);
  Eigen::Matrix3d covariance;
  covariance << 4, 0.5, -1, 0.5, 3, 1.25, -1, 1.25, 9;
  return s * covariance;
}

struct PersonAt {
  int track;
  Eigen::Vector3d place_W;
};
const PersonAt kPeople[] = {{31, {-1, 0.25, 4}}, {57, {1.25, 0, 5}}};
const int kJoints[] = {1, 2, 5, 8, 11};  // of the trunk, without the nose

Eigen::Vector3d JointInCamera(const PersonAt& person, int joint, int seq) {
  const Eigen::Vector3d offset(0.125 * (joint % 3 - 1), joint < 8 ? -0.5 : 0, 0.0625 * (joint % 2));
  return Truth(seq).inverse() * (person.place_W + offset);
}

human_observations_t PeopleMessage(int seq) {
  human_observations_t message = NoHumans(seq);
  for (const PersonAt& person : kPeople) {
    human_observation_t human{};
    human.track_id = person.track;
    for (std::size_t i = 0; i < 5; ++i) {
      const Eigen::Vector3f p_C = JointInCamera(person, kJoints[i], seq).cast<float>();
      const Eigen::Matrix3f S = Covariance(person.track, static_cast<int>(i)).cast<float>();
      human.joint_id.push_back(static_cast<std::int8_t>(kJoints[i]));
      for (auto* list : {&human.u_left_px, &human.v_left_px, &human.u_right_px, &human.v_right_px})
        list->push_back(1);
      human.sigma_px.push_back(1);
      human.x_C_m.push_back(p_C.x());
      human.y_C_m.push_back(p_C.y());
      human.z_C_m.push_back(p_C.z());
      human.covariance_C.push_back({S(0, 0), S(0, 1), S(0, 2), S(1, 1), S(1, 2), S(2, 2)});
    }
    human.num_joints = 5;
    message.humans.push_back(human);
  }
  message.num_humans = 2;
  return message;
}

std::vector<HumanMeasurement> PeopleMeasured(int seq) {
  std::vector<HumanMeasurement> people;
  for (const PersonAt& person : kPeople) {
    HumanMeasurement measurement{HumanId{person.track}, {}};
    for (std::size_t i = 0; i < 5; ++i) {
      HumanMeasurement::Joint joint;
      joint.joint = kJoints[i];
      joint.p_C = JointInCamera(person, kJoints[i], seq).cast<float>().cast<double>();
      joint.covariance_C =
          Covariance(person.track, static_cast<int>(i)).cast<float>().cast<double>();
      measurement.joints.push_back(joint);
    }
    people.push_back(measurement);
  }
  return people;
}

StereoImagePair ImagesOf(int seq) {
  cv::Mat mask(Walk(seq).left.size(), CV_8UC1, cv::Scalar(0));
  mask.colRange(kMaskBegin_px, kMaskEnd_px) = cv::Scalar(255);
  cv::dilate(mask, mask, cv::getStructuringElement(cv::MORPH_ELLIPSE, {11, 11}));
  return {FrameId{seq}, 0.1 * seq,          Walk(seq).left.clone(), Walk(seq).right.clone(),
          mask,         PeopleMeasured(seq)};
}

/// The optimizer has the frame a little elsewhere, three of its landmarks, too, and takes out two.
std::pair<map_update_t, MapCorrection> Correction(const OdometryFrame& frame, const LocalMap& map,
                                                  int seq) {
  map_update_t update = Update(seq);
  MapCorrection correction;
  correction.newest = FrameId{seq};
  Vector6d shift;
  shift << 0.004, -0.002, 0.003, 0.001, 0.002, -0.0015;
  const Se3 T_W_C = Boxplus(frame.T_W_C, (seq % 2 == 0 ? 1 : -1) * shift);
  AddFrame(seq, T_W_C, &update);
  correction.frames = {{FrameId{seq}, T_W_C}};
  for (std::size_t i = 0; i < 5; ++i) {
    const LandmarkId id = frame.sightings[7 * i].id;
    const Eigen::Vector3d p_W = map.landmarks().at(id).p_W + Eigen::Vector3d(0.01, -0.02, 0.03);
    if (i < 3) {
      update.landmark_id.push_back(id.value);
      update.x_W_m.push_back(p_W.x());
      update.y_W_m.push_back(p_W.y());
      update.z_W_m.push_back(p_W.z());
      update.sigma_m.push_back(0.01F);
      update.num_observations.push_back(2);
      correction.landmarks_W_m.emplace_back(id, p_W);
    } else {
      update.removed_landmark_id.push_back(id.value);
      correction.removed.push_back(id);
    }
  }
  update.num_landmarks = 3;
  update.num_removed = 2;
  return {update, correction};
}

void ExpectPose(const double position[3], const double orientation[4], const Se3& pose) {
  // The corrections went through a message, which rounds their quaternions once more; the pose's
  // iteration ends a little elsewhere.
  for (int i = 0; i < 3; ++i) EXPECT_NEAR(position[i], pose.translation[i], kRounding);
  EXPECT_NEAR(orientation[0], pose.rotation.w(), kRounding);
  EXPECT_NEAR(orientation[1], pose.rotation.x(), kRounding);
  EXPECT_NEAR(orientation[2], pose.rotation.y(), kRounding);
  EXPECT_NEAR(orientation[3], pose.rotation.z(), kRounding);
}

void ExpectFeatures(const static_features_t& message, const OdometryFrame& frame) {
  ASSERT_EQ(message.num_features, static_cast<int>(frame.sightings.size()));
  for (std::size_t i = 0; i < frame.sightings.size(); ++i) {
    const LandmarkSighting& sighting = frame.sightings[i];
    ASSERT_EQ(message.landmark_id[i], sighting.id.value);
    EXPECT_NEAR(message.u_left_px[i], sighting.uvu_px.x(), 1e-3);
    EXPECT_NEAR(message.v_px[i], sighting.uvu_px.y(), 1e-3);
    EXPECT_EQ(message.has_right[i] != 0, sighting.has_right);
    const double u_right_px = sighting.has_right ? sighting.uvu_px.z() : message.u_right_px[i];
    EXPECT_NEAR(message.u_right_px[i], u_right_px, 1e-3);
    EXPECT_NEAR(message.sigma_px[i], sighting.sigma_px, 1e-6);
  }
}

TEST(FrontendValues, TheMessageIsWhatTheOdometrySays) {
  FrontendNode node(Options());
  VisualOdometry odometry(Options().odometry);
  Send(channel::kCalibration, Calibration(), &node);
  std::vector<MapCorrection> corrections;
  int num_without_right = 0;
  for (int k = 0; k < kNumFrames; ++k) {
    SCOPED_TRACE(k);
    if (k >= 2) odometry.Apply(corrections[static_cast<std::size_t>(k - 2)]);
    const OdometryFrame frame = odometry.Process(SmallStereoCamera(), ImagesOf(k));
    Send(channel::kCameraLeft, Left(k), &node);
    Send(channel::kCameraRight, Right(k), &node);
    Send(channel::kPersonMask, Mask(k, kMaskBegin_px, kMaskEnd_px), &node);
    Send(channel::kHumanObservations, PeopleMessage(k), &node);
    Send(channel::kPersonKeypointsLeft, NoKeypoints(k), &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    const static_features_t& message = output[0];
    EXPECT_EQ(message.tracking_state, k == 0 ? kInitializing : kTracking);
    ExpectPose(message.position_O_C, message.orientation_O_C, frame.T_O_C);
    ExpectPose(message.position_W_C, message.orientation_W_C, frame.T_W_C);
    EXPECT_NEAR(message.sigma_position_m, frame.prior_sigma_position_m, kRounding);
    EXPECT_NEAR(message.sigma_orientation_rad, frame.prior_sigma_orientation_rad, kRounding);
    EXPECT_EQ(message.num_detected, frame.num_detected);
    EXPECT_EQ(message.num_masked, frame.num_masked);
    EXPECT_EQ(message.num_matched, frame.num_matched);
    ExpectFeatures(message, frame);
    for (const LandmarkSighting& sighting : frame.sightings)
      num_without_right += sighting.has_right ? 0 : 1;
    const auto [update, correction] = Correction(frame, odometry.map(), k);
    corrections.push_back(correction);
    Send(channel::kMapUpdate, update, &node);
    if (k < 3) continue;  // by now the numbers above are not equal by chance
    EXPECT_GT((frame.T_W_C.translation - frame.T_O_C.translation).norm(), 1e-3);
    EXPECT_GT(frame.num_masked, 0);
    EXPECT_GT(frame.num_matched, 0);
    EXPECT_EQ(frame.num_people, 2);
  }
  EXPECT_GT(num_without_right, 0);
}

TEST(FrontendValues, TheStateIsThatOfTheOdometry) {
  FrontendOptions options = WithoutFeedback();
  for (const bool is_weak : {false, true}) {
    if (is_weak) options.odometry.min_inliers_tracking = 1000;
    FrontendNode node(options);
    Send(channel::kCalibration, Calibration(), &node);
    for (int k = 0; k < 3; ++k) SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 3u);
    EXPECT_EQ(output[0].tracking_state, kInitializing);
    EXPECT_EQ(output[2].tracking_state, is_weak ? +static_features_t::STATE_WEAK : kTracking);
  }
}

// Far walls lie so near to their left columns that a right image that is a copy would match.
TEST(FrontendValues, WithoutARightImageNothingHasARightColumn) {
  FrontendNode node(WithoutFeedback());
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 4; ++k) {
    Send(channel::kCameraLeft, Left(k), &node);
    if (k < 3) Send(channel::kCameraRight, Right(k), &node);
    Send(channel::kPersonMask, NoMask(k), &node);
    SendNobody(k, &node);
  }
  while (node.Step() || node.CompleteOldest()) {
  }
  const std::vector<static_features_t> output = Take(&node);
  ASSERT_EQ(output.size(), 4u);
  const auto num_right = [](const static_features_t& message) {
    return std::count(message.has_right.begin(), message.has_right.end(), 1);
  };
  EXPECT_GT(num_right(output[2]), 50);
  EXPECT_GT(output[3].num_features, 50);
  EXPECT_EQ(num_right(output[3]), 0);
}

}  // namespace
}  // namespace airdos
