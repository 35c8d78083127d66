#include "common/evaluation/people_report.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <Eigen/Geometry>
#include <filesystem>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "common/evaluation/people_matching.h"
#include "common/util/error.h"

namespace airdos {
namespace {

/// A body of which only neck, right shoulder and right hip are given, upright, the neck at
/// `p_neck`. Neck to shoulder is 0.2 m, shoulder to hip 0.5 m.
Joints Body(const Eigen::Vector3d& p_neck) {
  return {{kNeck, p_neck},
          {kRightShoulder, p_neck + Eigen::Vector3d(-0.2, 0, 0)},
          {kRightHip, p_neck + Eigen::Vector3d(-0.2, 0.5, 0)}};
}

Joints Moved(Joints joints, const Eigen::Vector3d& by) {
  for (auto& [joint, p] : joints) p += by;
  return joints;
}

Joints Mapped(Joints joints, const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  for (auto& [joint, p] : joints) p = R * p + t;
  return joints;
}

TrajectoryPose Pose(double time_s, const Eigen::Matrix3d& R, const Eigen::Vector3d& t) {
  TrajectoryPose pose;
  pose.time_s = time_s;
  pose.rotation = R;
  pose.position_m = t;
  return pose;
}

/// Twelve frames in which the estimated camera is turned and 10 m off. Person 7 at 5 m and person 8
/// at 10 m are measured 6 cm too near and optimized to 3 cm; from frame 10 on person 8 has another
/// track. Lengths grow by 1 mm a frame.
class PeopleReportTest : public ::testing::Test {
 protected:
  PeopleReportTest() {
    for (int k = 0; k < 12; ++k) {
      const double time_s = 0.1 * k;
      cameras_.estimate.push_back(Pose(time_s, R_, {1, 2, 3}));
      cameras_.ground_truth.push_back(Pose(time_s, Eigen::Matrix3d::Identity(), {10, 0, 0}));
      TruePeople frame = {time_s, {}};
      for (const int person : {7, 8}) {
        const Joints truth_C = Body({3.0 * (person - 7), 0, person == 7 ? 5.0 : 10.0});
        frame.people[person] = {Moved(truth_C, {10, 0, 0}), 9, 9};
        PersonState state;
        state.time_s = time_s;
        state.track = person == 7 ? 70 : k < 10 ? 80 : 81;
        state.joints_W = Mapped(Moved(truth_C, {0, 0, -0.03}), R_, {1, 2, 3});
        state.measured_W = Mapped(Moved(truth_C, {0, 0, -0.06}), R_, {1, 2, 3});
        state.segment_length_m = {{0, 0.21 + 0.001 * k}, {2, 0.49 + 0.001 * k}};
        estimate_.push_back(state);
      }
      truth_.push_back(frame);
    }
  }

