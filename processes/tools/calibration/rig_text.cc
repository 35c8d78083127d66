#include "processes/tools/calibration/rig_text.h"

#include <cmath>
#include <nlohmann/json.hpp>

#include "common/util/format.h"

namespace airdos {
namespace {

constexpr double kDegreesPerRadian = 180 / M_PI;

std::string CameraLine(const char* name, const CameraIntrinsics& c) {
  return Format("%-10s %d x %d px, fx %.3f fy %.3f cx %.3f cy %.3f px, %s\n", name, c.width,
                c.height, c.fx_px, c.fy_px, c.cx_px, c.cy_px, LensText(c).c_str());
}

double FieldOfViewDeg(const StereoCamera& camera) {
  return kDegreesPerRadian * (std::atan(camera.cx_px / camera.fx_px) +
                              std::atan((camera.width - camera.cx_px) / camera.fx_px));
}

nlohmann::json CameraJson(const CameraIntrinsics& c) {
  const char* const lens = c.lens == LensModel::kNone      ? "none"
                           : c.lens == LensModel::kFisheye ? "fisheye"
                                                           : "radial_tangential";
  return {{"width", c.width}, {"height", c.height}, {"fx", c.fx_px}, {"fy", c.fy_px},
          {"cx", c.cx_px},    {"cy", c.cy_px},      {"lens", lens},  {"distortion", c.distortion}};
}

}  // namespace

std::string RigText(const StereoRig& rig, const StereoRectifier& rectifier) {
  const Eigen::Vector3d t = rig.T_L_R.translation;
  const Eigen::Vector3d r = kDegreesPerRadian * LogSo3(rig.T_L_R.rotation);
  const StereoCamera& camera = rectifier.camera();
  std::string text;
  for (const std::string& file : rig.files) text += "file       " + file + "\n";
  text += "format     " + rig.format +
          (rig.are_images_rectified ? ", images rectified already\n" : "\n");
  text += CameraLine("left", rig.left) + CameraLine("right", rig.right);
  text += Format(
      "baseline   %.5f m; the right camera is at (%.5f, %.5f, %.5f) m in the left one, turned by "
      "(%.3f, %.3f, %.3f) degrees\n",
      BaselineOf(rig), t.x(), t.y(), t.z(), r.x(), r.y(), r.z());
  text += Format(
      "rectified  %d x %d px, f %.3f px, cx %.3f cy %.3f px, baseline %.5f m, %.0f degrees wide\n",
      camera.width, camera.height, camera.fx_px, camera.cx_px, camera.cy_px, camera.baseline_m,
      FieldOfViewDeg(camera));
  for (const std::string& note : rig.notes) text += "note       " + note + "\n";
  for (const std::string& note : rectifier.notes()) text += "note       " + note + "\n";
  return text;
}

nlohmann::json RigJson(const StereoRig& rig, const StereoRectifier& rectifier) {
  const Eigen::Vector3d& t = rig.T_L_R.translation;
  const Eigen::Quaterniond& q = rig.T_L_R.rotation;
  const StereoCamera& c = rectifier.camera();
  std::vector<std::string> notes = rig.notes;
  notes.insert(notes.end(), rectifier.notes().begin(), rectifier.notes().end());
  return {
      {"files", rig.files},
      {"format", rig.format},
      {"images_rectified", rig.are_images_rectified},
      {"left", CameraJson(rig.left)},
      {"right", CameraJson(rig.right)},
      {"T_L_R",
       {{"translation_m", {t.x(), t.y(), t.z()}}, {"rotation_xyzw", {q.x(), q.y(), q.z(), q.w()}}}},
      {"rectified",
       {{"width", c.width},
        {"height", c.height},
        {"fx", c.fx_px},
        {"fy", c.fy_px},
        {"cx", c.cx_px},
        {"cy", c.cy_px},
        {"baseline_m", c.baseline_m}}},
      {"notes", notes}};
}

std::string RigCheckText(const RigCheck& check) {
  std::string text = Format("rows before rectification: %.2f px apart (median of %d matches)\n",
                            check.before.median_px, check.before.num_matches);
  text += Format("rows after rectification:  %.2f px apart (median of %d matches)\n",
                 check.after.median_px, check.after.num_matches);
  text += "after, by thirds of the left image (px; - where there are too few matches):\n";
  for (std::size_t region = 0; region < check.after.region_px.size(); ++region) {
    const double median_px = check.after.region_px[region];
    text += (region % 3 == 0 ? " " : "");
    text += median_px < 0 ? "      -" : Format("%7.2f", median_px);
    text += (region % 3 == 2 ? "\n" : "");
  }
  return text;
}

}  // namespace airdos
