#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <memory>
#include <vector>

#include "common/optimization/bundle/bundle_adjuster.h"

// What each factor costs at the start values, worked by hand: weights, kernels and what is joined
// with what.

namespace airdos {
namespace {

const StereoCamera kCamera{640, 480, 500, 470, 310, 250, 0.3};
constexpr double kNone = 1e9;

Se3 Pose(double x) { return {ExpSo3({0.1, -0.2, 0.3}), {x, -0.5 * x, 0.25 * x}}; }

BundleOptions Options() {
  BundleOptions options;
  options.max_iterations = 1;
  options.max_iterations_after_rejection = 0;
  options.huber_static_sigmas = options.huber_dynamic_sigmas = kNone;
  options.person_speed_m_s = 0;
  return options;
}

double CostOf(const BundleOptions& options, BundleProblem problem) {
  return SolveBundle(options, &problem).initial_cost;
}

/// Half of what the Huber kernel makes of a squared error beyond it.
double Huber(double squared, double delta) {
  return 0.5 * (2 * delta * std::sqrt(squared) - delta * delta);
}

/// A fixed frame and a free one; in the free one a landmark, off by (3, -2, 1) px of 0.5.
BundleProblem OneLandmark() {
  BundleProblem problem;
  problem.camera = kCamera;
  problem.frames.push_back({FrameId{0}, 0, Pose(0), true});
  problem.frames.push_back({FrameId{1}, 0.1, Pose(1), false});
  const Eigen::Vector3d p_C(1, -0.5, 6);
  problem.landmarks.push_back({LandmarkId{1}, Pose(1) * p_C, false});
  const Eigen::Vector3d uvu = kCamera.ProjectStereo(p_C) + Eigen::Vector3d(3, -2, 1);
  problem.observations.push_back({1, 0, uvu, true, 0.5, false});
  return problem;
}

TEST(BundleCosts, ALandmark) {
  BundleProblem problem = OneLandmark();
  BundleOptions options = Options();
  EXPECT_NEAR(CostOf(options, problem), 28, 1e-9);  // (36 + 16 + 4) / 2
  options.huber_static_sigmas = 2;
  options.huber_dynamic_sigmas = 0.1;
  EXPECT_NEAR(CostOf(options, problem), Huber(56, 2), 1e-9);
  problem.observations[0].has_right = false;
  EXPECT_NEAR(CostOf(Options(), problem), 26, 1e-9);
  problem.observations[0].point = {Eigen::Vector3d(1.1, -0.3, 5.8), 0.05};
  EXPECT_NEAR(CostOf(Options(), problem), 18, 1e-9);  // (4 + 16 + 16) / 2
  problem.observations[0].is_rejected = true;
  EXPECT_NEAR(CostOf(Options(), problem), 0, 1e-12);
}

TEST(BundleCosts, AnAcceleration) {
  BundleProblem problem;
  problem.camera = kCamera;
  const Eigen::Quaterniond straight = Eigen::Quaterniond::Identity();
  problem.frames.push_back({FrameId{0}, 0, {straight, {0, 0, 0}}, true});
  problem.frames.push_back({FrameId{1}, 0.1, {straight, {0.1, 0, 0}}, false});
  problem.frames.push_back({FrameId{2}, 0.3, {ExpSo3({0, 0.06, 0}), {0.7, 0.2, 0}}, false});
  problem.accelerations.push_back({{0, 1, 2}, {4, 0.5}});
  // v: (1, 0, 0), (3, 1, 0); w: 0, 0.3; over 0.15 s: (2, 1) / 0.6 and 0.3 / 0.075.
  EXPECT_NEAR(CostOf(Options(), problem), 0.5 * (5 / 0.36 + 16), 1e-9);
  problem.frames[2].time_s = 0.1;  // a clock that stood still says nothing
  EXPECT_NEAR(CostOf(Options(), problem), 0, 1e-12);
  problem.frames[2].time_s = 0.3;
  problem.frames[1].time_s = 0;
  problem.landmarks.push_back({LandmarkId{1}, {0.1, 0.2, 6}, false});
  const Eigen::Vector3d error_px(3, -2, 1);  // so that no cost is not mistaken for one of none
  problem.observations.push_back({1, 0, kCamera.ProjectStereo({0, 0.2, 6}) + error_px, true, 0.5});
  EXPECT_NEAR(CostOf(Options(), problem), 28, 1e-9);
}

/// Fixed frames at these times.
BundleProblem Frames(const std::vector<double>& times_s) {
  BundleProblem problem;
  problem.camera = kCamera;
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    problem.frames.push_back(
        {FrameId{static_cast<std::int64_t>(i)}, times_s[i], Pose(static_cast<double>(i)), true});
  }
  problem.humans.resize(1);
  problem.humans[0].id.value = 4;
  return problem;
}

/// A joint that is measured exactly where it is.
void AddJoint(int frame, int joint, const Eigen::Vector3d& p_W, BundleProblem* problem,
              std::size_t human = 0) {
  BundleProblem::JointState state;
  state.frame = frame;
  state.joint = joint;
  state.p_W = p_W;
  const Se3& T_W_C = problem->frames[static_cast<std::size_t>(frame)].T_W_C;
  state.point = BundleProblem::PointMeasurement{T_W_C.inverse() * p_W, 0.05};
  problem->humans[human].joints.push_back(state);
}

TEST(BundleCosts, AJointWithItsWholeCovariance) {
  BundleProblem problem = Frames({0});
  const Eigen::Vector3d p_C(0.5, 0.3, 5);
  AddJoint(0, kNeck, Pose(0) * p_C, &problem);
  BundleProblem::JointState& joint = problem.humans[0].joints[0];
  joint.point.reset();
  const Eigen::Vector3d error(1, -2, 0.5);
  joint.uvu_px = kCamera.ProjectStereo(p_C) - error;
  joint.covariance_px2 << 1.2, 0.3, 0.9, 0.3, 0.7, 0.2, 0.9, 0.2, 1.4;
  const double squared = error.dot(joint.covariance_px2.inverse() * error);
  EXPECT_NEAR(CostOf(Options(), problem), 0.5 * squared, 1e-9);
  BundleOptions options = Options();
  options.huber_static_sigmas = 0.1;
  options.huber_dynamic_sigmas = 1;
  EXPECT_NEAR(CostOf(options, problem), Huber(squared, 1), 1e-9);
  joint.is_rejected = true;
  EXPECT_NEAR(CostOf(options, problem), 0, 1e-12);
}

TEST(BundleCosts, ASegmentAndWhatIsKnownOfIt) {
  BundleProblem problem = Frames({0, 0.1});
  BundleProblem::Human& human = problem.humans[0];
  for (int frame = 0; frame < 2; ++frame) {
    AddJoint(frame, kRightHip, {1, 1, 5}, &problem);
    if (frame == 0) AddJoint(frame, kRightKnee, {1, 1.3, 5.4}, &problem);  // 0.5 m
  }
  AddJoint(1, kLeftHip, {1.4, 1, 5}, &problem);
  human.segment_length_m[9] = 0.53;
  human.segment_length_m[11] = 0.6;  // the left thigh is never seen whole
  human.known_length_m[11] = 0.4;
  human.known_length_sigma_m[11] = 0.01;
  human.known_length_m[4] = 0.3;  // and a length without a start has no factor
  human.known_length_sigma_m[4] = 0.01;
  BundleOptions options = Options();
  options.rigidity_sigma_m = 0.015;
  options.segment_length_sigma_m = 0.04;
  options.use_motion = false;
  EXPECT_NEAR(CostOf(options, problem), 2, 1e-9);
  human.known_length_m[9] = 0.50;
  human.known_length_sigma_m[9] = 0.03;
  EXPECT_NEAR(CostOf(options, problem), 2 + 0.18, 1e-9);  // 0.03 / 0.05
  options.huber_dynamic_sigmas = 0.5;                     // not on what is known
  options.huber_smoothness_sigmas = 0.1;
  EXPECT_NEAR(CostOf(options, problem), Huber(4, 0.5) + 0.18, 1e-9);
  BundleProblem copy = problem;
  const BundleSummary summary = SolveBundle(options, &copy);
  EXPECT_EQ(summary.num_rigidity, 1);
  EXPECT_EQ(summary.num_people, 1);
  options.use_rigidity = false;
  EXPECT_NEAR(CostOf(options, problem), 0, 1e-12);
  options.use_rigidity = true;
  options.use_people = false;
  EXPECT_NEAR(CostOf(options, problem), 0, 1e-12);
}

/// Neck and nose at 0, 0.1 and 0.3 s, which part in the first step; and an elbow that flies.
BundleProblem Walker() {
  BundleProblem problem = Frames({0, 0.1, 0.3});
  const std::vector<Eigen::Vector3d> necks = {{0, 0, 5}, {0.12, 0, 5}, {0.42, 0.1, 5}};
  const std::vector<Eigen::Vector3d> noses = {{0, -0.2, 5}, {0.08, -0.2, 5.04}, {0.38, -0.1, 5.04}};
  for (int frame = 0; frame < 3; ++frame) {
    const auto i = static_cast<std::size_t>(frame);
    AddJoint(frame, kNose, noses[i], &problem);
    AddJoint(frame, kNeck, necks[i], &problem);
    if (frame != 1) AddJoint(frame, kLeftShoulder, {3.0 * frame, 0, 5}, &problem);
    AddJoint(frame, kLeftElbow, {2.0 * frame, 0, 5}, &problem);
  }
  return problem;
}

BundleOptions WalkerOptions() {
  BundleOptions options = Options();
  options.motion_sigma_m = 0.02;
  options.person_acceleration_m_s2 = 2;
  options.person_speed_m_s = 2;
  return options;
}

// Steps 0.1 +- 0.02 and 0.02 +- 0.02 m: velocities (1, 0, 0.2) and, exactly, (1.5, 0.5, 0).
constexpr double kMotionSquared = 2;            // of neck and nose each: 0.0008 / 0.0004
constexpr double kSpeedSquared = 1.04 / 4;      // of the first velocity
constexpr double kChangeSquared = 0.54 / 0.09;  // of both over 0.15 s

TEST(BundleCosts, AVelocityAFramePair) {
  const BundleProblem problem = Walker();
  BundleOptions options = WalkerOptions();
  EXPECT_NEAR(CostOf(options, problem), kMotionSquared + 0.5 * (kSpeedSquared + kChangeSquared),
              1e-9);
  options.huber_dynamic_sigmas = 1;
  options.huber_smoothness_sigmas = 0.5;
  EXPECT_NEAR(CostOf(options, problem),
              2 * Huber(kMotionSquared, 1) + Huber(kSpeedSquared, 0.5) + Huber(kChangeSquared, 0.5),
              1e-9);
  options = WalkerOptions();
  options.person_speed_m_s = 0;
  EXPECT_NEAR(CostOf(options, problem), kMotionSquared + 0.5 * kChangeSquared, 1e-9);
  options.use_motion = false;
  EXPECT_NEAR(CostOf(options, problem), 0, 1e-12);
}

TEST(BundleCosts, APersonsOwnNoiseCounts) {
  BundleProblem problem = Walker();
  problem.humans[0].motion_noise = MotionNoise{0.04, 4, 1};
  EXPECT_NEAR(CostOf(WalkerOptions(), problem),
              kMotionSquared / 4 + 0.5 * (kSpeedSquared + kChangeSquared / 4), 1e-9);
}

TEST(BundleCosts, OneVelocityATrack) {
  BundleProblem problem = Walker();
  BundleOptions options = WalkerOptions();
  problem.humans[0].motion_form = MotionForm::kVelocityTrack;
  // The second step is (0.3, 0.1, 0) and not 0.2 s times the first velocity: 0.0216 / 0.0004.
  EXPECT_NEAR(CostOf(options, problem), kMotionSquared + 54 + 0.5 * kSpeedSquared, 1e-9);
  problem.humans[0].motion_form.reset();
  options.motion_form = MotionForm::kVelocityTrack;
  EXPECT_NEAR(CostOf(options, problem), kMotionSquared + 54 + 0.5 * kSpeedSquared, 1e-9);
  BundleProblem copy = problem;
  EXPECT_EQ(SolveBundle(options, &copy).num_motion, 4);
}

/// One joint that goes at (1, 0, 0) m/s through these times.
BundleProblem Runner(const std::vector<double>& times_s) {
  BundleProblem problem = Frames(times_s);
  for (std::size_t i = 0; i < times_s.size(); ++i) {
    AddJoint(static_cast<int>(i), kNeck, {times_s[i], 0, 5}, &problem);
  }
  return problem;
}

int NumMotions(const BundleOptions& options, BundleProblem problem) {
  return SolveBundle(options, &problem).num_motion;
}

TEST(BundleCosts, NoMotionLeadsAcrossAGapOrABreak) {
  BundleOptions options = WalkerOptions();
  options.motion_max_gap_s = 0.5;
  EXPECT_EQ(NumMotions(options, Runner({0, 0.5, 1})), 2) << "exactly the longest gap";
  EXPECT_EQ(NumMotions(options, Runner({0, 0.5001, 1})), 1);
  EXPECT_EQ(NumMotions(options, Runner({0, 0.1, 0.1, 0.05})), 1);
  // Each new velocity has its own start (1 m/s of 2): one, or one before and one after.
  BundleProblem problem = Runner({0, 0.25, 0.5, 0.75});
  EXPECT_NEAR(CostOf(options, problem), 0.125, 1e-9);
  problem.humans[0].track_breaks = {2};
  EXPECT_EQ(NumMotions(options, problem), 2);
  EXPECT_NEAR(CostOf(options, problem), 0.25, 1e-9);
  options.motion_form = MotionForm::kVelocityTrack;
  EXPECT_EQ(NumMotions(options, problem), 2);
  EXPECT_NEAR(CostOf(options, problem), 0.25, 1e-9);
  problem.humans[0].track_breaks.clear();
  problem.frames[2].time_s = 0.8;
  problem.frames[3].time_s = 1;
  problem.humans[0].joints[2].p_W.x() = 0.8;
  problem.humans[0].joints[3].p_W.x() = 1;
  for (BundleProblem::JointState& joint : problem.humans[0].joints) joint.is_rejected = true;
  EXPECT_NEAR(CostOf(options, problem), 0.125, 1e-9) << "one velocity before and after a gap";
  options.motion_form = MotionForm::kVelocity;
  EXPECT_NEAR(CostOf(options, problem), 0.25, 1e-9);
}

TEST(BundleCosts, TheVelocityIsReportedAsAMotionOfTheTorso) {
  BundleProblem problem = Frames({0, 0.1, 0.3});
  for (int frame = 0; frame < 3; ++frame) {
    const double way_m = std::vector<double>{0, 0.1, 0.3}[static_cast<std::size_t>(frame)];
    const Eigen::Vector3d way = way_m * Eigen::Vector3d(1, 0.5, -0.25);
    AddJoint(frame, kNeck, Eigen::Vector3d(0, 0.2, 5) + way, &problem);
    AddJoint(frame, kRightShoulder, Eigen::Vector3d(0.4, 0, 6) + way, &problem);
  }
  BundleOptions options = WalkerOptions();
  options.person_speed_m_s = 0;
  SolveBundle(options, &problem);
  const std::vector<BundleProblem::PartMotion>& motions = problem.humans[0].motions;
  ASSERT_EQ(motions.size(), 2U);
  EXPECT_EQ(motions[0].frame, 1);
  EXPECT_EQ(motions[1].frame, 2);
  EXPECT_EQ(motions[1].part, kTorsoPart);
  EXPECT_LT((motions[0].centroid_W - Eigen::Vector3d(0.2, 0.1, 5.5)).norm(), 1e-9);
  EXPECT_LT((motions[1].centroid_W - Eigen::Vector3d(0.3, 0.15, 5.475)).norm(), 1e-9);
  EXPECT_LT((motions[0].motion_W.translation - Eigen::Vector3d(0.1, 0.05, -0.025)).norm(), 1e-9);
  EXPECT_LT((motions[1].motion_W.translation - Eigen::Vector3d(0.2, 0.1, -0.05)).norm(), 1e-9);
  EXPECT_LT(LogSo3(motions[1].motion_W.rotation).norm(), 1e-9);
}

TEST(BundleCosts, AMotionAPart) {
  BundleProblem problem = Frames({0, 0.1});
  // Torso: three points whose steps are 0.1 + (0.02, -0.02, 0); right upper arm: 0.1, 0.06.
  AddJoint(0, kNeck, {0, 0, 5}, &problem);
  AddJoint(0, kRightShoulder, {0.2, 0, 5}, &problem);
  AddJoint(0, kRightElbow, {0.2, 0.3, 5}, &problem);
  AddJoint(0, kLeftShoulder, {-0.2, 0, 5}, &problem);
  AddJoint(0, kLeftWrist, {-0.2, 0.4, 5}, &problem);
  AddJoint(1, kNeck, {0.12, 0, 5}, &problem);
  AddJoint(1, kRightShoulder, {0.3, 0, 5}, &problem);
  AddJoint(1, kRightElbow, {0.26, 0.3, 5}, &problem);
  AddJoint(1, kLeftShoulder, {-0.12, 0, 5}, &problem);
  BundleOptions options = WalkerOptions();
  options.motion_form = MotionForm::kSe3Parts;
  EXPECT_NEAR(CostOf(options, problem), 0.5 * (1 + 1 + 1 + 1), 1e-9);
  BundleProblem copy = problem;
  EXPECT_EQ(SolveBundle(options, &copy).num_motion, 5);
  ASSERT_EQ(copy.humans[0].motions.size(), 2U);
  EXPECT_EQ(copy.humans[0].motions[0].part, 0);
  EXPECT_EQ(copy.humans[0].motions[1].part, 1);
  EXPECT_EQ(copy.humans[0].motions[1].frame, 1);
  EXPECT_LT((copy.humans[0].motions[1].centroid_W - Eigen::Vector3d(0.2, 0.15, 5)).norm(), 1e-9);
  problem.humans[0].motion_noise = MotionNoise{0.04, 4, 1};
  EXPECT_NEAR(CostOf(options, problem), 0.5, 1e-9);
}

TEST(BundleCosts, AMotionAPartChangesLittle) {
  BundleProblem problem = Walker();
  for (BundleProblem::JointState& joint : problem.humans[0].joints) {
    if (joint.joint == kLeftElbow) joint.joint = kRightShoulder;  // a third point of the torso
  }
  auto& joints = problem.humans[0].joints;
  for (auto it = joints.begin(); it != joints.end();) {
    it = it->joint == kLeftShoulder || it->joint == kNose ? joints.erase(it) : std::next(it);
  }
  // Neck and shoulder: steps (0.12, 0, 0), (0.3, 0.1, 0).
  for (auto& joint : joints) {
    if (joint.joint != kRightShoulder) continue;
    joint.p_W = joints[static_cast<std::size_t>(2 * joint.frame)].p_W + Eigen::Vector3d(0, 0, 1);
    joint.is_rejected = true;
  }
  BundleOptions options = WalkerOptions();
  options.motion_form = MotionForm::kSe3Smooth;
  // (1.5, 0.5) - (1.2, 0) m/s over 0.15 s: 0.34 / 0.09.
  EXPECT_NEAR(CostOf(options, problem), 0.5 * 0.34 / 0.09, 1e-9);
  options.huber_smoothness_sigmas = 0.5;
  options.huber_dynamic_sigmas = 0.1;
  EXPECT_NEAR(CostOf(options, problem), Huber(0.34 / 0.09, 0.5), 1e-9);
  problem.humans[0].motion_noise = MotionNoise{0.04, 4, 1};
  EXPECT_NEAR(CostOf(options, problem), Huber(0.34 / 0.36, 0.5), 1e-9);
  problem.humans[0].track_breaks = {2};
  EXPECT_NEAR(CostOf(options, problem), 0, 1e-12);
}

std::shared_ptr<const ArticulatedModel> Thing(int num_points) {
  auto model = std::make_shared<ArticulatedModel>();
  model->num_points = num_points;
  model->parts.resize(1);
  for (int i = 0; i < num_points; ++i) model->parts[0].push_back(i);
  model->body_points = model->parts[0];
  return model;
}

/// A thing whose points go through frames 0.1 s apart; each is measured exactly.
BundleProblem Things(const std::vector<std::vector<Eigen::Vector3d>>& points_W, MotionForm form) {
  std::vector<double> times_s;
  for (std::size_t i = 0; i < points_W.size(); ++i) times_s.push_back(0.1 * static_cast<double>(i));
  BundleProblem problem = Frames(times_s);
  problem.humans[0].model = Thing(static_cast<int>(points_W[0].size()));
  problem.humans[0].motion_form = form;
  for (std::size_t i = 0; i < points_W.size(); ++i) {
    for (std::size_t j = 0; j < points_W[i].size(); ++j) {
      AddJoint(static_cast<int>(i), static_cast<int>(j), points_W[i][j], &problem);
      problem.humans[0].joints.back().point->sigma_m = 1e-6;
    }
  }
  return problem;
}

std::vector<Eigen::Vector3d> Moved(const Se3& motion, const Eigen::Vector3d& centre,
                                   std::vector<Eigen::Vector3d> points) {
  for (Eigen::Vector3d& p : points)
    p = motion.rotation * (p - centre) + centre + motion.translation;
  return points;
}

Se3 Turned(const Eigen::Vector3d& turn) { return {ExpSo3(turn), Eigen::Vector3d::Zero()}; }

TEST(BundleCosts, OneMotionATrackStartsFromThePoints) {
  const Se3 motion{ExpSo3({0.1, 0.5, -0.2}), {0.3, 0.1, -0.2}};
  const std::vector<Eigen::Vector3d> p_0 = {{0, 0, 5}, {1, 0, 5}, {0, 0.8, 5}, {0.2, 0.1, 5.7}};
  const Eigen::Vector3d centre(0.3, 0.225, 5.175);
  const auto p_1 = Moved(motion, centre, p_0);
  const auto p_2 = Moved(motion, centre, p_1);
  BundleProblem problem = Things({p_0, p_1, p_2}, MotionForm::kSe3Track);
  const BundleOptions options = WalkerOptions();
  EXPECT_NEAR(CostOf(options, problem), 0, 1e-12);
  EXPECT_EQ(NumMotions(options, problem), 8);
  // A flat thing could be mirrored: it must not be.
  const std::vector<Eigen::Vector3d> flat = {{0, 0, 5}, {1, 0, 5}, {0, 0.8, 5}};
  const Eigen::Vector3d middle(1. / 3, 0.8 / 3, 5);
  EXPECT_NEAR(CostOf(options, Things({flat, Moved(motion, middle, flat)}, MotionForm::kSe3Track)),
              0, 1e-12);
  // A step that took a little longer still counts, one of another length does not.
  problem.frames[2].time_s = 0.2008;
  EXPECT_EQ(NumMotions(options, problem), 8);
  problem.frames[2].time_s = 0.2015;
  EXPECT_EQ(NumMotions(options, problem), 4);
  for (std::size_t i = 0; i < 3; ++i) problem.frames[i].time_s = 0.3 * static_cast<double>(i);
  EXPECT_EQ(NumMotions(options, problem), 8) << "whatever the first step was";
}

TEST(BundleCosts, OneMotionATrackStartsWhereItIsTold) {
  const std::vector<Eigen::Vector3d> points = {{0, 0, 5}, {1, 0, 5}};
  BundleProblem problem = Things({points, points}, MotionForm::kSe3Track);
  BundleOptions options = WalkerOptions();
  options.free_rotation_sigma_rad = 0.2;
  BundleProblem::PartMotion other, start;
  other.part = 1;
  other.motion_W.translation.x() = 100;
  start.part = 0;
  start.centroid_W = {0.5, 0, 5};
  start.motion_W.rotation = ExpSo3({0.1, 0, 0});
  problem.humans[0].start_motions = {other, start};
  // About the line through both points nothing else speaks: 1.1 * 0.1 / 0.2.
  EXPECT_NEAR(CostOf(options, problem), 0.5 * 0.3025, 1e-9);
  // Across it the damping is ten times less, but both points are off by 0.5 * 0.1.
  problem.humans[0].start_motions[1].motion_W.rotation = ExpSo3({0, 0, 0.1});
  const double chord = 2 * 0.5 * std::sin(0.05);
  EXPECT_NEAR(CostOf(options, problem), 0.5 * (0.0025 + 2 * chord * chord / 0.0004), 1e-9);
  problem.humans[0].start_motions[1].centroid_W.x() = 0;
  EXPECT_NEAR(CostOf(options, problem), 0.5 * (0.0025 + 4 * chord * chord / 0.0004), 1e-9);
}

/// The rotation vector of the first motion after a thorough solution.
Eigen::Vector3d Turn(const BundleOptions& options, BundleProblem problem, std::size_t motion = 0) {
  BundleOptions thorough = options;
  thorough.max_iterations = 50;
  thorough.function_tolerance = 1e-14;
  SolveBundle(thorough, &problem);
  return LogSo3(problem.humans[0].motions[motion].motion_W.rotation);
}

TEST(BundleCosts, TheDampingHoldsTheRotationByItsWeight) {
  BundleOptions options = WalkerOptions();
  options.motion_sigma_m = 0.1;
  options.free_rotation_sigma_rad = 0.02;
  const double damping = std::pow(0.1 / 0.02, 2);
  // Two points 2 * 0.5 m apart turn by 0.01 rad across their line.
  const std::vector<Eigen::Vector3d> two = {{-0.5, 0, 5}, {0.5, 0, 5}};
  const auto turned = Moved(Turned({0, 0, 0.01}), {0, 0, 5}, two);
  double information = 2 * 0.25 / 0.01;
  Eigen::Vector3d turn = Turn(options, Things({two, turned}, MotionForm::kSe3Parts));
  EXPECT_NEAR(turn.z(), 0.01 * information / (information + damping), 1e-6);
  EXPECT_NEAR(turn.x(), 0, 1e-6);
  // Three points turn about the line through the first two, 0.2 m from which is their middle.
  const std::vector<Eigen::Vector3d> three = {{-0.5, 0, 5}, {0.5, 0, 5}, {0, 0.6, 5}};
  const auto tilted = Moved(Turned({0.01, 0, 0}), {0, 0.2, 5}, three);
  information = (2 * 0.04 + 0.16) / 0.01;
  turn = Turn(options, Things({three, tilted}, MotionForm::kSe3Parts));
  EXPECT_NEAR(turn.x(), 0.01 * information / (information + damping), 1e-6);
}

TEST(BundleCosts, TheTurnAPartChangesLittle) {
  BundleOptions options = WalkerOptions();
  options.motion_sigma_m = 0.1;
  options.free_rotation_sigma_rad = 1;
  const std::vector<Eigen::Vector3d> p_0 = {{-0.5, 0, 5}, {0.5, 0, 5}};
  const auto p_1 = Moved(Turned({0, 0, 0.01}), {0, 0, 5}, p_0);
  const auto p_2 = Moved(Turned({0, 0, 0.03}), {0, 0, 5}, p_1);
  BundleProblem problem = Things({p_0, p_1, p_2}, MotionForm::kSe3Smooth);
  problem.frames[2].time_s = 0.3;
  problem.humans[0].motion_noise = MotionNoise{0.1, 1e3, 0.5};
  // Minimizes 50 (a - 0.01)^2 + 50 (b - 0.03)^2 + 0.01 (a^2 + b^2) + ((b / 0.2 - a / 0.1) / s)^2.
  const double weight = 1 / std::pow(0.5 * 0.15, 2);
  Eigen::Matrix2d H = (2 * 0.25 / 0.01 + 0.01) * Eigen::Matrix2d::Identity();
  const Eigen::Vector2d g(-10, 5);
  H += weight * g * g.transpose();
  const Eigen::Vector2d turns = H.inverse() * (50 * Eigen::Vector2d(0.01, 0.03));
  EXPECT_NEAR(Turn(options, problem, 0).z(), turns[0], 1e-6);
  EXPECT_NEAR(Turn(options, problem, 1).z(), turns[1], 1e-6);
}

}  // namespace
}  // namespace airdos
