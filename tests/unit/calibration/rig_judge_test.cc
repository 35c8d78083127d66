// What a calibration file must say to be a stereo pair, and what is said where it does not.
#include "common/calibration/rig_judge.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <opencv2/core.hpp>

#include "common/calibration/calibration_file.h"
#include "common/calibration/stereo_rectifier.h"
#include "common/util/error.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

StereoRig MakeRig() {
  StereoRig rig;
  rig.left = {640,
              480,
              461.25,
              458.5,
              322.75,
              236.125,
              LensModel::kRadialTangential,
              {-0.28, 0.07, 0.0002, 0.00175}};
  rig.right = {640,
               480,
               457.5,
               456.125,
               318.5,
               243.25,
               LensModel::kRadialTangential,
               {-0.27, 0.065, -0.0003, 0.0011}};
  rig.T_L_R.rotation = ExpSo3({0.011, -0.023, 0.007});
  rig.T_L_R.translation = {0.112, 0.0021, -0.0034};
  rig.format = "test";
  return rig;
}

/// The line that is said about a changed rig; empty where it is taken.
std::string Complaint(const std::function<void(StereoRig*, CalibrationOptions*)>& change) {
  StereoRig rig = MakeRig();
  CalibrationOptions options;
  change(&rig, &options);
  try {
    JudgeRig("x.yaml", options, &rig);
  } catch (const InputError& error) {
    return error.what();
  }
  return "";
}

TEST(RigJudge, AGoodRigIsTakenAsItIs) {
  StereoRig rig = MakeRig();
  JudgeRig("x.yaml", {}, &rig);
  EXPECT_EQ(rig.T_L_R.translation, MakeRig().T_L_R.translation);
  EXPECT_TRUE(rig.notes.empty());
}

TEST(RigJudge, EachWrongRigIsRefusedWithItsReason) {
  using Change = std::function<void(StereoRig*, CalibrationOptions*)>;
  const std::vector<std::pair<Change, std::string>> cases = {
      {[](StereoRig* r, auto*) {
         r->T_L_R.translation = {0.01, 0.12, 0};
       },
       "one above the other"},
      {[](StereoRig* r, auto*) {
         r->T_L_R.translation = {0.01, 0, 0.12};
       },
       "one behind the other"},
      {[](StereoRig* r, auto*) { r->T_L_R.translation.x() = -0.112; }, "--swap"},
      {[](StereoRig* r, auto*) {
         r->T_L_R.rotation = ExpSo3({0, 1.5, 0});
       },
       "85.94 degrees apart"},
      {[](StereoRig* r, auto*) { r->T_L_R.translation *= 50; }, "neither m nor mm"},
      {[](StereoRig* r, auto*) { r->T_L_R.translation *= 0.01; }, "neither m nor mm"},
      {[](StereoRig* r, auto*) { r->left.fx_px = 1; }, "left camera: focal lengths of 1 and 458.5"},
      {[](StereoRig* r, auto*) { r->right.cy_px = 481; },
       "right camera: the principal point (318.5, 481)"},
      {[](StereoRig* r, auto*) { r->right.distortion.pop_back(); },
       "right camera: 3 distortion coefficients"},
      {[](StereoRig* r, auto*) { r->left.distortion[1] = 1e9; },
       "a distortion coefficient of 1e+09"},
      {[](StereoRig* r, auto*) { r->left.width = r->right.width = 30000; }, "are too large"},
      {[](StereoRig* r, auto*) { r->right.width = 320; },
       "differ in size (640x480 px and 320x480 px)"},
      {[](StereoRig* r, auto*) { r->right.lens = LensModel::kFisheye; }, "the lens models differ"},
      {[](StereoRig* r, auto*) {
         r->left.width = r->left.height = r->right.width = r->right.height = 0;
       },
       "--size"},
      {[](StereoRig*, CalibrationOptions* o) {
         o->format.calibrated_size = {320, 240};
       },
       "is for images of 640x480 px"},
      {[](StereoRig*, CalibrationOptions* o) {
         o->format.image_size = {320, 240};
       },
       "0.5 times as large"},
      {[](StereoRig*, CalibrationOptions* o) {
         o->format.image_size = {480, 640};
       },
       "width and height are exchanged"},
      {[](StereoRig*, CalibrationOptions* o) {
         o->format.image_size = {640, 400};
       },
       "another shape"},
      {[](StereoRig*, CalibrationOptions* o) { o->are_images_rectified = true; },
       "does not say how images are rectified"},
  };
  for (const auto& [change, expected] : cases) {
    const std::string complaint = Complaint(change);
    EXPECT_NE(complaint.find(expected), std::string::npos)
        << "'" << complaint << "' lacks '" << expected << "'";
    EXPECT_EQ(complaint.rfind("x.yaml: ", 0), 0u) << complaint;
    EXPECT_EQ(complaint.find('\n'), std::string::npos);
  }
}

