#include "processes/node/run_tally.h"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "airdos/state_estimate_t.hpp"
#include "airdos/static_features_t.hpp"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"

namespace airdos {
namespace {

class RunTallyTest : public testing::Test {
 protected:
  void Features(std::int64_t seq, int num_features) {
    static_features_t message = {};
    message.seq = seq;
    message.num_features = num_features;
    const auto num = static_cast<std::size_t>(num_features);
    message.landmark_id.resize(num);
    message.u_left_px.resize(num);
    message.v_px.resize(num);
    message.u_right_px.resize(num);
    message.has_right.resize(num);
    message.sigma_px.resize(num);
    Take(channel::kStaticFeatures, message);
  }

  void Estimate(std::int64_t seq, std::int8_t status, int num_static, bool trusts_people = false,
                double x_m = 0) {
    state_estimate_t message = {};
    message.seq = seq;
    message.status = status;
    message.num_static_observations = num_static;
    message.trusted = trusts_people ? state_estimate_t::TRUSTED_WITH_PEOPLE
                                    : state_estimate_t::TRUSTED_WITHOUT_PEOPLE;
    message.position_W_C[0] = x_m;
    Take(channel::kStateEstimate, message);
  }

  template <class Message>
  void Take(const char* channel, const Message& message) {
    const std::vector<std::uint8_t> bytes = Encode(message);
    tally_.Take(channel, bytes.data(), bytes.size());
  }

  RunTally tally_;
};

TEST_F(RunTallyTest, EachPoseCountsBySourceOnce) {
  Features(0, 7);
  Estimate(0, state_estimate_t::STATUS_FIRST_FRAME, 0);  // no map yet, but landmarks are in view
  Features(1, 7);
  Estimate(1, state_estimate_t::STATUS_CONVERGED, 6);
  Features(2, 0);
  Estimate(2, state_estimate_t::STATUS_CONVERGED, 0, /*trusts_people=*/true);
  Features(3, 0);
  Estimate(3, state_estimate_t::STATUS_PREDICTED, 0);
  Estimate(4, state_estimate_t::STATUS_INVALID, 0);
  Estimate(5, state_estimate_t::STATUS_CONVERGED, 9, false,
           std::numeric_limits<double>::quiet_NaN());
  const RunTally::Counts counts = tally_.Count();
  EXPECT_EQ(counts.num_frames, 6);
  EXPECT_EQ(counts.num_from_images, 2);
  EXPECT_EQ(counts.num_from_people, 1);
  EXPECT_EQ(counts.num_predicted, 1);
  EXPECT_EQ(counts.num_without_pose, 2);
  EXPECT_EQ(counts.num_static_features, 14);
  EXPECT_EQ(ToText(counts), "from images 2, from people 1, predicted only 1, without a pose 2");
  EXPECT_EQ(WhyInVain(counts), "");
}

TEST_F(RunTallyTest, FeaturesOfAnotherFrameDoNotCount) {
  Features(1, 7);
  Estimate(0, state_estimate_t::STATUS_FIRST_FRAME, 0);
  EXPECT_EQ(tally_.Count().num_predicted, 1);
}

TEST_F(RunTallyTest, ARunWithoutAPoseWasInVain) {
  EXPECT_EQ(WhyInVain(tally_.Count()), "");  // nothing came at all: nobody asked for anything
  Estimate(0, state_estimate_t::STATUS_INVALID, 0);
  EXPECT_NE(WhyInVain(tally_.Count()).find("none of 1 frames has a pose"), std::string::npos);
}

TEST_F(RunTallyTest, PosesWithoutAnyStaticLandmarkMeanNothing) {
  Features(0, 0);
  Estimate(0, state_estimate_t::STATUS_FIRST_FRAME, 0);
  Estimate(1, state_estimate_t::STATUS_PREDICTED, 0);
  EXPECT_NE(WhyInVain(tally_.Count()).find("no static landmark"), std::string::npos);
  Features(2, 1);
  EXPECT_EQ(WhyInVain(tally_.Count()), "");
}

TEST_F(RunTallyTest, GarbageAndOtherChannelsArePassedOver) {
  const char bytes[] = "no message";
  tally_.Take(channel::kStateEstimate, bytes, sizeof bytes);
  tally_.Take("CAMERA_LEFT", bytes, sizeof bytes);
  EXPECT_EQ(tally_.Count().num_frames, 0);
}

}  // namespace
}  // namespace airdos
