// Every single field of every message: a value that makes no sense in it alone is rejected, and the
// greatest and least that are allowed pass.
#include <gtest/gtest.h>

#include <cstdint>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "processes/node/message/validate.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr float kNanF = std::numeric_limits<float>::quiet_NaN();
constexpr float kInfF = std::numeric_limits<float>::infinity();

template <class Message>
using Change = std::function<void(Message*)>;

template <class Message>
void ExpectEachRejected(const std::vector<Change<Message>>& changes) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Message message = Sample<Message>();
    changes[i](&message);
    EXPECT_NE(Validate(message), "") << Message::getTypeName() << ", change " << i;
  }
}

template <class Message>
void ExpectEachAccepted(const std::vector<Change<Message>>& changes) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Message message = Sample<Message>();
    changes[i](&message);
    EXPECT_EQ(Validate(message), "") << Message::getTypeName() << ", change " << i;
  }
}

/// One element of a list at a time is replaced.
template <class Message, class List, class Value>
void ExpectElementsRejected(List Message::*list, Value value) {
  const std::size_t size = (Sample<Message>().*list).size();
  ASSERT_GT(size, 1u);
  for (std::size_t i = 0; i < size; ++i) {
    Message message = Sample<Message>();
    (message.*list)[i] = value;
    EXPECT_NE(Validate(message), "") << Message::getTypeName() << ", element " << i;
  }
}

/// As above, in each of the people of a message.
template <class Message, class Human, class List, class Value>
void ExpectPeoplesElementsRejected(List Human::*list, Value value) {
  for (std::size_t person = 0; person < 2; ++person) {
    for (std::size_t i = 0; i < 2; ++i) {
      Message message = Sample<Message>();
      (message.humans[person].*list)[i] = value;
      EXPECT_NE(Validate(message), "") << "person " << person << ", element " << i;
    }
  }
}

TEST(ValidateBoundsTest, Headers) {
  ExpectEachRejected<pose_t>({[](pose_t* m) { m->seq = -1; }, [](pose_t* m) { m->utime = -1; },
                              [](pose_t* m) { m->seq = (std::int64_t{1} << 40) + 1; },
                              [](pose_t* m) { m->utime = std::int64_t{3} << 61; }});
  ExpectEachAccepted<pose_t>({[](pose_t* m) { m->seq = m->utime = 0; },
                              [](pose_t* m) { m->seq = std::int64_t{1} << 40; },
                              [](pose_t* m) { m->session = -5; }});
}

TEST(ValidateBoundsTest, Image) {
  using M = image_t;
  const auto resize = [](M* m, int width, int height, int num_bytes) {
    m->width = width;
    m->height = height;
    m->num_bytes = num_bytes;
    m->data.assign(static_cast<std::size_t>(num_bytes), 1);
  };
  const auto color = [&](M* m, int num_bytes) {
    resize(m, 4, 3, num_bytes);
    m->encoding = M::ENCODING_RAW_BGR8;
  };
  ExpectEachRejected<M>({[&](M* m) { resize(m, 0, 3, 0); }, [&](M* m) { resize(m, 4, 0, 0); },
                         [&](M* m) { resize(m, 4, 3, 11); }, [&](M* m) { resize(m, 4, 3, 13); },
                         [&](M* m) { resize(m, 4001, 3000, 12003000); },
                         [&](M* m) { color(m, 12); }, [&](M* m) { color(m, 35); }});
  ExpectEachAccepted<M>({[&](M* m) { resize(m, 8192, 1, 8192); },
                         [&](M* m) { resize(m, 1, 8192, 8192); }, [&](M* m) { color(m, 36); },
                         [&](M* m) { m->encoding = M::ENCODING_PNG; }});
}

