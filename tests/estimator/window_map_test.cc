#include "common/optimization/window/window_map.h"

#include <gtest/gtest.h>

#include <cmath>
#include <set>
#include <vector>

namespace airdos {
namespace {

using Ids = std::vector<std::int64_t>;

const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};

/// A pose whose axes are none of the world's.
Se3 Pose(double x) { return {ExpSo3({0.1, -0.2, 0.3}), {x, -0.5 * x, 0.25 * x}}; }

StaticObservation Seen(std::int64_t id, const Eigen::Vector3d& uvu_px = {400, 200, 380}) {
  return {LandmarkId{id}, uvu_px, true, 0.5};
}

/// A frame in which the landmarks of these ids are seen, all at one place of the image.
FrameInput Frame(std::int64_t id, const Ids& landmarks) {
  FrameInput input;
  input.id.value = id;
  input.time_s = 0.1 * static_cast<double>(id);
  for (const std::int64_t landmark : landmarks) input.features.push_back(Seen(landmark));
  return input;
}

Ids Range(std::int64_t first, std::int64_t last) {
  Ids ids;
  for (std::int64_t id = first; id <= last; ++id) ids.push_back(id);
  return ids;
}

Ids Kept(const WindowMap& map) {
  Ids ids;
  for (const auto& [id, frame] : map.frames()) ids.push_back(id.value);
  return ids;
}

Ids Window(const WindowMap& map) {
  Ids ids;
  for (const FrameId id : map.window()) ids.push_back(id.value);
  return ids;
}

bool Knows(const WindowMap& map, std::int64_t id) { return map.landmarks().count({id}) > 0; }

WindowMapOptions Small() {
  WindowMapOptions options;
  options.window_frames = 3;
  options.min_shared_landmarks = 1;
  return options;
}

TEST(WindowMap, KeepsAFrameAsItCame) {
  WindowMap map(Small());
  FrameInput input = Frame(7, {});
  input.time_s = 0.75;
  input.features = {Seen(3, {400, 200, 380}), {LandmarkId{4}, {100, 120, 0}, false, 0.25}};
  map.AddFrame(kCamera, input, Pose(2));
  map.AddFrame(kCamera, Frame(8, {3}), Pose(3));
  const WindowMap::Frame& frame = map.frames().at({7});
  EXPECT_EQ(frame.time_s, 0.75);
  EXPECT_EQ(frame.T_W_C.translation, Pose(2).translation);
  EXPECT_TRUE(frame.is_first);
  EXPECT_FALSE(map.frames().at({8}).is_first);
  const WindowMap::Observation& stereo = frame.observations.at({3});
  EXPECT_EQ(stereo.uvu_px, Eigen::Vector3d(400, 200, 380));
  EXPECT_TRUE(stereo.has_right);
  EXPECT_EQ(stereo.sigma_px, 0.5);
  EXPECT_EQ(stereo.num_rejections, 0);
  const WindowMap::Observation& mono = frame.observations.at({4});
  EXPECT_FALSE(mono.has_right);
  EXPECT_EQ(mono.sigma_px, 0.25);
  const WindowMap::Landmark& landmark = map.landmarks().at({3});
  EXPECT_EQ(landmark.frames, (std::set<FrameId>{{7}, {8}}));
  EXPECT_EQ(landmark.last_seen.value, 8);
  // z = 500 * 0.3 / 20, x = 90 z / 500, y = -50 z / 470; where frame 7 was, not frame 8.
  ASSERT_TRUE(landmark.p_W);
  EXPECT_LT((*landmark.p_W - Pose(2) * Eigen::Vector3d(1.35, -50 * 7.5 / 470, 7.5)).norm(), 1e-9);
  EXPECT_FALSE(map.landmarks().at({4}).p_W);
}

TEST(WindowMap, TwiceInAFrameCountsOnce) {
  WindowMap map(Small());
  FrameInput input = Frame(1, {});
  input.features = {Seen(3, {400, 200, 380}), Seen(3, {400, 200, 390})};
  map.AddFrame(kCamera, input, Se3());
  EXPECT_EQ(map.frames().at({1}).observations.at({3}).uvu_px.z(), 380);
  EXPECT_NEAR(map.landmarks().at({3}).p_W->z(), 7.5, 1e-12);
}

TEST(WindowMap, ALandmarkStartsWhereItsDepthIsKnown) {
  WindowMapOptions options = Small();
  options.min_disparity_px = 2;
  WindowMap map(options);
  FrameInput input = Frame(1, {});
  input.features = {Seen(3, {400, 200, 398}),
                    Seen(4, {400, 200, 398.25}),
                    {LandmarkId{5}, {400, 200, 300}, false, 1}};
  map.AddFrame(kCamera, input, Se3());
  EXPECT_TRUE(map.landmarks().at({3}).p_W) << "exactly the least disparity";
  EXPECT_FALSE(map.landmarks().at({4}).p_W);
  EXPECT_FALSE(map.landmarks().at({5}).p_W) << "u_right is no measurement";
  input = Frame(2, {});
  input.features = {Seen(4, {400, 200, 380}), Seen(5, {400, 200, 370})};
  map.AddFrame(kCamera, input, Se3());
  EXPECT_NEAR(map.landmarks().at({4}).p_W->z(), 7.5, 1e-12);
  EXPECT_NEAR(map.landmarks().at({5}).p_W->z(), 5, 1e-12);
}

TEST(WindowMap, TheWindowHoldsTheNewestFrames) {
  WindowMap map(Small());
  for (std::int64_t id = 0; id < 3; ++id) map.AddFrame(kCamera, Frame(id, Range(0, 9)), Se3());
  EXPECT_EQ(Window(map), Range(0, 2));
  map.AddFrame(kCamera, Frame(3, Range(0, 9)), Se3());
  EXPECT_EQ(Window(map), Range(1, 3));
}

TEST(WindowMap, TheFirstFrameAndThenOneInSoManyBecomesAKeyFrame) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 4;
  options.max_key_frames = 3;
  WindowMap map(options);
  for (std::int64_t id = 0; id <= 12; ++id) map.AddFrame(kCamera, Frame(id, Range(0, 9)), Se3());
  // 0, 4 and 8 left the window as key frames, 9 did not.
  EXPECT_EQ(Kept(map), (Ids{0, 4, 8, 10, 11, 12}));
  EXPECT_EQ(map.landmarks().at({5}).frames, (std::set<FrameId>{{0}, {4}, {8}, {10}, {11}, {12}}));
  for (std::int64_t id = 13; id <= 15; ++id) map.AddFrame(kCamera, Frame(id, Range(0, 9)), Se3());
  EXPECT_EQ(Kept(map), (Ids{4, 8, 12, 13, 14, 15})) << "the oldest of four went";
}

