// Files as users hand them to airdos-evaluate: read rightly, or named with the remedy.
#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>
#include <string>
#include <vector>

#include "common/evaluation/trajectory_plot.h"
#include "common/evaluation/trajectory_report.h"
#include "common/util/error.h"
#include "tests/support/input_errors.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kStart = 1.4e9;  // s since 1970

/// A carried camera in optical axes at 10 Hz, away from the origin; it turns about all axes.
TrajectoryPose PoseAt(double time_s) {
  const auto turn = [](double angle_rad, const Eigen::Vector3d& axis) {
    return Eigen::AngleAxisd(angle_rad, axis).toRotationMatrix();
  };
  TrajectoryPose pose;
  pose.time_s = time_s;
  pose.rotation = turn(0.4 * time_s, Eigen::Vector3d::UnitY()) *
                  turn(0.3 * std::sin(2.5 * time_s), Eigen::Vector3d::UnitX()) *
                  turn(0.2 * std::sin(1.7 * time_s), Eigen::Vector3d::UnitZ());
  pose.position_m = {8 + 4 * std::sin(0.4 * time_s), 3 + 0.5 * std::cos(2 * time_s),
                     -6 - 4 * std::cos(0.4 * time_s)};
  return pose;
}

std::vector<TrajectoryPose> Walk(int num_poses, double interval_s = 0.1) {
  std::vector<TrajectoryPose> poses;
  for (int i = 0; i < num_poses; ++i) poses.push_back(PoseAt(interval_s * i));
  return poses;
}

/// The same as an estimator finds it: in the world of its first pose, some mm off.
std::vector<TrajectoryPose> Estimated(std::vector<TrajectoryPose> poses) {
  const TrajectoryPose T_C0_W = Inverse(poses[0]);
  for (TrajectoryPose& pose : poses) {
    const Eigen::Vector3d off_m(0.004 * std::sin(3 * pose.time_s),
                                0.004 * std::cos(4 * pose.time_s), 0.003);
    pose.position_m = T_C0_W.rotation * (pose.position_m + off_m) + T_C0_W.position_m;
    pose.rotation = T_C0_W.rotation * pose.rotation;
  }
  return poses;
}

constexpr double kExpectedAteM = 0.005;  // the estimate is off by less

/// How a file is written.
struct Style {
  std::string separator = " ";
  std::string line_end = "\n";
  std::string heading;
  int decimals = 6;
  double unit_s = 1;
  double start_s = kStart;
  bool has_w_first = false;
  bool has_rotations = true;
};

std::string Number(double value, int decimals) {
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  return text;
}

std::string Join(const std::vector<std::string>& fields, const Style& style) {
  std::string row;
  for (const std::string& field : fields) row += (row.empty() ? "" : style.separator) + field;
  return row + style.line_end;
}

std::string TimeText(double time_s, const Style& style) {
  if (style.unit_s == 1) return Number(style.start_s + time_s, style.decimals);
  return std::to_string(std::llround(style.start_s) * std::llround(1 / style.unit_s) +
                        std::llround(time_s / style.unit_s));
}

std::string TumRow(const TrajectoryPose& pose, const Style& style) {
  std::vector<std::string> fields = {TimeText(pose.time_s, style)};
  for (int i = 0; i < 3; ++i) fields.push_back(Number(pose.position_m[i], 9));
  const Eigen::Quaterniond q(pose.rotation);
  const std::vector<double> numbers = style.has_w_first
                                          ? std::vector<double>{q.w(), q.x(), q.y(), q.z()}
                                          : std::vector<double>{q.x(), q.y(), q.z(), q.w()};
  for (const double number : numbers) {
    if (style.has_rotations) fields.push_back(Number(number, 9));
  }
  return Join(fields, style);
}

std::string Tum(const std::vector<TrajectoryPose>& poses, const Style& style = {}) {
  std::string text = style.heading;
  for (const TrajectoryPose& pose : poses) text += TumRow(pose, style);
  return text;
}

std::string Kitti(const std::vector<TrajectoryPose>& poses) {
  std::string text;
  for (const TrajectoryPose& pose : poses) {
    std::vector<std::string> fields;
    for (int row = 0; row < 3; ++row) {
      for (int column = 0; column < 3; ++column) {
        fields.push_back(Number(pose.rotation(row, column), 9));
      }
      fields.push_back(Number(pose.position_m[row], 9));
    }
    text += Join(fields, {});
  }
  return text;
}