TEST(RigJudge, MillimetresAreConvertedAndSaid) {
  StereoRig rig = MakeRig();
  rig.T_L_R.translation *= 1000;
  rig.rectified = StereoCamera{640, 480, 450, 450, 320, 240, 112};
  JudgeRig("x.yaml", {}, &rig);
  EXPECT_DOUBLE_EQ(rig.rectified->baseline_m, 0.112);
  EXPECT_LT((rig.T_L_R.translation - MakeRig().T_L_R.translation).norm(), 1e-12);
  ASSERT_EQ(rig.notes.size(), 1u);
  EXPECT_NE(rig.notes[0].find("in mm"), std::string::npos);
}

TEST(RigJudge, AUnitThatTheUserNamesIsTaken) {
  StereoRig rig = MakeRig();
  rig.T_L_R.translation *= 100;
  CalibrationOptions options;
  options.baseline_unit_m = 0.01;
  JudgeRig("x.yaml", options, &rig);
  EXPECT_LT((rig.T_L_R.translation - MakeRig().T_L_R.translation).norm(), 1e-12);
  EXPECT_TRUE(rig.notes.empty());
}

TEST(RigJudge, SwapExchangesTheCamerasAndTurnsThePoseRound) {
  StereoRig rig = Swapped(MakeRig());
  EXPECT_LT(rig.T_L_R.translation.x(), 0);
  CalibrationOptions options;
  options.swap = true;
  JudgeRig("x.yaml", options, &rig);
  EXPECT_LT(Boxminus(rig.T_L_R, MakeRig().T_L_R).norm(), 1e-12);
  EXPECT_EQ(rig.left.fx_px, MakeRig().left.fx_px);
}

TEST(RigJudge, ScaledImagesHaveScaledCameras) {
  StereoRig rig = MakeRig();
  CalibrationOptions options;
  options.format.image_size = {1280, 960};
  options.scale = true;
  JudgeRig("x.yaml", options, &rig);
  EXPECT_EQ(rig.left.width, 1280);
  EXPECT_DOUBLE_EQ(rig.left.fx_px, 922.5);
  EXPECT_DOUBLE_EQ(rig.right.fy_px, 912.25);
  EXPECT_DOUBLE_EQ(rig.left.cx_px, 646);   // (322.75 + 0.5) * 2 - 0.5
  EXPECT_DOUBLE_EQ(rig.right.cy_px, 487);  // (243.25 + 0.5) * 2 - 0.5
  EXPECT_EQ(rig.left.distortion, MakeRig().left.distortion);
  ASSERT_EQ(rig.notes.size(), 1u);
}