TEST(WindowMap, AFrameThatSharesLittleWithTheLastKeyFrameBecomesOne) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 100;
  options.key_frame_max_shared = 0.75;
  WindowMap map(options);
  map.AddFrame(kCamera, Frame(0, Range(0, 19)), Se3());   // a key frame
  map.AddFrame(kCamera, Frame(1, Range(14, 21)), Se3());  // shares 6 of its 8: not less
  map.AddFrame(kCamera, Frame(2, Range(15, 22)), Se3());  // shares 5 of 8
  map.AddFrame(kCamera, Frame(3, Range(16, 23)), Se3());  // 4 with 0, but 7 with 2
  for (std::int64_t id = 4; id < 7; ++id) map.AddFrame(kCamera, Frame(id, Range(16, 23)), Se3());
  EXPECT_EQ(Kept(map), (Ids{0, 2, 4, 5, 6}));
}

TEST(WindowMap, TheIntervalCountsFromTheLastKeyFrame) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 3;
  WindowMap map(options);
  map.AddFrame(kCamera, Frame(0, Range(0, 9)), Se3());
  map.AddFrame(kCamera, Frame(1, Range(0, 9)), Se3());
  map.AddFrame(kCamera, Frame(2, Range(20, 29)), Se3());  // elsewhere
  for (std::int64_t id = 3; id < 10; ++id) map.AddFrame(kCamera, Frame(id, Range(20, 29)), Se3());
  EXPECT_EQ(Kept(map), (Ids{0, 2, 5, 7, 8, 9}));
}

