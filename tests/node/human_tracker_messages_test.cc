#include "processes/human_tracker/human_tracker_messages.h"

#include <gtest/gtest.h>

#include <vector>

#include "processes/node/message/validate.h"

namespace airdos {
namespace {

// Every field differs from every other, so that no two can be exchanged unseen.
const Header kHeader{1500000, 42, 9};

TriangulatedJoint Joint() {
  TriangulatedJoint joint;
  joint.u_left_px = 11.5;
  joint.v_px = 12.5;
  joint.u_right_px = 10.5;
  joint.sigma_px = 1.25;
  joint.confidence = 0.75;
  joint.p_C = {0.5, -0.25, 4};
  joint.covariance_C << 0.25, 0.0625, -0.03125, 0.0625, 0.5, 0.125, -0.03125, 0.125, 1;
  return joint;
}

TEST(HumanTrackerMessages, TheFramesNumbersGoToTheirNames) {
  PeopleFrame frame;
  frame.left.resize(3);
  frame.right.resize(2);
  TrackedFrame tracked;
  tracked.num_rejected = 4;
  const human_observations_t message = ToHumanObservations(kHeader, frame, tracked);
  EXPECT_EQ(message.utime, 1500000);
  EXPECT_EQ(message.seq, 42);
  EXPECT_EQ(message.session, 9);
  EXPECT_EQ(message.num_detected_left, 3);
  EXPECT_EQ(message.num_detected_right, 2);
  EXPECT_EQ(message.num_rejected, 4);
  EXPECT_EQ(message.num_humans, 0);
  EXPECT_EQ(Validate(message), "");
}

TEST(HumanTrackerMessages, JointsThatWereSeenKeepTheirNumbersAndValues) {
  TrackedFrame tracked;
  tracked.humans.resize(2);
  tracked.humans[0].id = HumanId{17};
  tracked.humans[1].id = HumanId{18};
  tracked.humans[1].joints[4] = Joint();
  TriangulatedJoint other = Joint();
  other.p_C.z() = 5;
  tracked.humans[1].joints[11] = other;
  const human_observations_t message = ToHumanObservations(kHeader, {}, tracked);
  ASSERT_EQ(message.num_humans, 2);
  EXPECT_EQ(message.humans[0].track_id, 17);
  EXPECT_EQ(message.humans[0].num_joints, 0);
  const human_observation_t& human = message.humans[1];
  EXPECT_EQ(human.track_id, 18);
  ASSERT_EQ(human.num_joints, 2);
  EXPECT_EQ(human.joint_id, (std::vector<std::int8_t>{4, 11}));
  EXPECT_EQ(human.u_left_px[0], 11.5F);
  EXPECT_EQ(human.v_left_px[0], 12.5F);
  EXPECT_EQ(human.u_right_px[0], 10.5F);
  EXPECT_EQ(human.v_right_px[0], 12.5F) << "rows are the same";
  EXPECT_EQ(human.sigma_px[0], 1.25F);
  EXPECT_EQ(human.x_C_m[0], 0.5F);
  EXPECT_EQ(human.y_C_m[0], -0.25F);
  EXPECT_EQ(human.z_C_m, (std::vector<float>{4, 5}));
  EXPECT_EQ(human.covariance_C[0],
            (std::vector<float>{0.25F, 0.0625F, -0.03125F, 0.5F, 0.125F, 1}));
  EXPECT_EQ(Validate(message), "");
}

}  // namespace
}  // namespace airdos
