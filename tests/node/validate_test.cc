#include "processes/node/message/validate.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfF = std::numeric_limits<float>::infinity();

/// A sample with one thing wrong is rejected with a reason that names it.
template <class Message>
void ExpectReject(const std::string& part_of_reason, const std::function<void(Message*)>& damage) {
  Message message = Sample<Message>();
  ASSERT_EQ(Validate(message), "");
  damage(&message);
  EXPECT_NE(Validate(message).find(part_of_reason), std::string::npos)
      << "expected '" << part_of_reason << "' in '" << Validate(message) << "'";
}

template <class Message>
class ValidateAnyTest : public testing::Test {};
using MessageTypes =
    testing::Types<image_t, stereo_calibration_t, person_keypoints_t, person_mask_t,
                   static_features_t, human_observations_t, state_estimate_t, map_update_t, pose_t,
                   frame_done_t, process_status_t>;
TYPED_TEST_SUITE(ValidateAnyTest, MessageTypes);

TYPED_TEST(ValidateAnyTest, TheHeaderMustMakeSense) {
  ExpectReject<TypeParam>("seq -1", [](TypeParam* m) { m->seq = -1; });
  ExpectReject<TypeParam>("seq", [](TypeParam* m) { m->seq = std::int64_t{1} << 60; });
  ExpectReject<TypeParam>("utime -5", [](TypeParam* m) { m->utime = -5; });
}

TEST(ValidateTest, Image) {
  using M = image_t;
  ExpectReject<M>("width 0", [](M* m) { m->width = 0; });
  ExpectReject<M>("height 8193", [](M* m) { m->height = 8193; });
  // Found by fuzzing: three times their product does not fit into 64 bits.
  ExpectReject<M>("width 2147483647", [](M* m) {
    m->width = m->height = std::numeric_limits<int>::max();
    m->encoding = M::ENCODING_RAW_BGR8;
  });
  ExpectReject<M>("number of pixels", [](M* m) { m->width = 4000, m->height = 3001; });
  ExpectReject<M>("encoding 0", [](M* m) { m->encoding = M::ENCODING_INVALID; });
  ExpectReject<M>("encoding 5", [](M* m) { m->encoding = 5; });
  ExpectReject<M>("num_bytes 12 must be 16", [](M* m) { m->width = 4, m->height = 4; });
  ExpectReject<M>("must be 36", [](M* m) { m->encoding = M::ENCODING_RAW_BGR8; });
  ExpectReject<M>("num_bytes 0", [](M* m) {
    m->encoding = M::ENCODING_JPEG;
    m->num_bytes = 0;
    m->data.clear();
  });
}

TEST(ValidateTest, Calibration) {
  using M = stereo_calibration_t;
  ExpectReject<M>("width 9000", [](M* m) { m->width = 9000; });
  ExpectReject<M>("focal length", [](M* m) { m->fx_px = kNan; });
  ExpectReject<M>("not a camera", [](M* m) { m->fy_px = 0; });
  ExpectReject<M>("not a camera", [](M* m) { m->cx_px = 700; });
  ExpectReject<M>("fx_px 6", [](M* m) { m->fx_px = 6; });
  ExpectReject<M>("baseline_m 1e-05", [](M* m) { m->baseline_m = 1e-5; });
  ExpectReject<M>("baseline_m -0.1", [](M* m) { m->baseline_m = -0.1; });
}

TEST(ValidateTest, KeypointsOfNobodyNeedNoNumberOfJoints) {
  person_keypoints_t message = Sample<person_keypoints_t>();
  message.num_people = 0;
  for (auto* rows : {&message.u_px, &message.v_px, &message.confidence}) rows->clear();
  for (const int num_joints : {0, 17, 18, 99}) {
    message.num_joints = num_joints;
    EXPECT_EQ(Validate(message), "");
  }
  message.layout = person_keypoints_t::LAYOUT_INVALID;
  EXPECT_NE(Validate(message), "");
}