  Eigen::Matrix3d R_ = Eigen::AngleAxisd(0.5, Eigen::Vector3d::UnitY()).toRotationMatrix();
  MatchedTrajectories cameras_;
  std::vector<TruePeople> truth_;
  std::vector<PersonState> estimate_;
};

TEST_F(PeopleReportTest, JointErrorsDoNotCountTheCamerasPath) {
  const PeopleReport report = EvaluatePeople(estimate_, truth_, cameras_);
  EXPECT_EQ(report.num_states, 24u);
  EXPECT_EQ(report.num_matched, 24u);
  EXPECT_EQ(report.num_tracks, 3u);
  EXPECT_EQ(report.num_people, 2u);
  EXPECT_EQ(report.joint_errors.optimized.count, 72u);
  EXPECT_NEAR(report.joint_errors.optimized.mean, 0.03, 1e-12);
  EXPECT_NEAR(report.joint_errors.measured.median, 0.06, 1e-12);
  EXPECT_NEAR(report.joint_errors.mean_improvement_percent(), 50, 1e-9);
  EXPECT_EQ(report.joint_errors_by_depth[0].measured.count, 36u);
  EXPECT_EQ(report.joint_errors_by_depth[1].measured.count, 36u);
  EXPECT_EQ(report.joint_errors_by_depth[2].measured.count, 0u);
}

TEST_F(PeopleReportTest, OnlyJointsThatWereMeasuredAndOptimizedCount) {
  for (PersonState& state : estimate_) state.measured_W.erase(kRightHip);
  EXPECT_EQ(EvaluatePeople(estimate_, truth_, cameras_).joint_errors.optimized.count, 48u);
}

TEST_F(PeopleReportTest, IdentitiesOfPeopleToBeSeen) {
  // Person 8 has track 80 in 10 of 12 frames: IDTP = 12 + 10 of 24 and 24.
  PeopleReport report = EvaluatePeople(estimate_, truth_, cameras_);
  EXPECT_EQ(report.identity.num_switches, 1);
  EXPECT_EQ(report.identity.num_people, 2);
  EXPECT_EQ(report.num_to_be_seen, 24u);
  EXPECT_EQ(report.num_seen, 24u);
  EXPECT_NEAR(report.identity.idf1, 22.0 / 24, 1e-12);

  // Where an image hides person 8, its tracks are neither right nor wrong.
  for (TruePeople& frame : truth_) frame.people[8].num_visible_right = kMinVisibleJoints - 1;
  report = EvaluatePeople(estimate_, truth_, cameras_);
  EXPECT_EQ(report.identity.num_people, 1);
  EXPECT_EQ(report.num_seen, 12u);
  EXPECT_NEAR(report.identity.idf1, 1, 1e-12);

  // Somebody who is nobody costs precision.
  PersonState nobody = estimate_[0];
  nobody.track = 99;
  nobody.measured_W = Mapped(Body({-6, 0, 8}), R_, {1, 2, 3});
  estimate_.push_back(nobody);
  report = EvaluatePeople(estimate_, truth_, cameras_);
  EXPECT_EQ(report.num_matched, 24u);
  EXPECT_NEAR(report.identity.idf1, 24.0 / 25, 1e-12);
}

TEST_F(PeopleReportTest, LengthsAtTheEndOfATrack) {
  // Tracks 70 (to frame 11) and 80 (to frame 9); 81 has only two frames. True lengths 0.2 and 0.5.
  const PeopleReport report = EvaluatePeople(estimate_, truth_, cameras_);
  const LengthErrors& shoulder = report.lengths_by_segment[0];  // 0.221 and 0.219
  EXPECT_EQ(shoulder.relative_percent.count, 2u);
  EXPECT_NEAR(shoulder.relative_percent.mean, 10, 1e-9);
  EXPECT_NEAR(shoulder.median_signed_percent, 10, 1e-9);
  EXPECT_NEAR(shoulder.within_5_percent, 0, 1e-9);
  const LengthErrors& side = report.lengths_by_segment[2];  // 0.501 and 0.499
  EXPECT_NEAR(side.relative_percent.max, 0.2, 1e-9);
  EXPECT_NEAR(side.median_signed_percent, 0, 1e-9);
  EXPECT_EQ(report.lengths.relative_percent.count, 4u);
  EXPECT_NEAR(report.lengths.relative_percent.median, 0.5 * (0.2 + 9.5), 1e-9);
  EXPECT_NEAR(report.lengths.within_5_percent, 50, 1e-9);
  EXPECT_EQ(report.lengths_by_depth[0].relative_percent.count, 2u);
  EXPECT_EQ(report.lengths_by_depth[1].relative_percent.count, 2u);
}

TEST_F(PeopleReportTest, IsWritten) {
  const PeopleReport report = EvaluatePeople(estimate_, truth_, cameras_);
  const nlohmann::json json = ToJson(report);
  EXPECT_EQ(json["identity_switches"], 1);
  EXPECT_EQ(json["identity_switches_per_person"], 0.5);
  EXPECT_NEAR(json["joint_error"]["measured_m"]["mean"], 0.06, 1e-12);
  EXPECT_NEAR(json["segment_length_error"]["within_5_percent"], 50, 1e-9);
  EXPECT_TRUE(json["joint_error_by_depth"]["from 12 m"]["measured_m"].is_null());
  const std::string text = ToTable(report);
  EXPECT_NE(text.find("1 switches, 0.50 per person; IDF1 0.917"), std::string::npos) << text;
}

TEST(MatchPeople, ByTheImageWhateverTheDepth) {
  const Joints near = Body({0, 0, 5});
  const Joints beside = Body({0.9, 0, 5});
  Joints too_far = near;  // the same directions at 1.3 times the depth
  for (auto& [joint, p] : too_far) p *= 1.3;
  Joints exchanged = beside;  // left for right
  exchanged.erase(kRightShoulder);
  exchanged.erase(kRightHip);
  exchanged[kLeftShoulder] = beside.at(kRightShoulder);
  exchanged[kLeftHip] = beside.at(kRightHip);
  const auto matches =
      MatchPeople({exchanged, Body({-3, 0, 5}), too_far}, {{1, near}, {2, beside}});
  EXPECT_EQ(matches, (std::map<std::size_t, std::int64_t>{{0, 2}, {2, 1}}));
  EXPECT_TRUE(MatchPeople({}, {{1, near}}).empty());
  EXPECT_TRUE(MatchPeople({near}, {}).empty());
  EXPECT_TRUE(MatchPeople({near}, {{1, Body({0, 0, -5})}}).empty());  // behind the camera
}

TEST(IsToBeSeen, NeedsJointsInBothImagesAndANearPerson) {
  TruePersonState person;
  EXPECT_TRUE(IsToBeSeen(person, Body({0, 0, 5})));  // a file that does not say what is hidden
  EXPECT_FALSE(IsToBeSeen(person, Body({0, 0, kMaxPersonDepthM + 0.1})));
  EXPECT_FALSE(IsToBeSeen(person, Body({0, 0, -5})));
  person.num_visible_left = person.num_visible_right = kMinVisibleJoints;
  EXPECT_TRUE(IsToBeSeen(person, Body({0, 0, 5})));
  person.num_visible_left = kMinVisibleJoints - 1;
  EXPECT_FALSE(IsToBeSeen(person, Body({0, 0, 5})));
}

TEST(PeopleFiles, AreReadAndErrorsNameTheLine) {
  const std::string path =
      (std::filesystem::temp_directory_path() / ("airdos_people_test_" + std::to_string(getpid())))
          .string();
  const std::string state =
      R"({"seq": 1, "utime": 100000, "track": 3, "joints": {"1": [1, 2, 3], "14": [0, 0, 0]}, )"
      R"("measured": {"1": [1, 2, 4]}, "segment_lengths_m": {"13": 0.25}})";
  std::ofstream(path) << state << "\n" << state << "\n";
  const std::vector<PersonState> states = ReadPeople(path);
  ASSERT_EQ(states.size(), 2u);
  EXPECT_EQ(states[1].track, 3);
  EXPECT_EQ(states[1].joints_W.size(), 1u);  // 14 is of the face
  EXPECT_EQ(states[1].measured_W.at(1), Eigen::Vector3d(1, 2, 4));
  EXPECT_EQ(states[1].segment_length_m.at(13), 0.25);
  std::ofstream(path) << state << "\n{}\n";
  const auto message = [&](const std::function<void()>& call) -> std::string {
    try {
      call();
    } catch (const InputError& error) {
      return error.what();
    }
    return "no error";
  };
  EXPECT_NE(message([&] { ReadPeople(path); }).find(path + ":2: "), std::string::npos);

  std::ofstream(path) << R"([{"t": 0.5, "humans": [{"id": 4, "joints_w": {"0": [1, 2, 3]}, )"
                      << R"("vis0": [2, 0, 1, -1], "vis1": [0]}]}])";
  const std::vector<TruePeople> truth = ReadTruePeople(path);
  ASSERT_EQ(truth.size(), 1u);
  EXPECT_EQ(truth[0].people.at(4).num_visible_left, 2);
  EXPECT_EQ(truth[0].people.at(4).num_visible_right, 0);
  EXPECT_EQ(truth[0].people.at(4).joints.at(0), Eigen::Vector3d(1, 2, 3));
  std::ofstream(path) << "[{}]";
  EXPECT_NE(message([&] { ReadTruePeople(path); }).find(path + ": "), std::string::npos);
  // Ids that are none, which somebody may take for an index later on.
  const auto with = [&](const std::string& old_text, const std::string& new_text) {
    std::string changed = state;
    changed.replace(changed.find(old_text), old_text.size(), new_text);
    std::ofstream(path) << changed << "\n";
    return message([&] { ReadPeople(path); });
  };
  EXPECT_NE(with("\"1\"", "\"-1\"").find("'-1' is not a joint"), std::string::npos);
  EXPECT_NE(with("\"13\"", "\"14\"").find("'14' is not a segment"), std::string::npos);
  EXPECT_NE(with("3", "1e99").find("'1e+99' is not a whole number"), std::string::npos);
  EXPECT_EQ(with("3", "3.0"), "no error");
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace airdos
