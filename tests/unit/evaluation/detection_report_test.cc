// How good detections are, with people made by hand: each figure is known without computing it.
#include "common/evaluation/detection_report.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <set>

#include "common/evaluation/people_matching.h"

namespace airdos {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

using People = std::vector<BodyKeypoints>;

constexpr StereoCamera kCamera = {1000, 800, 500, 500, 500, 400, 0.5};

/// Where the joints of a person who faces the camera are, in m from the neck. The right shoulder is
/// on the left of the image.
const std::array<Vector2d, kNumJoints> kBody = {{{0, -0.2},
                                                 {0, 0},
                                                 {-0.2, 0},
                                                 {-0.25, 0.3},
                                                 {-0.25, 0.55},
                                                 {0.2, 0},
                                                 {0.25, 0.3},
                                                 {0.25, 0.55},
                                                 {-0.1, 0.5},
                                                 {-0.1, 0.9},
                                                 {-0.1, 1.3},
                                                 {0.1, 0.5},
                                                 {0.1, 0.9},
                                                 {0.1, 1.3}}};

Joints Body(const Vector3d& neck) {
  Joints joints;
  for (int joint = 0; joint < kNumJoints; ++joint) {
    const Vector2d& at = kBody[static_cast<std::size_t>(joint)];
    joints[joint] = neck + Vector3d(at.x(), at.y(), 0);
  }
  return joints;
}

std::set<int> FirstJoints(int num) {
  std::set<int> joints;
  for (int joint = 0; joint < num; ++joint) joints.insert(joint);
  return joints;
}

/// Of which the images show the first joints only.
TruePersonState Person(const Vector3d& neck, int num_left = kNumJoints,
                       int num_right = kNumJoints) {
  TruePersonState person;
  person.joints = Body(neck);
  person.num_visible_left = num_left;
  person.num_visible_right = num_right;
  person.visible_left = FirstJoints(num_left);
  person.visible_right = FirstJoints(num_right);
  return person;
}

/// As a detector without errors would find a person, but `by_px` beside it.
BodyKeypoints Found(const Vector3d& neck, ImageSide side = kLeftImage,
                    const Vector2d& by_px = {0, 0}) {
  BodyKeypoints person;
  for (const auto& [joint, p_C] : Body(neck)) {
    const Vector3d at = kCamera.ProjectStereo(p_C);
    const double u_px = side == kLeftImage ? at[0] : at[2];
    person[static_cast<std::size_t>(joint)] = {u_px + by_px.x(), at[1] + by_px.y(), 0.9};
  }
  return person;
}

DetectionFrame Frame(const std::vector<TruePersonState>& truth, const People& left,
                     const People& right = {}) {
  DetectionFrame frame;
  frame.detected = {left, right};
  frame.truth.emplace();
  for (const TruePersonState& person : truth) {
    const auto identity = static_cast<std::int64_t>(frame.truth->people.size());
    frame.truth->people[identity] = person;
  }
  return frame;
}

DetectorScore Score(const DetectionFrame& frame) {
  return EvaluateDetections(kCamera, {frame}).detected.value();
}
ImageScore ScoreLeft(const std::vector<TruePersonState>& truth, const People& left) {
  return Score(Frame(truth, left)).images[kLeftImage];
}

const Vector3d kNear(0, 0, 5);
const Vector3d kMiddle(-3, 0, 10);
const Vector3d kFar(5, 0, 20);

TEST(DetectionReportTest, EverybodyIsFoundByDepth) {
  const ImageScore score =
      ScoreLeft({Person(kNear), Person(kMiddle), Person(kFar)}, {Found(kFar), Found(kNear)});
  EXPECT_EQ(score.num_images, 1u);
  EXPECT_EQ(score.num_detections, 2u);
  EXPECT_EQ(score.recall.num_people, 3u);
  EXPECT_EQ(score.recall.num_found, 2u);
  EXPECT_NEAR(score.recall.percent(), 200.0 / 3, 1e-9);
  for (const std::size_t band : {0, 1, 2}) {
    EXPECT_EQ(score.recall_by_depth[band].num_people, 1u);
    EXPECT_EQ(score.recall_by_depth[band].num_found, band == 1 ? 0u : 1u);
    EXPECT_EQ(score.joint_px_by_depth[band].count, band == 1 ? 0u : 14u);
  }
  EXPECT_EQ(score.num_false, 0u);
  EXPECT_EQ(score.joint_px.count, 28u);
  EXPECT_NEAR(score.joint_px.percentile_90, 0, 1e-9);
}

TEST(DetectionReportTest, ErrorsOfJointsAreDistancesInTheImage) {
  BodyKeypoints found = Found(kNear, kLeftImage, {3, -4});
  EXPECT_NEAR(ScoreLeft({Person(kNear)}, {found}).joint_px.median, 5, 1e-9);
  EXPECT_NEAR(ScoreLeft({Person(kNear)}, {found}).joint_px.percentile_90, 5, 1e-9);
  // Of 14 errors the 90th percentile is 0.7 of the way from the 12th to the 13th.
  found = Found(kNear);
  found[kLeftAnkle].v_px += 10;
  found[kRightAnkle].u_px -= 10;
  EXPECT_NEAR(ScoreLeft({Person(kNear)}, {found}).joint_px.median, 0, 1e-9);
  EXPECT_NEAR(ScoreLeft({Person(kNear)}, {found}).joint_px.percentile_90, 7, 1e-9);
  // What the image does not show, or the detector does not know, has no error.
  EXPECT_NEAR(ScoreLeft({Person(kNear, 10)}, {found}).joint_px.percentile_90, 0, 1e-9);
  EXPECT_EQ(ScoreLeft({Person(kNear, 10)}, {found}).joint_px.count, 10u);
  found[kLeftAnkle].confidence = 0.09;
  EXPECT_EQ(ScoreLeft({Person(kNear)}, {found}).joint_px.count, 13u);
}

TEST(DetectionReportTest, TheWorldMayBeTurned) {
  DetectionFrame frame = Frame({Person(kNear)}, {Found(kNear, kLeftImage, {0, 2})});
  TrajectoryPose& T_W_C = frame.truth->T_W_C;
  T_W_C.rotation << 0, 0, 1, 1, 0, 0, 0, 1, 0;
  T_W_C.position_m = {7, 8, 9};
  for (auto& [joint, p] : frame.truth->people[0].joints) {
    p = T_W_C.rotation * p + T_W_C.position_m;
  }
  EXPECT_NEAR(Score(frame).images[kLeftImage].joint_px.median, 2, 1e-9);
}

TEST(DetectionReportTest, DisparitiesOfPeopleFoundInBothImages) {
  DetectionFrame frame =
      Frame({Person(kNear), Person(kMiddle), Person(kFar)},
            {Found(kNear, kLeftImage, {3, 0}), Found(kMiddle, kLeftImage, {-2, 1}), Found(kFar)},
            {Found(kMiddle, kRightImage, {2, 0}), Found(kNear, kRightImage, {1, 5})});
  DetectorScore score = Score(frame);
  EXPECT_EQ(score.images[kRightImage].recall.num_found, 2u);
  EXPECT_NEAR(score.images[kRightImage].joint_px_by_depth[1].median, 2, 1e-9);
  EXPECT_EQ(score.num_pairs, 2u);
  EXPECT_EQ(score.disparity_px.count, 28u);
  EXPECT_NEAR(score.disparity_px_by_depth[0].median, 2, 1e-9);
  EXPECT_NEAR(score.disparity_px_by_depth[1].median, 4, 1e-9);
  EXPECT_EQ(score.disparity_px_by_depth[2].count, 0u);
  EXPECT_NEAR(score.disparity_px.median, 3, 1e-9);
  // Joints count that both images show.
  frame.truth->people[0] = Person(kNear, 12, 9);
  frame.truth->people[1] = Person(kMiddle, 6, 13);
  score = Score(frame);
  EXPECT_EQ(score.disparity_px_by_depth[0].count, 9u);
  EXPECT_EQ(score.disparity_px_by_depth[1].count, 6u);
}

TEST(DetectionReportTest, HiddenPeopleNeedNotBeFoundButMay) {
  // The right image shows just enough of the middle person, the left one not.
  const std::vector<TruePersonState> truth = {
      Person(kNear), Person(kMiddle, kMinVisibleJoints - 1, kMinVisibleJoints)};
  DetectorScore score = Score(Frame(truth, {Found(kNear), Found(kMiddle)},
                                    {Found(kNear, kRightImage), Found(kMiddle, kRightImage)}));
  const ImageScore& left = score.images[kLeftImage];
  EXPECT_EQ(left.recall.num_people, 1u);
  EXPECT_EQ(left.recall.num_found, 1u);
  EXPECT_EQ(left.num_on_others, 1u);
  EXPECT_EQ(left.num_false, 0u);
  EXPECT_EQ(left.joint_px.count, 14u);
  const ImageScore& right = score.images[kRightImage];
  EXPECT_EQ(right.recall.num_people, 2u);
  EXPECT_EQ(right.recall.num_found, 2u);
  EXPECT_EQ(right.num_on_others, 0u);
  EXPECT_EQ(score.num_pairs, 1u);
}

TEST(DetectionReportTest, ADetectionIsOfWhoeverIsToBeSeen) {
  // It is nearer to the one behind.
  const ImageScore score =
      ScoreLeft({Person(kNear), Person({0.1, 0, 5.2}, 2)}, {Found({0.09, 0, 5.1})});
  EXPECT_EQ(score.recall.num_found, 1u);
  EXPECT_EQ(score.num_on_others, 0u);
}

TEST(DetectionReportTest, PeopleWhoAreTooFarAwayNeedNotBeFound) {
  const double limit_m = kMaxPersonDepthM;
  const ImageScore score = ScoreLeft({Person({0, 0, limit_m}), Person({5, 0, limit_m + 0.1})},
                                     {Found({5, 0, limit_m + 0.1})});
  EXPECT_EQ(score.recall.num_people, 1u);
  EXPECT_EQ(score.recall.num_found, 0u);
  EXPECT_EQ(score.num_on_others, 1u);
  EXPECT_EQ(score.num_false, 0u);
}

TEST(DetectionReportTest, FalseOnesAreOnNobodyOrOnSomebodyWhoIsFoundAlready) {
  const ImageScore score =
      ScoreLeft({Person(kNear), Person(kMiddle)},
                {Found(kNear, kLeftImage, {5, 0}), Found(kFar), Found(kNear), Found({-4, 0, 10})});
  EXPECT_EQ(score.num_detections, 4u);
  EXPECT_EQ(score.recall.num_found, 1u);
  EXPECT_EQ(score.num_false, 3u);
  EXPECT_EQ(score.num_doubles, 1u);
  EXPECT_NEAR(score.joint_px.percentile_90, 0, 1e-9);
  DetectionFrame frame = Frame({}, {Found(kNear)});
  const DetectionReport report = EvaluateDetections(kCamera, {frame, Frame({}, {})});
  EXPECT_NEAR(report.detected->images[kLeftImage].false_per_image(), 0.5, 1e-9);
}

TEST(DetectionReportTest, FalseOnesOnSomebodyHaveTheirJointsElsewhere) {
  // The body is 0.5 m wide and 1.5 m tall, and its box 0.17 m larger on each side.
  const auto score_of = [](const BodyKeypoints& found) {
    return ScoreLeft({Person(kNear)}, {found});
  };
  BodyKeypoints upside_down = Found(kNear);
  for (BodyKeypoint& joint : upside_down) joint.v_px = 400 + 110 - (joint.v_px - 400);
  EXPECT_EQ(score_of(upside_down).num_false, 1u);
  EXPECT_EQ(score_of(upside_down).num_doubles, 0u);
  EXPECT_EQ(score_of(upside_down).num_astray, 1u);
  EXPECT_EQ(score_of(upside_down).num_on_nobody(), 0u);
  EXPECT_EQ(ScoreLeft({Person(kNear, 0)}, {upside_down}).num_astray, 0u);  // behind something
  // The box ends 0.42 m beside the middle. It holds eight joints of somebody 0.4 m to the right,
  // nose, neck and those of the right side, and six of somebody at 0.45 m.
  EXPECT_EQ(score_of(Found({0.4, 0, 5})).num_astray, 1u);
  EXPECT_EQ(score_of(Found({0.45, 0, 5})).num_astray, 0u);
  EXPECT_EQ(score_of(Found({0.45, 0, 5})).num_on_nobody(), 1u);
  // In the right place, but of another size.
  const auto scaled = [](double factor) {
    BodyKeypoints person = Found(kNear);
    for (BodyKeypoint& joint : person) {
      joint.u_px = 500 + factor * (joint.u_px - 500);
      joint.v_px = 455 - factor * (joint.v_px - 455);  // and upside down
    }
    return person;
  };
  EXPECT_EQ(score_of(scaled(0.52)).num_astray, 1u);
  EXPECT_EQ(score_of(scaled(0.46)).num_astray, 0u);
  // Hips and knees stay in the box; the thighs are 0.93 of typical ones.
  const auto thighs = [&](double factor) {
    BodyKeypoints person = scaled(factor);
    for (const int joint : {0, 1, 2, 3, 4, 5, 6, 7, 10, 13}) {
      person[static_cast<std::size_t>(joint)].confidence = 0;
    }
    return person;
  };
  EXPECT_EQ(score_of(thighs(2.1)).num_astray, 1u);
  EXPECT_EQ(score_of(thighs(2.2)).num_astray, 0u);
}

TEST(DetectionReportTest, TwoPeopleCloseTogetherGetOneDetectionEach) {
  // The detection in the middle is nearer to the left person, but the other one fits only them.
  const std::vector<TruePersonState> truth = {Person(kNear), Person({0.3, 0, 5})};
  const People found = {Found({0.14, 0, 5}), Found({-0.2, 0, 5})};
  const ImageScore score = ScoreLeft(truth, found);
  EXPECT_EQ(score.recall.num_found, 2u);
  EXPECT_EQ(score.num_false, 0u);
  // 0.16 and 0.2 m at 100 px/m.
  EXPECT_NEAR(score.joint_px.median, 18, 1e-9);
}

TEST(DetectionReportTest, ADetectionMayBeOffByASmallPartOfTheHeight) {
  const double limit_m = 0.15 * 1.7;
  EXPECT_EQ(ScoreLeft({Person(kNear)}, {Found({limit_m - 0.01, 0, 5})}).num_false, 0u);
  EXPECT_EQ(ScoreLeft({Person(kNear)}, {Found({limit_m + 0.01, 0, 5})}).num_false, 1u);
}

TEST(DetectionReportTest, ExchangedSidesAreFoundButTheirJointsAreWrong) {
  const BodyKeypoints exchanged = SwapSides(Found(kNear), SideSwap::kAll);
  const ImageScore score = ScoreLeft({Person(kNear), Person(kMiddle)}, {exchanged, Found(kMiddle)});
  EXPECT_EQ(score.recall.num_found, 2u);
  EXPECT_EQ(score.num_exchanged, 1u);
  // Nose and neck are right; six joints of the legs and hips are 0.2 m off, shoulders 0.4 m, and
  // four of the arms 0.5 m, at 100 px/m.
  EXPECT_NEAR(score.joint_px_by_depth[0].median, 20, 1e-9);
  EXPECT_NEAR(score.joint_px_by_depth[0].percentile_90, 50, 1e-9);
  // One image's only: the disparity is wrong.
  const DetectorScore pair =
      Score(Frame({Person(kNear)}, {exchanged}, {Found(kNear, kRightImage)}));
  EXPECT_NEAR(pair.disparity_px.median, 20, 1e-9);
}

TEST(DetectionReportTest, TheSidesOfSomebodySeenFromTheSideMayBeEither) {
  TruePersonState person = Person(kNear);
  BodyKeypoints found = Found(kNear);
  for (auto& [joint, p] : person.joints) p.x() *= 0.01;
  for (BodyKeypoint& joint : found) joint.u_px = 500 - 0.01 * (joint.u_px - 500);
  EXPECT_EQ(ScoreLeft({person}, {found}).num_exchanged, 1u);
  // The exchange makes less of a difference than other errors do.
  for (BodyKeypoint& joint : found) joint.v_px += 1;
  const ImageScore score = ScoreLeft({person}, {found});
  EXPECT_EQ(score.recall.num_found, 1u);
  EXPECT_EQ(score.num_exchanged, 0u);
}

TEST(DetectionReportTest, ADetectionOfThreeJointsIsNone) {
  BodyKeypoints three = Found(kFar);
  for (std::size_t joint = 3; joint < three.size(); ++joint) three[joint].confidence = 0.09;
  BodyKeypoints four = three;
  four[3].confidence = 0.1;
  const ImageScore score = ScoreLeft({Person(kNear)}, {three, four});
  EXPECT_EQ(score.num_detections, 1u);
  EXPECT_EQ(score.num_unusable, 1u);
  EXPECT_EQ(score.num_false, 1u);
}

TEST(DetectionReportTest, WhatThereIsToSee) {
  // The image ends 5 m beside the middle at 5 m; half of fourteen joints is seven.
  const std::vector<TruePersonState> truth = {Person(kNear, 7), Person(kMiddle, 6),
                                              Person({-5, 0, 5}, 9), Person({2, 0, 5})};
  const ImageScore score = ScoreLeft(truth, {Found(kMiddle), Found({2, 0, 5})});
  const auto of = [&](Sight sight) {
    return score.recall_by_sight[static_cast<std::size_t>(sight)];
  };
  EXPECT_EQ(of(Sight::kWhole).num_people, 2u);
  EXPECT_EQ(of(Sight::kWhole).num_found, 1u);
  EXPECT_EQ(of(Sight::kHidden).num_people, 1u);
  EXPECT_EQ(of(Sight::kHidden).num_found, 1u);
  EXPECT_EQ(of(Sight::kCutOff).num_people, 1u);
  EXPECT_EQ(of(Sight::kCutOff).num_found, 0u);
}

TEST(DetectionReportTest, WithoutVisibilityTheImageDecides) {
  // Joints at -5.25 to -4.75 m; the image begins at -5 m and shows those from there on: nose, neck,
  // left shoulder, elbow and wrist, left hip, knee and ankle.
  TruePersonState person;
  person.joints = Body({-5, 0, 5});
  const DetectorScore score =
      Score(Frame({person}, {Found({-5, 0, 5})}, {Found({-5, 0, 5}, kRightImage)}));
  EXPECT_EQ(score.images[kLeftImage].recall.num_found, 1u);
  EXPECT_EQ(score.images[kLeftImage].joint_px.count, 8u);
  // The right camera is half a metre to the right, so that nothing is left.
  EXPECT_EQ(score.images[kRightImage].recall.num_people, 0u);
  EXPECT_EQ(score.images[kRightImage].num_on_others, 1u);
}

TEST(DetectionReportTest, NobodyBehindTheCameraIsToBeSeen) {
  TruePersonState behind;
  behind.joints = Body({0, 0, -5});
  const ImageScore score = ScoreLeft({behind}, {Found(kNear)});
  EXPECT_EQ(score.recall.num_people, 0u);
  EXPECT_EQ(score.num_false, 1u);
  EXPECT_EQ(score.num_doubles, 0u);
}

TEST(DetectionReportTest, AnImageOfWhichNothingIsKnownDoesNotCount) {
  DetectionFrame frame = Frame({Person(kNear)}, {Found(kNear)});
  frame.detected[kRightImage].reset();
  const DetectorScore score = Score(frame);
  EXPECT_EQ(score.images[kLeftImage].num_images, 1u);
  EXPECT_EQ(score.images[kRightImage].num_images, 0u);
  EXPECT_EQ(score.images[kRightImage].recall.num_people, 0u);
}

TEST(DetectionReportTest, AgainstGivenPeopleWithoutATruth) {
  DetectionFrame frame;
  frame.detected = {
      People{Found(kNear, kLeftImage, {5, 0}), Found(kFar), Found({3, 0, 6}), Found({-3, 0, 6})},
      People{}};
  frame.given = {People{Found(kFar), Found(kNear), Found(kMiddle)},
                 People{Found(kNear, kRightImage)}};
  const DetectionReport report = EvaluateDetections(kCamera, {frame, frame});
  EXPECT_FALSE(report.detected);
  EXPECT_FALSE(report.given);
  const AgreementScore& left = report.agreement.value()[kLeftImage];
  EXPECT_EQ(left.num_images, 2u);
  EXPECT_EQ(left.recall.num_people, 6u);
  EXPECT_EQ(left.recall.num_found, 4u);
  EXPECT_EQ(left.recall_by_depth[1].num_people, 2u);
  EXPECT_EQ(left.recall_by_depth[1].num_found, 0u);
  EXPECT_EQ(left.num_detections, 8u);
  EXPECT_EQ(left.num_without_partner, 4u);
  EXPECT_NEAR(left.without_partner_per_image(), 2, 1e-9);
  EXPECT_EQ(report.agreement.value()[kRightImage].recall.num_people, 2u);
  EXPECT_EQ(report.agreement.value()[kRightImage].recall.num_found, 0u);
}

TEST(DetectionReportTest, GivenPeopleAreComparedWithTheTruthToo) {
  DetectionFrame frame = Frame({Person(kNear), Person(kMiddle)}, {Found(kNear)});
  frame.given = {People{Found(kMiddle), Found(kNear, kLeftImage, {0, 6}), Found(kFar)}, People{}};
  const DetectionReport report = EvaluateDetections(kCamera, {frame});
  EXPECT_EQ(report.detected->images[kLeftImage].recall.num_found, 1u);
  EXPECT_EQ(report.given->images[kLeftImage].recall.num_found, 2u);
  EXPECT_EQ(report.given->images[kLeftImage].num_false, 1u);
  EXPECT_NEAR(report.given->images[kLeftImage].joint_px_by_depth[0].median, 6, 1e-9);
}

TEST(DetectionReportTest, TheSizeOfAPersonInTheImage) {
  // Limbs of exactly the typical lengths, at 100 px/m: all of them point along one line.
  BodyKeypoints person;
  EXPECT_FALSE(StandingHeight(person, 0.1));
  person[kRightHip] = {200, 300, 0.9};
  EXPECT_FALSE(StandingHeight(person, 0.1));
  person[kRightKnee] = {200, 343, 0.9};
  person[kRightAnkle] = {200, 343 + 42, 0.9};
  EXPECT_NEAR(StandingHeight(person, 0.1).value(), 170, 1e-9);
  // One that points towards the camera, and one that is not known, change nothing.
  person[kLeftHip] = {200, 300, 0.9};
  person[kLeftKnee] = {200, 390, 0.05};
  EXPECT_NEAR(StandingHeight(person, 0.1).value(), 170, 1e-9);
}

TEST(DetectionReportTest, PeopleOfOtherImagesAreSuspected) {
  const std::vector<DetectionFrame> eighteen(18, Frame({Person(kNear)}, {Found(kFar)}));
  std::vector<DetectionFrame> frames = eighteen;
  frames.push_back(Frame({Person(kNear)}, {Found(kNear)}));
  EXPECT_TRUE(DoubtsAbout(EvaluateDetections(kCamera, frames)).empty());  // too few to say
  frames.push_back(Frame({Person(kNear)}, {Found(kMiddle)}));
  const Remarks doubts = DoubtsAbout(EvaluateDetections(kCamera, frames));
  ASSERT_EQ(doubts.size(), 1u);
  EXPECT_TRUE(doubts[0].is_warning);
  EXPECT_EQ(doubts[0].text.find("only 1 of 20 detections are on a person"), 0u);
  frames.back() = Frame({Person(kNear)}, {Found(kNear)});
  EXPECT_TRUE(DoubtsAbout(EvaluateDetections(kCamera, frames)).empty());
  for (DetectionFrame& frame : frames) {
    frame.truth.reset();
    frame.given = {People{Found(kMiddle)}, People{}};
  }
  EXPECT_EQ(DoubtsAbout(EvaluateDetections(kCamera, frames)).size(), 1u);
}

TEST(DetectionReportTest, TextAndJson) {
  DetectionFrame frame =
      Frame({Person(kNear), Person(kMiddle)}, {Found(kNear, kLeftImage, {3, 4}), Found(kFar)},
            {Found(kNear, kRightImage)});
  frame.given = frame.detected;
  const DetectionReport report = EvaluateDetections(kCamera, {frame});
  const std::string text = ToTable(report);
  EXPECT_NE(text.find("  below 6 m                       1        1   100.0 %       14      5.00"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find("  6 to 12 m                       1        0     0.0 %        0         -"),
            std::string::npos);
  EXPECT_NE(text.find("false: 1.00 an image, 1 in all: 0 second ones"), std::string::npos);
  EXPECT_NE(text.find("detected people, against the given ones"), std::string::npos);
  EXPECT_EQ(text.find("\n\n\n"), std::string::npos);
  EXPECT_EQ(text.back(), '\n');

  const nlohmann::json json = ToJson(report);
  EXPECT_EQ(json.at("frames"), 1);
  const nlohmann::json& left = json.at("detected").at("left");
  EXPECT_EQ(left.at("to_be_seen").at("people"), 2);
  EXPECT_EQ(left.at("to_be_seen").at("recall_percent"), 50);
  EXPECT_EQ(left.at("to_be_seen_by_depth").at("below 6 m").at("found"), 1);
  EXPECT_TRUE(left.at("to_be_seen_by_depth").at("from 12 m").at("recall_percent").is_null());
  EXPECT_EQ(left.at("to_be_seen_by_sight").at("in full view").at("people"), 2);
  EXPECT_NEAR(left.at("joint_error_px").at("median"), 5, 1e-9);
  EXPECT_EQ(left.at("false"), 1);
  EXPECT_NEAR(json.at("detected").at("disparity_error_px").at("median"), 3, 1e-9);
  EXPECT_EQ(json.at("detected_against_given").at("left").at("given").at("found"), 2);

  frame.truth.reset();
  const nlohmann::json bare = ToJson(EvaluateDetections(kCamera, {frame}));
  EXPECT_TRUE(bare.at("detected").is_null());
  EXPECT_TRUE(bare.at("given").is_null());
}

TEST(DetectionReportTest, NothingAtAll) {
  const DetectionReport report = EvaluateDetections(kCamera, {});
  EXPECT_EQ(report.num_frames, 0u);
  EXPECT_FALSE(report.detected || report.given || report.agreement);
  EXPECT_FALSE(ToTable(report).empty());
}

}  // namespace
}  // namespace airdos
