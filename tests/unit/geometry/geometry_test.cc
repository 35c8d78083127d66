#include <gtest/gtest.h>

#include <limits>
#include <random>

#include "common/geometry/covariance.h"
#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {
namespace {

constexpr double kExact = 1e-12;  // a few roundings of numbers around 1

Vector6d RandomTangent(std::mt19937* generator, double scale) {
  std::normal_distribution<double> normal(0, scale);
  Vector6d delta;
  for (int i = 0; i < 6; ++i) delta[i] = normal(*generator);
  return delta;
}

TEST(MahalanobisTest, IsWhatOneWorksOutByHand) {
  Eigen::Matrix3d covariance;
  covariance << 4, 0, 0, 0, 2, 1, 0, 1, 2;  // the inverse of its lower block is [2 -1; -1 2] / 3
  EXPECT_NEAR(SquaredMahalanobis(Eigen::Vector3d(2, 1, 3), covariance), 1 + 14.0 / 3, kExact);
  Vector6d error;
  error << 1, 2, 3, 4, 5, 6;
  Matrix6d variances = Matrix6d::Zero();
  variances.diagonal() << 1, 4, 9, 16, 25, 36;
  EXPECT_NEAR(SquaredMahalanobis(error, variances), 6, kExact);
  variances(3, 3) = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(SquaredMahalanobis(error, variances) <= 6);
}

TEST(CovarianceTest, IsPropagatedByTheJacobian) {
  Eigen::Matrix3d J;
  J << 1, 2, 0, 0, 1, 0, 0, 0, 3;
  const Eigen::Matrix3d S = Eigen::Vector3d(1, 4, 2).asDiagonal();
  Eigen::Matrix3d expected;
  expected << 17, 8, 0, 8, 4, 0, 0, 0, 18;
  EXPECT_LT((Propagated(J, S) - expected).norm(), kExact);
  Matrix6d J6 = Matrix6d::Identity();
  J6.topLeftCorner<3, 3>() = J;
  Matrix6d S6 = Matrix6d::Identity();
  S6.topLeftCorner<3, 3>() = S;
  S6(4, 4) = 5;
  Matrix6d expected6 = Matrix6d::Identity();
  expected6.topLeftCorner<3, 3>() = expected;
  expected6(4, 4) = 5;
  EXPECT_LT((Propagated(J6, S6) - expected6).norm(), kExact);
  const Eigen::Matrix<double, 3, 6> upper = J6.topRows<3>();
  EXPECT_LT((Propagated(upper, S6) - expected).norm(), kExact);
  EXPECT_LT((Inverse(expected) * expected - Eigen::Matrix3d::Identity()).norm(), kExact);
  EXPECT_LT((Inverse(expected6) * expected6 - Matrix6d::Identity()).norm(), kExact);
}

TEST(CovarianceTest, SolvesWhatIsPositive) {
  Matrix6d H = Matrix6d::Identity();
  H(0, 1) = H(1, 0) = 0.5;
  Vector6d x;
  x << 1, -2, 3, 4, 5, 6;
  EXPECT_LT((SolvePositive(H, H * x).value() - x).norm(), kExact);
  H(5, 5) = -1;
  EXPECT_EQ(SolvePositive(H, x), std::nullopt);
}

TEST(Se3Test, BoxplusAndBoxminusAreInverse) {
  std::mt19937 generator(1);
  for (const double scale : {1e-9, 1e-4, 0.5}) {
    for (int i = 0; i < 20; ++i) {
      const Se3 T_A_B = Boxplus(Se3(), RandomTangent(&generator, 1.0));
      const Vector6d delta = RandomTangent(&generator, scale);
      EXPECT_LT((Boxminus(Boxplus(T_A_B, delta), T_A_B) - delta).norm(), kExact);
    }
  }
}

TEST(Se3Test, ComposesLikeMatrices) {
  std::mt19937 generator(2);
  const Se3 T_A_B = Boxplus(Se3(), RandomTangent(&generator, 1.0));
  const Se3 T_B_C = Boxplus(Se3(), RandomTangent(&generator, 1.0));
  EXPECT_LT(((T_A_B * T_B_C).matrix() - T_A_B.matrix() * T_B_C.matrix()).norm(), kExact);
  EXPECT_LT(((T_A_B * T_A_B.inverse()).matrix() - Eigen::Matrix4d::Identity()).norm(), kExact);
}

TEST(Se3Test, RightJacobianMatchesCentralDifferences) {
  std::mt19937 generator(3);
  constexpr double kStep = 1e-6;
  for (const double scale : {1e-7, 0.1, 1.0}) {
    const Eigen::Vector3d v = RandomTangent(&generator, scale).head<3>();
    Eigen::Matrix3d numeric;
    for (int i = 0; i < 3; ++i) {
      const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
      numeric.col(i) = LogSo3(ExpSo3(v - d).conjugate() * ExpSo3(v + d)) / (2 * kStep);
    }
    EXPECT_LT((RightJacobianSo3(v) - numeric).norm(), 1e-8);
    EXPECT_LT(
        (RightJacobianSo3(v) * RightJacobianInverseSo3(v) - Eigen::Matrix3d::Identity()).norm(),
        1e-9);
  }
}

TEST(StereoCameraTest, ProjectsAndTriangulates) {
  const StereoCamera camera{640, 360, 700, 710, 320, 180, 0.25};
  const Eigen::Vector3d uvu = camera.ProjectStereo({1, 0.5, 5});
  EXPECT_NEAR(uvu.x(), 460, kExact * 1e3);
  EXPECT_NEAR(uvu.y(), 251, kExact * 1e3);
  EXPECT_NEAR(uvu.z(), 425, kExact * 1e3);
  EXPECT_LT((*camera.Triangulate(460, 251, 425) - Eigen::Vector3d(1, 0.5, 5)).norm(), kExact * 1e3);
  EXPECT_FALSE(camera.Triangulate(100, 100, 100));
}

TEST(StereoCameraTest, JacobianMatchesCentralDifferences) {
  const StereoCamera camera{640, 360, 700, 710, 320, 180, 0.25};
  const Eigen::Vector3d p_C(1.3, -0.4, 6);
  constexpr double kStep = 1e-5;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d d = kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d numeric =
        (camera.ProjectStereo(p_C + d) - camera.ProjectStereo(p_C - d)) / (2 * kStep);
    EXPECT_LT((camera.ProjectStereoJacobian(p_C).col(i) - numeric).norm(), 1e-6);
  }
}

TEST(StereoCameraTest, RejectsCalibrationsWithoutMeaning) {
  const StereoCamera good{640, 360, 700, 710, 320, 180, 0.25};
  EXPECT_TRUE(good.IsValid());
  StereoCamera bad = good;
  bad.baseline_m = -0.25;
  EXPECT_FALSE(bad.IsValid());
  bad = good;
  bad.fx_px = std::numeric_limits<double>::quiet_NaN();
  EXPECT_FALSE(bad.IsValid());
}

}  // namespace
}  // namespace airdos
