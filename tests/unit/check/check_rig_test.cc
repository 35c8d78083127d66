// A calibration against images that were taken through its lenses, and through others.
#include "common/check/check_rig.h"

#include <gtest/gtest.h>

#include <opencv2/imgproc.hpp>
#include <string>
#include <utility>
#include <vector>

#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

StereoRig MakeRig() {
  StereoRig rig;
  rig.left = {
      480, 360, 330, 328, 242, 178, LensModel::kRadialTangential, {-0.2, 0.03, 0.0004, 0.0007}};
  rig.right = {
      480, 360, 328, 327, 236, 184, LensModel::kRadialTangential, {-0.21, 0.035, -0.0003, 0.0004}};
  rig.T_L_R.rotation = ExpSo3({0.02, -0.01, 0.015});
  rig.T_L_R.translation = {0.2, 0.003, -0.004};
  return rig;
}

/// What the rig's cameras see of a world whose rectified images are known: each raw pixel shows
/// what lies where it is rectified to.
RawPair Record(const StereoRig& rig, double offset_m, double lower_m = 0) {
  const StereoRectifier rectifier(rig);
  StereoCamera wide = rectifier.camera();  // raw images see beyond the rectified ones
  const int margin_px = 160;
  wide.width += 2 * margin_px;
  wide.height += 2 * margin_px;
  wide.cx_px += margin_px;
  wide.cy_px += margin_px;
  Se3 T_W_C;
  T_W_C.translation.x() = offset_m;
  T_W_C.translation.y() = lower_m;
  const StereoPair ideal = RenderedScene(7).Render(wide, T_W_C);
  const auto take = [&](const cv::Mat& image, bool is_left) {
    cv::Mat x(360, 480, CV_32FC1);
    cv::Mat y(360, 480, CV_32FC1);
    for (int v = 0; v < 360; ++v) {
      for (int u = 0; u < 480; ++u) {
        const Eigen::Vector2d at =
            is_left ? rectifier.RectifyLeft({u, v}) : rectifier.RectifyRight({u, v});
        x.at<float>(v, u) = static_cast<float>(at.x() + margin_px);
        y.at<float>(v, u) = static_cast<float>(at.y() + margin_px);
      }
    }
    cv::Mat raw;
    cv::remap(image, raw, x, y, cv::INTER_LINEAR);
    return raw;
  };
  return {take(ideal.left, true), take(ideal.right, false)};
}

class CheckRigTest : public testing::Test {
 protected:
  static void SetUpTestSuite() { pairs_ = {Record(MakeRig(), 0), Record(MakeRig(), 0.4)}; }
  static std::vector<RawPair> pairs_;

  /// The findings for a rig and images, a line each.
  static std::string Judge(const StereoRig& rig, const std::vector<RawPair>& pairs) {
    FindingList findings;
    JudgeRigCheck(rig, pairs, MeasureRig(StereoRectifier(rig), pairs), "x.yaml", &findings);
    std::string text;
    for (const Finding& finding : findings.findings()) {
      text +=
          std::string(NameOf(finding.severity)) + " " + finding.kind + ": " + finding.what + "\n";
    }
    return text;
  }
  static void ExpectHas(const std::string& text, const std::string& part) {
    EXPECT_NE(text.find(part), std::string::npos) << "'" << text << "' lacks '" << part << "'";
  }
};
std::vector<RawPair> CheckRigTest::pairs_;

TEST_F(CheckRigTest, TheRightCalibrationFits) {
  const RigCheck check = MeasureRig(StereoRectifier(MakeRig()), pairs_);
  EXPECT_GT(check.before.median_px, 4);
  EXPECT_LT(check.after.median_px, 0.3);
  EXPECT_LT(check.after.share_negative, 0.05);
  EXPECT_GT(check.after.num_matches, 100);
  for (const double median_px : check.after.region_px) EXPECT_LT(median_px, 1);
  ExpectHas(Judge(MakeRig(), pairs_), "note rig.fits");
}

