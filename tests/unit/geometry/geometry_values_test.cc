// Rotations, poses and the stereo camera by values worked by hand, none of them equal by chance.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <cmath>
#include <limits>
#include <utility>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {
namespace {

constexpr double kExact = 1e-12;  // a few roundings of numbers around 1
const StereoCamera kCamera{641, 363, 700, 650, 310, 190, 0.25};

TEST(GeometryValuesTest, ARotationTurnsTheRightWayRound) {
  // A quarter turn about z takes x to y, one about x takes y to z.
  EXPECT_LT(
      (ExpSo3({0, 0, M_PI / 2}) * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(-2, 1, 3)).norm(),
      kExact);
  EXPECT_LT(
      (ExpSo3({M_PI / 2, 0, 0}) * Eigen::Vector3d(1, 2, 3) - Eigen::Vector3d(1, -3, 2)).norm(),
      kExact);
  // v = (0.3, -0.4, 1.2) has length 1.3.
  const Eigen::Quaterniond q = ExpSo3({0.3, -0.4, 1.2});
  EXPECT_NEAR(q.w(), std::cos(0.65), kExact);
  EXPECT_LT((q.vec() - std::sin(0.65) / 1.3 * Eigen::Vector3d(0.3, -0.4, 1.2)).norm(), kExact);
  const Eigen::Vector3d tiny(1e-7, -2e-7, 3e-7);
  EXPECT_LT((ExpSo3(tiny).vec() - 0.5 * tiny).norm(), 1e-20);
  EXPECT_LT((LogSo3(ExpSo3(tiny)) - tiny).norm(), 1e-20);
}

TEST(GeometryValuesTest, TheLogarithmGoesTheShorterWayRound) {
  const Eigen::Vector3d v(0.3, -0.4, 1.2);
  const Eigen::Quaterniond q = ExpSo3(v);
  EXPECT_LT((LogSo3(Eigen::Quaterniond(-q.coeffs())) - v).norm(), kExact);
  // 200 degrees about z are -160.
  EXPECT_NEAR(LogSo3(ExpSo3({0, 0, 200 * M_PI / 180})).z(), -160 * M_PI / 180, kExact);
  const Eigen::Vector3d tiny(1e-7, -2e-7, 3e-7);
  EXPECT_LT((LogSo3(Eigen::Quaterniond(-ExpSo3(tiny).coeffs())) - tiny).norm(), 1e-20);
}

TEST(GeometryValuesTest, SkewIsTheCrossProduct) {
  // (1, 2, 3) x (4, 5, 7) = (2*7 - 3*5, 3*4 - 1*7, 1*5 - 2*4)
  EXPECT_EQ(Skew({1, 2, 3}) * Eigen::Vector3d(4, 5, 7), Eigen::Vector3d(-1, 5, -3));
}

// About z by angle a: Jr = [sin a / a, (1 - cos a) / a, 0; -(1 - cos a) / a, sin a / a, 0; 0 0 1].
TEST(GeometryValuesTest, TheRightJacobianAboutOneAxis) {
  for (const double a : {1.1, -0.7, 1e-6}) {
    const double s = std::sin(a) / a;
    const double c = a == 1e-6 ? 0.5 * a : (1 - std::cos(a)) / a;
    Eigen::Matrix3d expected;
    expected << s, c, 0, -c, s, 0, 0, 0, 1;
    EXPECT_LT((RightJacobianSo3({0, 0, a}) - expected).norm(), kExact) << a;
    EXPECT_LT((RightJacobianInverseSo3({0, 0, a}) - expected.inverse()).norm(), kExact) << a;
  }
}

TEST(GeometryValuesTest, PosesMoveAndInvert) {
  // A quarter turn about z, then a shift: (x, y, z) -> (-y + 1, x + 2, z + 3).
  const Se3 T_A_B{ExpSo3({0, 0, M_PI / 2}), {1, 2, 3}};
  EXPECT_LT((T_A_B * Eigen::Vector3d(4, 5, 6) - Eigen::Vector3d(-4, 6, 9)).norm(), kExact);
  EXPECT_LT((T_A_B.inverse() * Eigen::Vector3d(-4, 6, 9) - Eigen::Vector3d(4, 5, 6)).norm(),
            kExact);
  Eigen::Matrix4d matrix;
  matrix << 0, -1, 0, 1, 1, 0, 0, 2, 0, 0, 1, 3, 0, 0, 0, 1;
  EXPECT_LT((T_A_B.matrix() - matrix).norm(), kExact);
  // T_A_B * T_A_B: (4, 5, 6) -> (-4, 7, 9) -> (-6, -2, 12), one quarter turn more.
  EXPECT_LT(((T_A_B * T_A_B) * Eigen::Vector3d(4, 5, 6) - Eigen::Vector3d(-5, -2, 12)).norm(),
            kExact);
}

// The change is in the axes of the body: translation before rotation.
TEST(GeometryValuesTest, ATangentIsInTheBodysAxes) {
  const Se3 T_A_B{ExpSo3({0, 0, M_PI / 2}), {1, 2, 3}};
  Vector6d delta;
  delta << 0.1, 0.2, 0.3, 0.5, 0, 0;
  const Se3 moved = Boxplus(T_A_B, delta);
  EXPECT_LT((moved.translation - Eigen::Vector3d(0.8, 2.1, 3.3)).norm(), kExact);
  // B's y axis is turned about B's x axis; in A the axes are y, -x, z.
  const Eigen::Vector3d y_A = moved.rotation * Eigen::Vector3d::UnitY();
  EXPECT_LT((y_A - Eigen::Vector3d(-std::cos(0.5), 0, std::sin(0.5))).norm(), kExact);
  EXPECT_LT((Boxminus(moved, T_A_B) - delta).norm(), kExact);
}

TEST(StereoCameraValuesTest, ProjectsEachAxisWithItsOwnNumbers) {
  // x / z = 0.2, y / z = -0.1, disparity 700 * 0.25 / 5 = 35
  const Eigen::Vector3d p_C(1, -0.5, 5);
  EXPECT_LT((kCamera.ProjectStereo(p_C) - Eigen::Vector3d(450, 125, 415)).norm(), 1e-10);
  EXPECT_LT((kCamera.Project(p_C) - Eigen::Vector2d(450, 125)).norm(), 1e-10);
  EXPECT_LT((*kCamera.Triangulate(450, 125, 415) - p_C).norm(), 1e-10);
  EXPECT_FALSE(kCamera.Triangulate(450, 125, 450));
  EXPECT_FALSE(kCamera.Triangulate(450, 125, 451));
  EXPECT_FALSE(kCamera.Triangulate(std::nan(""), 125, 451));
}

// Against how Triangulate() moves when each of the three pixels does.
TEST(StereoCameraValuesTest, TheCovarianceIsThatOfThePixels) {
  const Eigen::Vector3d uvu(450, 125, 415);
  constexpr double kStep = 1e-4;
  Eigen::Matrix3d J;
  for (int i = 0; i < 3; ++i) {
    const Eigen::Vector3d a = uvu + kStep * Eigen::Vector3d::Unit(i);
    const Eigen::Vector3d b = uvu - kStep * Eigen::Vector3d::Unit(i);
    J.col(i) =
        (*kCamera.Triangulate(a.x(), a.y(), a.z()) - *kCamera.Triangulate(b.x(), b.y(), b.z())) /
        (2 * kStep);
  }
  const Eigen::Matrix3d expected = 0.49 * J * J.transpose();  // 0.7 px
  const Eigen::Matrix3d covariance = kCamera.TriangulationCovariance({1, -0.5, 5}, 0.7);
  EXPECT_LT((covariance - expected).norm(), 1e-6 * expected.norm());
  // Of the depth: z^2 / (fx b) * sqrt(2) * 0.7 px
  EXPECT_NEAR(std::sqrt(covariance(2, 2)), 25 / 175.0 * std::sqrt(2.0) * 0.7, 1e-9);
}

TEST(StereoCameraValuesTest, EachNumberMustMakeSense) {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_TRUE(kCamera.IsValid());
  for (double StereoCamera::*number :
       {&StereoCamera::fx_px, &StereoCamera::fy_px, &StereoCamera::cx_px, &StereoCamera::cy_px,
        &StereoCamera::baseline_m}) {
    for (const double value : {0.0, -1.0, kNan, kInfinity}) {
      StereoCamera camera = kCamera;
      camera.*number = value;
      EXPECT_FALSE(camera.IsValid()) << value;
    }
  }
  for (int StereoCamera::*size : {&StereoCamera::width, &StereoCamera::height}) {
    StereoCamera camera = kCamera;
    camera.*size = 0;
    EXPECT_FALSE(camera.IsValid());
  }
  StereoCamera camera = kCamera;
  camera.cx_px = 641;
  EXPECT_FALSE(camera.IsValid());
  camera = kCamera;
  camera.cy_px = 500;  // below the image, though not beyond its width
  EXPECT_FALSE(camera.IsValid());
  camera.cx_px = 640.9;
  camera.cy_px = 362.9;
  EXPECT_TRUE(camera.IsValid());
}

TEST(StereoCameraValuesTest, CamerasAreEqualInAllNumbersOrNot) {
  EXPECT_TRUE(kCamera == StereoCamera(kCamera));
  for (double StereoCamera::*number :
       {&StereoCamera::fx_px, &StereoCamera::fy_px, &StereoCamera::cx_px, &StereoCamera::cy_px,
        &StereoCamera::baseline_m}) {
    StereoCamera other = kCamera;
    other.*number += 1e-3;
    EXPECT_FALSE(kCamera == other);
  }
  for (int StereoCamera::*size : {&StereoCamera::width, &StereoCamera::height}) {
    StereoCamera other = kCamera;
    ++(other.*size);
    EXPECT_FALSE(kCamera == other);
  }
}

TEST(StereoCameraValuesTest, TheImageHasItsBorders) {
  for (const auto& [u, v] : {std::pair(0.5, 0.5), {639.5, 0.5}, {0.5, 361.5}, {639.5, 361.5}})
    EXPECT_TRUE(kCamera.IsInImage({u, v})) << u << " " << v;
  for (const auto& [u, v] : {std::pair(-1.5, 100.0), {642.0, 100.0}, {100.0, -1.5}, {100.0, 364.0}})
    EXPECT_FALSE(kCamera.IsInImage({u, v})) << u << " " << v;
}

}  // namespace
}  // namespace airdos
