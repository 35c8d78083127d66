#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>

#include "common/evaluation/alignment.h"
#include "common/evaluation/chart.h"
#include "common/evaluation/ground_truth_axes.h"
#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory.h"
#include "common/evaluation/trajectory_error.h"
#include "common/evaluation/trajectory_file.h"
#include "common/evaluation/trajectory_plot.h"
#include "common/evaluation/trajectory_report.h"
#include "tests/support/input_errors.h"

namespace airdos {
namespace {

Eigen::Matrix3d Rotation(double angle_rad, const Eigen::Vector3d& axis) {
  return Eigen::AngleAxisd(angle_rad, axis.normalized()).toRotationMatrix();
}

/// At the origin, at a time.
TrajectoryPose At(double time_s) {
  TrajectoryPose pose;
  pose.time_s = time_s;
  return pose;
}

/// A camera in optical axes that drives a bend: turns about y, nods a little, 0.5 m a frame.
std::vector<TrajectoryPose> Bend(int num_poses) {
  std::vector<TrajectoryPose> poses;
  Eigen::Vector3d position = Eigen::Vector3d::Zero();
  for (int i = 0; i < num_poses; ++i) {
    TrajectoryPose pose;
    pose.time_s = 0.1 * i;
    pose.rotation = Rotation(0.03 * i, Eigen::Vector3d::UnitY()) *
                    Rotation(0.02 * std::sin(0.4 * i), Eigen::Vector3d::UnitX());
    pose.position_m = position;
    poses.push_back(pose);
    position += pose.rotation * Eigen::Vector3d(0, 0, 0.5);
  }
  return poses;
}

/// The poses in another world, in which lengths are `scale` times as long.
std::vector<TrajectoryPose> InOtherWorld(const std::vector<TrajectoryPose>& poses, double scale) {
  return Apply({scale, Rotation(1.1, {1, 2, 3}), {5, -6, 7}}, poses);
}

/// The inverse of ToOptical() for NED, written out: forward z -> x, right x -> y, down y -> z.
TrajectoryPose InNed(const TrajectoryPose& pose) {
  const auto to_ned = [](const Eigen::Vector3d& v) { return Eigen::Vector3d(v.z(), v.x(), v.y()); };
  TrajectoryPose ned = pose;
  ned.position_m = to_ned(pose.position_m);
  ned.rotation.col(0) = to_ned(pose.rotation.col(2));
  ned.rotation.col(1) = to_ned(pose.rotation.col(0));
  ned.rotation.col(2) = to_ned(pose.rotation.col(1));
  return ned;
}

TEST(StatisticsTest, HandWorkedValues) {
  const Statistics odd = ComputeStatistics({3, 1, 2});
  EXPECT_EQ(odd.count, 3u);
  EXPECT_DOUBLE_EQ(odd.mean, 2);
  EXPECT_DOUBLE_EQ(odd.median, 2);
  EXPECT_DOUBLE_EQ(odd.max, 3);
  EXPECT_DOUBLE_EQ(odd.rmse, std::sqrt(14.0 / 3));
  EXPECT_DOUBLE_EQ(odd.std, std::sqrt(2.0 / 3));
  EXPECT_DOUBLE_EQ(ComputeStatistics({4, 1, 2, 10}).median, 3);
  EXPECT_EQ(ComputeStatistics({}).count, 0u);
}

TEST(AssociateTest, EachPoseOfTheShorterGetsTheNearest) {
  Trajectory estimate = {true, {}};
  Trajectory truth = {true, {}};
  for (const double t : {0.0, 0.1, 0.2}) estimate.poses.push_back(At(t));
  for (const double t : {0.004, 0.096, 0.102, 0.215}) truth.poses.push_back(At(t));
  const MatchedTrajectories matched = Associate(estimate, truth, 0.01);
  ASSERT_EQ(matched.estimate.size(), 2u);
  EXPECT_EQ(matched.ground_truth[0].time_s, 0.004);
  EXPECT_EQ(matched.ground_truth[1].time_s, 0.102);
  EXPECT_EQ(Associate(estimate, truth, 0.02).estimate.size(), 3u);
  EXPECT_EQ(Associate(truth, estimate, 0.02).estimate[1].time_s, 0.102);
}

TEST(AssociateTest, RowsByNumber) {
  Trajectory estimate = {false, Bend(5)};
  Trajectory truth = {false, Bend(5)};
  EXPECT_EQ(Associate(estimate, truth, 0.01).ground_truth.size(), 5u);
  estimate.poses.pop_back();  // it may be any row that lacks
  EXPECT_NE(ErrorOf([&] { Associate(estimate, truth, 0.01); }).find("has 4 rows"),
            std::string::npos);
  EXPECT_NE(ErrorOf([&] { Associate(truth, estimate, 0.01); }).find("has 4: "), std::string::npos);
  estimate.num_lost_rows = 1;  // a row of nan
  EXPECT_EQ(Associate(estimate, truth, 0.01).ground_truth.size(), 4u);
  truth.has_times = true;
  EXPECT_NE(ErrorOf([&] { Associate(estimate, truth, 0.01); }).find("--times"), std::string::npos);
}

TEST(AlignmentTest, FindsTheTransform) {
  const std::vector<TrajectoryPose> truth = Bend(40);
  const MatchedTrajectories moved = {InOtherWorld(truth, 1), truth};
  const std::vector<TrajectoryPose> se3 =
      Apply(ComputeAlignment(moved, Alignment::kSe3), moved.estimate);
  EXPECT_LT(ComputeStatistics(PositionErrors(se3, truth)).max, 1e-12);
  EXPECT_NEAR((se3[7].rotation - truth[7].rotation).norm(), 0, 1e-12);

  const MatchedTrajectories scaled = {InOtherWorld(truth, 0.25), truth};
  const Similarity sim3 = ComputeAlignment(scaled, Alignment::kSim3);
  EXPECT_NEAR(sim3.scale, 4, 1e-12);
  EXPECT_LT(ComputeStatistics(PositionErrors(Apply(sim3, scaled.estimate), truth)).max, 1e-12);
  EXPECT_EQ(ComputeAlignment(scaled, Alignment::kSe3).scale, 1);
  EXPECT_EQ(ComputeAlignment(scaled, Alignment::kNone).translation_m, Eigen::Vector3d::Zero());
}

TEST(AlignmentTest, AnEstimateThatNeverMovesKeepsItsScale) {
  std::vector<TrajectoryPose> still(10);
  const Similarity sim3 = ComputeAlignment({still, Bend(10)}, Alignment::kSim3);
  EXPECT_EQ(sim3.scale, 1);
  EXPECT_TRUE(sim3.translation_m.allFinite());
}

TEST(TrajectoryErrorTest, HandWorkedMotion) {
  // Truth: 2 m along x. Estimate: 2.5 m along x of its body and 0.1 rad too far about z.
  std::vector<TrajectoryPose> truth(2);
  truth[1].position_m = {2, 0, 0};
  std::vector<TrajectoryPose> estimate(2);
  estimate[0].rotation = estimate[1].rotation = Rotation(1.5, Eigen::Vector3d::UnitY());
  estimate[1].rotation = estimate[0].rotation * Rotation(0.1, Eigen::Vector3d::UnitZ());
  estimate[1].position_m = estimate[0].rotation * Eigen::Vector3d(2.5, 0, 0);
  const std::vector<RelativeError> errors = ErrorsPerFrame({estimate, truth});
  ASSERT_EQ(errors.size(), 1u);
  EXPECT_NEAR(errors[0].translation_m, 0.5, 1e-12);
  EXPECT_NEAR(errors[0].rotation_deg, 0.1 * 180 / M_PI, 1e-9);
  EXPECT_NEAR(errors[0].path_m, 2, 1e-12);
  EXPECT_NEAR(EndPointDriftPercent({estimate, truth}), 25, 1e-9);
}

TEST(TrajectoryErrorTest, DriftOfAWrongScale) {
  // Straight ahead, 1 m a frame, 2 % too far: 2 % over every length, 0.02 m/m per metre.
  std::vector<TrajectoryPose> truth(61);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i].position_m = {0, 0, static_cast<double>(i)};
  }
  std::vector<TrajectoryPose> estimate = truth;
  for (TrajectoryPose& pose : estimate) pose.position_m *= 1.02;
  const MatchedTrajectories matched = {estimate, truth};
  const std::vector<SegmentDrift> drifts = SegmentDrifts(matched);
  ASSERT_EQ(drifts.size(), 4u);  // 5, 10, 20, 50 m
  EXPECT_EQ(drifts[3].length_m, 50);
  EXPECT_EQ(drifts[3].num_segments, 11u);
  for (const SegmentDrift& drift : drifts) {
    EXPECT_NEAR(drift.translation_percent, 2, 1e-9);
    EXPECT_NEAR(drift.rotation_deg_per_m, 0, 1e-9);
  }
  EXPECT_NEAR(EndPointDriftPercent(matched), 2, 1e-9);
  EXPECT_EQ(EndPointDriftPercent({{truth[0], truth[0]}, {truth[0], truth[0]}}), 0);
}

