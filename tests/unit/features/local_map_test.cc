#include "common/features/local_map.h"

#include <gtest/gtest.h>

namespace airdos {
namespace {

Se3 Pose(double x, double yaw_rad) {
  Se3 T_W_C;
  T_W_C.translation = {x, 0.1 * x, -0.2 * x};
  T_W_C.rotation = ExpSo3({0.1 * yaw_rad, yaw_rad, 0});
  return T_W_C;
}

double Error(const Se3& a, const Se3& b) { return Boxminus(a, b).norm(); }

LocalLandmark LandmarkOf(const LocalMap& map, FrameId frame, const Eigen::Vector3d& p_C) {
  LocalLandmark landmark;
  landmark.reference_frame = frame;
  landmark.p_C_reference = p_C;
  landmark.p_W = map.poses_W_C().at(frame) * p_C;
  landmark.last_seen = frame;
  landmark.num_seen = 1;
  landmark.num_expected = 1;
  return landmark;
}

/// Frames 1 to 5 and a landmark created in each, with the id of the frame.
LocalMap FiveFrames(const LocalMapOptions& options = {}) {
  LocalMap map(options);
  for (std::int64_t seq = 1; seq <= 5; ++seq) {
    const auto k = static_cast<double>(seq);
    map.SetPose(FrameId{seq}, Pose(k, 0.1 * k));
    EXPECT_EQ(map.Add(LandmarkOf(map, FrameId{seq}, {0.3 * k, -0.2, 4 + k})).value, seq);
  }
  return map;
}

Eigen::Vector3d PointOf(const LocalMap& map, std::int64_t id) {
  return map.landmarks().at(LandmarkId{id}).p_W;
}

TEST(LocalMapApply, TheFramesOfTheCorrectionTakeItsPoses) {
  LocalMap map = FiveFrames();
  map.Apply({FrameId{3}, {{FrameId{2}, Pose(2.5, 0.1)}, {FrameId{3}, Pose(3.5, 0.2)}}, {}, {}});
  EXPECT_EQ(Error(map.poses_W_C().at(FrameId{2}), Pose(2.5, 0.1)), 0);
  EXPECT_EQ(Error(map.poses_W_C().at(FrameId{3}), Pose(3.5, 0.2)), 0);
  EXPECT_EQ(Error(map.poses_W_C().at(FrameId{1}), Pose(1, 0.1)), 0);  // not in it, and older
}

TEST(LocalMapApply, NewerFramesKeepTheirMotionRelativeToTheCorrection) {
  LocalMap map = FiveFrames();
  const std::map<FrameId, Se3> before = map.poses_W_C();
  map.Apply({FrameId{3}, {{FrameId{3}, Pose(-1, -0.7)}}, {}, {}});
  for (const std::int64_t seq : {4, 5}) {
    const Se3 motion = before.at(FrameId{3}).inverse() * before.at(FrameId{seq});
    EXPECT_LT(Error(map.poses_W_C().at(FrameId{seq}), Pose(-1, -0.7) * motion), 1e-12) << seq;
  }
}

TEST(LocalMapApply, UnrefinedLandmarksFollowTheirReferenceFrame) {
  LocalMap map = FiveFrames();
  map.Apply({FrameId{3}, {{FrameId{2}, Pose(2.5, 0)}, {FrameId{3}, Pose(3.5, 0)}}, {}, {}});
  for (std::int64_t id = 1; id <= 5; ++id) {
    const LocalLandmark& landmark = map.landmarks().at(LandmarkId{id});
    EXPECT_FALSE(landmark.is_refined);
    EXPECT_LT((landmark.p_W - map.poses_W_C().at(FrameId{id}) * landmark.p_C_reference).norm(),
              1e-12);
  }
  EXPECT_GT((PointOf(map, 5) - PointOf(FiveFrames(), 5)).norm(), 0.1);  // it did move
}

TEST(LocalMapApply, RefinedLandmarksStayWhereTheOptimizerPutThem) {
  LocalMap map = FiveFrames();
  const Eigen::Vector3d refined(7, 8, 9);
  map.Apply({FrameId{3}, {{FrameId{3}, Pose(3.5, 0)}}, {{LandmarkId{3}, refined}}, {}});
  EXPECT_EQ(PointOf(map, 3), refined);
  EXPECT_TRUE(map.landmarks().at(LandmarkId{3}).is_refined);
  // A later correction that says nothing of it moves its frame, not the landmark.
  map.Apply({FrameId{3}, {{FrameId{3}, Pose(4.5, 0)}}, {}, {}});
  EXPECT_EQ(PointOf(map, 3), refined);
}

TEST(LocalMapApply, RemovedLandmarksAreGoneAndTheirIdsNeverComeBack) {
  LocalMap map = FiveFrames();
  map.Apply({FrameId{5}, {}, {{LandmarkId{2}, {1, 1, 1}}}, {LandmarkId{2}, LandmarkId{5}}});
  EXPECT_EQ(map.landmarks().size(), 3u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{2}), 0u);
  EXPECT_EQ(map.Add(LandmarkOf(map, FrameId{5}, {0, 0, 4})).value, 6);
}

TEST(LocalMapApply, UnknownFramesAndLandmarksAreLeftAlone) {
  LocalMap map = FiveFrames();
  map.Apply(
      {FrameId{99}, {{FrameId{99}, Pose(50, 1)}}, {{LandmarkId{99}, {1, 2, 3}}}, {LandmarkId{77}}});
  EXPECT_EQ(map.poses_W_C().size(), 5u);
  EXPECT_EQ(map.landmarks().size(), 5u);
  for (std::int64_t id = 1; id <= 5; ++id)
    EXPECT_LT((PointOf(map, id) - PointOf(FiveFrames(), id)).norm(), 1e-12);
}

TEST(LocalMapApply, ALandmarkWhoseFrameIsForgottenStays) {
  LocalMap map = FiveFrames();
  const Eigen::Vector3d before = PointOf(map, 1);
  for (std::int64_t seq = 6; seq <= 80; ++seq) map.SetPose(FrameId{seq}, Pose(0, 0));
  EXPECT_EQ(map.poses_W_C().count(FrameId{1}), 0u);
  EXPECT_EQ(map.poses_W_C().size(), 64u);
  map.Apply({FrameId{80}, {{FrameId{80}, Pose(9, 0)}}, {}, {}});
  EXPECT_EQ(PointOf(map, 1), before);
}

TEST(LocalMapCull, ALandmarkSeenOnceIsDroppedAfterSomeFrames) {
  LocalMapOptions options;
  options.max_frames_unconfirmed = 4;
  LocalMap map = FiveFrames(options);
  map.landmarks().at(LandmarkId{2}).num_seen = 2;
  map.Cull(FrameId{5});
  EXPECT_EQ(map.landmarks().size(), 5u);
  map.Cull(FrameId{6});  // 1 was seen 5 frames ago
  EXPECT_EQ(map.landmarks().count(LandmarkId{1}), 0u);
  EXPECT_EQ(map.landmarks().size(), 4u);
  map.Cull(FrameId{100});  // 2 was seen twice
  EXPECT_EQ(map.landmarks().size(), 1u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{2}), 1u);
}

