#include "common/check/check_camera.h"

#include <cmath>
#include <optional>

#include "common/calibration/camera_causes.h"

namespace airdos {
namespace {

std::string SizeOf(const StereoCamera& camera) {
  return std::to_string(camera.width) + " x " + std::to_string(camera.height) + " px";
}

void CheckBaseline(const StereoCamera& camera, const std::string& where, FindingList* findings) {
  const double baseline_m = camera.baseline_m;
  const std::string what = "a baseline of " + Brief(baseline_m) + " m is " +
                           (baseline_m <= 0     ? "not positive"
                            : baseline_m < 0.02 ? "short"
                                                : "long") +
                           ExplainBaseline(camera);
  if (baseline_m < 0.005 || baseline_m > 5) {
    findings->Fail("camera.baseline", where, what);
  } else if (baseline_m < 0.02 || baseline_m > 2) {
    findings->Warn("camera.baseline", where, what);
  }
}

/// What a focal length is that is not in px: "; ...", or empty.
std::string ExplainFocalLength(const StereoCamera& camera) {
  const double as_px = camera.fx_px * camera.width;
  const bool is_normalised = camera.fx_px > 0.3 && camera.fx_px < 4;
  if (is_normalised && camera.cx_px < 1) {
    return "; divided by the image's width? In px it would be " + Brief(as_px);
  }
  if (camera.fx_px < 0.1) return "; in m, as of a lens? It is expected in px";
  if (camera.fx_px < 50) return "; in mm, as of a lens? It is expected in px";
  return "; is it in px of these images?";
}

void CheckFocalLength(const StereoCamera& camera, const std::string& where, FindingList* findings) {
  const double ratio = camera.fx_px / camera.width;
  const std::string focal = "focal length of " + Brief(camera.fx_px) + " px for images " +
                            std::to_string(camera.width) + " px wide is implausible";
  if (ratio < 0.1 || ratio > 20) {
    findings->Fail("camera.focal_length", where, focal + ExplainFocalLength(camera));
  } else if (ratio < 0.3 || ratio > 4) {
    findings->Warn("camera.focal_length", where, focal + ExplainFocalLength(camera));
  }
  if (std::abs(camera.fy_px / camera.fx_px - 1) > 0.1) {
    findings->Warn("camera.focal_length", where,
                   "fx " + Brief(camera.fx_px) + " and fy " + Brief(camera.fy_px) +
                       " differ by more than a tenth");
  }
}

/// False if the principal point belongs to images of another size.
bool CheckResolution(const StereoCamera& camera, const std::string& where, FindingList* findings) {
  const std::optional<double> factor = ResolutionFactor(camera);
  if (!factor) return true;
  const std::string what = "the principal point " + Brief(camera.cx_px) + " " +
                           Brief(camera.cy_px) + " is the centre of images " +
                           TimesAsLarge(*factor) + " as these of " + SizeOf(camera);
  // Between 10 and 20 %, the lens may just be badly centred.
  if (*factor < 0.8 || *factor > 1.25) {
    findings->Fail("camera.resolution", where,
                   what + ": calibrated for those; divide fx, fy, cx and cy by " + Brief(*factor));
  } else {
    findings->Warn("camera.resolution", where, what + ": was it calibrated for those?");
  }
  return false;
}

void CheckPrincipalPoint(const StereoCamera& camera, const std::string& where,
                         FindingList* findings) {
  const std::string point =
      "the principal point " + Brief(camera.cx_px) + " " + Brief(camera.cy_px);
  if (IsPrincipalPointSwapped(camera)) {
    findings->Fail("camera.principal_point", where,
                   point + " in images of " + SizeOf(camera) + ": cx and cy are exchanged");
    return;
  }
  if (!CheckResolution(camera, where, findings)) return;
  constexpr double kFarOff = 0.15;  // relative to the size
  const double off_x = camera.cx_px / camera.width - 0.5;
  const double off_y = camera.cy_px / camera.height - 0.5;
  if (std::abs(off_x) <= kFarOff && std::abs(off_y) <= kFarOff) return;
  std::string cause;
  if (camera.cx_px <= 1 && camera.cy_px <= 1) {
    cause = "; divided by the image's size? It is expected in px";
  } else if (std::abs(off_x) <= kFarOff || std::abs(off_y) <= kFarOff) {
    cause =
        "; if the images were cropped, what was cut off at the left and top must be "
        "subtracted from it";
  }
  findings->Warn("camera.principal_point", where,
                 point + " is far from the centre of images of " + SizeOf(camera) + cause);
}

}  // namespace

void CheckCamera(const StereoCamera& camera, const std::string& where, FindingList* findings) {
  CheckBaseline(camera, where, findings);
  CheckFocalLength(camera, where, findings);
  CheckPrincipalPoint(camera, where, findings);
}

}  // namespace airdos
