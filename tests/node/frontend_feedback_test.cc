#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <vector>

#include "processes/frontend/frontend_node.h"
#include "tests/node/frontend_walk.h"

// What the frontend makes of the optimizer's MAP_UPDATE.

namespace airdos {
namespace {

/// Says of the even ones of frame 0's landmarks that they are at T_new_old of where they were seen.
void AddLandmarks(const static_features_t& features, const Se3& T_new_old, map_update_t* update) {
  for (std::size_t i = 0; i < features.landmark_id.size(); ++i) {
    if (features.landmark_id[i] % 2 != 0) continue;
    const auto p_C = SmallStereoCamera().Triangulate(features.u_left_px[i], features.v_px[i],
                                                     features.u_right_px[i]);
    if (!p_C) continue;
    const Eigen::Vector3d p_W = T_new_old * *p_C;  // W is the camera of frame 0
    update->landmark_id.push_back(features.landmark_id[i]);
    update->x_W_m.push_back(p_W.x());
    update->y_W_m.push_back(p_W.y());
    update->z_W_m.push_back(p_W.z());
    update->sigma_m.push_back(0.01F);
    update->num_observations.push_back(2);
  }
  update->num_landmarks = static_cast<std::int32_t>(update->landmark_id.size());
}

TEST(FrontendNode, WaitsForTheUpdateOfTwoFramesBack) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 5; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  Send(channel::kMapUpdate, Update(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  // Update 1 never comes: that of a later frame says so.
  Send(channel::kMapUpdate, Update(2), &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  EXPECT_EQ(node.waiting_for(), "");
}

TEST(FrontendNode, AnUpdateInPartsCountsOnceItIsWhole) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  map_update_t part = Update(0);
  part.num_parts = 2;
  part.part = 1;
  Send(channel::kMapUpdate, part, &node);
  EXPECT_FALSE(node.Step());
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  // What does not go with it is no part of it.
  Send(channel::kMapUpdate, part, &node);
  EXPECT_EQ(node.channels().at(channel::kMapUpdate).last_reject, "part 1 came twice");
  Send(channel::kMapUpdate, Update(0), &node);
  EXPECT_EQ(node.channels().at(channel::kMapUpdate).last_reject,
            "num_parts 1 differs from that of another part");
  EXPECT_FALSE(node.Step());
  part.part = 0;
  Send(channel::kMapUpdate, part, &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
}

TEST(FrontendNode, WithoutAnUpdateItGoesOnAndWaitsAgainOnceOneComes) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 8; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  ASSERT_TRUE(node.CompleteOldest());
  const std::vector<static_features_t> completed = Take(&node);
  ASSERT_EQ(completed.size(), 1u);
  EXPECT_EQ(completed[0].tracking_state, kTracking);
  // The optimizer is silent: the next ones do not wait for it.
  ASSERT_TRUE(node.Step());
  ASSERT_TRUE(node.Step());
  EXPECT_EQ(Take(&node).back().seq, 4);
  // It is back, with frame 4: frames 5 and 6 may start, and 7 waits for frame 5.
  Send(channel::kMapUpdate, Update(4), &node);
  EXPECT_EQ(StepAll(&node).back().seq, 6);
  EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  EXPECT_EQ(node.frames().num_done, 7);
}

TEST(FrontendNode, UpdatesThatDoNotBelongHereAreRejected) {
  FrontendNode node(FrontendOptions{});
  const auto num_rejected = [&node] {
    return node.channels().at(channel::kMapUpdate).num_rejected;
  };
  Send(channel::kMapUpdate, Update(0), &node);  // before any frame
  EXPECT_EQ(num_rejected(), 1);
  Send(channel::kCalibration, Calibration(), &node);
  for (int k = 0; k < 3; ++k) SendFrame(k, &node);
  EXPECT_EQ(StepAll(&node).size(), 2u);
  Send(channel::kMapUpdate, Update(1, kSession + 1), &node);
  EXPECT_EQ(num_rejected(), 2);
  EXPECT_EQ(node.channels().at(channel::kMapUpdate).last_reject, "of another session");
  Send(channel::kMapUpdate, Update(4), &node);  // of a frame that is far from being done
  EXPECT_EQ(num_rejected(), 3);
  EXPECT_FALSE(node.Step());
  Send(channel::kMapUpdate, Update(0), &node);
  EXPECT_EQ(StepAll(&node).size(), 1u);
  Send(channel::kMapUpdate, Update(0), &node);  // again, and too late
  EXPECT_EQ(num_rejected(), 4);
}

// Updates 0 and 1 got lost, and the optimizer has waited in vain for frame 2: for it, or the one
// after where that one got lost as well, nobody waits any more.
TEST(FrontendNode, AnUpdateOfTheNextFrameEndsTheWaiting) {
  for (const std::int64_t given_up : {2, 3}) {
    FrontendNode node(FrontendOptions{});
    Send(channel::kCalibration, Calibration(), &node);
    for (int k = 0; k < 6; ++k) SendFrame(k, &node);
    EXPECT_EQ(StepAll(&node).size(), 2u);
    Send(channel::kMapUpdate, Update(given_up), &node);
    EXPECT_EQ(node.channels().at(channel::kMapUpdate).num_rejected, 1);
    ASSERT_TRUE(node.Step());
    ASSERT_TRUE(node.Step());
    EXPECT_EQ(Take(&node).back().seq, 3);
    // The optimizer has taken up frame 3: from now on it is waited for again.
    Send(channel::kMapUpdate, Update(3), &node);
    EXPECT_EQ(StepAll(&node).back().seq, 5);
    SendFrame(6, &node);
    EXPECT_TRUE(StepAll(&node).empty());
    EXPECT_EQ(node.waiting_for(), channel::kMapUpdate);
  }
}

TEST(FrontendNode, TheOptimizersWorldIsTakenOverAndTheOdometryFrameStays) {
  // The optimizer has frame 0 elsewhere and says of every second of its landmarks where it is now.
  // The others go with their frame: only if both are taken over do they still agree.
  Se3 T_new_old;
  T_new_old.translation = {0.3, -0.2, 0.1};
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  std::set<std::int64_t> first;
  for (int k = 0; k < 6; ++k) {
    SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    EXPECT_EQ(output[0].tracking_state, k == 0 ? kInitializing : kTracking);
    EXPECT_LT(PositionError_m(output[0], Truth(k)), 0.015) << "frame " << k;
    int num_seen[] = {0, 0};  // of the landmarks of frame 0, with even and odd numbers
    for (const std::int64_t id : output[0].landmark_id) {
      if (k == 0) first.insert(id);
      num_seen[id % 2] += static_cast<int>(first.count(id));
    }
    EXPECT_GT(num_seen[0], 20) << "frame " << k;
    EXPECT_GT(num_seen[1], 20) << "frame " << k;
    map_update_t update = Update(k);
    if (k == 0) {
      AddFrame(0, T_new_old * Truth(0), &update);
      AddLandmarks(output[0], T_new_old, &update);
    }
    Send(channel::kMapUpdate, update, &node);
  }
}

TEST(FrontendNode, LandmarksThatTheOptimizerMovesAreLookedForElsewhere) {
  // The same without the frame: every second landmark is put where it cannot be.
  Se3 T_new_old;
  T_new_old.translation = {0.3, -0.2, 0.1};
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  std::set<std::int64_t> moved;
  for (int k = 0; k < 5; ++k) {
    SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    map_update_t update = Update(k);
    if (k == 0) {
      AddLandmarks(output[0], T_new_old, &update);
      moved.insert(update.landmark_id.begin(), update.landmark_id.end());
    }
    Send(channel::kMapUpdate, update, &node);
    std::size_t num_seen = 0;
    for (const std::int64_t id : output[0].landmark_id) num_seen += moved.count(id);
    // Update 0 is in force from frame 2 on, though it was there before frame 1.
    if (k < 2) {
      EXPECT_GT(num_seen, moved.size() / 2) << "frame " << k;
    } else {
      EXPECT_LT(num_seen, moved.size() / 10) << "frame " << k;
    }
  }
}

TEST(FrontendNode, LandmarksThatTheOptimizerRemovedAreNotSeenAgain) {
  FrontendNode node(FrontendOptions{});
  Send(channel::kCalibration, Calibration(), &node);
  std::vector<std::int64_t> removed;
  for (int k = 0; k < 5; ++k) {
    SendFrame(k, &node);
    const std::vector<static_features_t> output = StepAll(&node);
    ASSERT_EQ(output.size(), 1u);
    map_update_t update = Update(k);
    if (k == 0) {
      for (const std::int64_t id : output[0].landmark_id) {
        if (id % 2 == 0) removed.push_back(id);
      }
      update.removed_landmark_id = removed;
      update.num_removed = static_cast<std::int32_t>(removed.size());
    }
    Send(channel::kMapUpdate, update, &node);
    int num_seen = 0;
    for (const std::int64_t id : output[0].landmark_id) {
      num_seen += std::find(removed.begin(), removed.end(), id) != removed.end() ? 1 : 0;
    }
    EXPECT_EQ(num_seen > 0, k < 2) << "frame " << k;
  }
}

}  // namespace
}  // namespace airdos