TEST(LocalMapCull, ALandmarkRarelyFoundWhereItShouldBeIsDropped) {
  LocalMapOptions options;
  options.min_found_ratio = 0.25;
  LocalMap map = FiveFrames(options);
  const auto set = [&map](std::int64_t id, int num_seen, int num_expected) {
    map.landmarks().at(LandmarkId{id}).num_seen = num_seen;
    map.landmarks().at(LandmarkId{id}).num_expected = num_expected;
  };
  set(1, 2, 9);   // too early to say
  set(2, 2, 10);  // 20 %
  set(3, 3, 10);  // 30 %
  set(4, 5, 20);  // 25 %
  set(5, 4, 20);  // 20 %
  map.Cull(FrameId{5});
  EXPECT_EQ(map.landmarks().count(LandmarkId{1}), 1u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{2}), 0u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{3}), 1u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{4}), 1u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{5}), 0u);
}

TEST(LocalMapCull, BeyondTheLimitTheLongestUnseenGo) {
  LocalMapOptions options;
  options.max_landmarks = 3;
  LocalMap map = FiveFrames(options);
  map.landmarks().at(LandmarkId{1}).last_seen = FrameId{5};
  map.Cull(FrameId{5});
  EXPECT_EQ(map.landmarks().size(), 3u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{1}), 1u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{2}), 0u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{3}), 0u);
}

TEST(LocalMapCull, OnlySoManyReferenceImagesAreHeld) {
  constexpr std::int64_t kSurplus = 50;
  const auto num_frames = static_cast<std::int64_t>(LocalMap::kMaxReferenceFrames) + kSurplus;
  LocalMap map((LocalMapOptions()));
  for (std::int64_t frame = 1; frame <= num_frames; ++frame) {
    LocalLandmark landmark;
    landmark.reference_frame = landmark.last_seen = FrameId{frame};
    landmark.num_seen = 2;
    map.Add(landmark);  // its id is the frame's number
  }
  map.landmarks().at(LandmarkId{1}).last_seen = FrameId{num_frames};
  map.Cull(FrameId{num_frames});
  EXPECT_EQ(map.landmarks().size(), LocalMap::kMaxReferenceFrames);
  EXPECT_EQ(map.landmarks().count(LandmarkId{1}), 1u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{2}), 0u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{kSurplus + 1}), 0u);
  EXPECT_EQ(map.landmarks().count(LandmarkId{kSurplus + 2}), 1u);
}

}  // namespace
}  // namespace airdos