// Sides are rounded to whole px.
TEST(RigJudge, EachSideIsScaledByItself) {
  StereoRig rig = MakeRig();
  rig.rectified = StereoCamera{600, 450, 450, 460, 300, 220, 0.112};
  CalibrationOptions options;
  options.format.image_size = {320, 241};
  options.scale = true;
  JudgeRig("x.yaml", options, &rig);
  EXPECT_EQ(rig.right.height, 241);
  EXPECT_DOUBLE_EQ(rig.left.fx_px, 461.25 / 2);
  EXPECT_DOUBLE_EQ(rig.left.fy_px, 458.5 * 241 / 480);
  EXPECT_EQ(rig.rectified->width, 300);
  EXPECT_EQ(rig.rectified->height, 226);  // 450 * 241 / 480
  EXPECT_DOUBLE_EQ(rig.rectified->fx_px, 225);
  EXPECT_EQ(rig.rectified->baseline_m, 0.112);
}

StereoRig WithoutSize() {
  StereoRig rig = MakeRig();
  rig.left.width = rig.left.height = rig.right.width = rig.right.height = 0;
  return rig;
}

TEST(RigJudge, ASizeThatTheFileLeavesOpenIsTheImagesOrTheUsersWord) {
  StereoRig rig = WithoutSize();
  rig.rectified = StereoCamera{0, 0, 450, 450, 320, 240, 0.112};
  CalibrationOptions options;
  options.format.image_size = {640, 480};
  JudgeRig("x.yaml", options, &rig);
  EXPECT_EQ(rig.left.width, 640);
  EXPECT_EQ(rig.right.height, 480);
  EXPECT_EQ(rig.rectified->width, 640);
  EXPECT_TRUE(rig.notes.empty());

  rig = WithoutSize();
  options.format.image_size = {1280, 960};
  options.format.calibrated_size = {640, 480};
  options.scale = true;
  JudgeRig("x.yaml", options, &rig);
  EXPECT_DOUBLE_EQ(rig.left.fx_px, 922.5);
  EXPECT_EQ(rig.left.width, 1280);
}

TEST(RigJudge, IntrinsicsOfAnotherResolutionAreKnownByTheirPrincipalPoints) {
  const std::string complaint = Complaint([](StereoRig* r, CalibrationOptions* o) {
    *r = WithoutSize();
    o->format.image_size = {1280, 960};
  });
  EXPECT_NE(complaint.find("centres of images half as large as 1280x960 px"), std::string::npos)
      << complaint;
  EXPECT_NE(complaint.find("--size"), std::string::npos) << complaint;
  // One camera alone may be badly centred.
  EXPECT_EQ(Complaint([](StereoRig* r, CalibrationOptions* o) {
              *r = WithoutSize();
              r->right.cx_px = 640;
              r->right.cy_px = 480;
              o->format.image_size = {1280, 960};
            }),
            "");
  // Where the file says the size, it is believed, and the doubt is said.
  StereoRig rig = MakeRig();
  for (CameraIntrinsics* camera : {&rig.left, &rig.right}) {
    camera->width = 1280;
    camera->height = 960;
  }
  JudgeRig("x.yaml", {}, &rig);
  ASSERT_EQ(rig.notes.size(), 1u);
  EXPECT_NE(rig.notes[0].find("half as large"), std::string::npos);
}

TEST(RigJudge, ALongBaselineIsSaid) {
  StereoRig rig = MakeRig();
  rig.T_L_R.translation *= 10;  // 1.12 m
  JudgeRig("x.yaml", {}, &rig);
  ASSERT_EQ(rig.notes.size(), 1u);
  EXPECT_NE(rig.notes[0].find("1.121 m is long"), std::string::npos) << rig.notes[0];
}

TEST(RigJudge, ImagesRectifiedWithTheFileTakeItsPair) {
  StereoRig rig = MakeRig();
  rig.rectified = StereoCamera{640, 480, 450, 450, 320, 240, 0.112};
  CalibrationOptions options;
  options.are_images_rectified = true;
  JudgeRig("x.yaml", options, &rig);
  EXPECT_TRUE(rig.are_images_rectified);
  options.swap = true;
  StereoRig swapped = rig;
  EXPECT_THROW(JudgeRig("x.yaml", options, &swapped), InputError);
}

