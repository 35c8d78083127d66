// The figures of people and the files they come from, each worked out by hand.
#include <gtest/gtest.h>

#include <set>
#include <string>

#include "common/evaluation/identity.h"
#include "common/evaluation/people_files.h"
#include "common/evaluation/people_matching.h"
#include "common/evaluation/people_report.h"
#include "common/human/body_keypoints.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

using Eigen::Vector3d;

/// Neck, right shoulder (0.2 m beside it) and right hip (0.5 m below that).
Joints Body(double depth_m) {
  return {{kNeck, {0, 0, depth_m}},
          {kRightShoulder, {-0.2, 0, depth_m}},
          {kRightHip, {-0.2, 0.5, depth_m}}};
}

Joints Nearer(Joints joints, double by_m) {
  for (auto& [joint, p] : joints) p.z() -= by_m;
  return joints;
}

/// Person 7 at these depths, frame by frame, always seen by track 70; the first segment (neck to
/// shoulder) is held to be 0.18 m, 10 % too short.
PeopleReport Report(const std::vector<double>& depths_m, int num_visible_left = 9,
                    int num_visible_right = 9) {
  MatchedTrajectories cameras;
  std::vector<PersonState> estimate;
  std::vector<TruePeople> truth;
  for (std::size_t i = 0; i < depths_m.size(); ++i) {
    TrajectoryPose camera;
    camera.time_s = 0.1 * static_cast<double>(i);
    cameras.estimate.push_back(camera);
    cameras.ground_truth.push_back(camera);
    TruePeople frame;
    frame.time_s = camera.time_s;
    frame.people[7] = {Body(depths_m[i]), num_visible_left, num_visible_right};
    truth.push_back(frame);
    PersonState state;
    state.time_s = camera.time_s;
    state.track = 70;
    state.joints_W = Nearer(Body(depths_m[i]), 0.03);
    state.measured_W = Nearer(Body(depths_m[i]), 0.06);
    state.segment_length_m = {{0, 0.18}};
    estimate.push_back(state);
  }
  return EvaluatePeople(estimate, truth, cameras);
}

TEST(PeopleReportValuesTest, MeasuredAndOptimizedByDepth) {
  const PeopleReport report = Report({5.9, 6, 11.9, 12});
  EXPECT_NEAR(report.joint_errors.measured.mean, 0.06, 1e-9);
  EXPECT_NEAR(report.joint_errors.optimized.mean, 0.03, 1e-9);
  EXPECT_NEAR(report.joint_errors.mean_improvement_percent(), 50, 1e-6);
  EXPECT_NEAR(report.joint_errors.median_improvement_percent(), 50, 1e-6);
  EXPECT_EQ(report.joint_errors_by_depth[0].measured.count, 3u);
  EXPECT_EQ(report.joint_errors_by_depth[1].measured.count, 6u);
  EXPECT_EQ(report.joint_errors_by_depth[2].measured.count, 3u);
}

TEST(PeopleReportValuesTest, LengthsCountFromTenFramesOnByTheLeastDepth) {
  std::vector<double> depths_m = {5, 5, 5, 13, 13, 13, 13, 13, 13};
  EXPECT_EQ(Report(depths_m).lengths.relative_percent.count, 0u);
  depths_m.push_back(13);
  const PeopleReport report = Report(depths_m);
  EXPECT_EQ(report.lengths.relative_percent.count, 1u);
  EXPECT_NEAR(report.lengths.relative_percent.mean, 10, 1e-6);
  EXPECT_NEAR(report.lengths.median_signed_percent, -10, 1e-6);
  EXPECT_EQ(report.lengths.within_5_percent, 0);
  EXPECT_EQ(report.lengths_by_depth[0].relative_percent.count, 1u);
  EXPECT_EQ(report.lengths_by_depth[2].relative_percent.count, 0u);
  EXPECT_EQ(report.lengths_by_segment[0].relative_percent.count, 1u);
}

TEST(PeopleReportValuesTest, SeenAreThoseOfThemWhoAreToBeSeen) {
  const PeopleReport seen = Report({5, 5, 5});
  EXPECT_EQ(seen.num_to_be_seen, 3u);
  EXPECT_EQ(seen.num_seen, 3u);
  const PeopleReport hidden = Report({5, 5, 5}, 9, 4);
  EXPECT_EQ(hidden.num_matched, 3u);
  EXPECT_EQ(hidden.num_to_be_seen, 0u);
  EXPECT_EQ(hidden.num_seen, 0u);
}

TEST(IsToBeSeenValuesTest, InBothImagesBetweenBothDepths) {
  const auto is_seen = [](std::optional<int> left, std::optional<int> right, double depth_m) {
    return IsToBeSeen({{}, left, right}, Body(depth_m));
  };
  EXPECT_TRUE(is_seen(5, 5, 4));
  EXPECT_FALSE(is_seen(4, 5, 4));
  EXPECT_FALSE(is_seen(5, 4, 4));
  EXPECT_TRUE(is_seen(std::nullopt, 5, 4));
  EXPECT_TRUE(is_seen(5, std::nullopt, 4));
  EXPECT_TRUE(is_seen(5, 5, 0.5));
  EXPECT_FALSE(is_seen(5, 5, 0.49));
  EXPECT_TRUE(is_seen(5, 5, 30));
  EXPECT_FALSE(is_seen(5, 5, 30.1));
}

