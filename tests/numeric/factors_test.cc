// Every factor: zero at the exact state, a value worked out by hand, and analytic derivatives
// against central differences taken along the manifold.
#include <ceres/cost_function.h>
#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

#include "common/optimization/factors/camera_acceleration_factor.h"
#include "common/optimization/factors/camera_point_factor.h"
#include "common/optimization/factors/human_factors.h"
#include "common/optimization/factors/reprojection_factor.h"
#include "common/optimization/solver/pose_manifold.h"

namespace airdos {
namespace {

constexpr double kExact = 1e-12;
constexpr double kStep = 1e-6;
constexpr double kRelative = 1e-6;  // of central differences with that step

using Blocks = std::vector<std::vector<double>>;

std::vector<double> Block(const Eigen::Vector3d& p) { return {p.x(), p.y(), p.z()}; }
std::vector<double> Block(const Se3& T) {
  const PoseBlock block = ToPoseBlock(T);
  return {block.begin(), block.end()};
}

std::vector<const double*> Pointers(const Blocks& blocks) {
  std::vector<const double*> pointers;
  for (const std::vector<double>& block : blocks) pointers.push_back(block.data());
  return pointers;
}

Eigen::VectorXd Residual(const ceres::CostFunction& factor, const Blocks& blocks) {
  Eigen::VectorXd r(factor.num_residuals());
  EXPECT_TRUE(factor.Evaluate(Pointers(blocks).data(), r.data(), nullptr));
  return r;
}

std::vector<double> Move(const std::vector<double>& block, int direction, double step) {
  std::vector<double> moved = block;
  if (block.size() == kPoseBlockSize) {
    const Vector6d delta = step * Vector6d::Unit(direction);
    PoseManifold().Plus(block.data(), delta.data(), moved.data());
  } else {
    moved[static_cast<std::size_t>(direction)] += step;
  }
  return moved;
}

/// Also that asking for one block's derivatives alone gives the same.
void ExpectDerivativesMatch(const ceres::CostFunction& factor, const Blocks& blocks) {
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  for (std::size_t i = 0; i < blocks.size(); ++i) {
    const int size = static_cast<int>(blocks[i].size());
    RowMajor analytic = RowMajor::Constant(factor.num_residuals(), size, std::nan(""));
    std::vector<double*> jacobians(blocks.size(), nullptr);
    jacobians[i] = analytic.data();
    Eigen::VectorXd r(factor.num_residuals());
    ASSERT_TRUE(factor.Evaluate(Pointers(blocks).data(), r.data(), jacobians.data()));
    const int tangent = size == kPoseBlockSize ? 6 : size;
    if (size == kPoseBlockSize) {
      EXPECT_EQ(analytic.col(6).norm(), 0.0);
    }
    for (int direction = 0; direction < tangent; ++direction) {
      Blocks plus = blocks, minus = blocks;
      plus[i] = Move(blocks[i], direction, kStep);
      minus[i] = Move(blocks[i], direction, -kStep);
      const Eigen::VectorXd numeric =
          (Residual(factor, plus) - Residual(factor, minus)) / (2 * kStep);
      EXPECT_LT((analytic.col(direction) - numeric).norm(), kRelative * (1 + numeric.norm()))
          << "block " << i << " direction " << direction;
    }
  }
}

Se3 RandomPose(std::mt19937* generator, double scale) {
  std::normal_distribution<double> normal(0, scale);
  Vector6d delta;
  for (int i = 0; i < 6; ++i) delta[i] = normal(*generator);
  return Boxplus(Se3(), delta);
}

const StereoCamera kCamera{640, 360, 700, 710, 320, 180, 0.25};

TEST(PoseManifoldTest, PlusAndMinusAreInverse) {
  std::mt19937 generator(1);
  const std::vector<double> x = Block(RandomPose(&generator, 1));
  const Vector6d delta = Boxminus(RandomPose(&generator, 0.3), Se3());
  PoseBlock y;
  PoseManifold().Plus(x.data(), delta.data(), y.data());
  Vector6d back;
  PoseManifold().Minus(y.data(), x.data(), back.data());
  EXPECT_LT((back - delta).norm(), kExact * 100);
}

TEST(ReprojectionFactorTest, IsZeroAtTheTruthAndKnowsItsUnits) {
  std::mt19937 generator(2);
  const Se3 T_W_C = RandomPose(&generator, 0.5);
  const Eigen::Vector3d p_C(0.4, -0.3, 5);
  const Blocks blocks = {Block(T_W_C), Block(T_W_C * p_C)};
  const ReprojectionFactor<3> exact(&kCamera, kCamera.ProjectStereo(p_C), 0.5);
  EXPECT_LT(Residual(exact, blocks).norm(), 1e-10);

  // By hand: (1, 0.5, 5) lands on u 460, v 251, u_right 425; 2 px away at sigma 0.5 px are 4.
  const Blocks origin = {Block(Se3()), Block(Eigen::Vector3d(1, 0.5, 5))};
  const Eigen::Vector3d uvu_px(458, 252, 425);
  EXPECT_LT(
      (Residual(ReprojectionFactor<3>(&kCamera, uvu_px, 0.5), origin) - Eigen::Vector3d(4, -2, 0))
          .norm(),
      1e-10);
  EXPECT_LT(
      (Residual(ReprojectionFactor<2>(&kCamera, uvu_px, 0.5), origin) - Eigen::Vector2d(4, -2))
          .norm(),
      1e-10);
}

TEST(ReprojectionFactorTest, DerivativesMatch) {
  std::mt19937 generator(3);
  for (int i = 0; i < 5; ++i) {
    const Se3 T_W_C = RandomPose(&generator, 1.0);
    const Eigen::Vector3d p_W = T_W_C * Eigen::Vector3d(0.5 * i - 1, 0.4, 3 + 2 * i);
    const Eigen::Vector3d uvu_px(300, 200, 280);
    ExpectDerivativesMatch(ReprojectionFactor<3>(&kCamera, uvu_px, 0.7),
                           {Block(T_W_C), Block(p_W)});
    ExpectDerivativesMatch(ReprojectionFactor<2>(&kCamera, uvu_px, 0.7),
                           {Block(T_W_C), Block(p_W)});
  }
}

TEST(ReprojectionFactorTest, APointBehindTheCameraIsALargeFiniteError) {
  const ReprojectionFactor<3> factor(&kCamera, {320, 180, 300}, 1);
  const Eigen::VectorXd r = Residual(factor, {Block(Se3()), Block(Eigen::Vector3d(0.1, 0.1, -2))});
  EXPECT_TRUE(r.allFinite());
  EXPECT_GT(r.norm(), 1000);
}

TEST(CameraPointFactorTest, ValueAndDerivatives) {
  std::mt19937 generator(7);
  const Se3 T_W_C = RandomPose(&generator, 0.5);
  const Eigen::Vector3d p_C(0.4, -0.3, 5);
  EXPECT_LT(Residual(CameraPointFactor(p_C, 0.05), {Block(T_W_C), Block(T_W_C * p_C)}).norm(),
            1e-10);
  // By hand: a camera at x = 1 m that looks along W's -x (a quarter turn about y) sees the point
  // 3 m before it at depth 3; 0.1 m more was measured, at sigma 0.05 m: -2.
  const Se3 turned{ExpSo3({0, -M_PI / 2, 0}), {1, 0, 0}};
  const Eigen::VectorXd r = Residual(CameraPointFactor({0, 0, 3.1}, 0.05),
                                     {Block(turned), Block(Eigen::Vector3d(-2, 0, 0))});
  EXPECT_LT((r - Eigen::Vector3d(0, 0, -2)).norm(), 1e-10);
  ExpectDerivativesMatch(CameraPointFactor({0.1, 0.2, 4}, 0.05),
                         {Block(T_W_C), Block(T_W_C * p_C)});
}

TEST(RigidityFactorTest, ValueAndDerivatives) {
  const RigidityFactor factor(0.02);
  const Eigen::Vector3d p_a(1, 2, 3), p_b(1, 2.3, 3.4);  // 0.5 m apart
  EXPECT_NEAR(Residual(factor, {Block(p_a), Block(p_b), {0.5}})[0], 0, kExact);
  EXPECT_NEAR(Residual(factor, {Block(p_a), Block(p_b), {0.46}})[0], 2, 1e-10);
  ExpectDerivativesMatch(factor, {Block(p_a), Block(p_b), {0.4}});
  // Joints in one place: no direction, but no NaN.
  std::vector<double> J(3, std::nan(""));
  double* jacobians[] = {J.data(), nullptr, nullptr};
  double r = 0;
  const Blocks same = {Block(p_a), Block(p_a), {0.5}};
  ASSERT_TRUE(factor.Evaluate(Pointers(same).data(), &r, jacobians));
  EXPECT_EQ(J, (std::vector<double>{0, 0, 0}));
}

TEST(LengthPriorFactorTest, ValueAndDerivatives) {
  const LengthPriorFactor factor(0.4, 0.05);
  EXPECT_EQ(Residual(factor, {{0.4}})[0], 0);
  EXPECT_NEAR(Residual(factor, {{0.5}})[0], 2, 1e-10);
  ExpectDerivativesMatch(factor, {{0.47}});
}

TEST(VelocityFactorTest, ValueAndDerivatives) {
  const VelocityFactor factor(0.1, 0.05);
  const Eigen::Vector3d p(1, 2, 3), v(1, 0, -2);
  EXPECT_LT(Residual(factor, {Block(p), Block(p + 0.1 * v), Block(v)}).norm(), 1e-10);
  // By hand: 0.1 m further than v says, at sigma 0.05 m: 2.
  const Eigen::Vector3d further = p + 0.1 * v + Eigen::Vector3d(0, 0.1, 0);
  EXPECT_LT(
      (Residual(factor, {Block(p), Block(further), Block(v)}) - Eigen::Vector3d(0, 2, 0)).norm(),
      1e-10);
  ExpectDerivativesMatch(factor, {Block(p), Block(further), Block(v)});
}

TEST(VelocitySmoothnessFactorTest, ValueAndDerivatives) {
  const VelocitySmoothnessFactor factor(0.25);
  const Eigen::Vector3d v(1, 0, -2), faster(1.5, 0, -2);
  EXPECT_EQ(Residual(factor, {Block(v), Block(v)}).norm(), 0);
  EXPECT_LT((Residual(factor, {Block(v), Block(faster)}) - Eigen::Vector3d(2, 0, 0)).norm(),
            kExact);
  ExpectDerivativesMatch(factor, {Block(v), Block(faster)});
}

TEST(VelocityPriorFactorTest, ZeroValueAndDerivatives) {
  const VelocityPriorFactor factor(0.5);
  EXPECT_EQ(Residual(factor, {Block(Eigen::Vector3d(0, 0, 0))}).norm(), 0);
  // By hand: 1 m/s at sigma 0.5 m/s are 2.
  EXPECT_LT(
      (Residual(factor, {Block(Eigen::Vector3d(1, -0.5, 0.25))}) - Eigen::Vector3d(2, -1, 0.5))
          .norm(),
      kExact);
  ExpectDerivativesMatch(factor, {Block(Eigen::Vector3d(0.7, -0.3, 1.2))});
}

TEST(PartMotionFactorTest, ValueAndDerivatives) {
  std::mt19937 generator(4);
  const Eigen::Vector3d centroid(5, -1, 7), p(5.2, -1.1, 7.3);
  const PartMotionFactor factor(centroid, 0.05);
  const Se3 motion = RandomPose(&generator, 0.4);
  const Eigen::Vector3d moved = motion.rotation * (p - centroid) + centroid + motion.translation;
  EXPECT_LT(Residual(factor, {Block(p), Block(moved), Block(motion)}).norm(), 1e-10);
  // By hand: a quarter turn about z takes (0.2, -0.1, 0.3) to (0.1, 0.2, 0.3).
  const Se3 quarter{ExpSo3({0, 0, M_PI / 2}), {0, 0, 0.1}};
  const Eigen::VectorXd r =
      Residual(factor, {Block(p), Block(Eigen::Vector3d(5.1, -0.7, 7.4)), Block(quarter)});
  EXPECT_LT((r - Eigen::Vector3d(0, 2, 0)).norm(), 1e-10);
  ExpectDerivativesMatch(factor, {Block(p), Block(moved + p), Block(motion)});
}

TEST(PartSmoothnessFactorTest, ValueAndDerivatives) {
  // Half the way and half the turn in half the time: the same velocity.
  const Se3 whole{ExpSo3({0, 0.2, 0}), {1, 0, 0.5}};
  const Se3 half{ExpSo3({0, 0.1, 0}), {0.5, 0, 0.25}};
  const PartSmoothnessFactor uneven(0.2, 0.1, 0.5, 0.4);
  EXPECT_LT(Residual(uneven, {Block(whole), Block(half)}).norm(), 1e-10);
  // By hand, steps of 0.1 s: 5 m/s less at sigma 0.5 m/s, 1 rad/s less at sigma 0.4 rad/s.
  const PartSmoothnessFactor even(0.1, 0.1, 0.5, 0.4);
  Vector6d expected;
  expected << -10, 0, -5, 0, -2.5, 0;
  EXPECT_LT((Residual(even, {Block(whole), Block(half)}) - expected).norm(), 1e-10);
  std::mt19937 generator(8);
  ExpectDerivativesMatch(uneven,
                         {Block(RandomPose(&generator, 0.5)), Block(RandomPose(&generator, 0.5))});
}

TEST(RotationDampingFactorTest, ValueAndDerivatives) {
  const Eigen::Vector3d axis = Eigen::Vector3d(1, 2, 2) / 3;
  const RotationDampingFactor factor(axis * axis.transpose() / 0.1);
  const Se3 about_axis{ExpSo3(0.3 * axis), {1, 2, 3}};
  const Se3 across{ExpSo3(0.3 * axis.unitOrthogonal()), {1, 2, 3}};
  EXPECT_EQ(Residual(factor, {Block(Se3())}).norm(), 0);
  EXPECT_NEAR(Residual(factor, {Block(about_axis)}).norm(), 3, 1e-10);
  EXPECT_NEAR(Residual(factor, {Block(across)}).norm(), 0, 1e-10);
  std::mt19937 generator(5);
  ExpectDerivativesMatch(factor, {Block(RandomPose(&generator, 0.5))});
}

TEST(CameraAccelerationFactorTest, ValueAndDerivatives) {
  const AccelerationSigma sigma{2.0, 5.0};
  // Constant velocity and turn, seen at uneven times: the middle frame is half a step late.
  const Eigen::Vector3d v(1, 0.5, -2), w(0.2, -0.1, 0.3);
  const auto at = [&](double time_s) { return Block(Se3{ExpSo3(time_s * w), time_s * v}); };
  const CameraAccelerationFactor uneven(0.15, 0.05, sigma);
  EXPECT_LT(Residual(uneven, {at(0), at(0.15), at(0.2)}).norm(), 1e-10);

  // By hand: steps of 0.1 s; the second is 4 cm longer and 0.1 rad further, so 4 m/s^2 and 10
  // rad/s^2.
  const CameraAccelerationFactor even(0.1, 0.1, sigma);
  const Se3 last{ExpSo3({0, 0.1, 0}), {0.24, 0, 0}};
  Vector6d expected;
  expected << 2, 0, 0, 0, 2, 0;
  EXPECT_LT((Residual(even, {Block(Se3()), Block(Se3{Eigen::Quaterniond::Identity(), {0.1, 0, 0}}),
                             Block(last)}) -
             expected)
                .norm(),
            1e-10);
  std::mt19937 generator(6);
  ExpectDerivativesMatch(uneven,
                         {Block(RandomPose(&generator, 0.5)), Block(RandomPose(&generator, 0.5)),
                          Block(RandomPose(&generator, 0.5))});
}

}  // namespace
}  // namespace airdos
