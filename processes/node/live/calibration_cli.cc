#include "processes/node/live/calibration_cli.h"

#include <cstdio>

#include "common/calibration/camera_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

/// "A<separator>B" as two whole numbers; throws InputError naming the option.
std::pair<int, int> TwoNumbers(const std::string& option, const std::string& text, char separator) {
  int a = 0;
  int b = 0;
  char between = '\0';
  char rest = '\0';
  if (std::sscanf(text.c_str(), "%6d%c%6d%c", &a, &between, &b, &rest) != 3 ||
      between != separator || a < 0 || b < 0) {
    throw InputError(option + ": '" + text + "' must be two whole numbers with '" + separator +
                     "' between them");
  }
  return {a, b};
}

}  // namespace

CommandOption CalibrationArguments::AddTo(const std::string& names, CommandLine* line,
                                          const std::string& more) {
  const CommandOption files =
      line->Add(
              names, &paths_,
              std::string() +
                  "calibration of an unrectified pair: one file (Kalibr, OpenCV, ORB-SLAM, KITTI, "
                  "ZED, calib.json), or the left and the right camera's (ROS, EuRoC)" +
                  more)
          .ShownAs("FILE")
          .Words(1, 2);
  line->Add("--size", &size_,
            "size of the images that were calibrated, where the file does not say it")
      .ShownAs("WIDTHxHEIGHT");
  line->AddFlag("--swap", &swap_, "the file's first camera is the right one");
  line->AddFlag("--rectified", &rectified_, "the images were rectified with this file already");
  line->AddFlag("--scale-calibration", &scale_,
                "the images are larger or smaller copies of those that were calibrated");
  line->Add("--baseline-unit", &baseline_unit_,
            "unit of the file's translations, where their size does not tell")
      .OneOf({"m", "cm", "mm"});
  line->Add("--lens", &lens_, "lens model of an OpenCV file with four coefficients")
      .OneOf({"radtan", "fisheye"});
  line->Add("--kitti-cameras", &kitti_cameras_, "which two cameras of a KITTI file")
      .ShownAs("LEFT,RIGHT")
      .ShowDefault();
  line->Add("--alpha", &rectifier_.alpha,
            "0: only what both images see; 1: all pixels are kept, with black borders")
      .Within(0.0, 1.0)
      .ShowDefault();
  return files;
}

StereoRig CalibrationArguments::Read(std::pair<int, int> image_size) const {
  CalibrationOptions options;
  options.format.image_size = image_size;
  if (!size_.empty()) {
    const auto [width, height] = TwoNumbers("--size", size_, 'x');
    options.format.calibrated_size = ToImageSize(width, height, "--size");
  }
  if (!lens_.empty())
    options.format.lens = lens_ == "fisheye" ? LensModel::kFisheye : LensModel::kRadialTangential;
  options.format.kitti_cameras = TwoNumbers("--kitti-cameras", kitti_cameras_, ',');
  options.swap = swap_;
  options.are_images_rectified = rectified_;
  options.scale = scale_;
  if (!baseline_unit_.empty())
    options.baseline_unit_m = baseline_unit_ == "m" ? 1 : baseline_unit_ == "cm" ? 0.01 : 0.001;
  return ReadStereoRig(paths_, options);
}

}  // namespace airdos
