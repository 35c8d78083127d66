#include "common/calibration/rig_judge.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "common/calibration/camera_causes.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/image_header.h"

namespace airdos {
namespace {

std::string Brief(double value) { return Format("%.4g", value); }

std::string SizeText(std::pair<int, int> size) {
  return std::to_string(size.first) + "x" + std::to_string(size.second) + " px";
}

std::pair<int, int> SizeOf(const CameraIntrinsics& camera) { return {camera.width, camera.height}; }

/// Why these are no camera's numbers, or empty.
std::string WhyNoIntrinsics(const CameraIntrinsics& camera) {
  constexpr int kMinSide_px = 16;
  if (camera.width < kMinSide_px || camera.height < kMinSide_px ||
      camera.width > kMaxImagePixels / camera.height) {
    return "images of " + SizeText(SizeOf(camera)) + " are " +
           (std::min(camera.width, camera.height) < kMinSide_px ? "too small" : "too large");
  }
  const auto is_focal_length = [&](double f_px) {
    return f_px > 0.05 * camera.width && f_px < 100.0 * camera.width;
  };
  if (!is_focal_length(camera.fx_px) || !is_focal_length(camera.fy_px)) {
    return "focal lengths of " + Brief(camera.fx_px) + " and " + Brief(camera.fy_px) +
           " px for images of " + SizeText(SizeOf(camera));
  }
  if (!(camera.cx_px > 0 && camera.cx_px < camera.width && camera.cy_px > 0 &&
        camera.cy_px < camera.height)) {
    return "the principal point (" + Brief(camera.cx_px) + ", " + Brief(camera.cy_px) +
           ") lies outside images of " + SizeText(SizeOf(camera));
  }
  if (!IsDistortionCount(camera.lens, camera.distortion.size())) {
    return std::to_string(camera.distortion.size()) +
           " distortion coefficients for this lens model";
  }
  for (const double coefficient : camera.distortion) {
    if (!(std::abs(coefficient) < 1e4)) return "a distortion coefficient of " + Brief(coefficient);
  }
  return "";
}

void RequireIntrinsics(const std::string& where, const StereoRig& rig) {
  const std::string left = WhyNoIntrinsics(rig.left);
  if (!left.empty()) throw InputError(where + ": left camera: " + left);
  const std::string right = WhyNoIntrinsics(rig.right);
  if (!right.empty()) throw InputError(where + ": right camera: " + right);
  if (SizeOf(rig.left) != SizeOf(rig.right)) {
    throw InputError(where + ": the cameras' images differ in size (" + SizeText(SizeOf(rig.left)) +
                     " and " + SizeText(SizeOf(rig.right)) + "), which is not supported");
  }
  if (rig.left.lens != rig.right.lens) {
    throw InputError(where + ": the lens models differ (" + LensText(rig.left) + " and " +
                     LensText(rig.right) + "), which is not supported");
  }
}

/// The size that both cameras were calibrated for: the file's, or the user's word, or the images'.
/// Returns whether it is the images' by assumption only.
bool SetSize(const std::string& where, const FormatOptions& options, StereoRig* rig) {
  const std::pair<int, int> said = options.calibrated_size;
  if (rig->left.width == 0) {
    const std::pair<int, int> size = options.chosen_size();
    if (size.first == 0)
      throw InputError(where + ": does not say the images' size: say it with --size WIDTHxHEIGHT");
    std::tie(rig->left.width, rig->left.height) = size;
    if (rig->right.width == 0) std::tie(rig->right.width, rig->right.height) = size;
    if (rig->rectified) std::tie(rig->rectified->width, rig->rectified->height) = size;
    return said.first == 0;
  }
  if (said.first != 0 && said != SizeOf(rig->left)) {
    throw InputError(where + ": is for images of " + SizeText(SizeOf(rig->left)) +
                     ", but --size says " + SizeText(said));
  }
  return false;
}

/// Ratio of the size that both principal points are the centre of to the size that the rig has.
std::optional<double> FactorOf(const StereoRig& rig) {
  const auto factor_of = [](const CameraIntrinsics& c) {
    return ResolutionFactor({c.width, c.height, c.fx_px, c.fy_px, c.cx_px, c.cy_px, 1});
  };
  const std::optional<double> left = factor_of(rig.left);
  const std::optional<double> right = factor_of(rig.right);
  // Of one lens that is badly centred, the other one tells nothing.
  constexpr double kSame = 0.1;
  if (!left || !right || std::abs(*left / *right - 1) > kSame) return std::nullopt;
  const double factor = std::sqrt(*left * *right);
  return factor > 0.8 && factor < 1.25 ? std::nullopt : std::make_optional(factor);
}

/// Intrinsics of another resolution than the one they are taken for.
void RequireResolution(const std::string& where, bool is_size_assumed, StereoRig* rig) {
  const std::optional<double> factor = FactorOf(*rig);
  if (!factor) return;
  const std::string what = "the principal points (" + Brief(rig->left.cx_px) + ", " +
                           Brief(rig->left.cy_px) + ") and (" + Brief(rig->right.cx_px) + ", " +
                           Brief(rig->right.cy_px) + ") are the centres of images " +
                           TimesAsLarge(*factor) + " as " + SizeText(SizeOf(rig->left));
  if (!is_size_assumed) {
    rig->notes.push_back(what);
    return;
  }
  throw InputError(where + ": " + what +
                   ": say the size of the images that were calibrated (--size WIDTHxHEIGHT)");
}

StereoCamera Resized(const StereoCamera& camera, std::pair<int, int> size) {
  const CameraIntrinsics c = Resized(CameraIntrinsics{camera.width,
                                                      camera.height,
                                                      camera.fx_px,
                                                      camera.fy_px,
                                                      camera.cx_px,
                                                      camera.cy_px,
                                                      LensModel::kNone,
                                                      {}},
                                     size);
  return {c.width, c.height, c.fx_px, c.fy_px, c.cx_px, c.cy_px, camera.baseline_m};
}

/// The calibrated size against the images'.
void FitSize(const std::string& where, const CalibrationOptions& options, StereoRig* rig) {
  const bool is_size_assumed = SetSize(where, options.format, rig);
  RequireResolution(where, is_size_assumed, rig);
  const std::pair<int, int> images = options.format.image_size;
  const std::pair<int, int> calibrated = SizeOf(rig->left);
  if (images.first == 0 || images == calibrated) return;
  const double by_width = static_cast<double>(images.first) / calibrated.first;
  const double by_height = static_cast<double>(images.second) / calibrated.second;
  const std::string differ = where + ": the cameras were calibrated for images of " +
                             SizeText(calibrated) + ", these have " + SizeText(images);
  if (images == std::make_pair(calibrated.second, calibrated.first))
    throw InputError(differ + ": width and height are exchanged");
  constexpr double kSameShape = 0.01;  // sides are rounded to whole px
  if (std::abs(by_width / by_height - 1) > kSameShape) {
    throw InputError(differ + ": another shape, so no larger or smaller copy of the same image");
  }
  if (!options.scale) {
    throw InputError(differ + ", " + Brief(by_width) +
                     " times as large: if the whole image was resized, say --scale-calibration");
  }
  rig->left = Resized(rig->left, images);
  rig->right = Resized(rig->right, images);
  if (rig->rectified) {  // KITTI's is a little smaller
    rig->rectified = Resized(*rig->rectified,
                             {static_cast<int>(std::lround(rig->rectified->width * by_width)),
                              static_cast<int>(std::lround(rig->rectified->height * by_height))});
  }
  rig->notes.push_back("calibrated for images of " + SizeText(calibrated) + ", scaled by " +
                       Brief(by_width));
}

/// Metres, by the user's word or by what a stereo rig's baseline may be.
void FitUnit(const std::string& where, const CalibrationOptions& options, StereoRig* rig) {
  const double baseline = BaselineOf(*rig);
  double unit_m = options.baseline_unit_m.value_or(1);
  constexpr double kMax_m = 3;
  constexpr double kMin_m = 0.005;
  constexpr double kMin_mm = 20;
  if (!options.baseline_unit_m && baseline >= kMin_mm && baseline <= 1000 * kMax_m) {
    unit_m = 1e-3;
    rig->notes.push_back("a baseline of " + Brief(baseline) +
                         " is taken in mm: " + Brief(baseline * unit_m) + " m");
  } else if (!options.baseline_unit_m && !(baseline >= kMin_m && baseline <= kMax_m)) {
    throw InputError(where + ": a baseline of " + Brief(baseline) +
                     " is neither m nor mm: say --baseline-unit m, cm or mm");
  }
  constexpr double kLong_m = 1;
  if (!options.baseline_unit_m && baseline * unit_m > kLong_m) {
    rig->notes.push_back("a baseline of " + Brief(baseline * unit_m) +
                         " m is long: if the file's unit is another, such as the squares of the "
                         "chessboard, calibrate with m or mm");
  }
  rig->T_L_R.translation *= unit_m;
  if (rig->rectified) rig->rectified->baseline_m *= unit_m;
}

void RequireHorizontalPair(const std::string& where, const StereoRig& rig) {
  const Eigen::Vector3d t = rig.T_L_R.translation;
  const std::string place =
      "(" + Brief(t.x()) + ", " + Brief(t.y()) + ", " + Brief(t.z()) + ") m from the first";
  if (std::abs(t.y()) > std::abs(t.x())) {
    throw InputError(where + ": the cameras stand one above the other (the second is " + place +
                     "); only pairs side by side are supported");
  }
  if (std::abs(t.z()) > std::abs(t.x())) {
    throw InputError(where + ": the cameras stand one behind the other (the second is " + place +
                     "); only pairs side by side are supported");
  }
  if (t.x() < 0) {
    throw InputError(where + ": the first camera stands right of the second (which is " + place +
                     "): if the images are given as left and right, say --swap");
  }
  constexpr double kMaxAngle_rad = 0.5;
  const double angle_rad = LogSo3(rig.T_L_R.rotation).norm();
  if (angle_rad > kMaxAngle_rad) {
    throw InputError(where + ": the cameras look in directions that are " +
                     Brief(angle_rad * 180 / M_PI) +
                     " degrees apart: no stereo pair (is the pose written the wrong way round?)");
  }
}

void RequireRectified(const std::string& where, const CalibrationOptions& options, StereoRig* rig) {
  if (!rig->rectified) {
    throw InputError(
        where + ": a " + rig->format +
        " does not say how images are rectified, so it cannot be used with images that are");
  }
  rig->are_images_rectified = true;
  if (options.swap)
    throw InputError(where +
                     ": --swap is for images that are not rectified; give the images of left and "
                     "right in order");
}

}  // namespace

void JudgeRig(const std::string& where, const CalibrationOptions& options, StereoRig* rig) {
  FitSize(where, options, rig);
  FitUnit(where, options, rig);
  if (options.are_images_rectified || (options.swap && rig->are_images_rectified)) {
    RequireRectified(where, options, rig);
  }
  if (options.swap) *rig = Swapped(*rig);
  RequireIntrinsics(where, *rig);
  RequireHorizontalPair(where, *rig);
  if (rig->are_images_rectified && !rig->rectified->IsValid()) {
    throw InputError(where + ": the rectified pair is none: focal length " +
                     Brief(rig->rectified->fx_px) + " px, principal point (" +
                     Brief(rig->rectified->cx_px) + ", " + Brief(rig->rectified->cy_px) +
                     "), baseline " + Brief(rig->rectified->baseline_m) + " m");
  }
}

}  // namespace airdos