TEST(WindowMap, ALandmarkIsForgottenJustAfterTheLimit) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 1000;
  options.forget_after_frames = 10;
  WindowMap map(options);
  const Ids all = Range(0, 9);
  Ids with_guest = all;
  with_guest.push_back(50);
  map.AddFrame(kCamera, Frame(0, all), Se3());         // a key frame
  map.AddFrame(kCamera, Frame(1, with_guest), Se3());  // forgotten when it leaves
  for (std::int64_t id = 2; id <= 11; ++id) map.AddFrame(kCamera, Frame(id, all), Se3());
  ASSERT_TRUE(Knows(map, 50)) << "ten frames ago";
  EXPECT_TRUE(map.landmarks().at({50}).frames.empty());
  map.AddFrame(kCamera, Frame(12, all), Se3());
  EXPECT_FALSE(Knows(map, 50));
  for (std::int64_t id = 13; id <= 30; ++id) map.AddFrame(kCamera, Frame(id, {3}), Se3());
  EXPECT_TRUE(Knows(map, 7)) << "key frame 0 still sees it";
}

TEST(WindowMap, ALandmarkThatNoFrameHoldsStartsAnewWhenItComesBack) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 1000;
  WindowMap map(options);
  map.AddFrame(kCamera, Frame(0, {1, 2}), Se3());
  map.AddFrame(kCamera, Frame(1, {1, 2, 50}), Se3());
  for (std::int64_t id = 2; id <= 4; ++id) map.AddFrame(kCamera, Frame(id, {1, 2}), Se3());
  FrameInput back = Frame(5, {});
  back.features = {Seen(50, {400, 200, 370}), Seen(1, {400, 200, 370})};
  map.AddFrame(kCamera, back, Se3());
  EXPECT_NEAR(map.landmarks().at({50}).p_W->z(), 5, 1e-12);
  EXPECT_NEAR(map.landmarks().at({1}).p_W->z(), 7.5, 1e-12) << "that one is known";
}

TEST(WindowMap, TheProblemHoldsWhatIsSeenTwiceAndOnceInTheWindow) {
  WindowMap map(Small());
  FrameInput first = Frame(0, {1, 2, 3});
  first.features.push_back({LandmarkId{9}, {100, 110, 50}, true, 0.125});
  map.AddFrame(kCamera, first, Pose(0));
  map.AddFrame(kCamera, Frame(1, {2, 3, 4}), Pose(1));
  FrameInput third = Frame(2, {3, 5});
  third.features.push_back({LandmarkId{9}, {102, 111, 0}, false, 0.75});
  third.features.push_back({LandmarkId{4}, {400, 200, 381}, true, 1.5});
  map.AddFrame(kCamera, third, Pose(2));
  const BundleProblem problem = map.BuildProblem(kCamera);
  EXPECT_EQ(problem.camera, kCamera);
  ASSERT_EQ(problem.frames.size(), 3U);
  for (int i = 0; i < 3; ++i) {
    const BundleProblem::Frame& frame = problem.frames[static_cast<std::size_t>(i)];
    EXPECT_EQ(frame.id.value, i);
    EXPECT_DOUBLE_EQ(frame.time_s, 0.1 * i);
    EXPECT_EQ(frame.T_W_C.translation, Pose(i).translation);
    EXPECT_EQ(frame.is_fixed, i == 0) << "the first one defines W";
  }
  Ids ids;
  for (const BundleProblem::Landmark& landmark : problem.landmarks) {
    ids.push_back(landmark.id.value);
    EXPECT_EQ(landmark.p_W, *map.landmarks().at(landmark.id).p_W);
    EXPECT_FALSE(landmark.is_fixed);
  }
  EXPECT_EQ(ids, (Ids{2, 3, 4, 9}));
  ASSERT_EQ(problem.observations.size(), 9U);  // 2 + 3 + 2 + 2
  std::set<std::pair<int, int>> places;
  for (const auto& o : problem.observations) places.emplace(o.landmark, o.frame);
  EXPECT_EQ(places, (std::set<std::pair<int, int>>{
                        {0, 0}, {0, 1}, {1, 0}, {1, 1}, {1, 2}, {2, 1}, {2, 2}, {3, 0}, {3, 2}}));
  const BundleProblem::LandmarkObservation& of_4 = problem.observations[6];
  EXPECT_EQ(of_4.uvu_px, Eigen::Vector3d(400, 200, 381));
  EXPECT_EQ(of_4.sigma_px, 1.5);
  EXPECT_TRUE(of_4.has_right);
  const BundleProblem::LandmarkObservation& of_9 = problem.observations[8];
  EXPECT_EQ(of_9.sigma_px, 0.75);
  EXPECT_FALSE(of_9.has_right);
  EXPECT_FALSE(of_9.is_rejected);
}

