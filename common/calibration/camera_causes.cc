#include "common/calibration/camera_causes.h"

#include <cmath>
#include <utility>

#include "common/util/format.h"

namespace airdos {
namespace {

bool IsPlausibleBaseline(double baseline_m) { return baseline_m >= 0.02 && baseline_m <= 2; }

std::string Brief(double value) { return Format("%.4g", value); }

/// Size of the images in which the camera's principal point would be central.
std::pair<double, double> CalibratedSize(const StereoCamera& camera) {
  return {2 * camera.cx_px / camera.width, 2 * camera.cy_px / camera.height};
}

std::string WhyNoPrincipalPoint(const StereoCamera& camera) {
  const std::string point = "the principal point cx " + Brief(camera.cx_px) + " cy " +
                            Brief(camera.cy_px) + " is not in an image of " +
                            std::to_string(camera.width) + " x " + std::to_string(camera.height) +
                            " px";
  if (IsPrincipalPointSwapped(camera)) return point + "; cx and cy are exchanged";
  const std::optional<double> factor = ResolutionFactor(camera);
  if (factor) {
    return point + "; it belongs to images " + TimesAsLarge(*factor) + ": divide fx, fy, cx and " +
           "cy by " + Brief(*factor);
  }
  return point;
}

std::string WhyNoBaseline(const StereoCamera& camera) {
  StereoCamera positive = camera;
  positive.baseline_m = -camera.baseline_m;
  std::string text = "the baseline " + Brief(camera.baseline_m) + " m is " +
                     (camera.baseline_m < 0 ? "negative" : "0") +
                     "; it is the distance from the left to the right camera";
  if (camera.baseline_m < 0) {
    text += IsPlausibleBaseline(positive.baseline_m)
                ? ", " + Brief(positive.baseline_m) +
                      ", without the sign of Kalibr's T_cn_cnm1 or "
                      "ROS' Tx; or left and right are exchanged"
                : ", without the sign of Kalibr's T_cn_cnm1 or ROS' Tx" + ExplainBaseline(positive);
  }
  return text;
}

}  // namespace

std::optional<double> ResolutionFactor(const StereoCamera& camera) {
  const auto [by_width, by_height] = CalibratedSize(camera);
  if (!(by_width > 0.02) || !(by_height > 0.02) || by_width > 50 || by_height > 50) {
    return std::nullopt;
  }
  // Lenses are rarely centred that well, but a difference of 10 % does not mean another resolution.
  constexpr double kSameFactor = 0.1;
  const double factor = std::sqrt(by_width * by_height);
  if (std::abs(std::log(by_width / by_height)) > kSameFactor) return std::nullopt;
  if (std::abs(std::log(factor)) < std::log(1.1)) return std::nullopt;
  return factor;
}

bool IsPrincipalPointSwapped(const StereoCamera& camera) {
  constexpr double kNear = 0.1;  // relative to the size
  const auto is_middle = [](double value_px, int size) {
    return std::abs(value_px / size - 0.5) < kNear;
  };
  return is_middle(camera.cx_px, camera.height) && is_middle(camera.cy_px, camera.width) &&
         !(is_middle(camera.cx_px, camera.width) && is_middle(camera.cy_px, camera.height));
}

std::string TimesAsLarge(double factor) {
  if (std::abs(factor - 2) < 0.1) return "twice as large";
  if (std::abs(factor - 0.5) < 0.025) return "half as large";
  return Brief(factor) + " times as large";
}

std::string ExplainBaseline(const StereoCamera& camera) {
  std::string text;
  const auto add = [&](const std::string& as, double baseline_m) {
    if (!IsPlausibleBaseline(baseline_m)) return;
    text += (text.empty() ? "; " : ", ") + as + " it would be " + Brief(baseline_m) + " m";
  };
  if (camera.baseline_m < 2) return "";
  add("in mm instead of m", 1e-3 * camera.baseline_m);
  if (text.empty()) add("in cm instead of m", 1e-2 * camera.baseline_m);
  add("as fx * baseline (bf) in px m", camera.baseline_m / camera.fx_px);
  return text;
}

std::string WhyNoCamera(const StereoCamera& camera) {
  for (const auto& [name, value] : {std::make_pair("fx", camera.fx_px),
                                    {"fy", camera.fy_px},
                                    {"cx", camera.cx_px},
                                    {"cy", camera.cy_px},
                                    {"baseline", camera.baseline_m}}) {
    if (!std::isfinite(value)) return std::string(name) + " is not finite";
  }
  if (camera.fx_px <= 0 || camera.fy_px <= 0) {
    return "the focal length fx " + Brief(camera.fx_px) + " fy " + Brief(camera.fy_px) +
           " is not positive";
  }
  if (camera.cx_px <= 0 || camera.cy_px <= 0 || camera.cx_px >= camera.width ||
      camera.cy_px >= camera.height) {
    return WhyNoPrincipalPoint(camera);
  }
  return camera.baseline_m <= 0 ? WhyNoBaseline(camera) : "";
}

}  // namespace airdos