/// A point in the left camera's axes, in px of either original image.
Eigen::Vector2d Distort(const CameraIntrinsics& c, const Eigen::Vector3d& p) {
  const double x = p.x() / p.z();
  const double y = p.y() / p.z();
  const double r2 = x * x + y * y;
  const double radial = 1 + r2 * (c.distortion[0] + r2 * c.distortion[1]);
  const double p1 = c.distortion[2];
  const double p2 = c.distortion[3];
  const double xd = x * radial + 2 * p1 * x * y + p2 * (r2 + 2 * x * x);
  const double yd = y * radial + p1 * (r2 + 2 * y * y) + 2 * p2 * x * y;
  return {c.fx_px * xd + c.cx_px, c.fy_px * yd + c.cy_px};
}

TEST(StereoRectifier, TheSamePointHasTheSameRowAndItsDepth) {
  const StereoRig rig = MakeRig();
  const StereoRectifier rectifier(rig);
  const StereoCamera& camera = rectifier.camera();
  EXPECT_NEAR(camera.baseline_m, rig.T_L_R.translation.norm(), 1e-9);
  for (const Eigen::Vector3d& p_L :
       {Eigen::Vector3d(0.3, -0.2, 2), {-0.5, 0.4, 3}, {0, 0, 10}, {1.5, 0.9, 5}}) {
    const Eigen::Vector2d left = rectifier.RectifyLeft(Distort(rig.left, p_L));
    const Eigen::Vector2d right =
        rectifier.RectifyRight(Distort(rig.right, rig.T_L_R.inverse() * p_L));
    EXPECT_NEAR(left.y(), right.y(), 0.01);
    const double depth_m = camera.fx_px * camera.baseline_m / (left.x() - right.x());
    // The rectified camera is turned by a degree or so, thus the point's distance is compared.
    const Eigen::Vector3d p_C =
        depth_m * Eigen::Vector3d((left.x() - camera.cx_px) / camera.fx_px,
                                  (left.y() - camera.cy_px) / camera.fy_px, 1);
    EXPECT_NEAR(p_C.norm(), p_L.norm(), 0.002 * p_L.norm());
  }
}

TEST(StereoRectifier, ImagesFollowTheirPixels) {
  const StereoRig rig = MakeRig();
  const StereoRectifier rectifier(rig);
  cv::Mat image(480, 640, CV_8UC3, cv::Scalar(10, 20, 30));
  const cv::Point spot(400, 150);
  image(cv::Rect(spot.x - 3, spot.y - 3, 7, 7)) = cv::Scalar(250, 240, 230);
  const Eigen::Vector2d at = rectifier.RectifyRight({400, 150});
  const cv::Mat rectified = rectifier.Right(image);
  ASSERT_EQ(rectified.type(), CV_8UC3);
  ASSERT_EQ(rectified.size(), image.size());
  const cv::Vec3b value = rectified.at<cv::Vec3b>(
      cv::Point(static_cast<int>(std::lround(at.x())), static_cast<int>(std::lround(at.y()))));
  EXPECT_EQ(value, cv::Vec3b(250, 240, 230));
  EXPECT_THROW(rectifier.Left(cv::Mat(480, 641, CV_8UC1)), InputError);
}