TEST(ValidateBoundsTest, Calibration) {
  using M = stereo_calibration_t;
  ExpectEachRejected<M>(
      {[](M* m) { m->width = 0; }, [](M* m) { m->height = 0; }, [](M* m) { m->fx_px = -500; },
       [](M* m) { m->fy_px = -500; }, [](M* m) { m->fx_px = 6.3; }, [](M* m) { m->fy_px = 4.7; },
       [](M* m) { m->fx_px = 1.1e5; }, [](M* m) { m->fy_px = 1.1e5; }, [](M* m) { m->cx_px = 0; },
       [](M* m) { m->cy_px = 0; }, [](M* m) { m->cx_px = 641; }, [](M* m) { m->cy_px = 481; },
       [](M* m) { m->cy_px = 600; }, [](M* m) { m->baseline_m = 0.0009; },
       [](M* m) { m->baseline_m = 1001; }, [](M* m) { m->baseline_m = kNan; }});
  ExpectEachAccepted<M>({[](M* m) { m->fx_px = 6.5; }, [](M* m) { m->fy_px = 4.9; },
                         [](M* m) { m->baseline_m = 0.0011; }, [](M* m) { m->cx_px = 639; },
                         [](M* m) { m->cy_px = 479; }});
}

TEST(ValidateBoundsTest, Keypoints) {
  using M = person_keypoints_t;
  const auto layout = [](M* m, std::int8_t number, std::int32_t num_joints) {
    m->layout = number;
    m->num_joints = num_joints;
    for (auto* rows : {&m->u_px, &m->v_px, &m->confidence})
      rows->assign(2, std::vector<float>(static_cast<std::size_t>(num_joints), 0.5F));
  };
  const struct {
    std::int8_t number;
    std::int32_t num_joints;
  } layouts[] = {{M::LAYOUT_COCO18, 18}, {M::LAYOUT_COCO17, 17}, {M::LAYOUT_HALPE26, 26}};
  for (const auto& one : layouts) {
    for (const auto& other : layouts) {
      M message = Sample<M>();
      layout(&message, one.number, other.num_joints);
      EXPECT_EQ(Validate(message).empty(), one.num_joints == other.num_joints);
    }
  }
  for (std::size_t person = 0; person < 2; ++person) {
    for (std::size_t joint = 0; joint < 17; ++joint) {
      ExpectEachRejected<M>({[=](M* m) { m->u_px[person][joint] = kNanF; },
                             [=](M* m) { m->v_px[person][joint] = kNanF; },
                             [=](M* m) { m->confidence[person][joint] = 1.01F; },
                             [=](M* m) { m->confidence[person][joint] = -0.01F; }});
    }
  }
}

TEST(ValidateBoundsTest, StaticFeatures) {
  using M = static_features_t;
  for (std::size_t i = 0; i < 3; ++i) {
    ExpectEachRejected<M>({[=](M* m) { m->position_O_C[i] = 1.1e7; },
                           [=](M* m) { m->position_O_C[i] = -1.1e7; },
                           [=](M* m) { m->position_W_C[i] = kNan; }});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    ExpectEachRejected<M>(
        {[=](M* m) { m->orientation_O_C[i] += 0.1; }, [=](M* m) { m->orientation_W_C[i] = kNan; }});
  }
  ExpectEachRejected<M>(
      {[](M* m) { m->odometry_start_seq = -1; }, [](M* m) { m->odometry_start_seq = m->seq + 1; },
       [](M* m) { m->sigma_position_m = -0.1; }, [](M* m) { m->sigma_orientation_rad = -0.1; },
       [](M* m) { m->sigma_orientation_rad = 1001; }, [](M* m) { m->num_detected = -1; },
       [](M* m) { m->num_matched = -1; }, [](M* m) { m->num_features = 5001; }});
  ExpectElementsRejected(&M::landmark_id, -1);
  ExpectElementsRejected(&M::u_left_px, kNanF);
  ExpectElementsRejected(&M::v_px, -1.1e5F);
  ExpectElementsRejected(&M::sigma_px, 0.9e-4F);
  ExpectElementsRejected(&M::has_right, std::int8_t{-1});
  ExpectEachRejected<M>({[](M* m) { m->u_right_px[0] = kInfF; }});
  ExpectEachAccepted<M>({[](M* m) { m->u_right_px[1] = kInfF; },
                         [](M* m) { m->odometry_start_seq = 0; },
                         [](M* m) { m->odometry_start_seq = m->seq; },
                         [](M* m) { m->sigma_position_m = m->sigma_orientation_rad = 0; }});
}