// The right image's top right third is two rows lower than it should be.
TEST_F(CheckRigTest, WhereRowsDifferIsMeasuredAndNamed) {
  StereoRig rig = MakeRig();
  rig.rectified = StereoCamera{480, 360, 330, 330, 240, 180, 0.2};
  rig.are_images_rectified = true;
  const RawPair good = {NoisePicture(480, 360, 5), NoisePicture(480, 360, 5, 4)};
  RawPair pair = {good.left, good.right.clone()};
  const cv::Rect corner(310, 0, 170, 125);
  NoisePicture(480, 360, 5, 4, -2)(corner).copyTo(pair.right(corner));
  const RigCheck check = MeasureRig(StereoRectifier(rig), {pair});
  for (std::size_t region = 0; region < 9; ++region)
    EXPECT_NEAR(check.after.region_px[region], region == 2 ? 2 : 0, 0.1) << region;
  ASSERT_EQ(check.after.pair_px.size(), 1u);
  EXPECT_LT(check.after.pair_px[0], 0.1);
}

TEST_F(CheckRigTest, ExchangedImagesAreNamed) {
  std::vector<RawPair> exchanged = pairs_;
  for (RawPair& pair : exchanged) std::swap(pair.left, pair.right);
  const std::string text = Judge(MakeRig(), exchanged);
  ExpectHas(text, "error rig.");
  ExpectHas(text, "exchanged");
}

TEST_F(CheckRigTest, ACalibrationOfAnotherResolutionIsNamed) {
  StereoRig doubled = MakeRig();
  for (CameraIntrinsics* camera : {&doubled.left, &doubled.right}) {
    *camera = Resized(*camera, {360, 270});
    camera->width = 480;
    camera->height = 360;
  }
  const std::string text = Judge(doubled, pairs_);
  ExpectHas(text, "error rig.rows");
  ExpectHas(text, "0.75 times as large (360x270 px): --size and --scale-calibration");
}

TEST_F(CheckRigTest, RectifiedImagesAreNamed) {
  const StereoRectifier rectifier(MakeRig());
  std::vector<RawPair> rectified;
  for (const RawPair& pair : pairs_)
    rectified.push_back({rectifier.Left(pair.left), rectifier.Right(pair.right)});
  const std::string text = Judge(MakeRig(), rectified);
  ExpectHas(text, "error rig.rows");
  ExpectHas(text, "rectified already");
}

// No calibration is right in some pairs and wrong in others.
TEST_F(CheckRigTest, PairsOfWhichSomeWereNotTakenAtOneTimeAreNamed) {
  const RawPair higher = Record(MakeRig(), 0, 0.12);
  const RawPair late = {pairs_[0].left, higher.right};
  const std::string some =
      Judge(MakeRig(), {pairs_[0], late, pairs_[1], pairs_[0], late, pairs_[1], pairs_[0]});
  ExpectHas(some, "note rig.fits");
  ExpectHas(some, "warning rig.times");
  const std::string most = Judge(MakeRig(), {late, pairs_[0], late, late, pairs_[1], late});
  ExpectHas(most, "error rig.rows");
  ExpectHas(most, "not all taken at one time");
}

TEST_F(CheckRigTest, AFisheyeLensThatWasTakenForAnotherIsNamed) {
  StereoRig rig = MakeRig();
  rig.left.lens = rig.right.lens = LensModel::kFisheye;
  rig.left.distortion = {-0.0137, 0.0207, -0.0128, 0.0025};
  rig.right.distortion = {-0.0085, 0.0114, -0.007, 0.0015};
  const std::vector<RawPair> pairs = {Record(rig, 0)};
  rig.left.lens = rig.right.lens = LensModel::kRadialTangential;
  rig.is_lens_assumed = true;
  ExpectHas(Judge(rig, pairs), "--lens fisheye");
}

TEST_F(CheckRigTest, AFileOfRectifiedImagesForOthersIsNamed) {
  StereoRig rig = MakeRig();
  rig.rectified = StereoRectifier(rig).camera();
  rig.are_images_rectified = true;
  ExpectHas(Judge(rig, pairs_), "the file is for rectified images, these are not");
}

TEST_F(CheckRigTest, ImagesOfDifferentTimesFitNothing) {
  const std::string text = Judge(MakeRig(), {{pairs_[0].left, NoisePicture(480, 360, 3)}});
  ExpectHas(text, "warning rig.few_matches");
}

}  // namespace
}  // namespace airdos