TEST(TrajectoryErrorTest, CountsLostFrames) {
  // Straight ahead, 1 m a frame; of the estimate's steps one is 11 cm too long, one 9 cm, one turns
  // 2.1 deg too far, one 1.9 deg; two of 8 frames have no pose.
  std::vector<TrajectoryPose> truth(6);
  std::vector<TrajectoryPose> estimate(6);
  for (std::size_t i = 1; i < truth.size(); ++i) {
    truth[i].position_m = {0, 0, static_cast<double>(i)};
    const double too_long_m = i == 1 ? 0.11 : i == 2 ? 0.09 : 0;
    const double too_far_deg = i == 4 ? 2.1 : i == 5 ? 1.9 : 0;
    estimate[i].position_m = estimate[i - 1].position_m +
                             estimate[i - 1].rotation * Eigen::Vector3d(0, 0, 1 + too_long_m);
    estimate[i].rotation =
        estimate[i - 1].rotation * Rotation(too_far_deg * M_PI / 180, Eigen::Vector3d::UnitY());
  }
  EXPECT_EQ(CountLostFrames({estimate, truth}, 6), 2u);
  EXPECT_EQ(CountLostFrames({estimate, truth}, 8), 4u);
  EXPECT_EQ(CountLostFrames({truth, truth}, 6), 0u);
}

