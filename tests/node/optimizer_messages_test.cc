#include "processes/optimizer/optimizer_messages.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <string>
#include <utility>
#include <vector>

#include "processes/node/message/validate.h"

namespace airdos {
namespace {

// Every field differs from every other, so that no two can be exchanged unseen.
const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};
const Header kHeader{1500000, 42, 9};
constexpr float kNaN = std::numeric_limits<float>::quiet_NaN();

/// A covariance in C whose six entries differ, and which is none once two of them are exchanged.
Eigen::Matrix3d CovarianceC() {
  Eigen::Matrix3d S;
  S << 0.0004, 0.0001, 0.0007, 0.0001, 0.0009, -0.0005, 0.0007, -0.0005, 0.04;
  return S;
}

void AddJoint(int joint, const Eigen::Vector3d& p_C, const Eigen::Matrix3d& S,
              human_observation_t* human) {
  const Eigen::Vector3d uvu = kCamera.ProjectStereo(p_C);
  human->joint_id.push_back(static_cast<std::int8_t>(joint));
  human->u_left_px.push_back(static_cast<float>(uvu[0]));
  human->v_left_px.push_back(static_cast<float>(uvu[1] + 0.75));
  human->u_right_px.push_back(static_cast<float>(uvu[2]));
  human->v_right_px.push_back(static_cast<float>(uvu[1] - 0.25));
  human->sigma_px.push_back(1.5F);
  human->x_C_m.push_back(static_cast<float>(p_C.x()));
  human->y_C_m.push_back(static_cast<float>(p_C.y()));
  human->z_C_m.push_back(static_cast<float>(p_C.z()));
  std::vector<float> packed;
  for (int row = 0; row < 3; ++row) {
    for (int column = row; column < 3; ++column) {
      packed.push_back(static_cast<float>(S(row, column)));
    }
  }
  human->covariance_C.push_back(packed);
  ++human->num_joints;
}

human_observations_t People(const std::vector<human_observation_t>& humans) {
  human_observations_t message{};
  message.humans = humans;
  message.num_humans = static_cast<std::int32_t>(humans.size());
  return message;
}

/// By differences of the projection formula, not by the camera's own Jacobian.
Eigen::Matrix3d ImageJacobian(const Eigen::Vector3d& p) {
  Eigen::Matrix3d J;
  const double z2 = p.z() * p.z();
  J << 500 / p.z(), 0, -500 * p.x() / z2,  //
      0, 470 / p.z(), -470 * p.y() / z2,   //
      500 / p.z(), 0, -500 * (p.x() - 0.3) / z2;
  return J;
}

TEST(OptimizerMessages, AJointKeepsItsWholeCovariance) {
  const Eigen::Vector3d p_C(0.8, -0.5, 4);
  human_observation_t human{};
  human.track_id = 17;
  AddJoint(5, p_C, CovarianceC(), &human);
  const human_observations_t message = People({human});
  const FrameInput input = ToFrameInput(kHeader, kCamera, nullptr, &message);
  EXPECT_EQ(input.id.value, 42);
  EXPECT_NEAR(input.time_s, 1.5, 1e-12);
  ASSERT_EQ(input.humans.size(), 1U);
  EXPECT_EQ(input.humans[0].id.value, 17);
  ASSERT_EQ(input.humans[0].joints.size(), 1U);
  const JointObservation& joint = input.humans[0].joints[0];
  EXPECT_EQ(joint.joint, 5);
  // u = 310 + 500 * 0.2, v = 250 - 470 * 0.125 and half of 0.75 - 0.25, u_right = 310 + 500 *
  // 0.125.
  EXPECT_LT((joint.uvu_px - Eigen::Vector3d(410, 191.5, 372.5)).norm(), 1e-4);
  const Eigen::Matrix3d J = ImageJacobian(p_C);
  const Eigen::Matrix3d expected =
      J * CovarianceC() * J.transpose() + 1e-4 * Eigen::Matrix3d::Identity();
  // Single precision: seven digits of numbers up to 30.
  EXPECT_LT((joint.covariance_px2 - expected).norm(), 1e-4);
  EXPECT_GT(std::abs(expected(0, 1) - expected(1, 2)), 0.1) << "else the test cannot see an order";
}

TEST(OptimizerMessages, JointsThatAreNoneAreLeftOut) {
  const Eigen::Vector3d p_C(0.5, -0.5, 5);
  human_observation_t human{};
  for (int joint = 0; joint < 9; ++joint) AddJoint(joint, p_C, CovarianceC(), &human);
  AddJoint(14, p_C, CovarianceC(), &human);  // an eye
  AddJoint(-1, p_C, CovarianceC(), &human);
  AddJoint(13, p_C, CovarianceC(), &human);
  human.u_left_px[0] = kNaN;
  human.v_left_px[1] = kNaN;
  human.u_right_px[2] = kNaN;
  human.z_C_m[3] = 0;
  human.z_C_m[4] = -5;
  human.y_C_m[5] = kNaN;
  human.covariance_C[6][4] = kNaN;
  human.covariance_C[7][1] = 0.01F;  // more than its variances allow
  human.v_right_px[8] = std::numeric_limits<float>::infinity();
  const human_observations_t message = People({human});
  const FrameInput input = ToFrameInput(kHeader, kCamera, nullptr, &message);
  ASSERT_EQ(input.humans.size(), 1U);
  ASSERT_EQ(input.humans[0].joints.size(), 1U);
  EXPECT_EQ(input.humans[0].joints[0].joint, 13);
}

TEST(OptimizerMessages, PeopleAndJointsAreSortedAndTheFirstOfTwoCounts) {
  human_observation_t late{}, early{}, twin{}, nobody{};
  late.track_id = twin.track_id = 8;
  early.track_id = 3;
  nobody.track_id = 1;
  AddJoint(11, {0.1, 0, 5}, CovarianceC(), &late);
  AddJoint(2, {0.2, 0, 5}, CovarianceC(), &late);
  AddJoint(2, {0.3, 0, 5}, CovarianceC(), &late);
  AddJoint(7, {0.4, 0, 5}, CovarianceC(), &early);
  AddJoint(1, {0.5, 0, 5}, CovarianceC(), &twin);
  const human_observations_t message = People({late, early, twin, nobody});
  const FrameInput input = ToFrameInput(kHeader, kCamera, nullptr, &message);
  ASSERT_EQ(input.humans.size(), 2U);
  EXPECT_EQ(input.humans[0].id.value, 3);
  EXPECT_EQ(input.humans[1].id.value, 8);
  ASSERT_EQ(input.humans[1].joints.size(), 2U);
  EXPECT_EQ(input.humans[1].joints[0].joint, 2);
  EXPECT_NEAR(input.humans[1].joints[0].uvu_px.x(), 310 + 500 * 0.2 / 5, 1e-4);
  EXPECT_EQ(input.humans[1].joints[1].joint, 11);
}

static_features_t Features() {
  static_features_t message{};
  const double half_sqrt = std::sqrt(0.5);
  message.position_O_C[0] = 1.1;
  message.position_O_C[1] = -2.2;
  message.position_O_C[2] = 3.3;
  message.orientation_O_C[0] = half_sqrt;  // a quarter turn about y
  message.orientation_O_C[2] = half_sqrt;
  message.position_W_C[0] = 4.4;
  message.position_W_C[1] = 5.5;
  message.position_W_C[2] = -6.6;
  message.orientation_W_C[0] = half_sqrt;  // about z
  message.orientation_W_C[3] = half_sqrt;
  message.odometry_start_seq = 31;
  message.sigma_position_m = 0.07;
  message.sigma_orientation_rad = 0.02;
  const auto add = [&message](std::int64_t id, float u, float v, float u_right, bool has_right,
                              float sigma) {
    message.landmark_id.push_back(id);
    message.u_left_px.push_back(u);
    message.v_px.push_back(v);
    message.u_right_px.push_back(u_right);
    message.has_right.push_back(has_right ? 1 : 0);
    message.sigma_px.push_back(sigma);
    ++message.num_features;
  };
  add(900, 400, 100, 350, true, 0.5F);
  add(901, 200, 300, kNaN, false, 0.25F);
  add(902, kNaN, 300, 100, true, 1);
  add(903, 200, kNaN, 100, false, 1);
  add(904, 200, 300, kNaN, true, 1);
  add(905, 200, 300, 100, true, 0);
  add(906, 200, 300, 100, true, kNaN);
  return message;
}

TEST(OptimizerMessages, FeaturesComeAsTheyWereSeen) {
  const static_features_t message = Features();
  const FrameInput input = ToFrameInput(kHeader, kCamera, &message, nullptr);
  ASSERT_TRUE(input.T_O_C && input.T_W_C);
  EXPECT_EQ(input.T_O_C->translation, Eigen::Vector3d(1.1, -2.2, 3.3));
  EXPECT_LT((*input.T_O_C * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(1.1, -2.2, 2.3)).norm(),
            1e-12);
  EXPECT_EQ(input.T_W_C->translation, Eigen::Vector3d(4.4, 5.5, -6.6));
  EXPECT_LT((*input.T_W_C * Eigen::Vector3d(1, 0, 0) - Eigen::Vector3d(4.4, 6.5, -6.6)).norm(),
            1e-12);
  EXPECT_EQ(input.odometry_start.value, 31);
  EXPECT_EQ(input.motion_sigma_position_m, 0.07);
  EXPECT_EQ(input.motion_sigma_orientation_rad, 0.02);
  EXPECT_TRUE(input.humans.empty());
  ASSERT_EQ(input.features.size(), 2U);
  EXPECT_EQ(input.features[0].id.value, 900);
  EXPECT_EQ(input.features[0].uvu_px, Eigen::Vector3d(400, 100, 350));
  EXPECT_TRUE(input.features[0].has_right);
  EXPECT_EQ(input.features[0].sigma_px, 0.5);
  EXPECT_EQ(input.features[1].id.value, 901);
  EXPECT_EQ(input.features[1].uvu_px.x(), 200);
  EXPECT_EQ(input.features[1].uvu_px.y(), 300);
  EXPECT_FALSE(input.features[1].has_right);
  EXPECT_EQ(input.features[1].sigma_px, 0.25);
}

TEST(OptimizerMessages, WhatTheFrontEndDidNotSayIsNotThere) {
  static_features_t message = Features();
  message.sigma_position_m = 0;
  message.position_O_C[1] = std::numeric_limits<double>::quiet_NaN();
  FrameInput input = ToFrameInput(kHeader, kCamera, &message, nullptr);
  EXPECT_FALSE(input.T_O_C || input.T_W_C);
  EXPECT_FALSE(input.motion_sigma_position_m || input.motion_sigma_orientation_rad);
  EXPECT_EQ(input.features.size(), 2U);
  message.sigma_position_m = 1;
  message.sigma_orientation_rad = 0;
  input = ToFrameInput(kHeader, kCamera, &message, nullptr);
  EXPECT_FALSE(input.motion_sigma_position_m || input.motion_sigma_orientation_rad);
}

/// Translation (x, 2 x, 3 x), a turn of 0.1 x about y.
Se3 Pose(double x) { return {ExpSo3({0, 0.1 * x, 0}), {x, 2 * x, 3 * x}}; }

void ExpectPose(double x, const double position[3], const double orientation[4]) {
  for (int i = 0; i < 3; ++i) EXPECT_DOUBLE_EQ(position[i], (i + 1) * x);
  EXPECT_NEAR(orientation[0], std::cos(0.05 * x), 1e-12);
  EXPECT_NEAR(orientation[1], 0, 1e-12);
  EXPECT_NEAR(orientation[2], std::sin(0.05 * x), 1e-12);
  EXPECT_NEAR(orientation[3], 0, 1e-12);
}

FrameEstimate Estimate() {
  FrameEstimate estimate;
  estimate.status = FrameEstimate::Status::kConverged;
  estimate.T_W_C = Pose(1);
  estimate.T_W_C_without_people = Pose(2);
  estimate.T_W_C_with_people = Pose(3);
  for (int row = 0; row < 6; ++row) {
    for (int column = 0; column < 6; ++column) {
      estimate.covariance(row, column) = 1 + 10 * row + column;
    }
  }
  estimate.num_window_frames = 12;
  estimate.num_static_landmarks = 13;
  estimate.num_static_observations = 14;
  BundleSummary& summary = estimate.summary;
  summary.num_people = 15;
  summary.num_rigidity = 16;
  summary.num_motion = 17;
  summary.num_rigidity_rejected = 18;
  summary.num_motion_rejected = 19;
  summary.num_reprojection_rejected = 20;
  summary.num_iterations = 21;
  summary.initial_cost = 22.5;
  summary.final_cost = 23.5;
  return estimate;
}

TEST(OptimizerMessages, AnEstimateIsPublishedFieldByField) {
  const state_estimate_t message = ToStateEstimate(kHeader, Estimate());
  EXPECT_EQ(message.utime, 1500000);
  EXPECT_EQ(message.seq, 42);
  EXPECT_EQ(message.session, 9);
  ExpectPose(1, message.position_W_C, message.orientation_W_C);
  ExpectPose(2, message.position_without_people_W_C, message.orientation_without_people_W_C);
  ExpectPose(3, message.position_with_people_W_C, message.orientation_with_people_W_C);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(message.covariance[i], 1 + 10 * (i / 6) + i % 6);
  EXPECT_EQ(message.num_window_frames, 12);
  EXPECT_EQ(message.num_static_landmarks, 13);
  EXPECT_EQ(message.num_static_observations, 14);
  EXPECT_EQ(message.num_people, 15);
  EXPECT_EQ(message.num_rigidity_factors, 16);
  EXPECT_EQ(message.num_motion_factors, 17);
  EXPECT_EQ(message.num_rigidity_eliminated, 18);
  EXPECT_EQ(message.num_motion_eliminated, 19);
  EXPECT_EQ(message.num_reprojection_eliminated, 20);
  EXPECT_EQ(message.num_iterations, 21);
  EXPECT_EQ(message.initial_cost, 22.5);
  EXPECT_EQ(message.final_cost, 23.5);
}

TEST(OptimizerMessages, EachStatusAndTrustHasItsNumber) {
  using Status = FrameEstimate::Status;
  const std::vector<std::pair<Status, int>> numbers = {{Status::kFirstFrame, 1},
                                                       {Status::kConverged, 2},
                                                       {Status::kNotConverged, 3},
                                                       {Status::kPredicted, 4}};
  FrameEstimate estimate = Estimate();
  for (const auto& [status, number] : numbers) {
    estimate.status = status;
    EXPECT_EQ(ToStateEstimate(kHeader, estimate).status, number);
  }
  EXPECT_EQ(ToStateEstimate(kHeader, estimate).trusted, 1);
  estimate.trusts_people = true;
  EXPECT_EQ(ToStateEstimate(kHeader, estimate).trusted, 2);
}

TEST(OptimizerMessages, ACovarianceThatIsNoneSaysThatNothingIsKnown) {
  const auto published = [](int row, int column, double value) {
    FrameEstimate estimate = Estimate();
    estimate.covariance(row, column) = value;
    const state_estimate_t message = ToStateEstimate(kHeader, estimate);
    return std::pair(message.covariance[0], message.covariance[1]);
  };
  const std::pair<double, double> unknown(1e6, 0);
  EXPECT_EQ(published(3, 3, -1e-9), unknown);
  EXPECT_EQ(published(5, 5, std::numeric_limits<double>::infinity()), unknown);
  EXPECT_EQ(published(2, 4, -2e12), unknown);
  EXPECT_EQ(published(2, 4, 1e12), std::pair(1.0, 2.0));
  EXPECT_EQ(published(3, 3, 0), std::pair(1.0, 2.0));
}

TEST(OptimizerMessages, AnUnknownPoseIsValidAndSaysSo) {
  const state_estimate_t message = UnknownStateEstimate(kHeader);
  EXPECT_EQ(Validate(message), "");
  EXPECT_EQ(message.seq, 42);
  EXPECT_EQ(message.status, 0);
  for (int i = 0; i < 36; ++i) EXPECT_EQ(message.covariance[i], i % 7 == 0 ? 1e4 : 0);  // 100 m
}

HumanState Person() {
  HumanState state;
  state.id.value = 5;
  state.frame.value = 41;
  state.time_s = 1.4;
  state.joints.push_back({3, {0.25, 0.5, 0.75}, {1.25, 1.5, 1.75}});
  state.joints.push_back({12, {2.25, 2.5, 2.75}, {3.25, 3.5, 3.75}});
  state.segments.push_back({9, 0.4375});
  BundleProblem::PartMotion motion;
  motion.part = 4;
  motion.motion_W = Pose(0.5);
  state.motions.push_back(motion);
  return state;
}

TEST(OptimizerMessages, APersonIsPublishedFieldByField) {
  MapChanges changes;
  changes.humans.push_back(Person());
  const std::vector<map_update_t> parts = ToMapUpdates(kHeader, changes);
  ASSERT_EQ(parts.size(), 1U);
  ASSERT_EQ(parts[0].num_humans, 1);
  const human_state_t& human = parts[0].humans[0];
  EXPECT_EQ(human.track_id, 5);
  EXPECT_EQ(human.seq, 41);
  EXPECT_EQ(human.utime, 1400000);
  EXPECT_EQ(human.num_joints, 2);
  EXPECT_EQ(human.joint_id, (std::vector<std::int8_t>{3, 12}));
  EXPECT_EQ(human.x_W_m, (std::vector<float>{0.25F, 2.25F}));
  EXPECT_EQ(human.y_W_m, (std::vector<float>{0.5F, 2.5F}));
  EXPECT_EQ(human.z_W_m, (std::vector<float>{0.75F, 2.75F}));
  EXPECT_EQ(human.x_W_measured_m, (std::vector<float>{1.25F, 3.25F}));
  EXPECT_EQ(human.y_W_measured_m, (std::vector<float>{1.5F, 3.5F}));
  EXPECT_EQ(human.z_W_measured_m, (std::vector<float>{1.75F, 3.75F}));
  EXPECT_EQ(human.num_segments, 1);
  EXPECT_EQ(human.segment_id, (std::vector<std::int8_t>{9}));
  EXPECT_EQ(human.length_m, (std::vector<float>{0.4375F}));
  EXPECT_EQ(human.num_motions, 1);
  EXPECT_EQ(human.part_id, (std::vector<std::int8_t>{4}));
  EXPECT_EQ(human.translation_m[0], (std::vector<float>{0.5F, 1.0F, 1.5F}));
  ASSERT_EQ(human.rotation[0].size(), 4U);
  EXPECT_NEAR(human.rotation[0][0], std::cos(0.025), 1e-7);
  EXPECT_NEAR(human.rotation[0][1], 0, 1e-7);
  EXPECT_NEAR(human.rotation[0][2], std::sin(0.025), 1e-7);
  EXPECT_NEAR(human.rotation[0][3], 0, 1e-7);
}

TEST(OptimizerMessages, FramesAndLandmarksArePublishedFieldByField) {
  MapChanges changes;
  changes.frames.push_back({FrameId{41}, 1.4, Pose(2)});
  changes.frames.push_back({FrameId{42}, 1.5, Pose(3)});
  changes.landmarks.push_back({LandmarkId{70}, {0.1, 0.2, 0.3}, 0.0625, 4});
  changes.removed.push_back(LandmarkId{99});
  const std::vector<map_update_t> parts = ToMapUpdates(kHeader, changes);
  ASSERT_EQ(parts.size(), 1U);
  const map_update_t& part = parts[0];
  EXPECT_EQ(part.utime, 1500000);
  EXPECT_EQ(part.seq, 42);
  EXPECT_EQ(part.session, 9);
  EXPECT_EQ(part.part, 0);
  EXPECT_EQ(part.num_parts, 1);
  ASSERT_EQ(part.num_frames, 2);
  EXPECT_EQ(part.frames[0].seq, 41);
  EXPECT_EQ(part.frames[0].utime, 1400000);
  ExpectPose(2, part.frames[0].position_W_C, part.frames[0].orientation_W_C);
  EXPECT_EQ(part.frames[1].seq, 42);
  ExpectPose(3, part.frames[1].position_W_C, part.frames[1].orientation_W_C);
  ASSERT_EQ(part.num_landmarks, 1);
  EXPECT_EQ(part.landmark_id[0], 70);
  EXPECT_EQ(part.x_W_m[0], 0.1);
  EXPECT_EQ(part.y_W_m[0], 0.2);
  EXPECT_EQ(part.z_W_m[0], 0.3);
  EXPECT_EQ(part.sigma_m[0], 0.0625F);
  EXPECT_EQ(part.num_observations[0], 4);
  ASSERT_EQ(part.num_removed, 1);
  EXPECT_EQ(part.removed_landmark_id[0], 99);
}

// Everything together may not exceed what travels, whatever it is made of, and nothing is lost.
TEST(OptimizerMessages, EveryKindCountsTowardsTheSizeOfAPart) {
  MapChanges changes;
  changes.frames.resize(3000);
  changes.removed.resize(30000);
  changes.humans.assign(1500, Person());
  int num_frames = 0, num_removed = 0, num_humans = 0;
  const std::vector<map_update_t> parts = ToMapUpdates(kHeader, changes);
  // 3000 * 72 + 30000 * 8 + 1500 * 120 bytes at 110 kB a part.
  EXPECT_GE(parts.size(), 6U);
  EXPECT_LE(parts.size(), 7U);
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_EQ(parts[i].part, static_cast<int>(i));
    EXPECT_EQ(parts[i].num_parts, static_cast<int>(parts.size()));
    EXPECT_LT(parts[i].getEncodedSize(), 120000);
    EXPECT_EQ(parts[i].seq, 42);
    num_frames += parts[i].num_frames;
    num_removed += parts[i].num_removed;
    num_humans += parts[i].num_humans;
  }
  EXPECT_EQ(num_frames, 3000);
  EXPECT_EQ(num_removed, 30000);
  EXPECT_EQ(num_humans, 1500);
}

}  // namespace
}  // namespace airdos