TEST(WindowMap, ALandmarkWithoutDepthIsNotAdjusted) {
  WindowMap map(Small());
  for (std::int64_t id = 0; id < 2; ++id) {
    FrameInput input = Frame(id, {1});
    input.features.push_back({LandmarkId{2}, {100, 110, 0}, false, 1});
    map.AddFrame(kCamera, input, Se3());
  }
  const BundleProblem problem = map.BuildProblem(kCamera);
  ASSERT_EQ(problem.landmarks.size(), 1U);
  EXPECT_EQ(problem.landmarks[0].id.value, 1);
}

/// Key frames 0 to 4, of which each sees other landmarks, and a window that sees some of each.
WindowMap WithKeyFrames(WindowMapOptions options) {
  options.key_frame_interval = 1;
  WindowMap map(options);
  map.AddFrame(kCamera, Frame(0, Range(0, 4)), Pose(0));    // 3 in the window
  map.AddFrame(kCamera, Frame(1, Range(10, 18)), Pose(1));  // 6
  map.AddFrame(kCamera, Frame(2, Range(20, 24)), Pose(2));  // 2
  map.AddFrame(kCamera, Frame(3, Range(30, 39)), Pose(3));  // 3
  map.AddFrame(kCamera, Frame(4, Range(40, 49)), Pose(4));  // 4
  map.AddFrame(kCamera, Frame(5, {0, 1, 10, 11, 12}), Pose(5));
  map.AddFrame(kCamera, Frame(6, {2, 13, 14, 15, 20, 21}), Pose(6));
  map.AddFrame(kCamera, Frame(7, {30, 31, 32, 40, 41, 42, 43, 10}), Pose(7));
  return map;
}

Ids FixedFrames(const BundleProblem& problem) {
  Ids ids;
  for (const BundleProblem::Frame& frame : problem.frames) {
    if (frame.is_fixed) ids.push_back(frame.id.value);
  }
  return ids;
}

TEST(WindowMap, TheKeyFramesThatShareMostHoldTheWindow) {
  WindowMapOptions options = Small();
  options.max_fixed_key_frames = 3;
  options.min_shared_landmarks = 3;
  // 1 shares six, 4 four, 0 and 3 three each: the older one. In the order of time.
  BundleProblem problem = WithKeyFrames(options).BuildProblem(kCamera);
  EXPECT_EQ(FixedFrames(problem), (Ids{0, 1, 4}));
  ASSERT_EQ(problem.frames.size(), 6U);
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(problem.frames[3 + i].id.value, static_cast<int>(5 + i));
    EXPECT_EQ(problem.frames[3 + i].T_W_C.translation,
              Pose(5 + static_cast<double>(i)).translation);
  }
  // Of the window: 0 1 2, 10-15, 40-43. Landmark 20 is seen by 6 alone, 3 by key frame 0 alone.
  EXPECT_EQ(problem.landmarks.size(), 13U);

  options.max_fixed_key_frames = 8;
  problem = WithKeyFrames(options).BuildProblem(kCamera);
  EXPECT_EQ(FixedFrames(problem), (Ids{0, 1, 3, 4})) << "exactly the least number counts";
  options.min_shared_landmarks = 5;
  EXPECT_EQ(FixedFrames(WithKeyFrames(options).BuildProblem(kCamera)), (Ids{1}));
}