TEST(AxesTest, ConvertsWorldAndBody) {
  const TrajectoryPose pose = Bend(20)[13];
  const TrajectoryPose back = ToOptical(InNed(pose), GroundTruthAxes::Ned());
  EXPECT_NEAR((back.position_m - pose.position_m).norm(), 0, 1e-12);
  EXPECT_NEAR((back.rotation - pose.rotation).norm(), 0, 1e-12);
}

/// A ground truth that a file in these axes would hold: R' = S R S^T, p' = S p.
std::vector<TrajectoryPose> InAxes(std::vector<TrajectoryPose> poses, const GroundTruthAxes& axes) {
  const Eigen::Matrix3d& S = axes.matrix();
  for (TrajectoryPose& pose : poses) {
    pose.rotation = S * pose.rotation * S.transpose();
    pose.position_m = S * pose.position_m;
  }
  return poses;
}

/// A camera that is carried about: Bend() that also sways and rises.
std::vector<TrajectoryPose> Carried(int num_poses) {
  std::vector<TrajectoryPose> poses = Bend(num_poses);
  for (int i = 0; i < num_poses; ++i) {
    TrajectoryPose& pose = poses[static_cast<std::size_t>(i)];
    pose.rotation *= Rotation(0.3 * std::sin(0.25 * i), Eigen::Vector3d::UnitX());
    pose.position_m += Eigen::Vector3d(0.5 * std::sin(0.3 * i), std::cos(0.2 * i), 0);
  }
  return poses;
}