TEST(ValidateTest, Keypoints) {
  using M = person_keypoints_t;
  ExpectReject<M>("layout 0", [](M* m) { m->layout = M::LAYOUT_INVALID; });
  ExpectReject<M>("layout 4", [](M* m) { m->layout = 4; });
  ExpectReject<M>("num_joints 17", [](M* m) { m->layout = M::LAYOUT_COCO18; });
  ExpectReject<M>("num_people 201", [](M* m) { m->num_people = 201; });
  ExpectReject<M>("u_px nan", [](M* m) { m->u_px[1][3] = kNanF; });
  ExpectReject<M>("v_px inf", [](M* m) { m->v_px[0][16] = kInfF; });
  ExpectReject<M>("confidence 1.5", [](M* m) { m->confidence[1][0] = 1.5F; });
}

TEST(ValidateTest, Mask) {
  using M = person_mask_t;
  ExpectReject<M>("encoding 4", [](M* m) { m->encoding = 4; });
  ExpectReject<M>("num_bytes 12 must be 0", [](M* m) { m->encoding = M::ENCODING_NONE; });
  ExpectReject<M>("num_bytes 12 must be 15", [](M* m) { m->width = 5; });
  ExpectReject<M>("height -1", [](M* m) { m->height = -1; });
  M none = Sample<M>();
  none.encoding = M::ENCODING_NONE;
  none.width = none.height = none.num_bytes = 0;
  none.data.clear();
  EXPECT_EQ(Validate(none), "");
}

TEST(ValidateTest, StaticFeatures) {
  using M = static_features_t;
  ExpectReject<M>("tracking_state -1", [](M* m) { m->tracking_state = -1; });
  ExpectReject<M>("where nothing was tracked", [](M* m) { m->tracking_state = M::STATE_INVALID; });
  ExpectReject<M>("tracking_state 5", [](M* m) { m->tracking_state = 5; });
  ExpectReject<M>("position_O_C nan", [](M* m) { m->position_O_C[2] = kNan; });
  ExpectReject<M>("orientation_O_C 1.1", [](M* m) { m->orientation_O_C[0] = 1.1; });
  ExpectReject<M>("orientation_O_C nan", [](M* m) { m->orientation_O_C[0] = kNan; });
  ExpectReject<M>("odometry_start_seq -1", [](M* m) { m->odometry_start_seq = -1; });
  ExpectReject<M>("odometry_start_seq", [](M* m) { m->odometry_start_seq = m->seq + 1; });
  ExpectReject<M>("position_W_C nan", [](M* m) { m->position_W_C[1] = kNan; });
  ExpectReject<M>("orientation_W_C", [](M* m) { m->orientation_W_C[0] = 0; });
  ExpectReject<M>("sigma_position_m", [](M* m) { m->sigma_position_m = -1; });
  ExpectReject<M>("sigma_orientation_rad", [](M* m) { m->sigma_orientation_rad = kNan; });
  ExpectReject<M>("num_masked", [](M* m) { m->num_masked = -1; });
  ExpectReject<M>("num_features 20001", [](M* m) { m->num_features = 20001; });
  ExpectReject<M>("landmark_id -2", [](M* m) { m->landmark_id[1] = -2; });
  ExpectReject<M>("u_left_px nan", [](M* m) { m->u_left_px[0] = kNanF; });
  ExpectReject<M>("v_px 1e+09", [](M* m) { m->v_px[1] = 1e9F; });
  ExpectReject<M>("u_right_px nan", [](M* m) { m->u_right_px[0] = kNanF; });
  ExpectReject<M>("has_right 2", [](M* m) { m->has_right[1] = 2; });
  ExpectReject<M>("sigma_px 0", [](M* m) { m->sigma_px[0] = 0; });
  M without_right = Sample<M>();
  without_right.u_right_px[1] = kNanF;
  EXPECT_EQ(Validate(without_right), "") << "meaningless where has_right is false";
}

