#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <random>

#include "common/human/disparity_refiner.h"
#include "common/human/joint_triangulator.h"
#include "common/human/person_pairing.h"
#include "tests/support/synthetic_people.h"

namespace airdos {
namespace {

BodyKeypoints Exact(const Joints3d& joints, bool is_right) {
  std::mt19937 random(1);
  return Detect(kTestCamera, joints, is_right, 0, &random);
}

TEST(PersonPairing, NobodyAnywhere) {
  const PersonPairing pairing = PairPeople({}, kTestCamera, {}, {});
  EXPECT_TRUE(pairing.pairs.empty());
  const auto person = Exact(WalkingPerson({0, 0, 5}, 0), false);
  const PersonPairing one_sided = PairPeople({}, kTestCamera, {person}, {});
  EXPECT_TRUE(one_sided.pairs.empty());
  EXPECT_EQ(one_sided.unpaired_left, std::vector<int>{0});
}

TEST(PersonPairing, PairsShuffledPeopleAndLeavesTheOthersAlone) {
  const auto near = WalkingPerson({-0.6, 0.1, 4}, 0.3);
  const auto middle = WalkingPerson({0.1, 0.1, 6}, 1.2);
  const auto far = WalkingPerson({0.5, 0.1, 9}, 2);
  const auto only_left = WalkingPerson({1.4, 0.1, 5}, 2);
  const PersonPairing pairing = PairPeople(
      {}, kTestCamera,
      {Exact(far, false), Exact(only_left, false), Exact(near, false), Exact(middle, false)},
      {Exact(near, true), Exact(middle, true), Exact(far, true)});
  ASSERT_EQ(pairing.pairs.size(), 3U);
  const std::vector<int> expected_right = {2, 0, 1};
  const std::vector<double> expected_depth = {9, 4, 6};
  for (std::size_t i = 0; i < 3; ++i) {
    EXPECT_EQ(pairing.pairs[i].right, expected_right[i]);
    EXPECT_EQ(pairing.pairs[i].right_swap, SideSwap::kNone);
    const double depth_m =
        kTestCamera.fx_px * kTestCamera.baseline_m / pairing.pairs[i].disparity_px;
    EXPECT_NEAR(depth_m, expected_depth[i], 0.05);
  }
  EXPECT_EQ(pairing.unpaired_left, std::vector<int>{1});
  EXPECT_TRUE(pairing.unpaired_right.empty());
}

TEST(PersonPairing, FindsExchangedSides) {
  const auto person = WalkingPerson({0, 0, 4}, 1);
  const BodyKeypoints left = Exact(person, false);
  for (const SideSwap swap : kSideSwaps) {
    const auto fit = FitPersonPair({}, kTestCamera, left, SwapSides(Exact(person, true), swap));
    ASSERT_TRUE(fit);
    EXPECT_EQ(fit->right_swap, swap);
    EXPECT_LT(fit->cost, 1);
  }
}

TEST(PersonPairing, RefusesWhatCannotBeOnePerson) {
  const auto left = Exact(WalkingPerson({0, 0, 5}, 0), false);
  // To the right of where it is in the left image: behind the camera.
  EXPECT_FALSE(FitPersonPair({}, kTestCamera, left, Exact(WalkingPerson({0.5, 0, 5}, 0), true)));
  // Disparity of 2 m but the size of 5 m.
  BodyKeypoints shifted = left;
  for (BodyKeypoint& joint : shifted) joint.u_px -= 770 * 0.25 / 2;
  const auto fit = FitPersonPair({}, kTestCamera, left, shifted);
  EXPECT_TRUE(!fit || fit->cost > PersonPairingOptions().max_mean_squared_sigmas);
  // Another row.
  BodyKeypoints lower = Exact(WalkingPerson({0, 0, 5}, 0), true);
  for (BodyKeypoint& joint : lower) joint.v_px += 15;
  EXPECT_GT(FitPersonPair({}, kTestCamera, left, lower)->cost,
            PersonPairingOptions().max_mean_squared_sigmas);
}

TEST(Triangulator, ExactWithoutNoise) {
  const auto person = WalkingPerson({0.4, 0.2, 5}, 1);
  const JointObservations joints =
      TriangulatePerson({}, kTestCamera, {}, Exact(person, false), Exact(person, true), 38.5);
  for (std::size_t joint = 0; joint < person.size(); ++joint) {
    ASSERT_TRUE(joints[joint]);
    EXPECT_NEAR((joints[joint]->p_C - person[joint]).norm(), 0, 1e-9);
  }
}

TEST(Triangulator, CovarianceMatchesTheScatter) {
  const auto person = WalkingPerson({0.4, 0.2, 5}, 1);
  std::mt19937 random(5);
  double sum = 0;
  int num = 0;
  const double sigma_px = KeypointNoise().Sigma(0.9, 770 * kPersonHeightM / 5);
  for (int trial = 0; trial < 300; ++trial) {
    const BodyKeypoints left = Detect(kTestCamera, person, false, sigma_px, &random);
    const BodyKeypoints right = Detect(kTestCamera, person, true, sigma_px, &random);
    const JointObservations joints = TriangulatePerson({}, kTestCamera, {}, left, right, 38.5);
    for (std::size_t joint = 0; joint < person.size(); ++joint) {
      if (!joints[joint]) continue;
      const Eigen::Vector3d error = joints[joint]->p_C - person[joint];
      sum += error.dot(joints[joint]->covariance_C.inverse() * error);
      ++num;
    }
  }
  EXPECT_GT(num, 300 * 13);
  EXPECT_NEAR(sum / num / 3, 1, 0.1);  // mean of a chi-square variable over its degrees of freedom
}

TEST(Triangulator, DropsTheImpossibleJointAndKeepsThePerson) {
  auto person = WalkingPerson({0, 0, 4}, 1);
  person[kRightWrist] += Eigen::Vector3d(0.9, 0, 0);
  const JointObservations joints =
      TriangulatePerson({}, kTestCamera, {}, Exact(person, false), Exact(person, true), 48);
  EXPECT_FALSE(joints[kRightWrist]);
  EXPECT_EQ(NumObserved(joints), kNumJoints - 1);
}

TEST(Triangulator, DropsJointsWhoseRowsOrDepthDisagree) {
  const auto person = WalkingPerson({0, 0, 4}, 1);
  BodyKeypoints right = Exact(person, true);
  right[kNose].v_px += 40;
  right[kLeftAnkle].u_px -= 60;
  right[kLeftKnee].confidence = 0;
  const JointObservations joints =
      TriangulatePerson({}, kTestCamera, {}, Exact(person, false), right, 48);
  EXPECT_FALSE(joints[kNose] || joints[kLeftAnkle] || joints[kLeftKnee]);
  EXPECT_EQ(NumObserved(joints), kNumJoints - 3);
}

// Random texture, blurred so that it can be interpolated, and the same moved left by `disparity`.
cv::Mat Texture(double shift_px) {
  cv::Mat image(120, 200, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double x = u + shift_px;
      image.at<unsigned char>(v, u) = static_cast<unsigned char>(
          128 + 40 * std::sin(0.31 * x + 0.2 * v) + 30 * std::sin(0.17 * x * (1 + 0.002 * v)) +
          20 * std::cos(0.53 * x - 0.41 * v));
    }
  }
  return image;
}

TEST(DisparityRefiner, FindsFractionsOfAPixel) {
  for (const double disparity_px : {7.0, 7.3, 8.5}) {
    const auto found = RefineDisparity({}, Texture(0), Texture(disparity_px), {100, 60}, 8, 4, 200);
    ASSERT_TRUE(found) << disparity_px;
    EXPECT_NEAR(*found, disparity_px, 0.1);
  }
}

TEST(DisparityRefiner, SaysNothingWithoutContrastOrOutside) {
  const cv::Mat flat(120, 200, CV_8UC1, cv::Scalar(90));
  EXPECT_FALSE(RefineDisparity({}, flat, flat, {100, 60}, 8, 4, 200));
  EXPECT_FALSE(RefineDisparity({}, Texture(0), Texture(8), {1, 60}, 8, 4, 200));
  EXPECT_FALSE(RefineDisparity({}, Texture(0), Texture(8), {std::nan(""), 60}, 8, 4, 200));
  EXPECT_FALSE(RefineDisparity({}, Texture(0), cv::Mat(), {100, 60}, 8, 4, 200));
  EXPECT_FALSE(RefineDisparity({}, Texture(0), Texture(8), {100, 60}, 17, 2, 200));  // far off
}

}  // namespace
}  // namespace airdos