TEST(AxesTest, NamesAreReadBack) {
  const std::vector<GroundTruthAxes> all = GroundTruthAxes::All();
  ASSERT_EQ(all.size(), 48u);
  EXPECT_EQ(all[1].Name(), "NED");
  int num_right_handed = 0;
  for (const GroundTruthAxes& axes : all) {
    EXPECT_EQ(GroundTruthAxes::Parse(axes.Name()), axes) << axes.Name();
    EXPECT_EQ(std::count(all.begin(), all.end(), axes), 1);
    num_right_handed += axes.is_right_handed() ? 1 : 0;
  }
  EXPECT_EQ(num_right_handed, 24);
  EXPECT_EQ(GroundTruthAxes::Parse("+Y,z,x"), GroundTruthAxes::Ned());
  for (const char* const wrong : {"", "x", "x,y", "x,y,x", "x,y,w", "x,y,z,z", "east"}) {
    EXPECT_EQ(GroundTruthAxes::Parse(wrong), std::nullopt) << wrong;
  }
}

TEST(AxesTest, DetectsEachOfAll) {
  const std::vector<TrajectoryPose> truth = Carried(60);
  const std::vector<TrajectoryPose> estimate = InOtherWorld(truth, 1);
  for (const GroundTruthAxes& axes : GroundTruthAxes::All()) {
    const AxesDecision decision = DetectAxes({estimate, InAxes(truth, axes)});
    EXPECT_TRUE(decision.is_known);
    EXPECT_EQ(decision.axes, axes) << decision.Explain();
    EXPECT_TRUE(decision.alternatives.empty());
    EXPECT_NEAR(decision.agreement, 1, 1e-9);
  }
}

TEST(AxesTest, ALeftHandedFileIsMirroredBack) {
  // As an engine with x forward, y right, z up writes it.
  const GroundTruthAxes left_handed = *GroundTruthAxes::Parse("y,-z,x");
  EXPECT_FALSE(left_handed.is_right_handed());
  const Trajectory estimate = {true, InOtherWorld(Carried(50), 1)};
  const Trajectory truth = {true, InAxes(Carried(50), left_handed)};
  const TrajectoryReport report = EvaluateTrajectory(estimate, truth, {});
  EXPECT_EQ(report.axes, left_handed);
  EXPECT_LT(report.ate_se3_m.max, 1e-9);
  EXPECT_LT(report.rpe_rotation_per_frame_deg.max, 1e-6);
  EXPECT_EQ(ToJson(report)["ground_truth_right_handed"], false);
}

TEST(AxesTest, OnAPlaneTheMirrorImageIsNamedAsWell) {
  std::vector<TrajectoryPose> flat;  // turns and drives on level ground
  for (TrajectoryPose pose : Bend(60)) {
    pose.rotation = Rotation(0.3 * pose.time_s, Eigen::Vector3d::UnitY());
    pose.position_m.y() = 0;
    flat.push_back(pose);
  }
  const GroundTruthAxes mirrored = *GroundTruthAxes::Parse("y,-z,x");
  const AxesDecision decision = DetectAxes({InOtherWorld(flat, 1), InAxes(flat, mirrored)});
  EXPECT_TRUE(decision.is_known);
  EXPECT_EQ(decision.axes, GroundTruthAxes::Ned());  // of the two, the usual one
  EXPECT_EQ(decision.alternatives, std::vector<GroundTruthAxes>{mirrored});
  const TrajectoryReport report =
      EvaluateTrajectory({true, InOtherWorld(flat, 1)}, {true, InAxes(flat, mirrored)}, {});
  ASSERT_EQ(report.alternatives.size(), 1u);
  EXPECT_LT(report.alternatives[0].ate_se3_m.max, 1e-9);
  EXPECT_NE(ToTable(report).find("AMBIGUOUS: the motion fits axes y,-z,x (left-handed)"),
            std::string::npos);
}