TEST(ValidateTest, HumanObservations) {
  using M = human_observations_t;
  ExpectReject<M>("num_detected_left", [](M* m) { m->num_detected_left = -1; });
  ExpectReject<M>("num_humans 300", [](M* m) { m->num_humans = 300; });
  ExpectReject<M>("track_id -1", [](M* m) { m->humans[1].track_id = -1; });
  ExpectReject<M>("num_joints 15", [](M* m) { m->humans[0].num_joints = 15; });
  ExpectReject<M>("joint_id 14", [](M* m) { m->humans[0].joint_id[1] = 14; });
  ExpectReject<M>("joint_id -3", [](M* m) { m->humans[0].joint_id[1] = -3; });
  ExpectReject<M>("joint_id 1 comes twice", [](M* m) { m->humans[1].joint_id[1] = 1; });
  ExpectReject<M>("pixel nan", [](M* m) { m->humans[1].v_right_px[1] = kNanF; });
  ExpectReject<M>("sigma_px -1", [](M* m) { m->humans[1].sigma_px[1] = -1; });
  ExpectReject<M>("sigma_px inf", [](M* m) { m->humans[1].sigma_px[1] = kInfF; });
  ExpectReject<M>("coordinate inf", [](M* m) { m->humans[1].z_C_m[0] = kInfF; });
  ExpectReject<M>("diagonal -1", [](M* m) { m->humans[0].covariance_C[1][3] = -1; });
  ExpectReject<M>("covariance_C nan", [](M* m) { m->humans[0].covariance_C[1][1] = kNanF; });
}

TEST(ValidateTest, StateEstimate) {
  using M = state_estimate_t;
  ExpectReject<M>("status 5", [](M* m) { m->status = 5; });
  ExpectReject<M>("trusted 0", [](M* m) { m->trusted = 0; });
  ExpectReject<M>("position_W_C nan", [](M* m) { m->position_W_C[0] = kNan; });
  ExpectReject<M>("without_people", [](M* m) { m->position_without_people_W_C[1] = kNan; });
  ExpectReject<M>("with_people", [](M* m) { m->orientation_with_people_W_C[2] = 0; });
  ExpectReject<M>("covariance nan", [](M* m) { m->covariance[5] = kNan; });
  ExpectReject<M>("diagonal -0.1", [](M* m) { m->covariance[35] = -0.1; });
  ExpectReject<M>("count -7", [](M* m) { m->num_iterations = -7; });
  ExpectReject<M>("final_cost nan", [](M* m) { m->final_cost = kNan; });
}