TEST(ValidateBoundsTest, HumanObservations) {
  using M = human_observations_t;
  using H = human_observation_t;
  for (const auto list : {&H::u_left_px, &H::v_left_px, &H::u_right_px, &H::v_right_px}) {
    ExpectPeoplesElementsRejected<M>(list, 1.1e5F);
    ExpectPeoplesElementsRejected<M>(list, kNanF);
  }
  for (const auto list : {&H::x_C_m, &H::y_C_m, &H::z_C_m}) {
    ExpectPeoplesElementsRejected<M>(list, 1.1e7F);
    ExpectPeoplesElementsRejected<M>(list, -1.1e7F);
  }
  ExpectPeoplesElementsRejected<M>(&H::sigma_px, 0.9e-4F);
  ExpectPeoplesElementsRejected<M>(&H::sigma_px, 1.1e5F);
  ExpectPeoplesElementsRejected<M>(&H::joint_id, std::int8_t{14});
  for (std::size_t i = 0; i < 6; ++i) {
    const bool is_diagonal = i == 0 || i == 3 || i == 5;  // xx, yy, zz of xx, xy, xz, yy, yz, zz
    M message = Sample<M>();
    message.humans[1].covariance_C[1][i] = -0.5F;
    EXPECT_EQ(Validate(message).empty(), !is_diagonal) << i;
    ExpectEachRejected<M>({[=](M* m) { m->humans[1].covariance_C[0][i] = 2e12F; },
                           [=](M* m) { m->humans[0].covariance_C[1][i] = kNanF; }});
  }
  ExpectEachRejected<M>(
      {[](M* m) { m->num_detected_left = -1; }, [](M* m) { m->num_detected_right = -1; },
       [](M* m) { m->num_rejected = -1; }, [](M* m) { m->humans[1].track_id = -1; },
       [](M* m) {
         m->humans[0].joint_id = {5, 5};
       }});
}

TEST(ValidateBoundsTest, StateEstimate) {
  using M = state_estimate_t;
  for (std::size_t i = 0; i < 3; ++i) {
    ExpectEachRejected<M>({[=](M* m) { m->position_W_C[i] = kNan; },
                           [=](M* m) { m->position_without_people_W_C[i] = 1.1e7; },
                           [=](M* m) { m->position_with_people_W_C[i] = -1.1e7; }});
  }
  for (std::size_t i = 0; i < 4; ++i) {
    ExpectEachRejected<M>({[=](M* m) { m->orientation_W_C[i] += 0.1; },
                           [=](M* m) { m->orientation_without_people_W_C[i] += 0.1; },
                           [=](M* m) { m->orientation_with_people_W_C[i] += 0.1; }});
  }
  for (std::size_t i = 0; i < 36; ++i) {
    M message = Sample<M>();
    message.covariance[i] = -1e-3;
    EXPECT_EQ(Validate(message).empty(), i % 7 != 0) << i;
    ExpectEachRejected<M>({[=](M* m) { m->covariance[i] = 2e12; }});
  }
  std::int32_t M::*const counts[] = {&M::num_window_frames,       &M::num_static_landmarks,
                                     &M::num_static_observations, &M::num_people,
                                     &M::num_rigidity_factors,    &M::num_motion_factors,
                                     &M::num_rigidity_eliminated, &M::num_motion_eliminated,
                                     &M::num_iterations,          &M::num_reprojection_eliminated};
  for (std::int32_t M::*count : counts) ExpectEachRejected<M>({[=](M* m) { m->*count = -1; }});
  ExpectEachRejected<M>({[](M* m) { m->initial_cost = -1; }, [](M* m) { m->final_cost = -1; },
                         [](M* m) { m->status = -1; }, [](M* m) { m->status = 5; },
                         [](M* m) { m->trusted = 3; }});
  ExpectEachAccepted<M>(
      {[](M* m) { m->status = 0; }, [](M* m) { m->status = 4; }, [](M* m) { m->trusted = 1; }});
}