TEST(WindowMap, WhatOnlyKeyFramesSeeIsNotAdjusted) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 1;
  WindowMap map(options);
  for (std::int64_t id = 0; id < 2; ++id) map.AddFrame(kCamera, Frame(id, {1, 50}), Se3());
  for (std::int64_t id = 2; id < 5; ++id) map.AddFrame(kCamera, Frame(id, {1, 60}), Se3());
  const BundleProblem problem = map.BuildProblem(kCamera);
  EXPECT_EQ(FixedFrames(problem), (Ids{0, 1}));
  ASSERT_EQ(problem.landmarks.size(), 2U);
  EXPECT_EQ(problem.landmarks[0].id.value, 1);
  EXPECT_EQ(problem.landmarks[1].id.value, 60);
}

TEST(WindowMap, WithoutAKeyFrameTheOldestOfTheWindowIsHeld) {
  WindowMapOptions options = Small();
  options.min_shared_landmarks = 100;
  EXPECT_EQ(FixedFrames(WithKeyFrames(options).BuildProblem(kCamera)), (Ids{5}));
}

/// Frames 0 to num_frames - 1 that all see landmarks 1 to 3.
WindowMap Watched(int num_frames, int max_rejections) {
  WindowMapOptions options;
  options.max_rejections = max_rejections;
  WindowMap map(options);
  for (std::int64_t id = 0; id < num_frames; ++id) {
    map.AddFrame(kCamera, Frame(id, {1, 2, 3}), Pose(static_cast<double>(id)));
  }
  return map;
}

/// Absorbs an adjustment that threw out landmark 2 in these frames.
std::vector<LandmarkId> ThrowOut(const std::set<int>& frames, WindowMap* map) {
  BundleProblem problem = map->BuildProblem(kCamera);
  for (auto& observation : problem.observations) {
    const std::int64_t id =
        problem.landmarks[static_cast<std::size_t>(observation.landmark)].id.value;
    observation.is_rejected = id == 2 && frames.count(observation.frame) > 0;
  }
  return map->Absorb(problem);
}

TEST(WindowMap, TakesTheResultBack) {
  WindowMap map = Watched(3, 2);
  BundleProblem problem = map.BuildProblem(kCamera);
  for (std::size_t i = 0; i < 3; ++i) {
    problem.frames[i].T_W_C = Pose(10 + static_cast<double>(i));
    problem.landmarks[i].p_W = {1.0 + static_cast<double>(i), 2, 3};
  }
  EXPECT_TRUE(map.Absorb(problem).empty());
  for (std::int64_t i = 0; i < 3; ++i) {
    EXPECT_EQ(map.frames().at({i}).T_W_C.translation,
              Pose(10 + static_cast<double>(i)).translation);
    EXPECT_EQ(map.landmarks().at({i + 1}).p_W->x(), 1.0 + static_cast<double>(i));
  }
}

TEST(WindowMap, AnObservationGoesAfterSoManyFailuresInARow) {
  WindowMap map = Watched(6, 2);
  EXPECT_TRUE(ThrowOut({4}, &map).empty());
  EXPECT_EQ(map.frames().at({4}).observations.at({2}).num_rejections, 1);
  ThrowOut({}, &map);
  EXPECT_EQ(map.frames().at({4}).observations.at({2}).num_rejections, 0);
  ThrowOut({4}, &map);
  EXPECT_EQ(map.frames().at({4}).observations.count({2}), 1U) << "not twice in a row";
  EXPECT_TRUE(ThrowOut({4}, &map).empty());
  EXPECT_EQ(map.frames().at({4}).observations.count({2}), 0U);
  EXPECT_EQ(map.frames().at({4}).observations.count({1}), 1U);
  EXPECT_EQ(map.frames().at({3}).observations.count({2}), 1U);
  EXPECT_EQ(map.landmarks().at({2}).num_dropped, 1);
  EXPECT_EQ(map.landmarks().at({2}).frames, (std::set<FrameId>{{0}, {1}, {2}, {3}, {5}}));
}

