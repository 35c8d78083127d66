#include <string>
#include <vector>

#include "common/calibration/calibration_file.h"
#include "common/calibration/rig_writer.h"
#include "common/calibration/stereo_rectifier.h"
#include "common/util/error.h"
#include "tests/fuzz/fuzz_input.h"

// Calibrations as users bring them: one file or two, of any tool.

namespace airdos {
namespace {

/// A byte of options, two of the images' size (0: not known), the file, and perhaps a second one.
void RunCalibration(const std::uint8_t* data, std::size_t size) {
  FuzzInput input(data, size);
  const int flags = input.U8();
  CalibrationOptions options;
  options.format.image_size = {input.U8(), input.U8()};
  if (options.format.image_size.second == 0) options.format.image_size.first = 0;
  options.swap = (flags & 1) != 0;
  options.are_images_rectified = (flags & 2) != 0;
  options.scale = (flags & 4) != 0;
  if ((flags & 8) != 0) options.baseline_unit_m = 0.01;
  if ((flags & 16) != 0) options.format.lens = LensModel::kFisheye;
  if ((flags & 32) != 0) options.format.calibrated_size = {96, 64};
  const FuzzBytes first = input.Block();
  const FuzzBytes second = input.Block();
  std::vector<std::string> paths = {FuzzFolder::Write("first.yaml", first.data(), first.size())};
  if (!second.empty())
    paths.push_back(FuzzFolder::Write("second.yaml", second.data(), second.size()));
  try {
    const StereoRig rig = ReadStereoRig(paths, options);
    constexpr int kMaxPixels = 40000;  // larger images take longer, and nothing else
    if (rig.left.width > kMaxPixels / rig.left.height) return;
    RectifierOptions rectifier_options;
    rectifier_options.alpha = (flags & 64) != 0 ? 1 : 0;
    const StereoRectifier rectifier(rig, rectifier_options);
    FuzzCheck(rectifier.camera().IsValid(), "a rectified pair that is none");
    const cv::Mat image(rectifier.camera().height, rectifier.camera().width, CV_8UC1,
                        cv::Scalar(9));
    rectifier.Left(image);
    rectifier.RectifyRight({1, 2});
    for (const std::string& format : WrittenFormats()) {
      try {
        WriteRig(rig, rectifier, format);
      } catch (const InputError&) {
      }
    }
  } catch (const InputError&) {
  }
}

FuzzBytes Seed(int flags, const std::vector<std::string>& files, int width = 0, int height = 0) {
  FuzzOutput seed;
  seed.U8(flags);
  seed.U8(width);
  seed.U8(height);
  for (const std::string& file : files) seed.Block(file);
  return seed.Take();
}

StereoRig SmallRig(LensModel lens) {
  StereoRig rig;
  rig.left = {96, 64, 80.5, 81, 47, 32.5, lens, {-0.02, 0.01, 0.001, 0.002}};
  rig.right = {96, 64, 80, 80.25, 48, 31, lens, {-0.01, 0.02, 0.003, 0.001}};
  rig.T_L_R.rotation = ExpSo3({0.01, -0.02, 0.03});
  rig.T_L_R.translation = {0.2, 0.01, -0.02};
  return rig;
}

constexpr char kKittiRaw[] =
    "calib_time: 09-Jan-2012\nS_00: 96 64\nK_00: 80 0 48 0 80 32 0 0 1\nD_00: 0.1 0 0 0 0\n"
    "R_00: 1 0 0 0 1 0 0 0 1\nT_00: 0 0 0\nS_rect_00: 90 60\nP_rect_00: 80 0 45 0 0 80 30 0 0 0 1 "
    "0\nS_01: 96 64\nK_01: 80 0 48 0 80 32 0 0 1\nD_01: 0.1 0 0 0 0\nR_01: 1 0 0 0 1 0 0 0 1\n"
    "T_01: -0.5 0 0\nS_rect_01: 90 60\nP_rect_01: 80 0 45 -40 0 80 30 0 0 0 1 0\n";
constexpr char kZed[] =
    "[LEFT_CAM_VGA]\nfx=350\nfy=350\ncx=336\ncy=188\nk1=-0.1\nk2=0.02\n[RIGHT_CAM_VGA]\nfx=350\n"
    "fy=350\ncx=336\ncy=188\nk1=-0.1\nk2=0.02\n[STEREO]\nBaseline=120\nCV_VGA=0.01\nRX_VGA=0.001\n";
constexpr char kOrbSlam2[] =
    "%YAML:1.0\nCamera.fx: 80.0\nCamera.fy: 80.0\nCamera.cx: 48.0\nCamera.cy: 32.0\n"
    "Camera.width: 96\nCamera.height: 64\nCamera.bf: 16.0\nLEFT.D: !!opencv-matrix\n   rows: 1\n"
    "   cols: 5\n   dt: d\n   data:[-0.28, 0.07, 0.0002, 1.7e-05, 0.0]\n";

std::vector<FuzzBytes> CalibrationSeeds() {
  std::vector<FuzzBytes> seeds;
  for (const LensModel lens : {LensModel::kRadialTangential, LensModel::kFisheye}) {
    const StereoRig rig = SmallRig(lens);
    for (const std::string& format : WrittenFormats()) {
      std::vector<std::string> files;
      for (const NamedText& file : WriteRig(rig, StereoRectifier(rig), format))
        files.push_back(file.text);
      seeds.push_back(Seed(0, files));
    }
  }
  seeds.push_back(Seed(4, {kKittiRaw}, 48, 32));
  seeds.push_back(Seed(0, {kKittiRaw}, 90, 60));
  seeds.push_back(
      Seed(2, {"P0: 80 0 48 0 0 80 32 0 0 0 1 0\nP1: 80 0 48 -16 0 80 32 0 0 0 1 0\n"}, 96, 64));
  seeds.push_back(Seed(4, {kZed}, 168, 94));
  seeds.push_back(Seed(0, {kOrbSlam2}));
  return seeds;
}

}  // namespace

std::vector<FuzzTarget> CalibrationTargets() {
  return {{"calibration", RunCalibration, CalibrationSeeds, 4096}};
}

}  // namespace airdos