TEST(AxesTest, RefusesWhatDoesNotFit) {
  std::vector<TrajectoryPose> skewed = Carried(60);  // half-way between two conventions
  for (TrajectoryPose& pose : skewed) pose.rotation *= Rotation(M_PI / 3, {1, 1, 1});
  const AxesDecision decision = DetectAxes({Carried(60), skewed});
  EXPECT_FALSE(decision.is_known) << decision.Explain();
}

TEST(AxesTest, ADriveStraightAheadIsToldByItsDisplacements) {
  std::vector<TrajectoryPose> straight(20);
  std::vector<TrajectoryPose> ned;
  for (std::size_t i = 0; i < straight.size(); ++i) {
    straight[i].position_m = {0, 0, 0.5 * static_cast<double>(i)};
    ned.push_back(InNed(straight[i]));
  }
  const AxesDecision decision = DetectAxes({straight, ned});
  EXPECT_TRUE(decision.is_known);
  EXPECT_FALSE(decision.uses_rotation);
  EXPECT_EQ(decision.axes, GroundTruthAxes::Ned());
  EXPECT_EQ(decision.alternatives.size(), 7u);  // turned about the way, or mirrored
  std::vector<TrajectoryPose> still(20);
  EXPECT_FALSE(DetectAxes({still, still}).is_known);
}

TEST(EvaluateTrajectoryTest, TheSamePathInNedHasNoError) {
  Trajectory truth = {true, Bend(50)};
  const Trajectory estimate = {true, InOtherWorld(truth.poses, 1)};
  for (TrajectoryPose& pose : truth.poses) pose = InNed(pose);
  EvaluationOptions options;
  options.num_frames = 100;
  const TrajectoryReport report = EvaluateTrajectory(estimate, truth, options);
  EXPECT_EQ(report.axes, GroundTruthAxes::Ned());
  EXPECT_DOUBLE_EQ(report.completeness, 0.5);
  EXPECT_LT(report.ate_se3_m.max, 1e-9);
  EXPECT_GT(report.ate_none_m.mean, 1);
  EXPECT_LT(report.rpe_rotation_per_frame_deg.max, 1e-6);
  EXPECT_LT(report.rpe_translation_per_metre_m.max, 1e-9);
  EXPECT_NEAR(report.path_m, 24.5, 1e-9);

  options.axes = GroundTruthAxes::Optical();  // a wrong statement shows in the rotations
  EXPECT_GT(EvaluateTrajectory(estimate, truth, options).rpe_rotation_per_frame_deg.mean, 1);

  const nlohmann::json json = ToJson(report);
  EXPECT_EQ(json.at("ground_truth_axes"), "NED");
  EXPECT_EQ(json.at("rpe_rotation_per_frame_deg").at("count"), 49);
  EXPECT_NE(ToTable(report).find("50.0 % complete"), std::string::npos);
}

TEST(EvaluateTrajectoryTest, RefusesWhatCannotBeCompared) {
  const Trajectory truth = {true, Bend(50)};
  Trajectory late = truth;
  for (TrajectoryPose& pose : late.poses) pose.time_s += 100;
  EXPECT_NE(ErrorOf([&] { EvaluateTrajectory(late, truth, {}); }).find("only 0 of 50"),
            std::string::npos);
  Trajectory still = truth;
  for (TrajectoryPose& pose : still.poses) pose = At(pose.time_s);
  EXPECT_NE(ErrorOf([&] { EvaluateTrajectory(still, truth, {}); }).find("--gt-axes"),
            std::string::npos);
}

class TrajectoryFileTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() /
             ("airdos_evaluation_test_" + std::to_string(getpid())))
                .string();
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string MessageFor(const std::string& text) const {
    std::ofstream(path_) << text;
    return ErrorOf([&] { ReadTrajectory(path_); });
  }
  std::string path_;
};

TEST_F(TrajectoryFileTest, ReadsBothFormats) {
  std::ofstream(path_) << "# t x y z qx qy qz qw\n1.5 1 2 3 0 0 0.6 0.8\n";
  const Trajectory tum = ReadTrajectory(path_);
  EXPECT_TRUE(tum.has_times);
  EXPECT_EQ(tum.poses[0].time_s, 1.5);
  EXPECT_NEAR(tum.poses[0].rotation(1, 0), 0.96, 1e-12);
  std::ofstream(path_) << "0 -1 0 5 1 0 0 6 0 0 1 7\n1 0 0 5 0 1 0 6 0 0 1 8\n";
  const Trajectory kitti = ReadTrajectory(path_);
  EXPECT_FALSE(kitti.has_times);
  EXPECT_EQ(kitti.poses[1].position_m, Eigen::Vector3d(5, 6, 8));
  EXPECT_EQ(kitti.poses[0].rotation(0, 1), -1);
  EXPECT_EQ(kitti.poses[1].time_s, 1);
}

TEST_F(TrajectoryFileTest, NamesTheLine) {
  EXPECT_EQ(MessageFor(""), path_ + ": contains no pose");
  EXPECT_EQ(
      MessageFor("1 2 3\n"),
      path_ +
          ":1: holds 3 numbers per row: expected are 8 (t x y z qx qy qz qw, TUM), 12 (KITTI), "
          "17 (EuRoC's state_groundtruth), 7 (x y z qx qy qz qw, TartanAir) or 4 (t x y z)");
  EXPECT_EQ(MessageFor("1 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 x\n"),
            path_ + ":2: 'x' is not a finite number");
  EXPECT_EQ(MessageFor("2 1 2 3 0 0 0 1\n1 1 2 3 0 0 0 1\n"),
            path_ +
                ":2: time 1 is before that of the row above; sort the rows by time (sort -g), "
                "without duplicates");
  EXPECT_EQ(MessageFor("2 1 2 3 0 0 0 2\n"),
            path_ +
                ":1: the quaternion is not of length 1 but 2.000000; the columns are not those "
                "of TUM (t x y z qx qy qz qw)?");
}

TEST(ChartTest, TicksAreRound) {
  EXPECT_EQ(RoundTicks(0, 10, 5), (std::vector<double>{0, 2, 4, 6, 8, 10}));
  EXPECT_EQ(RoundTicks(-0.7, 0.7, 3), (std::vector<double>{-0.5, 0, 0.5}));
  EXPECT_EQ(RoundTicks(3, 3, 5).size(), 1u);
}

TEST(PlotTest, ShowsBothTrajectoriesEvenOfOneThatStandsStill) {
  const Trajectory truth = {true, Bend(50)};
  Trajectory estimate = {true, InOtherWorld(truth.poses, 1)};
  for (TrajectoryPose& pose : estimate.poses) pose.position_m.x() += 0.02 * std::sin(pose.time_s);
  const cv::Mat picture = DrawEvaluation(EvaluateTrajectory(estimate, truth, {}), "bend");
  int num_estimate = 0;
  for (int row = 0; row < picture.rows; ++row) {
    for (int column = 0; column < picture.cols / 2; ++column) {
      num_estimate += picture.at<cv::Vec3b>(row, column) == cv::Vec3b(200, 90, 0) ? 1 : 0;
    }
  }
  EXPECT_GT(num_estimate, 500);

  Trajectory still = truth;
  for (TrajectoryPose& pose : still.poses) pose.position_m.setZero();
  EvaluationOptions options;
  options.axes = GroundTruthAxes::Optical();
  EXPECT_FALSE(DrawEvaluation(EvaluateTrajectory(still, still, options), "still").empty());
}

}  // namespace
}  // namespace airdos
