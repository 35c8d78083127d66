#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <initializer_list>
#include <optional>
#include <vector>

#include "common/human/disparity_refiner.h"
#include "common/human/joint_triangulator.h"
#include "common/human/layouts.h"
#include "common/human/person_pairing.h"

// Costs, gates and covariances of people in two images, worked by hand: just below and just above.

namespace airdos {
namespace {

const StereoCamera kCamera{640, 360, 770, 700, 320, 180, 0.25};
constexpr double kFocalBaseline = 192.5;  // px m
constexpr double kPerson_px = 38.5;       // at 5 m

/// Two pixels, whoever it is; 1.9 times as much at a confidence of 0.6.
KeypointNoise TwoPixels() {
  KeypointNoise noise;
  noise.min_px = 2;
  noise.per_height = 0;
  noise.full_confidence = 0.85;
  noise.per_confidence = 3.6;
  return noise;
}

JointTriangulatorOptions Triangulating() {
  JointTriangulatorOptions options;
  options.noise = TwoPixels();
  return options;
}

struct Pair {
  BodyKeypoints left, right;
};

/// The nose alone, `disparity_px` apart and `rows_px` off in the right image.
Pair Nose(double disparity_px, double rows_px = 0, double left = 0.9, double right = 0.9) {
  Pair pair;
  pair.left[kNose] = {400, 200, left};
  pair.right[kNose] = {400 - disparity_px, 200 + rows_px, right};
  return pair;
}

std::optional<TriangulatedJoint> Triangulate(const JointTriangulatorOptions& options,
                                             const Pair& pair, double person_px,
                                             const StereoImages& images = {}) {
  return TriangulatePerson(options, kCamera, images, pair.left, pair.right, person_px)[kNose];
}

TEST(TriangulatorValues, RowsMayDifferBySoManySigmas) {
  const double limit_px = 4 * std::sqrt(8.0);
  EXPECT_TRUE(Triangulate(Triangulating(), Nose(kPerson_px, limit_px - 0.01), kPerson_px));
  EXPECT_FALSE(Triangulate(Triangulating(), Nose(kPerson_px, limit_px + 0.01), kPerson_px));
  EXPECT_FALSE(Triangulate(Triangulating(), Nose(kPerson_px, -limit_px - 0.01), kPerson_px));
}

TEST(TriangulatorValues, AJointIsNotFarFromItsPerson) {
  // Noise of both keypoints, and 0.3 m of depth at 5 m: 2.31 px.
  const double limit_px = 3.5 * std::hypot(std::sqrt(8.0), 0.3 * kPerson_px / 5);
  EXPECT_TRUE(Triangulate(Triangulating(), Nose(kPerson_px + limit_px - 0.01), kPerson_px));
  EXPECT_FALSE(Triangulate(Triangulating(), Nose(kPerson_px + limit_px + 0.01), kPerson_px));
  EXPECT_FALSE(Triangulate(Triangulating(), Nose(kPerson_px - limit_px - 0.01), kPerson_px));
}

TEST(TriangulatorValues, DepthsOutOfRangeAreNone) {
  EXPECT_TRUE(Triangulate(Triangulating(), Nose(kFocalBaseline / 39.9), 5));
  EXPECT_FALSE(Triangulate(Triangulating(), Nose(kFocalBaseline / 40.1), 5));
  EXPECT_TRUE(Triangulate(Triangulating(), Nose(kFocalBaseline / 0.51), 380));
  EXPECT_FALSE(Triangulate(Triangulating(), Nose(kFocalBaseline / 0.49), 380));
}

/// Of (u_left, v, u_right) in C, by differences.
Eigen::Matrix3d CovarianceC(const Eigen::Vector3d& uvu, const Eigen::Matrix3d& covariance_px2) {
  const auto point = [](const Eigen::Vector3d& at) {
    const double z = kFocalBaseline / (at[0] - at[2]);
    return Eigen::Vector3d((at[0] - 320) / 770 * z, (at[1] - 180) / 700 * z, z);
  };
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = 1e-4 * Eigen::Vector3d::Unit(i);
    J.col(i) = (point(uvu + d) - point(uvu - d)) / 2e-4;
  }
  return J * covariance_px2 * J.transpose();
}

TEST(TriangulatorValues, BothKeypointsSpeakByTheirConfidence) {
  const auto joint = Triangulate(Triangulating(), Nose(kPerson_px, 4, 0.85, 0.6), kPerson_px);
  ASSERT_TRUE(joint);
  const double left = 4, right = 3.8 * 3.8;  // px^2
  const double v_px = (200 / left + 204 / right) / (1 / left + 1 / right);
  EXPECT_NEAR(joint->u_left_px, 400, 1e-9);
  EXPECT_NEAR(joint->u_right_px, 361.5, 1e-9);
  EXPECT_NEAR(joint->v_px, v_px, 1e-9);
  EXPECT_EQ(joint->confidence, 0.6) << "the lower one";
  EXPECT_NEAR(joint->sigma_px, std::sqrt((left + right) / 2), 1e-9);
  EXPECT_LT((joint->p_C - Eigen::Vector3d(80 / 154., (v_px - 180) / 140, 5)).norm(), 1e-9);
  const Eigen::Vector3d variances((left + right) / 2, 1 / (1 / left + 1 / right),
                                  (left + right) / 2);
  const Eigen::Matrix3d expected = CovarianceC({400, v_px, 361.5}, variances.asDiagonal());
  EXPECT_LT((joint->covariance_C - expected).norm(), 1e-6 * expected.norm());
}

/// A wall of texture as the camera sees it that far to the right.
cv::Mat Wall(double shift_px, double contrast = 1) {
  cv::Mat image(kCamera.height, kCamera.width, CV_8UC1);
  for (int v = 0; v < image.rows; ++v) {
    for (int u = 0; u < image.cols; ++u) {
      const double x = u + shift_px;
      image.at<unsigned char>(v, u) = static_cast<unsigned char>(std::lround(
          128 + contrast * (40 * std::sin(0.31 * x + 0.2 * v) + 20 * std::cos(0.53 * x - 0.41 * v) +
                            30 * std::sin(0.17 * x * (1 + 0.002 * v)))));
    }
  }
  return image;
}

TEST(TriangulatorValues, AMeasuredDisparityCountsAndLiesBehindTheSurface) {
  const StereoImages images{Wall(0), Wall(kPerson_px)};
  // The right keypoint is 6 px off, which the images know better.
  const auto joint = Triangulate(Triangulating(), Nose(kPerson_px - 6), kPerson_px, images);
  ASSERT_TRUE(joint);
  const double disparity_px = kFocalBaseline / 5.05;  // 5 cm behind what is seen at 5 m
  EXPECT_NEAR(joint->p_C.z(), 5.05, 0.02);            // a tenth of a pixel is 1.3 cm
  // The middle of 400 and 367.5 + the disparity.
  EXPECT_NEAR(joint->u_left_px, 0.5 * (400 + 367.5 + disparity_px), 0.1);
  EXPECT_NEAR(joint->u_left_px - joint->u_right_px, disparity_px, 0.1);
  EXPECT_NEAR(joint->sigma_px, std::sqrt(2.0), 1e-9);
  Eigen::Matrix3d covariance_px2;  // Var(u_left - u_right) = 0.4^2
  covariance_px2 << 2, 0, 1.92, 0, 2, 0, 1.92, 0, 2;
  const Eigen::Matrix3d expected =
      CovarianceC({joint->u_left_px, joint->v_px, joint->u_right_px}, covariance_px2);
  EXPECT_LT((joint->covariance_C - expected).norm(), 1e-6 * expected.norm());

  // Hidden joints are not on the surface.
  const auto hidden =
      Triangulate(Triangulating(), Nose(kPerson_px - 6, 0, 0.9, 0.39), kPerson_px, images);
  ASSERT_TRUE(hidden);
  EXPECT_NEAR(hidden->p_C.z(), kFocalBaseline / (kPerson_px - 6), 1e-9);
  JointTriangulatorOptions options = Triangulating();
  options.is_refined = false;
  EXPECT_NEAR(Triangulate(options, Nose(kPerson_px - 6), kPerson_px, images)->p_C.z(),
              kFocalBaseline / (kPerson_px - 6), 1e-9);
}

TEST(TriangulatorValues, OneKeypointIsWidenedByTheFactor) {
  const StereoImages images{Wall(0), Wall(kPerson_px)};
  const auto joints =
      TriangulateLeftOnly(Triangulating(), kCamera, images, Nose(0).left, kPerson_px + 1, 1.75);
  ASSERT_TRUE(joints[kNose]);
  EXPECT_NEAR(joints[kNose]->sigma_px, 3.5, 1e-9);
  EXPECT_NEAR(joints[kNose]->p_C.z(), 5.05, 0.02);
  EXPECT_EQ(joints[kNose]->u_left_px, 400);
}

/// How many go of a neck and a nose `length_m` apart (0.25 m is typical), with sigmas along it of
/// 1 and 2 cm.
int NumRemoved(double length_m) {
  JointObservations joints;
  joints[kNeck].emplace();
  joints[kNose].emplace();
  joints[kNeck]->covariance_C = Eigen::Vector3d(0.01, 1e-4, 0.01).asDiagonal();
  joints[kNose]->covariance_C = Eigen::Vector3d(0.01, 4e-4, 0.01).asDiagonal();
  joints[kNeck]->confidence = 0.5;
  joints[kNose]->confidence = 0.4;
  joints[kNose]->p_C = {0, -length_m, 0};
  const int num_removed = RemoveImpossibleLimbs({}, &joints);
  EXPECT_EQ(joints[kNose].has_value(), num_removed == 0) << "the less confident one goes";
  EXPECT_TRUE(joints[kNeck]);
  return num_removed;
}

TEST(TriangulatorValues, ALimbIsBelievableWithinItsNoise) {
  const double margin_m = 3 * std::sqrt(5e-4);
  EXPECT_EQ(NumRemoved(1.6 * 0.25 + margin_m - 0.001), 0);
  EXPECT_EQ(NumRemoved(1.6 * 0.25 + margin_m + 0.001), 1);
  EXPECT_EQ(NumRemoved(0.35 * 0.25 - margin_m + 0.001), 0);
  EXPECT_EQ(NumRemoved(0.35 * 0.25 - margin_m - 0.001), 1);
}

PersonPairingOptions Matching() {
  PersonPairingOptions options;
  options.noise = TwoPixels();
  return options;
}

/// These joints, spread over the image so that no two are at one place, and exact.
Pair Joints(std::initializer_list<int> joints) {
  Pair pair;
  for (const int joint : joints) {
    const auto j = static_cast<std::size_t>(joint);
    pair.left[j] = {300 + 9.0 * joint, 100 + 13.0 * joint, 0.9};
    pair.right[j] = {300 + 9.0 * joint - kPerson_px, 100 + 13.0 * joint, 0.9};
  }
  return pair;
}

double CostOf(const Pair& pair, PersonPairingOptions options = Matching()) {
  const auto fit = FitPersonPair(options, kCamera, pair.left, pair.right);
  return fit ? fit->cost : -1;
}

TEST(PersonPairingValues, TheCostOfRowsAndDisparities) {
  // No segment has both ends among these: the size says nothing.
  const std::initializer_list<int> some = {kNose, kRightElbow, kLeftElbow, kRightKnee, kLeftAnkle};
  Pair pair = Joints(some);
  EXPECT_NEAR(CostOf(pair), 0, 1e-12);
  for (const int joint : some) pair.right[static_cast<std::size_t>(joint)].v_px += 4;
  EXPECT_NEAR(CostOf(pair), 1, 1e-9);  // 16 / 8, of two measurements
  pair.right[kNose].v_px += 100;
  EXPECT_NEAR(CostOf(pair), (4 * 2 + 8) / 10.0, 1e-9) << "an outlier counts as eight";
  pair = Joints(some);
  pair.right[kNose].u_px -= 3;
  // 0.2 m of depth at 5 m: 1.54 px.
  EXPECT_NEAR(CostOf(pair), 9 / (8 + 1.54 * 1.54) / 10, 1e-9);
  pair = Joints(some);
  pair.right[kNose].confidence = 0.09;
  EXPECT_NEAR(CostOf(pair), 0, 1e-12) << "four are enough";
  pair.right[kLeftAnkle].confidence = 0.09;
  EXPECT_EQ(CostOf(pair), -1);
}

TEST(PersonPairingValues, TheCostOfExchangedSides) {
  const Pair pair = Joints({kNose, kRightElbow, kLeftElbow, kRightWrist, kLeftWrist, kNeck});
  const auto cost = [&pair](SideSwap swap) {
    return FitPersonPair(Matching(), kCamera, pair.left, SwapSides(pair.right, swap));
  };
  EXPECT_EQ(cost(SideSwap::kLowerArms)->right_swap, SideSwap::kLowerArms);
  EXPECT_NEAR(cost(SideSwap::kLowerArms)->cost - cost(SideSwap::kNone)->cost, 0.15, 1e-9);
  const Pair shoulders = Joints({kNose, kRightShoulder, kLeftShoulder, kRightAnkle, kLeftAnkle});
  const auto all = FitPersonPair(Matching(), kCamera, shoulders.left,
                                 SwapSides(shoulders.right, SideSwap::kAll));
  EXPECT_EQ(all->right_swap, SideSwap::kAll);
  EXPECT_NEAR(all->cost, 0.3, 1e-9);
}

TEST(PersonPairingValues, TheCostOfAnotherSize) {
  // At 5 m a metre is 154 px. The longest of three ratios counts: half as long again.
  Pair pair;
  const auto put = [&pair](int joint, double x_m, double y_m) {
    const auto j = static_cast<std::size_t>(joint);
    pair.left[j] = {320 + 154 * x_m, 180 + 154 * y_m, 0.9};
    pair.right[j] = {320 + 154 * x_m - kPerson_px, 180 + 154 * y_m, 0.9};
  };
  put(kNeck, 0, 0);
  put(kRightShoulder, 0.18, 0);
  put(kLeftShoulder, -0.18, 0);
  put(kNose, 0, -0.25);
  EXPECT_NEAR(CostOf(pair), 0, 1e-9);
  put(kNose, 0, -0.375);
  EXPECT_NEAR(CostOf(pair), std::pow(std::log(1.5) / 0.3, 2) / 2, 1e-9);
}

TEST(RefinerValues, FaintTextureIsNone) {
  // The standard deviation of the three waves is sqrt(40^2 + 20^2 + 30^2) / sqrt(2): 38 grey
  // levels; a patch of 13 px sees less or more of it.
  for (const double deviation : {1.5, 6.0}) {
    const double contrast = deviation / 38;
    const auto found =
        RefineDisparity({}, Wall(0, contrast), Wall(8, contrast), {300, 150}, 8, 4, 200);
    EXPECT_EQ(found.has_value(), deviation > 3) << deviation;
  }
}

TEST(RefinerValues, WhatIsNotFoundOnTheWayBackIsNone) {
  // Left, two marks alike 14 px apart; the right image has only the second, a little clearer.
  const auto mark = [](double u, double v, double du, double contrast) {
    const double x = u - du, y = v - 60;
    return contrast * std::exp(-(x * x + y * y) / 30) * (1 + 0.3 * std::sin(x));
  };
  cv::Mat left(120, 200, CV_8UC1), right(120, 200, CV_8UC1);
  for (int v = 0; v < 120; ++v) {
    for (int u = 0; u < 200; ++u) {
      const double floor = 100 + 8 * std::sin(0.9 * u + 0.7 * v);
      left.at<unsigned char>(v, u) =
          static_cast<unsigned char>(floor + mark(u, v, 100, 60) + mark(u, v, 114, 120));
      right.at<unsigned char>(v, u) = static_cast<unsigned char>(100 + mark(u, v, 94, 120));
    }
  }
  DisparityRefinerOptions options;
  options.min_correlation = 0.3;
  EXPECT_TRUE(RefineDisparity(options, left, right, {114, 60}, 20, 16, 200));
  EXPECT_FALSE(RefineDisparity(options, left, right, {100, 60}, 6, 16, 200));
  options.max_return_error_px = 100;
  EXPECT_TRUE(RefineDisparity(options, left, right, {100, 60}, 6, 16, 200));
}

TEST(LayoutValues, EachJointComesFromItsPlace) {
  const auto columns = [](KeypointLayout layout) {
    std::vector<BodyKeypoint> detection;
    for (int i = 0; i < NumKeypoints(layout); ++i)
      detection.push_back({1.0 * i, 0, 0.5 + i / 100.});
    const std::optional<BodyKeypoints> body = MapToBody(layout, detection);
    std::vector<double> columns_px;
    for (std::size_t joint = 0; body && joint < body->size(); ++joint) {
      columns_px.push_back((*body)[joint].u_px);
    }
    return columns_px;
  };
  // nose, neck; shoulder, elbow, wrist right and left; hip, knee, ankle right and left
  EXPECT_EQ(columns(KeypointLayout::kCoco17),
            (std::vector<double>{0, 5.5, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15}));
  EXPECT_EQ(columns(KeypointLayout::kHalpe26),
            (std::vector<double>{0, 18, 6, 8, 10, 5, 7, 9, 12, 14, 16, 11, 13, 15}));
  EXPECT_EQ(columns(KeypointLayout::kCoco18),
            (std::vector<double>{0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13}));
}

}  // namespace
}  // namespace airdos