TEST(WindowMap, ALandmarkGoesWhenAsManyOfItsObservationsWereWrongAsRight) {
  WindowMap map = Watched(5, 1);
  EXPECT_TRUE(ThrowOut({1, 3}, &map).empty()) << "two against three";
  map = Watched(4, 1);
  const std::vector<LandmarkId> bad = ThrowOut({1, 3}, &map);
  ASSERT_EQ(bad.size(), 1U);
  EXPECT_EQ(bad[0].value, 2);
  EXPECT_FALSE(Knows(map, 2));
  for (std::int64_t id = 0; id < 4; ++id) {
    EXPECT_EQ(map.frames().at({id}).observations.count({2}), 0U);
    EXPECT_EQ(map.frames().at({id}).observations.count({3}), 1U);
  }
}

// Or it would be there again when somebody else gets its number.
TEST(WindowMap, ARemovedLandmarkIsGoneFromKeyFramesToo) {
  WindowMapOptions options = Small();
  options.key_frame_interval = 1000;
  options.max_rejections = 1;
  WindowMap map(options);
  for (std::int64_t id = 0; id < 5; ++id) map.AddFrame(kCamera, Frame(id, {1, 2, 3}), Se3());
  ASSERT_EQ(Kept(map), (Ids{0, 2, 3, 4}));
  ASSERT_EQ(ThrowOut({2, 3}, &map).size(), 1U) << "of the key frame and the window's three";
  for (const std::int64_t id : {0, 2, 3, 4}) {
    EXPECT_EQ(map.frames().at({id}).observations.count({2}), 0U) << id;
    EXPECT_EQ(map.frames().at({id}).observations.count({3}), 1U) << id;
  }
}

TEST(WindowMap, ARemovedLandmarkIsNotListenedToForFiftyFrames) {
  WindowMapOptions options;
  options.max_rejections = 1;
  WindowMap map(options);
  for (std::int64_t id = 0; id < 4; ++id) map.AddFrame(kCamera, Frame(id, {1, 2, 3}), Se3());
  ThrowOut({1, 3}, &map);  // the newest was frame 3
  for (std::int64_t id = 4; id <= 53; ++id) {
    map.AddFrame(kCamera, Frame(id, {1, 2, 3}), Se3());
    EXPECT_FALSE(Knows(map, 2)) << id;
  }
  map.AddFrame(kCamera, Frame(54, {1, 2, 3}), Se3());  // forgets after it has looked
  EXPECT_FALSE(Knows(map, 2));
  map.AddFrame(kCamera, Frame(55, {1, 2, 3}), Se3());
  EXPECT_TRUE(Knows(map, 2));
}

TEST(WindowMap, AnImpossiblePlaceIsNone) {
  WindowMap map = Watched(3, 2);
  BundleProblem problem = map.BuildProblem(kCamera);
  problem.landmarks[0].p_W = {0, 0.999e5, 0};
  problem.landmarks[1].p_W = {0, -1.001e5, 0};
  problem.landmarks[2].p_W.x() = std::nan("");
  const std::vector<LandmarkId> bad = map.Absorb(problem);
  ASSERT_EQ(bad.size(), 2U);
  EXPECT_EQ(bad[0].value, 2);
  EXPECT_EQ(bad[1].value, 3);
  EXPECT_TRUE(Knows(map, 1));
}

TEST(WindowMap, NotesWhatWasPublished) {
  WindowMap map = Watched(2, 2);
  EXPECT_FALSE(map.landmarks().at({2}).published_p_W);
  map.MarkPublished({2});
  EXPECT_EQ(*map.landmarks().at({2}).published_p_W, *map.landmarks().at({2}).p_W);
  EXPECT_FALSE(map.landmarks().at({1}).published_p_W);
  map.SetPose({1}, Pose(9));
  EXPECT_EQ(map.frames().at({1}).T_W_C.translation, Pose(9).translation);
  EXPECT_EQ(map.frames().at({0}).T_W_C.translation, Pose(0).translation);
}

}  // namespace
}  // namespace airdos