TEST(StereoRectifier, AWideFisheyeLensIsCutToAnAngleAndThatIsSaid) {
  StereoRig rig = MakeRig();
  // 512 px at 190 px per radian: 154 degrees.
  rig.left = {
      512, 512, 190.5, 190.25, 254.5, 256.5, LensModel::kFisheye, {0.0035, 0.0007, -0.002, 0.0002}};
  rig.right = {512,
               512,
               190.25,
               190.5,
               252.5,
               254.75,
               LensModel::kFisheye,
               {0.0034, 0.0018, -0.0027, 0.0003}};
  const StereoRectifier rectifier(rig);
  EXPECT_NEAR(rectifier.camera().fx_px, 256 / std::sqrt(3.0), 1e-9);  // tan(60 degrees)
  EXPECT_EQ(rectifier.camera().cx_px, 255.5);
  ASSERT_EQ(rectifier.notes().size(), 1u);
  EXPECT_NE(rectifier.notes()[0].find("120 degrees"), std::string::npos);
  // A white image stays white up to the border: nothing is invented.
  const cv::Mat rectified = rectifier.Left(cv::Mat(512, 512, CV_8UC1, cv::Scalar(255)));
  EXPECT_EQ(cv::countNonZero(rectified == 255), 512 * 512);
  const Eigen::Vector3d p_L(1.2, -0.7, 1.5);
  const auto project = [](const CameraIntrinsics& c, const Eigen::Vector3d& p) -> Eigen::Vector2d {
    const double r = p.head<2>().norm();
    const double t = std::atan2(r, p.z());
    double d = t;
    for (int i = 0; i < 4; ++i)
      d += c.distortion[static_cast<std::size_t>(i)] * std::pow(t, 2 * i + 3);
    return {c.fx_px * d * p.x() / r + c.cx_px, c.fy_px * d * p.y() / r + c.cy_px};
  };
  const Eigen::Vector2d left = rectifier.RectifyLeft(project(rig.left, p_L));
  const Eigen::Vector2d right =
      rectifier.RectifyRight(project(rig.right, rig.T_L_R.inverse() * p_L));
  EXPECT_NEAR(left.y(), right.y(), 0.01);
  EXPECT_GT(left.x() - right.x(), 1);
}

TEST(StereoRectifier, RectifiedImagesPassUntouched) {
  StereoRig rig = MakeRig();
  rig.are_images_rectified = true;
  rig.rectified = StereoCamera{640, 480, 450, 450, 320, 240, 0.112};
  const StereoRectifier rectifier(rig);
  EXPECT_TRUE(rectifier.camera() == *rig.rectified);
  const cv::Mat image(480, 640, CV_8UC1, cv::Scalar(7));
  EXPECT_EQ(rectifier.Left(image).data, image.data);
  EXPECT_EQ(rectifier.RectifyLeft({5, 6}), Eigen::Vector2d(5, 6));
}

TEST(CalibrationFile, WhatIsNoneIsNamed) {
  const ScratchFolder folder("calibration_file");
  const auto complaint = [&](const std::vector<std::string>& paths) -> std::string {
    try {
      ReadStereoRig(paths, {});
    } catch (const InputError& error) {
      return error.what();
    }
    return "";
  };
  const std::string text = folder.Write("text.txt", "hello");
  EXPECT_NE(complaint({text}).find("is no calibration file"), std::string::npos);
  EXPECT_NE(complaint({text}).find("Kalibr"), std::string::npos);
  EXPECT_NE(complaint({folder.Write("empty", "")}).find("is no calibration file"),
            std::string::npos);
  EXPECT_NE(
      complaint({folder.Write("x.xml", "<?xml version=\"1.0\"?>\n<opencv_storage>")}).find("XML"),
      std::string::npos);
  EXPECT_NE(complaint({folder.Write("ros.yaml", "projection_matrix: 1\nrectification_matrix: 2\n")})
                .find("of one camera"),
            std::string::npos);
  EXPECT_NE(
      complaint({folder.Write("euroc.yaml", "T_BS: 1\nintrinsics: 2\n")}).find("of one camera"),
      std::string::npos);
  EXPECT_NE(complaint({text, text}).find("no pair"), std::string::npos);
  EXPECT_NE(complaint({folder.path()}).find("is a folder"), std::string::npos);
  EXPECT_NE(complaint({folder.PathOf("none")}).find("cannot be read"), std::string::npos);
  EXPECT_NE(complaint({}).find("one file or two"), std::string::npos);
}

}  // namespace
}  // namespace airdos
