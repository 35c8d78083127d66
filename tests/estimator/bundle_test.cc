#include <gtest/gtest.h>

#include <Eigen/Cholesky>
#include <cmath>
#include <iostream>
#include <memory>
#include <optional>
#include <vector>

#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/window/human_tracks.h"
#include "common/optimization/window/window_map.h"
#include "tests/support/synthetic_scene.h"

namespace airdos {
namespace {

/// A problem over all frames of a scene, at the start values that an optimizer would have: poses
/// from odometry, points triangulated.
BundleProblem MakeProblem(const SyntheticScene& scene, bool with_people) {
  WindowMapOptions map_options;
  map_options.window_frames = static_cast<int>(scene.frames.size());
  HumanTracksOptions people_options;
  people_options.window_frames = map_options.window_frames;
  WindowMap map(map_options);
  HumanTracks people(people_options);
  for (const FrameInput& input : scene.frames) {
    map.AddFrame(scene.camera, input, *input.T_O_C);
    people.AddFrame(scene.camera, input);
  }
  BundleProblem problem = map.BuildProblem(scene.camera);
  if (with_people) people.AddTo(&problem);
  return problem;
}

BundleOptions Thorough() {
  BundleOptions options;
  options.max_iterations = 100;
  options.max_iterations_after_rejection = 100;
  options.function_tolerance = 1e-12;
  return options;
}

double CameraError(const BundleProblem& problem, const SyntheticScene& scene) {
  std::vector<Se3> poses;
  for (const BundleProblem::Frame& frame : problem.frames) poses.push_back(frame.T_W_C);
  return RmsPositionError(poses, scene.T_W_C);
}

double JointError(const BundleProblem& problem, const SyntheticScene& scene) {
  double sum = 0;
  int num = 0;
  for (const BundleProblem::Human& human : problem.humans) {
    const auto& truth = scene.joints_W[static_cast<std::size_t>(human.id.value - 1)];
    for (const BundleProblem::JointState& joint : human.joints) {
      const auto frame =
          static_cast<std::size_t>(problem.frames[static_cast<std::size_t>(joint.frame)].id.value);
      sum += (joint.p_W - truth[frame][static_cast<std::size_t>(joint.joint)]).squaredNorm();
      ++num;
    }
  }
  return std::sqrt(sum / num);
}

SyntheticSceneOptions Walkers(int num_static, int num_people) {
  SyntheticSceneOptions options;
  options.num_frames = 10;
  options.max_static_per_frame = num_static;
  options.num_people = num_people;
  return options;
}

TEST(BundleTest, ExactMeasurementsGiveExactPeople) {
  SyntheticSceneOptions scene_options = Walkers(60, 3);
  scene_options.sigma_px = scene_options.joint_sigma_px = 0;
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  BundleProblem problem = MakeProblem(scene, true);
  BundleOptions options = Thorough();
  options.use_motion = false;  // walkers swing: no motion model is exact
  const BundleSummary summary = SolveBundle(options, &problem);
  EXPECT_EQ(summary.num_people, 3);
  EXPECT_GT(summary.num_rigidity, 100);
  EXPECT_LT(CameraError(problem, scene), 1e-6);
  EXPECT_LT(JointError(problem, scene), 1e-5);
  for (const BundleProblem::Human& human : problem.humans) {
    ASSERT_TRUE(human.segment_length_m[9]);
    EXPECT_NEAR(*human.segment_length_m[9], 0.43, 1e-5);  // the walker's right thigh
  }
}

TEST(BundleTest, WithoutMotionPeopleLeaveTheCameraAlone) {
  // Shifting a camera together with its people changes no reprojection and no rigidity residual.
  const SyntheticScene scene = MakeSyntheticScene(Walkers(20, 4));
  BundleOptions options = Thorough();
  options.max_iterations_after_rejection = 0;
  BundleProblem static_only = MakeProblem(scene, false);
  SolveBundle(options, &static_only);
  BundleProblem rigid = MakeProblem(scene, true);
  options.use_motion = false;
  const BundleSummary summary = SolveBundle(options, &rigid);
  EXPECT_GT(summary.num_rigidity, 100);
  for (std::size_t i = 0; i < rigid.frames.size(); ++i) {
    const double way_m = static_only.frames[i].T_W_C.translation.norm();
    EXPECT_LE((rigid.frames[i].T_W_C.translation - static_only.frames[i].T_W_C.translation).norm(),
              1e-3 * way_m + 1e-9);
  }
}

TEST(BundleTest, RigidityImprovesTheJoints) {
  double sum_with = 0, sum_without = 0;
  for (const std::uint32_t seed : {1U, 2U, 3U, 4U}) {
    SyntheticSceneOptions scene_options = Walkers(150, 4);
    scene_options.seed = seed;
    const SyntheticScene scene = MakeSyntheticScene(scene_options);
    BundleOptions options = Thorough();
    options.max_iterations = 30;
    options.use_motion = false;
    BundleProblem with = MakeProblem(scene, true);
    SolveBundle(options, &with);
    options.use_rigidity = false;
    BundleProblem without = MakeProblem(scene, true);
    SolveBundle(options, &without);
    sum_with += JointError(with, scene);
    sum_without += JointError(without, scene);
  }
  std::cout << "joints' rms error, m: rigid " << sum_with / 4 << ", free " << sum_without / 4
            << "\n";
  EXPECT_LT(sum_with, 0.9 * sum_without);
}

TEST(BundleTest, MotionHelpsTheCameraWhereStaticPointsAreFew) {
  double sum_with = 0, sum_without = 0;
  for (std::uint32_t seed = 1; seed <= 8; ++seed) {
    SyntheticSceneOptions scene_options = Walkers(8, 8);
    scene_options.seed = seed;
    scene_options.nearest_m = 15;  // far static points leave the translation weak
    const SyntheticScene scene = MakeSyntheticScene(scene_options);
    BundleOptions options = Thorough();
    options.max_iterations = 30;
    BundleProblem with = MakeProblem(scene, true);
    SolveBundle(options, &with);
    BundleProblem without = MakeProblem(scene, false);
    SolveBundle(options, &without);
    sum_with += CameraError(with, scene);
    sum_without += CameraError(without, scene);
  }
  std::cout << "camera's rms error, m: with people " << sum_with / 8 << ", without "
            << sum_without / 8 << "\n";
  EXPECT_LT(sum_with, 0.85 * sum_without);
}

TEST(BundleTest, EveryMotionFormSolvesAndReportsMotions) {
  SyntheticSceneOptions scene_options = Walkers(60, 3);
  scene_options.joint_sigma_px = 0.2;  // at 12 m depth 1 px is 0.8 m: more than anybody moves
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  for (const MotionForm form :
       {MotionForm::kVelocity, MotionForm::kVelocityTrack, MotionForm::kSe3Parts}) {
    BundleOptions options;
    options.motion_form = form;
    options.max_iterations = 20;
    BundleProblem problem = MakeProblem(scene, true);
    const BundleSummary summary = SolveBundle(options, &problem);
    EXPECT_LT(summary.final_cost, summary.initial_cost);
    EXPECT_GT(summary.num_motion, 100);
    EXPECT_LT(CameraError(problem, scene), 0.05);
    for (const BundleProblem::Human& human : problem.humans) {
      ASSERT_FALSE(human.motions.empty());
      for (const BundleProblem::PartMotion& motion : human.motions) {
        EXPECT_TRUE(motion.motion_W.matrix().allFinite());
        EXPECT_LT(motion.motion_W.translation.norm(), 1.0);  // in 0.1 s
      }
    }
  }
}

// The neighbours and the rest of the body hold the joint where it is, so that its own measurement
// goes, and nothing else.
TEST(BundleTest, AJointFarOffIsRejected) {
  SyntheticSceneOptions scene_options = Walkers(100, 2);
  scene_options.joint_sigma_px = 0.2;
  const SyntheticScene scene = MakeSyntheticScene(scene_options);
  BundleProblem problem = MakeProblem(scene, true);
  BundleOptions options;
  options.use_motion = false;
  options.max_iterations = options.max_iterations_after_rejection = 50;
  BundleProblem right = problem;
  const BundleSummary before = SolveBundle(options, &right);
  BundleProblem::JointState& wrong = problem.humans[0].joints[3];
  wrong.uvu_px += Eigen::Vector3d(0, 60, 0);  // along the image, where the segments say most
  const BundleSummary after = SolveBundle(options, &problem);
  EXPECT_FALSE(right.humans[0].joints[3].is_rejected);
  EXPECT_TRUE(wrong.is_rejected);
  EXPECT_EQ(after.num_reprojection_rejected, before.num_reprojection_rejected + 1);
  EXPECT_EQ(problem.humans[1].num_rigidity_rejected, right.humans[1].num_rigidity_rejected);
}

TEST(BundleTest, CovarianceMatchesTheScatterOfTheErrors) {
  // Squared Mahalanobis distances of the newest pose have a mean of 6 and, over 160 runs, a
  // standard error of 0.27. Four of these: a covariance that is a quarter too large or too small is
  // seen.
  constexpr int kRuns = 160;
  double sum = 0;
  for (std::uint32_t seed = 1; seed <= kRuns; ++seed) {
    SyntheticSceneOptions scene_options = Walkers(60, 0);
    scene_options.seed = seed;
    scene_options.num_frames = 5;
    const SyntheticScene scene = MakeSyntheticScene(scene_options);
    BundleProblem problem = MakeProblem(scene, false);
    BundleOptions options = Thorough();
    options.huber_static_sigmas = 1e6;
    options.max_iterations_after_rejection = 0;
    const BundleSummary summary = SolveBundle(options, &problem);
    ASSERT_TRUE(summary.newest_covariance);
    const Vector6d error = Boxminus(problem.frames.back().T_W_C, scene.T_W_C.back());
    sum += error.dot(summary.newest_covariance->ldlt().solve(error));
  }
  EXPECT_NEAR(sum / kRuns, 6, 1.1);
  std::cout << "mean squared Mahalanobis distance: " << sum / kRuns << "\n";
}

/// A box of eight points that turns and drives, measured in camera axes by a camera that sees no
/// static point at all: only the motion that its pairs of frames share can place the camera.
BundleProblem DrivingBox(const Se3& step_W, std::vector<Se3>* truth) {
  auto model = std::make_shared<ArticulatedModel>();
  std::vector<Eigen::Vector3d> points_W;
  model->parts.emplace_back();
  for (int i = 0; i < 8; ++i) {
    points_W.emplace_back(i & 1 ? 1 : -1, i & 2 ? 0.5 : -0.5, i & 4 ? 8 : 5);
    model->parts[0].push_back(i);
  }
  model->num_points = 8;
  model->body_points = model->parts[0];
  model->segments = {{0, 1}, {1, 2}, {2, 4}, {4, 7}};
  EXPECT_TRUE(model->IsValid());
  const Eigen::Vector3d centre_W(0, 0, 6.5);
  truth->clear();

  BundleProblem problem;
  problem.humans.resize(1);
  BundleProblem::Human& box = problem.humans[0];
  box.model = model;
  box.motion_form = MotionForm::kSe3Track;
  box.motion_noise = MotionNoise{0.01, 0.3, 0.3};
  box.segment_length_m.assign(4, std::nullopt);
  for (int frame = 0; frame < 6; ++frame) {
    const Se3 T_W_C{ExpSo3({0, 0.02 * frame, 0}), {0.1 * frame, 0, 0.05 * frame * frame}};
    truth->push_back(T_W_C);
    // The start of all but the first three (which fix the box's motion) is far off.
    const bool is_fixed = frame < 3;
    Vector6d off;
    off << 0.2, -0.1, 0.3, 0.02, -0.05, 0.03;
    const Se3 T_W_C_start = is_fixed ? T_W_C : Boxplus(T_W_C, off);
    problem.frames.push_back({FrameId{frame}, 0.1 * frame, T_W_C_start, is_fixed});
    for (int i = 0; i < 8; ++i) {
      Eigen::Vector3d& p_W = points_W[static_cast<std::size_t>(i)];
      BundleProblem::JointState point;
      point.frame = frame;
      point.joint = i;
      point.point = {T_W_C.inverse() * p_W, 0.05};
      point.p_W = T_W_C_start * point.point->p_C;
      box.joints.push_back(point);
      p_W = step_W.rotation * (p_W - centre_W) + centre_W + step_W.translation;
    }
  }
  return problem;
}

TEST(BundleTest, ARigidObjectsMotionOverItsTrackPlacesTheCamera) {
  std::vector<Se3> truth;
  const Se3 step_W{ExpSo3({0, 0.05, 0.01}), {0.05, 0, 0.1}};
  BundleProblem problem = DrivingBox(step_W, &truth);
  BundleOptions options = Thorough();
  options.huber_dynamic_sigmas = 1e6;
  options.max_iterations_after_rejection = 0;
  const BundleSummary summary = SolveBundle(options, &problem);
  EXPECT_EQ(summary.num_motion, 5 * 8);
  EXPECT_LT(summary.final_cost, 1e-10);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    EXPECT_LT(Boxminus(problem.frames[i].T_W_C, truth[i]).norm(), 1e-6) << i;
  }
  ASSERT_EQ(problem.humans[0].motions.size(), 5U);
  const BundleProblem::PartMotion& motion = problem.humans[0].motions[4];
  EXPECT_LT(LogSo3(motion.motion_W.rotation.conjugate() * step_W.rotation).norm(), 1e-6);