// Shoulders 0.4 m apart are 0.24 of the height from where the other one is: too much for a match.
TEST(MatchPeopleValuesTest, SidesMayBeExchanged) {
  const Joints truth = {{kRightShoulder, {-0.2, 0, 5}}, {kLeftShoulder, {0.2, 0, 5}}};
  const Joints swapped = {{kRightShoulder, {0.2, 0, 5}}, {kLeftShoulder, {-0.2, 0, 5}}};
  EXPECT_EQ(MatchPeople({truth}, {{3, truth}}).size(), 1u);
  EXPECT_EQ(MatchPeople({swapped}, {{3, truth}}).size(), 1u);
  const auto beside = [](double by_m) { return Joints{{kNeck, {by_m, 0, 5}}}; };
  EXPECT_EQ(MatchPeople({beside(0.254)}, {{3, beside(0)}}).size(), 1u);  // 0.15 of 1.7 m: 0.255
  EXPECT_TRUE(MatchPeople({beside(0.256)}, {{3, beside(0)}}).empty());
}

TEST(InCameraValuesTest, TurnsAndShifts) {
  TrajectoryPose T_A_C;  // x of the camera is y of A
  T_A_C.rotation << 0, -1, 0, 1, 0, 0, 0, 0, 1;
  T_A_C.position_m = {1, 2, 3};
  const Joints joints = InCamera({{4, {1.5, 2.25, 3.125}}}, T_A_C);
  EXPECT_LT((joints.at(4) - Vector3d(0.25, -0.5, 0.125)).norm(), 1e-12);
}

TEST(IdentityValuesTest, SharesOfTracksAndOfPeople) {
  IdentityEvaluator evaluator;
  for (int i = 0; i < 5; ++i) {
    std::map<std::int64_t, std::optional<std::int64_t>> tracks = {{20, std::nullopt}};
    if (i < 3) tracks[10] = 1;
    evaluator.AddFrame(i < 4 ? std::set<std::int64_t>{1} : std::set<std::int64_t>{}, tracks);
  }
  const IdentityScore score = evaluator.Score();
  EXPECT_NEAR(score.id_precision, 3 / 8.0, 1e-9);
  EXPECT_NEAR(score.id_recall, 3 / 4.0, 1e-9);
  EXPECT_NEAR(score.idf1, 2 * 3 / 12.0, 1e-9);
  EXPECT_EQ(score.num_people, 1);
  EXPECT_EQ(score.num_switches, 0);
}

TEST(IdentityValuesTest, ASwitchIsAChangeAndWhoCannotBeSeenDoesNotCount) {
  IdentityEvaluator evaluator;
  for (const std::int64_t track : {1, 1, 1, 2}) evaluator.AddFrame({5}, {{track, 5}});
  EXPECT_EQ(evaluator.Score().num_switches, 1);
  IdentityEvaluator hidden;
  hidden.AddFrame({}, {{1, 5}});
  hidden.AddFrame({5}, {{1, 5}});
  EXPECT_NEAR(hidden.Score().idf1, 1, 1e-9);
}

TEST(PeopleFilesValuesTest, FieldByField) {
  const ScratchFolder folder("people_files_values");
  const std::vector<PersonState> states = ReadPeople(
      folder.Write("people.jsonl",
                   R"({"utime":1250000,"track":3,"joints":{"1":[1,2,3],"13":[4,5,6],"14":[7,8,9]},)"
                   R"("measured":{"1":[1.5,2.5,3.5]},"segment_lengths_m":{"0":0.2,"13":0.25}})"
                   "\n"));
  ASSERT_EQ(states.size(), 1u);
  EXPECT_DOUBLE_EQ(states[0].time_s, 1.25);
  EXPECT_EQ(states[0].track, 3);
  EXPECT_EQ(states[0].joints_W.size(), 2u);
  EXPECT_EQ(states[0].joints_W.at(1), Vector3d(1, 2, 3));
  EXPECT_EQ(states[0].joints_W.at(13), Vector3d(4, 5, 6));
  ASSERT_EQ(states[0].measured_W.size(), 1u);
  EXPECT_EQ(states[0].measured_W.at(1), Vector3d(1.5, 2.5, 3.5));
  EXPECT_EQ(states[0].segment_length_m, (std::map<int, double>{{0, 0.2}, {13, 0.25}}));

  const std::vector<TruePeople> truth = ReadTruePeople(folder.Write(
      "joints_gt.json", R"([{"t":0.5,"humans":[{"id":4,"joints_w":{"2":[1,2,3],"14":[0,0,0]},)"
                        R"("vis0":[1,0,2,0.5],"vis1":[0,1,0,0]},{"id":9,"joints_w":{}}]}])"));
  ASSERT_EQ(truth.size(), 1u);
  EXPECT_EQ(truth[0].time_s, 0.5);
  const TruePersonState& person = truth[0].people.at(4);
  EXPECT_EQ(person.joints.size(), 1u);
  EXPECT_EQ(person.joints.at(2), Vector3d(1, 2, 3));
  EXPECT_EQ(person.num_visible_left, 3);
  EXPECT_EQ(person.num_visible_right, 1);
  EXPECT_EQ(person.visible_left, (std::set<int>{0, 2, 3}));
  EXPECT_EQ(person.visible_right, (std::set<int>{1}));
  EXPECT_FALSE(truth[0].people.at(9).num_visible_left);
}

}  // namespace
}  // namespace airdos