TEST(ValidateBoundsTest, MapUpdate) {
  using M = map_update_t;
  using H = human_state_t;
  for (const auto list : {&M::x_W_m, &M::y_W_m, &M::z_W_m}) ExpectElementsRejected(list, kNan);
  ExpectElementsRejected(&M::sigma_m, 0.0F);
  ExpectElementsRejected(&M::sigma_m, kInfF);
  ExpectElementsRejected(&M::sigma_m, kNanF);
  ExpectElementsRejected(&M::landmark_id, -1);
  ExpectElementsRejected(&M::num_observations, -1);
  ExpectElementsRejected(&M::removed_landmark_id, -1);
  for (const auto list : {&H::x_W_m, &H::y_W_m, &H::z_W_m, &H::x_W_measured_m, &H::y_W_measured_m,
                          &H::z_W_measured_m})
    ExpectPeoplesElementsRejected<M>(list, kNanF);
  ExpectPeoplesElementsRejected<M>(&H::length_m, -0.1F);
  ExpectPeoplesElementsRejected<M>(&H::length_m, kInfF);
  ExpectPeoplesElementsRejected<M>(&H::joint_id, std::int8_t{14});
  ExpectPeoplesElementsRejected<M>(&H::segment_id, std::int8_t{14});
  ExpectPeoplesElementsRejected<M>(&H::part_id, std::int8_t{9});
  ExpectEachRejected<M>({[](M* m) {
                           m->humans[1].segment_id = {4, 4};
                         },
                         [](M* m) {
                           m->humans[1].part_id = {4, 4};
                         },
                         [](M* m) { m->humans[1].utime = -1; },
                         [](M* m) { m->humans[1].track_id = -1; }, [](M* m) { m->part = 2; }});
  for (std::size_t i = 0; i < 3; ++i) {
    ExpectEachRejected<M>({[=](M* m) { m->humans[1].translation_m[1][i] = kNanF; },
                           [=](M* m) { m->humans[0].translation_m[0][i] = 1.1e7F; },
                           [=](M* m) { m->frames[1].position_W_C[i] = kNan; }});
  }
  ExpectEachRejected<M>(
      {[](M* m) { m->frames[1].utime = -1; }, [](M* m) { m->humans[1].rotation[1][3] = 0.1F; }});
  ExpectEachAccepted<M>({[](M* m) { m->part = 1; }, [](M* m) { m->part = 0; }});
}

TEST(ValidateBoundsTest, PoseAndStatus) {
  for (std::size_t i = 0; i < 3; ++i)
    ExpectEachRejected<pose_t>({[=](pose_t* m) { m->position[i] = -1.1e7; }});
  for (std::size_t i = 0; i < 4; ++i)
    ExpectEachRejected<pose_t>({[=](pose_t* m) { m->orientation[i] += 0.1; }});
  ExpectEachRejected<pose_t>({[](pose_t* m) { m->axes = 0; }, [](pose_t* m) { m->axes = 4; }});
  ExpectEachAccepted<pose_t>({[](pose_t* m) { m->axes = 1; }, [](pose_t* m) { m->axes = 2; },
                              [](pose_t* m) { m->axes = 3; }});
  using M = process_status_t;
  for (std::string M::*text :
       {&M::process, &M::version, &M::types_fingerprint, &M::waiting_for, &M::last_error})
    ExpectEachRejected<M>({[=](M* m) { (m->*text).assign(1001, 'x'); }});
  for (std::int64_t M::*count :
       {&M::pid, &M::num_frames_done, &M::num_frames_incomplete, &M::num_frames_skipped})
    ExpectEachRejected<M>({[=](M* m) { m->*count = -1; }});
  for (double M::*figure :
       {&M::latency_p50_ms, &M::latency_p99_ms, &M::cpu_ms_per_frame, &M::memory_mb})
    ExpectEachRejected<M>({[=](M* m) { m->*figure = -1; }, [=](M* m) { m->*figure = kNan; }});
  using C = channel_status_t;
  for (std::int64_t C::*count :
       {&C::num_received, &C::num_missing, &C::num_duplicate, &C::num_rejected})
    ExpectEachRejected<M>({[=](M* m) { m->channels[1].*count = -1; }});
  ExpectEachRejected<M>({[](M* m) { m->state = 0; }, [](M* m) { m->state = 5; }});
  ExpectEachAccepted<M>({[](M* m) { m->state = 1; }, [](M* m) { m->state = 4; }});
}

}  // namespace
}  // namespace airdos