  // One motion a pair, smoothed: nearly the same, as the curve accelerates the box by 0.6 m/s^2,
  // 5 cm within the 0.3 s that nothing else sees; the start was 0.4 off.
  problem = DrivingBox(step_W, &truth);
  problem.humans[0].motion_form = MotionForm::kSe3Smooth;
  EXPECT_EQ(SolveBundle(options, &problem).num_motion, 5 * 8);
  for (std::size_t i = 0; i < problem.frames.size(); ++i) {
    EXPECT_LT(Boxminus(problem.frames[i].T_W_C, truth[i]).norm(), 0.1) << i;
  }

  // Where the track became another's there is no motion, in any form.
  for (const MotionForm form : {MotionForm::kSe3Track, MotionForm::kSe3Smooth,
                                MotionForm::kVelocity, MotionForm::kVelocityTrack}) {
    problem = DrivingBox(step_W, &truth);
    problem.humans[0].motion_form = form;
    problem.humans[0].track_breaks = {2};
    EXPECT_EQ(SolveBundle(options, &problem).num_motion, 4 * 8);
  }

  // A step that took twice the time gets no factor.
  problem = DrivingBox(step_W, &truth);
  problem.frames[5].time_s += 0.1;
  EXPECT_EQ(SolveBundle(options, &problem).num_motion, 4 * 8);
}

TEST(BundleTest, DegenerateProblemsDoNotCrash) {
  const SyntheticScene scene = MakeSyntheticScene(Walkers(30, 1));
  BundleProblem empty = MakeProblem(scene, false);
  empty.observations.clear();
  empty.landmarks.clear();
  EXPECT_EQ(SolveBundle(BundleOptions(), &empty).num_reprojection_rejected, 0);

  BundleProblem one_point = MakeProblem(scene, false);
  one_point.landmarks.resize(1);
  std::vector<BundleProblem::LandmarkObservation> of_it;
  for (const auto& observation : one_point.observations) {
    if (observation.landmark == 0) of_it.push_back(observation);
  }
  one_point.observations = of_it;
  SolveBundle(BundleOptions(), &one_point);
  for (const BundleProblem::Frame& frame : one_point.frames) {
    EXPECT_TRUE(frame.T_W_C.matrix().allFinite());
  }

  BundleProblem all_fixed = MakeProblem(scene, true);
  for (BundleProblem::Frame& frame : all_fixed.frames) frame.is_fixed = true;
  EXPECT_FALSE(SolveBundle(BundleOptions(), &all_fixed).newest_covariance);

  BundleProblem nothing;
  nothing.camera = scene.camera;
  SolveBundle(BundleOptions(), &nothing);
}

}  // namespace
}  // namespace airdos
