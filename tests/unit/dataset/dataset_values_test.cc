// What data sets say of their cameras and poses, number by number: none equal, none zero by chance.
#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>

#include "common/dataset/kitti_calibration.h"
#include "common/dataset/oxts.h"
#include "common/util/error.h"

namespace airdos {
namespace {

const KittiProjection kLeft{
    4, {721.5, 0.125, 609.5, 43.29, 0.25, 688.25, 172.75, 0.5, 0.75, 0.375, 1, 0.0625}};
// The right one's fourth number is 43.29 - 721.5 * 0.54.
const KittiProjection kRight{
    5, {721.5, 0.125, 609.5, -346.32, 0.25, 688.25, 172.75, 2.5, 0.75, 0.375, 1, 0.03}};

TEST(DatasetValuesTest, APairOfProjectionsIsACamera) {
  const StereoCamera camera = MakeStereoCamera("x.txt", kLeft, kRight, {1242, 375});
  EXPECT_EQ(camera.width, 1242);
  EXPECT_EQ(camera.height, 375);
  EXPECT_EQ(camera.fx_px, 721.5);
  EXPECT_EQ(camera.fy_px, 688.25);
  EXPECT_EQ(camera.cx_px, 609.5);
  EXPECT_EQ(camera.cy_px, 172.75);
  EXPECT_NEAR(camera.baseline_m, 0.54, 1e-12);
}

TEST(DatasetValuesTest, CamerasThatDifferOrAreExchangedAreNoPair) {
  for (const std::size_t i : {0u, 2u, 5u, 6u}) {
    KittiProjection right = kRight;
    right.p[i] *= 1 + 2e-6;
    EXPECT_THROW(MakeStereoCamera("x.txt", kLeft, right, {1242, 375}), InputError) << i;
    right.p[i] = kRight.p[i] * (1 + 1e-7);
    EXPECT_NO_THROW(MakeStereoCamera("x.txt", kLeft, right, {1242, 375})) << i;
  }
  EXPECT_THROW(MakeStereoCamera("x.txt", kRight, kLeft, {1242, 375}), InputError);
  EXPECT_THROW(MakeStereoCamera("x.txt", kLeft, kRight, {375, 1242}), InputError);
}

class OxtsValuesTest : public ::testing::Test {
 protected:
  void SetUp() override {
    path_ = (std::filesystem::temp_directory_path() / ("airdos_oxts_" + std::to_string(getpid())))
                .string();
  }
  void TearDown() override { std::filesystem::remove(path_); }
  std::string path_;
};

// Roll 0.3 about x, then pitch -0.2 about y, then yaw 0.7 about z.
TEST_F(OxtsValuesTest, ARowHasPlaceAndAllThreeAngles) {
  std::ofstream file(path_);
  file.precision(12);
  for (int row = 0; row < 2; ++row) {
    file << 49.5 + 1e-5 * row << " " << 8.25 + 2e-5 * row << " " << 115.5 + row << " 0.3 -0.2 0.7";
    for (int i = 6; i < 30; ++i) file << " " << i;
    file << "\n";
  }
  file.close();
  const std::vector<Se3> poses = ReadOxts(path_);
  ASSERT_EQ(poses.size(), 2u);
  const double cr = std::cos(0.3), sr = std::sin(0.3), cp = std::cos(-0.2), sp = std::sin(-0.2);
  const double cy = std::cos(0.7), sy = std::sin(0.7);
  Eigen::Matrix3d R;
  R << cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr,  //
      sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr,   //
      -sp, cp * sr, cp * cr;
  for (const Se3& pose : poses) EXPECT_LT((pose.rotation.toRotationMatrix() - R).norm(), 1e-9);
  // On the ground a degree of latitude is 111319.49 m of the sphere, of longitude cos(49.5) of it.
  const Eigen::Vector3d step = poses[1].translation - poses[0].translation;
  EXPECT_NEAR(step.x(), 2e-5 * 111319.49 * std::cos(49.5 * M_PI / 180), 1e-4);
  EXPECT_NEAR(step.y(), 1e-5 * 111319.49, 1e-4);
  EXPECT_NEAR(step.z(), 1, 1e-9);
}

}  // namespace
}  // namespace airdos
