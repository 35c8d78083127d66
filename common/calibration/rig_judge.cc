#include "common/calibration/rig_judge.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <tuple>

#include "common/util/error.h"

namespace airdos {
namespace {

std::string Brief(double value) {
  char text[32];
  std::snprintf(text, sizeof(text), "%.4g", value);
  return text;
}

std::string SizeText(std::pair<int, int> size) {
  return std::to_string(size.first) + "x" + std::to_string(size.second) + " px";
}

void SetSize(std::pair<int, int> size, CameraIntrinsics* camera) {
  if (camera->width == 0) std::tie(camera->width, camera->height) = size;
}

/// Why these are no camera's numbers, or empty.
std::string WhyNoIntrinsics(const CameraIntrinsics& camera) {
  if (camera.width < 16 || camera.height < 16 || camera.width > 20000 || camera.height > 20000) {
    return "images of " + SizeText({camera.width, camera.height});
  }
  const auto is_focal_length = [&](double f_px) {
    return f_px > 0.05 * camera.width && f_px < 100.0 * camera.width;
  };
  if (!is_focal_length(camera.fx_px) || !is_focal_length(camera.fy_px)) {
    return "focal lengths of " + Brief(camera.fx_px) + " and " + Brief(camera.fy_px) +
           " px for images of " + SizeText({camera.width, camera.height});
  }
  if (!(camera.cx_px > 0 && camera.cx_px < camera.width && camera.cy_px > 0 &&
        camera.cy_px < camera.height)) {
    return "the principal point (" + Brief(camera.cx_px) + ", " + Brief(camera.cy_px) +
           ") lies outside images of " + SizeText({camera.width, camera.height});
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
  if (rig.left.width != rig.right.width || rig.left.height != rig.right.height) {
    throw InputError(where + ": the cameras' images differ in size (" +
                     SizeText({rig.left.width, rig.left.height}) + " and " +
                     SizeText({rig.right.width, rig.right.height}) + "), which is not supported");
  }
  if (rig.left.lens != rig.right.lens) {
    throw InputError(where + ": the lens models differ (" + LensText(rig.left) + " and " +
                     LensText(rig.right) + "), which is not supported");
  }
}

/// The calibrated size against the images'.
void FitSize(const std::string& where, const CalibrationOptions& options, StereoRig* rig) {
  const std::pair<int, int> images = options.format.image_size;
  SetSize(images, &rig->left);
  SetSize(images, &rig->right);
  if (rig->rectified && rig->rectified->width == 0)
    std::tie(rig->rectified->width, rig->rectified->height) = images;
  const std::pair<int, int> calibrated = {rig->left.width, rig->left.height};
  if (calibrated.first == 0)
    throw InputError(where + ": does not say the images' size: say it with --size WIDTHxHEIGHT");
  if (images.first == 0 || images == calibrated) return;
  const double by_width = static_cast<double>(images.first) / calibrated.first;
  const double by_height = static_cast<double>(images.second) / calibrated.second;
  const std::string differ = where + ": the cameras were calibrated for images of " +
                             SizeText(calibrated) + ", these have " + SizeText(images);
  if (images == std::make_pair(calibrated.second, calibrated.first))
    throw InputError(differ + ": width and height are exchanged");
  if (std::abs(by_width / by_height - 1) > 0.01) {
    throw InputError(differ + ": another shape, so no larger or smaller copy of the same image");
  }
  if (!options.scale) {
    throw InputError(differ + ", " + Brief(by_width) +
                     " times as large: if the whole image was resized, say --scale-calibration");
  }
  rig->left = Scaled(rig->left, by_width);
  rig->right = Scaled(rig->right, by_width);
  if (rig->rectified) {
    const CameraIntrinsics scaled = Scaled({rig->rectified->width,
                                            rig->rectified->height,
                                            rig->rectified->fx_px,
                                            rig->rectified->fy_px,
                                            rig->rectified->cx_px,
                                            rig->rectified->cy_px,
                                            LensModel::kNone,
                                            {}},
                                           by_width);
    rig->rectified = StereoCamera{scaled.width,
                                  scaled.height,
                                  scaled.fx_px,
                                  scaled.fy_px,
                                  scaled.cx_px,
                                  scaled.cy_px,
                                  rig->rectified->baseline_m};
  }
  SetSize(images, &rig->left);
  rig->notes.push_back("calibrated for images of " + SizeText(calibrated) + ", scaled by " +
                       Brief(by_width));
}

/// Metres, by the user's word or by what a stereo rig's baseline may be.
void FitUnit(const std::string& where, const CalibrationOptions& options, StereoRig* rig) {
  const double baseline = BaselineOf(*rig);
  double unit_m = options.baseline_unit_m.value_or(1);
  constexpr double kMax_m = 3;
  constexpr double kMin_mm = 20;
  if (!options.baseline_unit_m && baseline >= kMin_mm && baseline <= 1000 * kMax_m) {
    unit_m = 1e-3;
    rig->notes.push_back("a baseline of " + Brief(baseline) +
                         " is taken in mm: " + Brief(baseline * unit_m) + " m");
  } else if (!options.baseline_unit_m && !(baseline >= 0.005 && baseline <= kMax_m)) {
    throw InputError(where + ": a baseline of " + Brief(baseline) +
                     " is neither m nor mm: say --baseline-unit m, cm or mm");
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