class UserCases : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_evaluator_cases_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Write(const std::string& name, const std::string& text) const {
    const std::string path = (folder_ / name).string();
    std::ofstream(path, std::ios::binary) << text;
    return path;
  }
  TrajectoryReport Evaluate(const std::string& estimate, const std::string& truth,
                            const EvaluationOptions& options = {}) const {
    const Trajectory estimated = ReadTrajectory(Write("estimate.txt", estimate));
    return EvaluateTrajectory(estimated, ReadTrajectory(Write("truth.txt", truth)), options);
  }
  std::string ErrorOf(const std::string& estimate, const std::string& truth,
                      const EvaluationOptions& options = {}) const {
    try {
      Evaluate(estimate, truth, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  }

  fs::path folder_;
};

/// Whether the table says so in a line of its end, and the JSON as well.
bool Says(const TrajectoryReport& report, const std::string& kind, const std::string& part) {
  std::istringstream table(ToTable(report));
  bool is_in_table = false;
  for (std::string line; std::getline(table, line);) {
    if (line.rfind(kind + ": ", 0) == 0 && Holds(line, part)) is_in_table = true;
  }
  return is_in_table && Holds(ToJson(report).at("remarks").dump(), part);
}

void ExpectAsGood(const TrajectoryReport& report) {
  EXPECT_GT(report.ate_se3_m.rmse, 0);
  EXPECT_LT(report.ate_se3_m.rmse, kExpectedAteM);
  EXPECT_EQ(report.axes, GroundTruthAxes::Optical());
  EXPECT_LT(report.rpe_rotation_per_frame_deg.max, 0.01);
  EXPECT_DOUBLE_EQ(report.completeness, 1);
}

TEST_F(UserCases, PlainFilesHaveNoRemarks) {
  const TrajectoryReport report = Evaluate(Tum(Estimated(Walk(100))), Tum(Walk(100)));
  ExpectAsGood(report);
  EXPECT_TRUE(report.remarks.empty()) << report.remarks[0].text;
}

TEST_F(UserCases, Case01TimesOfWholeSecondsRepeat) {
  Style whole_s;
  whole_s.decimals = 0;
  const std::string estimate = Tum(Estimated(Walk(100)), whole_s);
  EvaluationOptions options;
  options.axes = GroundTruthAxes::Optical();
  for (const std::string& truth : {Tum(Walk(100), whole_s), Tum(Walk(100))}) {
    const std::string error = ErrorOf(estimate, truth, options);
    EXPECT_TRUE(Holds(error, "estimate.txt:2: times repeat: 89 of 100 rows")) << error;
    EXPECT_TRUE(Holds(error, "too few digits")) << error;
  }
  EXPECT_TRUE(
      Holds(ErrorOf(Tum(Estimated(Walk(100))), Tum(Walk(100), whole_s)), "truth.txt:2: times"));
}

TEST_F(UserCases, Case01bSingleRepetitionsAreAWarning) {
  std::vector<TrajectoryPose> twice = Walk(100);
  twice.insert(twice.begin() + 50, twice[50]);
  const TrajectoryReport report = Evaluate(Tum(Estimated(Walk(100))), Tum(twice));
  EXPECT_TRUE(Says(report, "WARNING", "truth.txt:52: times repeat: 1 of 101 rows"));
}

TEST_F(UserCases, Case03DefaultPrecisionInTheEstimateOnly) {
  std::string estimate;
  for (const TrajectoryPose& pose : Estimated(Walk(100))) {
    const std::string row = TumRow(pose, {});
    estimate += "1.4e+09" + row.substr(row.find(' '));
  }
  EXPECT_TRUE(Holds(ErrorOf(estimate, Tum(Walk(100))), "times repeat: 99 of 100 rows"));
}

TEST_F(UserCases, Case03bNoMatchNamesBothRangesAndTheLikelyCause) {
  const std::string truth = Tum(Walk(100));
  Style from_zero;
  from_zero.start_s = 0;
  std::string error = ErrorOf(Tum(Estimated(Walk(100)), from_zero), truth);
  EXPECT_TRUE(Holds(error, "only 0 of 100 estimated poses match")) << error;
  EXPECT_TRUE(Holds(error, "0.000000 to 9.900000 s")) << error;
  EXPECT_TRUE(Holds(error, "1400000000.000000 to 1400000009.900000 s")) << error;
  EXPECT_TRUE(Holds(error, "from 1970")) << error;

  Style local;
  local.start_s = kStart + 7200;
  EXPECT_TRUE(Holds(ErrorOf(Tum(Estimated(Walk(100)), local), truth), "local time"));
  Style late;
  late.start_s = kStart + 0.05;
  EXPECT_TRUE(Holds(ErrorOf(Tum(Estimated(Walk(100)), late), truth),
                    "the nearest times are 0.050000 s apart"));
}

TEST_F(UserCases, Case05KittiRowsThatLackTheFirst) {
  std::vector<TrajectoryPose> estimate = Estimated(Walk(100));
  estimate.erase(estimate.begin(), estimate.begin() + 10);
  const std::string error = ErrorOf(Kitti(estimate), Kitti(Walk(100)));
  EXPECT_TRUE(Holds(error, "has 90 rows") && Holds(error, "has 100")) << error;
  EXPECT_TRUE(Holds(error, "--times")) << error;
  // A longer estimate is no better.
  EXPECT_TRUE(Holds(ErrorOf(Kitti(Estimated(Walk(100))), Kitti(Walk(98))), "has 98"));

  std::string rows_of_nan;
  for (int i = 0; i < 10; ++i) rows_of_nan += "nan nan nan nan nan nan nan nan nan nan nan nan\n";
  const TrajectoryReport report = Evaluate(rows_of_nan + Kitti(estimate), Kitti(Walk(100)));
  EXPECT_EQ(report.num_matched, 90u);
  EXPECT_EQ(report.num_lost, 10u);
  EXPECT_LT(report.ate_se3_m.rmse, kExpectedAteM);
  EXPECT_TRUE(Says(report, "WARNING", "10 rows (this is the first) hold no pose"));
}

TEST_F(UserCases, Case06ByteOrderMarkAndLineEndsOfWindows) {
  Style windows;
  windows.line_end = "\r\n";
  ExpectAsGood(Evaluate("\xEF\xBB\xBF" + Tum(Estimated(Walk(100)), windows), Tum(Walk(100))));
}

TEST_F(UserCases, Case07Utf16IsNamed) {
  std::string utf16 = "\xFF\xFE";
  for (const char c : Tum(Estimated(Walk(5)))) utf16 += std::string{c, '\0'};
  EXPECT_TRUE(Holds(ErrorOf(utf16, Tum(Walk(100))), "UTF-16"));
}

/// EuRoC's state_groundtruth, or what a user left of it.
std::string Euroc(const std::vector<TrajectoryPose>& poses, bool has_heading, bool has_all,
                  const std::string& separator = ",") {
  Style style;
  style.separator = separator;
  style.unit_s = 1e-9;
  style.has_w_first = true;
  std::string text =
      !has_heading ? ""
                   : std::string(
                         "#timestamp, p_RS_R_x [m], p_RS_R_y [m], p_RS_R_z [m], q_RS_w "
                         "[], q_RS_x [], q_RS_y [], q_RS_z []") +
                         (has_all ? ", v_RS_R_x [m s^-1], v_RS_R_y [m s^-1], v_RS_R_z [m s^-1], "
                                    "b_w_RS_S_x [rad s^-1], b_w_RS_S_y [rad s^-1], b_w_RS_S_z "
                                    "[rad s^-1], b_a_RS_S_x [m s^-2], b_a_RS_S_y [m s^-2], "
                                    "b_a_RS_S_z [m s^-2]\n"
                                  : "\n");
  for (const TrajectoryPose& pose : poses) {
    std::string row = TumRow(pose, style);
    row.pop_back();
    for (int i = 0; has_all && i < 9; ++i) row += separator + "0.01";
    text += row + "\n";
  }
  return text;
}

TEST_F(UserCases, Case08EurocGroundTruthIsRead) {
  for (const bool has_heading : {true, false}) {
    for (const bool has_all : {true, false}) {
      const TrajectoryReport report =
          Evaluate(Tum(Estimated(Walk(100))), Euroc(Walk(100), has_heading, has_all));
      ExpectAsGood(report);
      EXPECT_TRUE(Says(report, "NOTE", "w x y z"));
      EXPECT_TRUE(Says(report, "NOTE", "the times are in ns"));
    }
  }
}

TEST_F(UserCases, Case08bOtherTablesAreReadOrNamed) {
  Style style;
  for (const char* const separator : {",", ";", "\t", ", "}) {
    style.separator = separator;
    ExpectAsGood(Evaluate(Tum(Estimated(Walk(100)), style), Tum(Walk(100))));
  }
  style.separator = ",";
  style.heading = "time,pos_x,pos_y,pos_z,quat_w,quat_x,quat_y,quat_z\n";
  style.has_w_first = true;
  ExpectAsGood(Evaluate(Tum(Estimated(Walk(100)), style), Tum(Walk(100))));

  std::string decimal_commas = Tum(Walk(100));
  for (char& c : decimal_commas) c = c == '.' ? ',' : c;
  EXPECT_TRUE(Holds(ErrorOf(decimal_commas, Tum(Walk(100))),
                    "estimate.txt:1: '1400000000,000000': "
                    "numbers have decimal commas"));
  EXPECT_TRUE(Holds(ErrorOf("{\"poses\": [1]}\n", Tum(Walk(100))), "is JSON"));
  EXPECT_TRUE(Holds(ErrorOf("1,2,3,4,5,6,7,8,9\n", Tum(Walk(100))), "holds 9 numbers per row"));
  const std::vector<TrajectoryPose> walk = Walk(100);
  EXPECT_TRUE(Holds(ErrorOf(Tum({walk.rbegin(), walk.rend()}), Tum(walk)), "backwards in time"));
}

TEST_F(UserCases, Case09EurocCutToEightColumnsOfBlanks) {
  const TrajectoryReport report =
      Evaluate(Tum(Estimated(Walk(100))), Euroc(Walk(100), false, false, " "));
  ExpectAsGood(report);
  EXPECT_TRUE(Says(report, "NOTE", "the times are in ns"));
  EXPECT_TRUE(Says(report, "WARNING", "the ground truth's quaternions as w x y z"));
}

TEST_F(UserCases, Case10QuaternionsWithWFirst) {
  Style w_first;
  w_first.has_w_first = true;
  const TrajectoryReport truth = Evaluate(Tum(Estimated(Walk(100))), Tum(Walk(100), w_first));
  ExpectAsGood(truth);
  EXPECT_TRUE(Says(truth, "WARNING", "the ground truth's quaternions as w x y z"));
  const TrajectoryReport estimate = Evaluate(Tum(Estimated(Walk(100)), w_first), Tum(Walk(100)));
  ExpectAsGood(estimate);
  EXPECT_TRUE(Says(estimate, "WARNING", "the estimate's quaternions as w x y z"));
  ExpectAsGood(Evaluate(Tum(Estimated(Walk(100)), w_first), Tum(Walk(100), w_first)));
  // A heading that is wrong is not believed against the motion.
  w_first.heading = "# timestamp tx ty tz qx qy qz qw\n";
  ExpectAsGood(Evaluate(Tum(Estimated(Walk(100))), Tum(Walk(100), w_first)));
}

TEST_F(UserCases, Case10bRotationsOfAnotherBodyAreAContradiction) {
  std::vector<TrajectoryPose> truth = Walk(100);
  for (TrajectoryPose& pose : truth) {
    pose.rotation *= Eigen::AngleAxisd(1.0, Eigen::Vector3d(1, -2, 1.5).normalized()).matrix();
  }
  const TrajectoryReport report = Evaluate(Tum(Estimated(Walk(100))), Tum(truth));
  EXPECT_LT(report.ate_se3_m.rmse, kExpectedAteM);
  EXPECT_TRUE(Says(report, "WARNING", "contradiction: the positions fit"));
}

TEST_F(UserCases, Case12TimesInOtherUnits) {
  for (const auto& [unit_s, name] :
       {std::pair<double, std::string>{1e-9, "ns"}, {1e-6, "us"}, {1e-3, "ms"}}) {
    for (const double start_s : {0.0, kStart}) {
      Style style;
      style.unit_s = unit_s;
      style.start_s = start_s;
      const TrajectoryReport both =
          Evaluate(Tum(Estimated(Walk(100)), style), Tum(Walk(100), style));
      ExpectAsGood(both);
      EXPECT_NEAR(both.duration_s, 9.9, 1e-6);
      EXPECT_TRUE(Says(both, "NOTE", "the times are in " + name)) << start_s;
      Style seconds;
      seconds.start_s = start_s;
      ExpectAsGood(Evaluate(Tum(Estimated(Walk(100)), style), Tum(Walk(100), seconds)));
    }
  }
}

TEST_F(UserCases, Case12bNumbersOfRowsAsTimes) {
  std::vector<TrajectoryPose> truth = Walk(100);
  std::vector<TrajectoryPose> estimate = Estimated(truth);
  for (std::size_t i = 0; i < truth.size(); ++i) {
    truth[i].time_s = estimate[i].time_s = static_cast<double>(i);
  }
  Style from_zero;
  from_zero.start_s = 0;
  EXPECT_TRUE(Says(Evaluate(Tum(estimate, from_zero), Tum(truth, from_zero)), "WARNING",
                   "numbers of rows rather than s"));
}

TEST_F(UserCases, Case21GroundTruthOfPositionsOnly) {
  std::vector<TrajectoryPose> identity = Walk(100);
  for (TrajectoryPose& pose : identity) pose.rotation.setIdentity();
  Style four_columns;
  four_columns.has_rotations = false;
  for (const std::string& truth : {Tum(identity), Tum(Walk(100), four_columns)}) {
    const TrajectoryReport report = Evaluate(Tum(Estimated(Walk(100))), truth);
    EXPECT_LT(report.ate_se3_m.rmse, kExpectedAteM);
    EXPECT_EQ(report.rpe_rotation_per_frame_deg.count, 0u);
    EXPECT_EQ(report.num_lost, 0u);
    EXPECT_TRUE(Says(report, "WARNING", "holds positions only"));
    EXPECT_TRUE(Holds(ToTable(report), "n/a: the ground truth has positions only"));
    EXPECT_TRUE(ToJson(report).at("rpe_rotation_per_frame_deg").is_null());
    EXPECT_FALSE(DrawEvaluation(report, "positions").empty());
  }
  const TrajectoryReport estimate =
      Evaluate(Tum(Estimated(Walk(100)), four_columns), Tum(Walk(100)));
  EXPECT_LT(estimate.ate_se3_m.rmse, kExpectedAteM);
  EXPECT_TRUE(Holds(ToTable(estimate), "n/a: the estimate has positions only"));
}

TEST_F(UserCases, Case25FewerFramesThanPoses) {
  EvaluationOptions options;
  options.num_frames = 10;
  const std::string error = ErrorOf(Tum(Estimated(Walk(100))), Tum(Walk(100)), options);
  EXPECT_TRUE(Holds(error, "--frames 10: fewer than the 100 poses")) << error;
  options.num_frames = 200;
  EXPECT_DOUBLE_EQ(Evaluate(Tum(Estimated(Walk(100))), Tum(Walk(100)), options).completeness, 0.5);
}

TEST_F(UserCases, Case25bRowsOfATruthOfAHigherRateAreNoFrames) {
  std::vector<TrajectoryPose> estimate = Estimated(Walk(100));
  const std::string truth = Tum(Walk(991, 0.01));
  const TrajectoryReport whole = Evaluate(Tum(estimate), truth);
  EXPECT_DOUBLE_EQ(whole.completeness, 1);
  EXPECT_EQ(whole.num_lost, 0u);
  EXPECT_TRUE(Holds(ToTable(whole), "the truth has a higher rate"));
  estimate.erase(estimate.begin() + 40, estimate.begin() + 50);
  const TrajectoryReport with_gap = Evaluate(Tum(estimate), truth);
  EXPECT_DOUBLE_EQ(with_gap.completeness, 0.9);
  EXPECT_EQ(with_gap.num_lost, 10u);
  // Where the rates agree the truth's rows are the frames.
  EXPECT_DOUBLE_EQ(Evaluate(Tum(estimate), Tum(Walk(100))).completeness, 0.9);
}

TEST_F(UserCases, Case28bTimesThatDoNotFitTheRows) {
  std::string times;
  for (int i = 0; i < 100; ++i) times += Number(kStart + 0.1 * i, 6) + "\n";
  const std::string times_path = Write("times.txt", times);
  std::vector<TrajectoryPose> late = Estimated(Walk(100));
  late.erase(late.begin(), late.begin() + 2);
  const auto error_of = [&](const std::string& estimate_rows, const std::string& truth_rows) {
    Trajectory estimate = ReadTrajectory(Write("estimate.txt", estimate_rows));
    Trajectory truth = ReadTrajectory(Write("truth.txt", truth_rows));
    try {
      SetTimesOfPair(times_path, &estimate, &truth);
    } catch (const InputError& error) {
      return std::string(error.what());
    }
    ExpectAsGood(EvaluateTrajectory(estimate, truth, {}));
    return std::string();
  };
  EXPECT_TRUE(Holds(error_of(Kitti(late), Tum(Walk(100))), "holds 100 times, "));
  EXPECT_TRUE(Holds(error_of(Kitti(late), Tum(Walk(100))), "estimate.txt has 98 rows"));
  EXPECT_TRUE(Holds(error_of(Kitti(late), Kitti(Walk(100))), "fits the ground truth only"));
  EXPECT_EQ(error_of(Kitti(Estimated(Walk(100))), Tum(Walk(100))), "");
  EXPECT_EQ(error_of(Kitti(Estimated(Walk(100))), Kitti(Walk(100))), "");
}

TEST_F(UserCases, Case29InvertedPoses) {
  std::vector<TrajectoryPose> inverted = Estimated(Walk(100));
  for (TrajectoryPose& pose : inverted) pose = Inverse(pose);
  const std::string error = ErrorOf(Tum(inverted), Tum(Walk(100)));
  EXPECT_TRUE(Holds(error, "estimate.txt: looks like inverted poses")) << error;
  EXPECT_TRUE(Holds(error, "--inverted estimate")) << error;
  EXPECT_TRUE(Holds(ErrorOf(Kitti(inverted), Kitti(Walk(100))), "--inverted estimate"));
  EvaluationOptions options;
  options.is_estimate_inverted = true;
  ExpectAsGood(Evaluate(Tum(inverted), Tum(Walk(100)), options));
  EXPECT_TRUE(
      Holds(ErrorOf(Tum(Estimated(Walk(100))), Tum(Walk(100)), options), "omit --inverted"));

  std::vector<TrajectoryPose> truth = Walk(100);
  for (TrajectoryPose& pose : truth) pose = Inverse(pose);
  EXPECT_TRUE(Holds(ErrorOf(Tum(Estimated(Walk(100))), Tum(truth)), "--inverted ground-truth"));
}

/// An estimate that lost ten frames, written as `lost` behind the time.
std::string WithLostRows(const std::string& lost) {
  const std::vector<TrajectoryPose> poses = Estimated(Walk(100));
  std::string text;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const bool is_lost = i >= 50 && i < 60;
    text += is_lost ? TimeText(poses[i].time_s, {}) + lost + "\n" : TumRow(poses[i], {});
  }
  return text;
}

