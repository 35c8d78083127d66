#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

#include "common/optimization/window/human_tracks.h"
#include "common/optimization/window/sliding_window.h"
#include "common/optimization/window/window_map.h"
#include "tests/estimator/window_frames.h"
#include "tests/support/synthetic_scene.h"

// What people may do to the window and the window says of them.

namespace airdos {
namespace {

using Status = FrameEstimate::Status;

/// Where static points are few and joints exact, so that people are believed at times.
SyntheticScene WeakScene() {
  SyntheticSceneOptions options;
  options.seed = 2;
  options.num_frames = 18;
  options.num_people = 12;
  options.max_static_per_frame = 100;
  options.joint_sigma_px = 0.3;
  SyntheticScene scene = MakeSyntheticScene(options);
  for (std::size_t k = 13; k < 17; ++k) {
    scene.frames[k].features.clear();
    scene.frames[k].T_O_C->translation += Eigen::Vector3d(0.06, -0.05, 0.07);
  }
  return scene;
}

std::vector<FrameResult> RunAll(const SlidingWindowOptions& options, const SyntheticScene& scene) {
  SlidingWindowOptimizer optimizer(options, scene.camera);
  std::vector<FrameResult> results;
  for (const FrameInput& input : scene.frames) results.push_back(optimizer.Process(input));
  return results;
}

TEST(SlidingWindow, WhoIsBelievedGivesThePoseAndOldFramesAreNotForPeopleToMove) {
  const SyntheticScene scene = WeakScene();
  SlidingWindowOptions options;
  options.people.window_frames = 5;
  const std::vector<FrameResult> with = RunAll(options, scene);
  options.bundle.use_people = false;
  const std::vector<FrameResult> without = RunAll(options, scene);
  std::size_t first = 0;
  while (first < with.size() && !with[first].estimate.trusts_people) ++first;
  ASSERT_LT(first, with.size());
  ASSERT_GE(first, 13U);
  const FrameEstimate& estimate = with[first].estimate;
  ExpectPose(estimate.T_W_C, estimate.T_W_C_with_people);
  ExpectPose(estimate.T_W_C_without_people, without[first].estimate.T_W_C);
  EXPECT_GT(Boxminus(estimate.T_W_C_with_people, estimate.T_W_C_without_people).norm(), 1e-3);
  const auto position_variance = [](const FrameEstimate& of) {
    return Eigen::Matrix3d(of.covariance.topLeftCorner<3, 3>()).trace();
  };
  EXPECT_LT(position_variance(estimate), position_variance(without[first].estimate));
  EXPECT_EQ(estimate.num_static_observations, 0);
  EXPECT_NE(estimate.status, Status::kPredicted);
  EXPECT_NE(estimate.summary.initial_cost, without[first].estimate.summary.initial_cost);
  const std::size_t num_frames = with[first].changes.frames.size();
  ASSERT_EQ(num_frames, 12U);
  for (std::size_t i = 0; i < num_frames; ++i) {
    const double moved =
        Boxminus(with[first].changes.frames[i].T_W_C, without[first].changes.frames[i].T_W_C)
            .norm();
    if (i < num_frames - 5) {
      EXPECT_EQ(moved, 0) << i;
    } else {
      EXPECT_GT(moved, 0) << i;
    }
  }
}

TEST(SlidingWindow, WhereTheStaticSceneIsStrongTheSummaryIsItsOwn) {
  SyntheticSceneOptions scene_options;
  scene_options.num_frames = 6;
  scene_options.num_people = 3;
  scene_options.max_static_per_frame = 60;
  scene_options.sigma_px = scene_options.joint_sigma_px = 0.1;
  SyntheticScene scene = MakeSyntheticScene(scene_options);
  scene.frames[5].features[3].uvu_px.x() += 40;
  scene.frames[5].humans[0].joints[3].uvu_px.x() += 40;
  SlidingWindowOptions options;
  options.bundle.max_iterations = options.bundle.max_iterations_after_rejection = 30;
  const std::vector<FrameResult> with = RunAll(options, scene);
  options.bundle.use_people = false;
  const std::vector<FrameResult> without = RunAll(options, scene);
  const BundleSummary& both = with[5].estimate.summary;
  const BundleSummary& one = without[5].estimate.summary;
  EXPECT_EQ(one.num_reprojection_rejected, 1);
  EXPECT_EQ(both.num_reprojection_rejected, 2) << "the landmark and the joint";
  EXPECT_GT(both.num_iterations, one.num_iterations);
  EXPECT_EQ(both.initial_cost, one.initial_cost);
  EXPECT_EQ(both.final_cost, one.final_cost);
  EXPECT_EQ(both.has_converged, one.has_converged);
  EXPECT_EQ(both.num_people, 3);
  // One step each: as many iterations again.
  options.bundle.max_iterations = 1;
  options.bundle.max_iterations_after_rejection = 0;
  const int num_alone = RunAll(options, scene)[5].estimate.summary.num_iterations;
  options.bundle.use_people = true;
  EXPECT_EQ(RunAll(options, scene)[5].estimate.summary.num_iterations, 2 * num_alone);
  EXPECT_EQ(with[5].estimate.covariance, without[5].estimate.covariance);
}

/// Two frames with so many static points, and people.
SyntheticScene TwoFrames(int num_static) {
  SyntheticSceneOptions options;
  options.num_frames = 2;
  options.num_people = 3;
  SyntheticScene scene = MakeSyntheticScene(options);
  for (FrameInput& input : scene.frames) {
    std::vector<StaticObservation> both;
    for (const StaticObservation& feature : input.features) {
      const auto is_it = [&feature](const StaticObservation& o) { return o.id == feature.id; };
      const auto& first = scene.frames[0].features;
      const auto& second = scene.frames[1].features;
      if (std::any_of(first.begin(), first.end(), is_it) &&
          std::any_of(second.begin(), second.end(), is_it)) {
        both.push_back(feature);
      }
    }
    input.features = both;
  }
  for (FrameInput& input : scene.frames)
    input.features.resize(static_cast<std::size_t>(num_static));
  return scene;
}

/// The adjustment with people of the second frame, step by step.
Se3 PoseWithPeople(const SyntheticScene& scene, const SlidingWindowOptions& options,
                   bool are_landmarks_fixed) {
  WindowMap map(options.map);
  HumanTracks people(options.people);
  for (const FrameInput& input : scene.frames) {
    map.AddFrame(scene.camera, input,
                 scene.frames[0].T_W_C.value_or(*scene.frames[0].T_O_C) *
                     (scene.frames[0].T_O_C->inverse() * *input.T_O_C));
    people.AddFrame(scene.camera, input);
  }
  BundleProblem problem = map.BuildProblem(scene.camera);
  BundleOptions bundle = options.bundle;
  bundle.use_people = false;
  SolveBundle(bundle, &problem);
  for (BundleProblem::Landmark& landmark : problem.landmarks)
    landmark.is_fixed = are_landmarks_fixed;
  people.AddTo(&problem);
  SolveBundle(options.bundle, &problem);
  return problem.frames.back().T_W_C;
}

TEST(SlidingWindow, PeopleDoNotMoveTheLandmarksOfAStrongScene) {
  SlidingWindowOptions options;
  options.learn_track_noise = false;
  options.camera_motion.use_acceleration = false;
  options.bundle.reject_static_sigmas = 1e9;  // all of them count
  options.trust.min_static_observations = 20;
  for (const int num_static : {20, 19}) {
    const SyntheticScene scene = TwoFrames(num_static);
    const FrameEstimate estimate = RunAll(options, scene)[1].estimate;
    ASSERT_EQ(estimate.num_static_observations, num_static);
    const Se3 fixed = PoseWithPeople(scene, options, true);
    const Se3 free = PoseWithPeople(scene, options, false);
    ASSERT_GT(Boxminus(fixed, free).norm(), 1e-6);
    ExpectPose(estimate.T_W_C_with_people, num_static == 20 ? fixed : free);
  }
}

TEST(SlidingWindow, NoMotionLeadsToWhereATrackBecameSomebodyElses) {
  SlidingWindowOptions options = StaticOnly();
  options.bundle.use_people = true;
  SlidingWindowOptimizer optimizer(options, kCamera);
  BundleSummary summary;
  for (int i = 0; i < 6; ++i) {
    FrameInput input = At(i, 0.1 * i, Pose(0));
    AddFeatures(Pose(0), 0, 19, 0.5, &input);
    HumanObservation person{HumanId{1}, {}};
    for (const int joint : {kNeck, kRightShoulder, kLeftShoulder}) {
      const Eigen::Vector3d p_C(-1.5 + 0.2 * joint + (i < 3 ? 0 : 3), 0.1, 4);
      person.joints.push_back({joint, kCamera.ProjectStereo(p_C), Eigen::Matrix3d::Identity()});
    }
    input.humans.push_back(person);
    summary = optimizer.Process(input).estimate.summary;
  }
  EXPECT_EQ(summary.num_motion, 3 * 4) << "of five steps one is none";
}

TEST(SlidingWindow, PeopleAreDescribedWhenTheyComeAndWhenTheyLeave) {
  SyntheticSceneOptions scene_options;
  scene_options.num_frames = 7;
  scene_options.num_people = 3;
  scene_options.sigma_px = scene_options.joint_sigma_px = 0;
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  SlidingWindowOptions options;
  options.map.window_frames = 4;  // cuts the people's eight
  const std::vector<FrameResult> results = RunAll(options, scene);
  for (std::size_t k = 0; k < results.size(); ++k) {
    std::map<std::int64_t, std::size_t> num_of_frame;
    for (const HumanState& state : results[k].changes.humans) {
      ++num_of_frame[state.frame.value];
      ASSERT_FALSE(state.joints.empty());
      const auto& truth_W = scene.joints_W[static_cast<std::size_t>(state.id.value - 1)]
                                          [static_cast<std::size_t>(state.frame.value)];
      EXPECT_DOUBLE_EQ(state.time_s,
                       scene.frames[static_cast<std::size_t>(state.frame.value)].time_s);
      for (const HumanState::JointPosition& joint : state.joints) {
        // Triangulated from exact pixels, and placed by a camera that is a few mm off.
        const auto j = static_cast<std::size_t>(joint.joint);
        EXPECT_LT((joint.p_W_measured - truth_W[j]).norm(), 0.01);
      }
    }
    std::map<std::int64_t, std::size_t> expected;
    expected[static_cast<std::int64_t>(k)] = scene.frames[k].humans.size();
    if (k >= 3) expected[static_cast<std::int64_t>(k - 3)] = scene.frames[k - 3].humans.size();
    EXPECT_EQ(num_of_frame, expected) << k;
  }
}

}  // namespace
}  // namespace airdos
