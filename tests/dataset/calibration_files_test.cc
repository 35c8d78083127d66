// Calibration files that people have (user_files/calibration of the test data).
#include <gtest/gtest.h>

#include <cstdlib>
#include <filesystem>

#include "common/calibration/calibration_file.h"
#include "common/calibration/stereo_rectifier.h"
#include "common/util/error.h"

namespace airdos {
namespace {

class CalibrationFiles : public testing::Test {
 protected:
  void SetUp() override {
    const char* const given = std::getenv("AIRDOS_DATA_DIR");
    folder_ = std::string(given != nullptr ? given : AIRDOS_SOURCE_DIR "/../shared/data") +
              "/user_files/calibration/";
    if (!std::filesystem::exists(folder_))
      GTEST_SKIP() << "no calibration files in " << folder_ << " (AIRDOS_DATA_DIR)";
  }
  StereoRig Read(const std::vector<std::string>& names,
                 const CalibrationOptions& options = {}) const {
    std::vector<std::string> paths;
    for (const std::string& name : names) paths.push_back(folder_ + name);
    return ReadStereoRig(paths, options);
  }
  std::string Complaint(const std::vector<std::string>& names,
                        const CalibrationOptions& options = {}) const {
    try {
      Read(names, options);
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  }
  /// Rectifies, and says where the image's middle and a point between it and a corner come to lie:
  /// rows must nearly agree.
  static void ExpectRectifiable(const StereoRig& rig, double baseline_m) {
    const StereoRectifier rectifier(rig);
    EXPECT_NEAR(rectifier.camera().baseline_m, baseline_m, 0.002) << rig.format;
    EXPECT_GT(rectifier.camera().fx_px, 0.6 * rig.left.fx_px);
    EXPECT_LT(rectifier.camera().fx_px, 2 * rig.left.fx_px);
  }

  std::string folder_;
};

TEST_F(CalibrationFiles, Kalibr) {
  struct Case {
    const char* name;
    double baseline_m;  // as the data set's page or the file's translations say
    LensModel lens;
  };
  const Case cases[] = {{"kalibr_euroc_mav.yaml", 0.110, LensModel::kRadialTangential},
                        {"kalibr_kaist.yaml", 0.475, LensModel::kRadialTangential},
                        {"kalibr_rpng_ironsides.yaml", 0.0664, LensModel::kFisheye},
                        {"kalibr_rs_t265.yaml", 0.0627, LensModel::kFisheye},
                        {"kalibr_tum_vi.yaml", 0.101, LensModel::kFisheye},
                        {"kalibr_uzhfpv_indoor.yaml", 0.0796, LensModel::kFisheye}};
  for (const Case& c : cases) {
    SCOPED_TRACE(c.name);
    const StereoRig rig = Read({c.name});
    EXPECT_EQ(rig.left.lens, c.lens);
    ExpectRectifiable(rig, c.baseline_m);
  }
}

TEST_F(CalibrationFiles, RosAndZedAndOrbSlam) {
  ExpectRectifiable(Read({"ros_zed_left.yaml", "ros_zed_right.yaml"}), 0.5162);
  EXPECT_NE(Complaint({"ros_zed_left.yaml"}).find("of one camera"), std::string::npos);
  EXPECT_NE(Complaint({"ros_zed_right.yaml", "ros_zed_left.yaml"}).find("--swap"),
            std::string::npos);
  CalibrationOptions options;
  options.format.image_size = {1280, 720};
  ExpectRectifiable(Read({"zed_SN1267.conf"}, options), 0.12);
  EXPECT_NE(Complaint({"zed_SN1267.conf"}).find("2208x1242"), std::string::npos);
  const StereoRig kitti = Read({"orbslam2_kitti00.yaml"});
  EXPECT_TRUE(kitti.are_images_rectified);
  EXPECT_NEAR(kitti.rectified->baseline_m, 0.5371657, 1e-6);
}

TEST_F(CalibrationFiles, OneRigInTwoFormatsIsTheSame) {
  // ORB-SLAM2's file was made from the same calibration as Kalibr's.
  const StereoRig kalibr = Read({"kalibr_euroc_mav.yaml"});
  const StereoRig orb = Read({"orbslam2_euroc.yaml"});
  EXPECT_LT(Boxminus(kalibr.T_L_R, orb.T_L_R).norm(), 1e-4);
  const StereoRectifier a(kalibr);
  const StereoRectifier b(orb);
  for (const Eigen::Vector2d& uv : {Eigen::Vector2d(100, 100), {376, 240}, {700, 50}, {60, 440}}) {
    EXPECT_LT((a.RectifyLeft(uv) - b.RectifyLeft(uv)).norm(), 0.02);
    EXPECT_LT((a.RectifyRight(uv) - b.RectifyRight(uv)).norm(), 0.02);
  }
}

}  // namespace
}  // namespace airdos