TEST_F(UserCases, Case29bLostFramesWrittenAsSomething) {
  for (const std::string lost :
       {" 0 0 0 0 0 0 1", " 0 0 0 0 0 0 0", " nan nan nan nan nan nan nan", " 0 0 0 0.6 0 0 0.8"}) {
    const TrajectoryReport report = Evaluate(WithLostRows(lost), Tum(Walk(100)));
    EXPECT_EQ(report.num_matched, 90u) << lost;
    EXPECT_EQ(report.num_lost, 10u) << lost;
    EXPECT_LT(report.ate_se3_m.rmse, kExpectedAteM) << lost;
    EXPECT_TRUE(Says(report, "WARNING", "estimate.txt:51: 10 rows")) << lost;
  }
  const std::string last = TumRow(Estimated(Walk(100))[49], {});
  const TrajectoryReport frozen = Evaluate(
      WithLostRows(last.substr(last.find(' '), last.size() - last.find(' ') - 1)), Tum(Walk(100)));
  EXPECT_TRUE(Says(frozen, "WARNING", "10 poses of the estimate repeat the previous one"));
}

TEST_F(UserCases, Case29cAStartAtTheOriginIsNoLoss) {
  std::vector<TrajectoryPose> truth = Walk(100);
  for (std::size_t i = 1; i < 20; ++i) {
    const double time_s = truth[i].time_s;
    truth[i] = truth[0];
    truth[i].time_s = time_s;
  }
  for (std::size_t i = 20; i < truth.size(); ++i) {
    const double time_s = truth[i].time_s;
    truth[i] = PoseAt(time_s - 1.9);
    truth[i].time_s = time_s;
  }
  std::vector<TrajectoryPose> estimate = truth;
  for (TrajectoryPose& pose : estimate) {
    pose.position_m = truth[0].rotation.transpose() * (pose.position_m - truth[0].position_m);
    pose.rotation = truth[0].rotation.transpose() * pose.rotation;
  }
  const TrajectoryReport report = Evaluate(Tum(estimate), Tum(truth));
  EXPECT_EQ(report.num_matched, 100u);
  EXPECT_TRUE(report.remarks.empty()) << report.remarks[0].text;
}

TEST_F(UserCases, Case29dPositionsInMillimetres) {
  std::vector<TrajectoryPose> estimate = Estimated(Walk(100));
  for (TrajectoryPose& pose : estimate) pose.position_m *= 1000;
  EXPECT_TRUE(Says(Evaluate(Tum(estimate), Tum(Walk(100))), "WARNING", "in mm or cm"));
}

}  // namespace
}  // namespace airdos