TEST(ValidateTest, MapUpdate) {
  using M = map_update_t;
  ExpectReject<M>("num_parts 0", [](M* m) { m->num_parts = 0; });
  ExpectReject<M>("num_parts 65", [](M* m) { m->num_parts = 65; });
  ExpectReject<M>("part 2", [](M* m) { m->part = 2; });
  ExpectReject<M>("part -1", [](M* m) { m->part = -1; });
  ExpectReject<M>("frame's seq", [](M* m) { m->frames[1].seq = -1; });
  ExpectReject<M>("frame's orientation", [](M* m) { m->frames[1].orientation_W_C[0] = 2; });
  ExpectReject<M>("repeated_landmark_id -1", [](M* m) { m->repeated_landmark_id[0] = -1; });
  ExpectReject<M>("repeated landmark's coordinate", [](M* m) { m->repeated_z_W_m[0] = kNan; });
  ExpectReject<M>("repeated_sigma_m 0", [](M* m) { m->repeated_sigma_m[1] = 0; });
  ExpectReject<M>("repeated_num_observations -1",
                  [](M* m) { m->repeated_num_observations[1] = -1; });
  ExpectReject<M>("landmark_id -1", [](M* m) { m->landmark_id[0] = -1; });
  ExpectReject<M>("landmark's coordinate", [](M* m) { m->y_W_m[1] = kNan; });
  ExpectReject<M>("sigma_m 0", [](M* m) { m->sigma_m[1] = 0; });
  ExpectReject<M>("num_observations -1", [](M* m) { m->num_observations[0] = -1; });
  ExpectReject<M>("removed_landmark_id -1", [](M* m) { m->removed_landmark_id[0] = -1; });
  ExpectReject<M>("person's seq", [](M* m) { m->humans[0].seq = -1; });
  ExpectReject<M>("joint_id 20", [](M* m) { m->humans[0].joint_id[0] = 20; });
  ExpectReject<M>("coordinate nan", [](M* m) { m->humans[1].z_W_measured_m[0] = kNanF; });
  ExpectReject<M>("segment_id 14", [](M* m) { m->humans[1].segment_id[0] = 14; });
  ExpectReject<M>("length_m 0", [](M* m) { m->humans[1].length_m[0] = 0; });
  ExpectReject<M>("part_id 9", [](M* m) { m->humans[1].part_id[0] = 9; });
  ExpectReject<M>("translation_m nan", [](M* m) { m->humans[1].translation_m[1][2] = kNanF; });
  ExpectReject<M>("rotation 0", [](M* m) { m->humans[1].rotation[0][0] = 0; });
}

TEST(ValidateTest, PoseFrameDoneAndStatus) {
  ExpectReject<pose_t>("axes 0", [](pose_t* m) { m->axes = 0; });
  ExpectReject<pose_t>("position nan", [](pose_t* m) { m->position[0] = kNan; });
  ExpectReject<pose_t>("orientation 0", [](pose_t* m) { m->orientation[3] = 0; });
  ExpectReject<frame_done_t>("process", [](frame_done_t* m) { m->process.clear(); });
  using M = process_status_t;
  ExpectReject<M>("process", [](M* m) { m->process.clear(); });
  ExpectReject<M>("state 0", [](M* m) { m->state = 0; });
  ExpectReject<M>("pid -1", [](M* m) { m->pid = -1; });
  ExpectReject<M>("frame counter -1", [](M* m) { m->num_frames_skipped = -1; });
  ExpectReject<M>("latency", [](M* m) { m->latency_p99_ms = kNan; });
  ExpectReject<M>("num_warnings 101", [](M* m) { m->num_warnings = 101; });
  ExpectReject<M>("a warning 1001 letters", [](M* m) { m->warnings[1].assign(1001, 'a'); });
  ExpectReject<M>("num_channels 101", [](M* m) { m->num_channels = 101; });
  ExpectReject<M>("channel counter -2", [](M* m) { m->channels[1].num_missing = -2; });
}

// Found by fuzzing: encoding such a text again aborted.
TEST(ValidateTest, Texts) {
  ExpectReject<frame_done_t>("letters with a zero in it",
                             [](frame_done_t* m) { m->process = std::string("a\0b", 3); });
  ExpectReject<frame_done_t>("process 1001 letters are too many",
                             [](frame_done_t* m) { m->process.assign(1001, 'a'); });
  using M = process_status_t;
  ExpectReject<M>("zero in it", [](M* m) { m->version = std::string(1, '\0'); });
  ExpectReject<M>("zero in it", [](M* m) { m->types_fingerprint = std::string(1, '\0'); });
  ExpectReject<M>("zero in it", [](M* m) { m->last_error = std::string(1, '\0'); });
  ExpectReject<M>("zero in it", [](M* m) { m->waiting_for = std::string(1, '\0'); });
  ExpectReject<M>("zero in it", [](M* m) { m->channels[1].channel = std::string(1, '\0'); });
  ExpectReject<M>("last_reject", [](M* m) { m->channels[1].last_reject.assign(1001, 'a'); });
}

}  // namespace
}  // namespace airdos
