// Trajectories as files have them, and the figures of them: numbers that all differ.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include "common/evaluation/alignment.h"
#include "common/evaluation/statistics.h"
#include "common/evaluation/trajectory_doubts.h"
#include "common/evaluation/trajectory_error.h"
#include "common/evaluation/trajectory_file.h"
#include "common/evaluation/trajectory_report.h"
#include "common/evaluation/trajectory_times.h"
#include "common/util/error.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

using Eigen::Vector3d;

class TrajectoryValuesTest : public ::testing::Test {
 protected:
  Trajectory Read(const std::string& text) { return ReadTrajectory(folder_.Write("t.txt", text)); }
  std::string ReadError(const std::string& text) {
    return ErrorOf([&] { Read(text); });
  }
  ScratchFolder folder_{"trajectory_values"};
};

/// At (1, 2, 3), turned about z: half the angle has the sine 0.6, so the angle has 0.96.
void ExpectThePose(const TrajectoryPose& pose) {
  EXPECT_LT((pose.position_m - Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_LT((pose.rotation * Vector3d::UnitX() - Vector3d(0.28, 0.96, 0)).norm(), 1e-9);
}

TEST_F(TrajectoryValuesTest, EachFormOfRows) {
  const std::string euroc_rest = " 0.1 0.2 0.3 0.4 0.5 0.6 0.7 0.8 0.9\n";
  const struct {
    std::string text;
    double time_s;
    QuaternionOrder order;
  } forms[] = {
      {"5.5 1 2 3 0 0 0.6 0.8\n", 5.5, QuaternionOrder::kXyzw},
      {"1 2 3 0 0 0.6 0.8\n", 0, QuaternionOrder::kXyzw},
      {"1400000000500000000 1 2 3 0.8 0 0 0.6" + euroc_rest, 1400000000.5, QuaternionOrder::kWxyz},
      {"1400000000500000000,1,2,3,0.8,0,0,0.6\n", 1400000000.5, QuaternionOrder::kWxyz},
      {"1400000000500000000 1 2 3 0 0 0.6 0.8\n", 1400000000.5, QuaternionOrder::kXyzw},
      {"# q_w q_z q_y q_x p_z p_y p_x time\n0.8 0.6 0 0 3 2 1 5.5\n", 5.5, QuaternionOrder::kWxyz},
      {"0.28 -0.96 0 1 0.96 0.28 0 2 0 0 1 3\n", 0, QuaternionOrder::kNone},
      {"0.28 -0.96 0 1 0.96 0.28 0 2 0 0 1 3 0 0 0 1\n", 0, QuaternionOrder::kNone},
  };
  for (const auto& form : forms) {
    const Trajectory trajectory = Read(form.text);
    ASSERT_EQ(trajectory.poses.size(), 1u) << form.text;
    ExpectThePose(trajectory.poses[0]);
    EXPECT_NEAR(trajectory.poses[0].time_s, form.time_s, 1e-6) << form.text;
    EXPECT_EQ(trajectory.order, form.order) << form.text;
    EXPECT_TRUE(trajectory.has_rotations);
  }
}

TEST_F(TrajectoryValuesTest, AHeadingNamesTheColumns) {
  const Trajectory positions = Read("t,z,y,x\n5.5,3,2,1\n");
  EXPECT_LT((positions.poses[0].position_m - Vector3d(1, 2, 3)).norm(), 1e-12);
  EXPECT_FALSE(positions.has_rotations);
  const Trajectory stamped = Read(
      "%time,field.header.stamp,field.pose.position.x,field.pose.position.y,"
      "field.pose.position.z\n100.5,200.5,1,2,3\n");
  EXPECT_EQ(stamped.poses[0].time_s, 200.5);
}

TEST_F(TrajectoryValuesTest, ANumberBeforeAMatrixIsSaid) {
  EXPECT_TRUE(Holds(ReadError("5 1 0 0 1 0 1 0 2 0 0 1 3 0 0 0 1\n"), "before a matrix"));
  EXPECT_TRUE(Holds(ReadError("5 1 0 0 1 0 1 0 2 0 0 1 3\n"), "before a matrix"));
}

TEST_F(TrajectoryValuesTest, AQuaternionIsNearlyOfLengthOne) {
  EXPECT_TRUE(Holds(ReadError("0 1 2 3 0 0 0.528 0.704\n"), "not of length 1"));  // 0.88
  EXPECT_TRUE(Holds(ReadError("0 1 2 3 0 0 0.672 0.896\n"), "not of length 1"));  // 1.12
  for (const char* text : {"0 1 2 3 0 0 0.552 0.736\n", "0 1 2 3 0 0 0.648 0.864\n"}) {
    const Trajectory trajectory = Read(text);  // 0.92 and 1.08
    ExpectThePose(trajectory.poses[0]);
    ASSERT_EQ(trajectory.remarks.size(), 1u);
    EXPECT_TRUE(trajectory.remarks[0].is_warning);
  }
  EXPECT_TRUE(Read("0 1 2 3 0 0 0.603 0.804\n").remarks.empty());  // 1.005
}

std::string Along(const std::vector<double>& places) {
  std::string text;
  for (std::size_t i = 0; i < places.size(); ++i) {
    text += std::to_string(0.1 * static_cast<double>(i)) + " " + std::to_string(places[i]) +
            " 0 0 0 0 0 1\n";
  }
  return text;
}

TEST_F(TrajectoryValuesTest, RowsAtTheOriginAreLostBeyondAJump) {
  const auto num_lost = [&](const std::vector<double>& places) {
    const Trajectory trajectory = Read(Along(places));
    EXPECT_EQ(trajectory.num_rows(), places.size());
    EXPECT_EQ(trajectory.poses.size() + trajectory.num_lost_rows, places.size());
    return trajectory.num_lost_rows;
  };
  EXPECT_EQ(num_lost({0, 0, 5, 6, 7, 8}), 0u);      // a start: five steps are no jump
  EXPECT_EQ(num_lost({0, 0, 11, 12, 13, 14}), 1u);  // the first row stays
  EXPECT_EQ(num_lost({5, 6, 0, 0, 9, 10}), 2u);
  EXPECT_EQ(num_lost({1, 2, 3, 0, 3, 2}), 0u);  // three steps
  EXPECT_EQ(num_lost({1, 2, 3, 4, 0, 0}), 2u);
}

TEST_F(TrajectoryValuesTest, ATenthOfRotationsMakesPoses) {
  const auto rows = [](int num_with, int num) {
    std::string text;
    for (int i = 0; i < num; ++i) {
      text += std::to_string(0.1 * i) + " " + std::to_string(1 + i) + " 2 3 " +
              (i < num_with ? "0 0 0.6 0.8\n" : "nan nan nan nan\n");
    }
    return text;
  };
  const Trajectory poses = Read(rows(2, 20));
  EXPECT_TRUE(poses.has_rotations);
  EXPECT_EQ(poses.poses.size(), 2u);
  EXPECT_EQ(poses.num_lost_rows, 18u);
  const Trajectory positions = Read(rows(2, 21));
  EXPECT_FALSE(positions.has_rotations);
  EXPECT_EQ(positions.poses.size(), 21u);
}

TEST_F(TrajectoryValuesTest, TimesOfRowsGrow) {
  std::string rows;
  std::string times;
  for (int i = 0; i < 20; ++i) {
    rows += "1 0 0 " + std::to_string(i) + " 0 1 0 0 0 0 1 0\n";
    times += std::to_string(0.5 + 0.1 * i) + "\n";
  }
  Trajectory trajectory = Read(rows);
  EXPECT_FALSE(trajectory.has_times);
  SetTimes(folder_.Write("times.txt", times), &trajectory);
  EXPECT_NEAR(trajectory.poses[19].time_s, 2.4, 1e-9);
  EXPECT_TRUE(trajectory.has_times);
  Trajectory other = Read(rows);
  const std::string twice = folder_.Write("times.txt", times.replace(times.find("0.6"), 3, "0.5"));
  EXPECT_TRUE(Holds(ErrorOf([&] { SetTimes(twice, &other); }), "times.txt:2: must hold one time"));
}

Trajectory At(const std::vector<double>& times_s) {
  Trajectory trajectory;
  trajectory.has_times = true;
  for (const double time_s : times_s) {
    trajectory.poses.emplace_back();
    trajectory.poses.back().time_s = time_s;
    trajectory.poses.back().position_m = {time_s, 0, 0};
  }
  return trajectory;
}

TEST(AssociateValuesTest, TheEarlierOfTwoAndTheLimitItself) {
  const MatchedTrajectories matched = Associate(At({0.5}), At({0, 1}), 0.5);
  ASSERT_EQ(matched.ground_truth.size(), 1u);
  EXPECT_EQ(matched.ground_truth[0].time_s, 0);
  EXPECT_EQ(matched.estimate[0].time_s, 0.5);
  EXPECT_TRUE(Associate(At({0.5}), At({0, 1}), 0.49).estimate.empty());
}

TEST(MatchPosesValuesTest, HalfOfTheShorterIsEnough) {
  Remarks remarks;
  MatchPoses(At({0, 0.1, 0.2, 0.3}), At({0, 0.1, 5, 6}), 0.01, &remarks);
  EXPECT_TRUE(remarks.empty());
  MatchPoses(At({0, 0.1, 0.2, 0.3, 0.4}), At({0, 0.1, 5, 6, 7}), 0.01, &remarks);
  EXPECT_EQ(remarks.size(), 1u);
  EXPECT_THROW(MatchPoses(At({0, 0.1}), At({0, 5}), 0.01, &remarks), InputError);
}

TrajectoryPose Pose(double angle_deg, const Vector3d& axis, const Vector3d& position_m) {
  TrajectoryPose pose;
  pose.rotation = Eigen::AngleAxisd(angle_deg * M_PI / 180, axis).toRotationMatrix();
  pose.position_m = position_m;
  return pose;
}

// A quarter turn about z makes y of x.
TEST(TrajectoryPoseValuesTest, MotionsAreInBodyAxes) {
  const TrajectoryPose a = Pose(90, Vector3d::UnitZ(), {1, 2, 3});
  TrajectoryPose b = Pose(90, Vector3d::UnitX(), {1, 5, 7});
  b.time_s = 0.25;
  const TrajectoryPose motion = RelativePose(a, b);
  EXPECT_LT((motion.position_m - Vector3d(3, 0, 4)).norm(), 1e-12);
  EXPECT_EQ(motion.time_s, 0.25);
  EXPECT_LT((motion.rotation * Vector3d::UnitY() - Vector3d(0, 0, 1)).norm(), 1e-12);
  EXPECT_LT((Inverse(a).position_m - Vector3d(-2, 1, -3)).norm(), 1e-12);
  EXPECT_LT((Inverse(a).rotation * Vector3d::UnitY() - Vector3d(1, 0, 0)).norm(), 1e-12);
}

TEST(AlignmentValuesTest, ScaleTurnAndShift) {
  MatchedTrajectories matched;
  for (const Vector3d& p :
       {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0, 3, 0), Vector3d(2, 1, 5)}) {
    matched.estimate.push_back(Pose(0, Vector3d::UnitX(), p));
    matched.ground_truth.push_back(
        Pose(0, Vector3d::UnitX(), {-2 * p.y() + 1, 2 * p.x() + 2, 2 * p.z() + 3}));
  }
  const Similarity sim3 = ComputeAlignment(matched, Alignment::kSim3);
  EXPECT_NEAR(sim3.scale, 2, 1e-9);
  EXPECT_LT((sim3.translation_m - Vector3d(1, 2, 3)).norm(), 1e-9);
  const std::vector<TrajectoryPose> moved = Apply(sim3, matched.estimate);
  EXPECT_LT((moved[3].position_m - Vector3d(-1, 6, 13)).norm(), 1e-9);
  EXPECT_LT((moved[3].rotation * Vector3d::UnitX() - Vector3d::UnitY()).norm(), 1e-9);
  EXPECT_EQ(ComputeAlignment(matched, Alignment::kSe3).scale, 1);
}

/// Along x, both the same, but for turns of the estimate about z.
MatchedTrajectories Line(const std::vector<double>& places_m,
                         const std::vector<double>& turns_deg) {
  MatchedTrajectories matched;
  for (std::size_t i = 0; i < places_m.size(); ++i) {
    matched.ground_truth.push_back(Pose(0, Vector3d::UnitZ(), {places_m[i], 0, 0}));
    matched.estimate.push_back(Pose(turns_deg[i], Vector3d::UnitZ(), {places_m[i], 0, 0}));
  }
  return matched;
}

TEST(TrajectoryErrorValuesTest, PathsAndLostFrames) {
  const MatchedTrajectories matched = Line({0, 0.01, 0.03, 0.06}, {0, 1.9, 4, 4});
  const std::vector<RelativeError> errors = ErrorsPerFrame(matched);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_NEAR(errors[0].path_m, 0.01, 1e-12);
  EXPECT_NEAR(errors[2].path_m, 0.03, 1e-12);
  EXPECT_NEAR(errors[0].rotation_deg, 1.9, 1e-6);
  EXPECT_NEAR(errors[1].rotation_deg, 2.1, 1e-6);
  EXPECT_EQ(CountLostFrames(matched, 4), 1u);
  EXPECT_EQ(CountLostFrames(matched, 7), 4u);
  MatchedTrajectories moved = Line({0, 0, 0}, {0, 0, 0});
  moved.estimate[1].position_m.y() = 0.099;
  moved.estimate[2].position_m.y() = 0.099 + 0.101;
  EXPECT_EQ(CountLostFrames(moved, 3), 1u);
}

TEST(TrajectoryErrorValuesTest, SegmentsStartAtEachPose) {
  const std::vector<RelativeError> errors =
      ErrorsOverLength(Line({0, 1, 2, 3.5, 4.5}, {0, 1, 3, 6, 10}), 2);
  ASSERT_EQ(errors.size(), 3u);
  EXPECT_NEAR(errors[0].path_m, 2, 1e-12);    // 0 to 2
  EXPECT_NEAR(errors[1].path_m, 2.5, 1e-12);  // 1 to 3
  EXPECT_NEAR(errors[2].path_m, 2.5, 1e-12);  // 2 to 4
  EXPECT_NEAR(errors[0].rotation_deg, 3, 1e-6);
  EXPECT_NEAR(errors[1].rotation_deg, 5, 1e-6);
  EXPECT_NEAR(errors[2].rotation_deg, 7, 1e-6);
}

TEST(StatisticsValuesTest, OfFourAndFive) {
  const Statistics four = ComputeStatistics({6, 1, 3, 2});
  EXPECT_DOUBLE_EQ(four.mean, 3);
  EXPECT_DOUBLE_EQ(four.median, 2.5);
  EXPECT_DOUBLE_EQ(four.std, std::sqrt(14 / 4.0));
  EXPECT_DOUBLE_EQ(four.rmse, std::sqrt(50 / 4.0));
  EXPECT_DOUBLE_EQ(four.max, 6);
  EXPECT_EQ(four.count, 4u);
  EXPECT_DOUBLE_EQ(ComputeStatistics({6, 1, 3, 2, 9}).median, 3);
}

// The numbers of one turn as they stand in a file, read in the wrong order and then in the other.
TEST(ReadAsValuesTest, TheSameFourNumbersInTheOtherOrder) {
  const Eigen::Vector4d n = Eigen::Vector4d(0.1, 0.2, 0.3, 0.9).normalized();
  const Eigen::Quaterniond as_xyzw(n[3], n[0], n[1], n[2]);
  const Eigen::Quaterniond as_wxyz(n[0], n[1], n[2], n[3]);
  MatchedTrajectories matched;
  matched.estimate.resize(1);
  matched.ground_truth.resize(1);
  matched.estimate[0].rotation = as_xyzw.toRotationMatrix();
  matched.ground_truth[0].rotation = as_wxyz.toRotationMatrix();
  PoseReading reading;
  reading.has_other_order_in_estimate = true;
  reading.has_other_order_in_truth = true;
  const MatchedTrajectories other =
      ReadAs(reading, QuaternionOrder::kXyzw, QuaternionOrder::kWxyz, matched);
  EXPECT_LT((other.estimate[0].rotation - as_wxyz.toRotationMatrix()).norm(), 1e-9);
  EXPECT_LT((other.ground_truth[0].rotation - as_xyzw.toRotationMatrix()).norm(), 1e-9);
}

TEST(FrozenPosesValuesTest, CountWhereTheTruthMoves) {
  MatchedTrajectories matched = Line({0, 1, 1, 2}, {0, 0, 0, 0});
  EXPECT_EQ(CountFrozenPoses(matched), 0u);
  matched.estimate[3].position_m = matched.estimate[2].position_m;
  EXPECT_EQ(CountFrozenPoses(matched), 1u);
  matched.ground_truth[3] = matched.ground_truth[2];
  matched.ground_truth[3].position_m.x() += 0.0009;
  EXPECT_EQ(CountFrozenPoses(matched), 0u);
  matched.ground_truth[3].rotation = Pose(0.06, Vector3d::UnitY(), Vector3d::Zero()).rotation;
  EXPECT_EQ(CountFrozenPoses(matched), 1u);
}

TEST(TrajectoryTimesValuesTest, ATenthMayRepeat) {
  const auto remarks_of = [](int num_rows) {
    std::vector<FileTime> times;
    for (int i = 0; i < num_rows; ++i) times.push_back({0.1 * (i == 4 ? 3 : i), i + 1});
    Remarks remarks;
    TimesInSeconds("t", times, &remarks);
    return remarks;
  };
  EXPECT_THROW(remarks_of(9), InputError);
  ASSERT_EQ(remarks_of(10).size(), 1u);
  EXPECT_TRUE(remarks_of(10)[0].is_warning);
  EXPECT_FALSE(remarks_of(201)[0].is_warning);  // below half a per cent
}

TEST(TrajectoryTimesValuesTest, MissingFramesOfASlowerEstimateCount) {
  std::vector<double> truth_s;
  for (int i = 0; i < 100; ++i) truth_s.push_back(0.01 * i);
  EXPECT_EQ(FramesOfSlowerEstimate(At({0, 0.1, 0.2, 0.5, 0.6}), At(truth_s)), 7u);
  EXPECT_EQ(FramesOfSlowerEstimate(At({0, 0.013, 0.026, 0.039}), At(truth_s)), 0u);
}

// Both turn, the estimate by 1.5 deg more in each step of 2 m.
TEST(TrajectoryReportValuesTest, ErrorsPerMetreAreDividedByThePath) {
  Trajectory truth = At({0, 0.1, 0.2, 0.3, 0.4, 0.5});
  Trajectory estimate = truth;
  for (std::size_t i = 0; i < 6; ++i) {
    const auto step = static_cast<double>(i);
    truth.poses[i] = Pose(10 * step, Vector3d::UnitY(), {2 * step, 0, 0});
    estimate.poses[i] = Pose(11.5 * step, Vector3d::UnitY(), {2 * step, 0, 0});
    truth.poses[i].time_s = estimate.poses[i].time_s = 0.1 * step;
  }
  EvaluationOptions options;
  options.axes = GroundTruthAxes::Optical();
  const TrajectoryReport report = EvaluateTrajectory(estimate, truth, options);
  EXPECT_EQ(report.no_rotations_because, "");
  EXPECT_NEAR(report.rpe_rotation_per_frame_deg.mean, 1.5, 1e-6);
  EXPECT_NEAR(report.rpe_rotation_per_metre_deg.mean, 0.75, 1e-6);
  EXPECT_NEAR(report.path_m, 10, 1e-9);
  EXPECT_NEAR(report.duration_s, 0.5, 1e-9);
  EXPECT_EQ(report.num_matched, 6u);
  // Seen from a body that is turned by 1.5 deg a step more, 2 m go astray by 5 cm more each step.
  EXPECT_EQ(report.num_lost, 3u);
}

}  // namespace
}  // namespace airdos
