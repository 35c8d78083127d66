#include "common/calibration/rig_writer.h"

#include <algorithm>
#include <nlohmann/json.hpp>

#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

std::string Exact(double value) { return Format("%.17g", value); }

/// "[1, 2]"; every YAML reader takes it.
std::string List(const std::vector<double>& values) {
  std::string text;
  for (const double value : values) text += (text.empty() ? "" : ", ") + Exact(value);
  return "[" + text + "]";
}

template <class Derived>
std::vector<double> RowMajor(const Eigen::MatrixBase<Derived>& matrix) {
  std::vector<double> values;
  for (Eigen::Index row = 0; row < matrix.rows(); ++row) {
    for (Eigen::Index col = 0; col < matrix.cols(); ++col) values.push_back(matrix(row, col));
  }
  return values;
}

Eigen::Matrix3d CameraMatrix(const CameraIntrinsics& camera) {
  Eigen::Matrix3d K;
  K << camera.fx_px, 0, camera.cx_px, 0, camera.fy_px, camera.cy_px, 0, 0, 1;
  return K;
}

std::string Rows(const std::string& key, const Eigen::Matrix4d& matrix) {
  std::string text = "  " + key + ":\n";
  for (int row = 0; row < 4; ++row) text += "  - " + List(RowMajor(matrix.row(row))) + "\n";
  return text;
}

/// Formats that know k1 k2 p1 p2 (or k1..k4) only.
std::vector<double> FourCoefficients(const CameraIntrinsics& camera, const std::string& format) {
  if (camera.lens == LensModel::kNone) return {0, 0, 0, 0};
  const bool has_more = std::any_of(camera.distortion.begin() + 4, camera.distortion.end(),
                                    [](double c) { return c != 0; });
  if (has_more) {
    throw InputError(format + " cannot say a lens of " + std::to_string(camera.distortion.size()) +
                     " coefficients; opencv and ros can");
  }
  return {camera.distortion.begin(), camera.distortion.begin() + 4};
}

std::string LensName(const CameraIntrinsics& camera, const std::string& radial,
                     const std::string& fisheye) {
  return camera.lens == LensModel::kFisheye ? fisheye : radial;
}

std::vector<double> Intrinsics(const CameraIntrinsics& c) {
  return {c.fx_px, c.fy_px, c.cx_px, c.cy_px};
}

std::string SizeList(const CameraIntrinsics& c) {
  return "[" + std::to_string(c.width) + ", " + std::to_string(c.height) + "]";
}

std::vector<NamedText> Kalibr(const StereoRig& rig) {
  const auto camera = [](const CameraIntrinsics& c) {
    return "  camera_model: pinhole\n  distortion_coeffs: " + List(FourCoefficients(c, "kalibr")) +
           "\n  distortion_model: " + LensName(c, "radtan", "equidistant") +
           "\n  intrinsics: " + List(Intrinsics(c)) + "\n  resolution: " + SizeList(c) + "\n";
  };
  return {{"kalibr.yaml", "cam0:\n" + camera(rig.left) + "cam1:\n" +
                              Rows("T_cn_cnm1", rig.T_L_R.inverse().matrix()) + camera(rig.right)}};
}

std::vector<NamedText> Euroc(const StereoRig& rig) {
  const auto sensor = [](const CameraIntrinsics& c, const Se3& T_B_C) {
    return "sensor_type: camera\nT_BS:\n  cols: 4\n  rows: 4\n  data: " +
           List(RowMajor(T_B_C.matrix())) + "\nresolution: " + SizeList(c) +
           "\ncamera_model: pinhole\nintrinsics: " + List(Intrinsics(c)) +
           "\ndistortion_model: " + LensName(c, "radial-tangential", "equidistant") +
           "\ndistortion_coefficients: " + List(FourCoefficients(c, "euroc")) + "\n";
  };
  return {{"left.yaml", sensor(rig.left, Se3())}, {"right.yaml", sensor(rig.right, rig.T_L_R)}};
}

std::string OpencvMatrix(const std::string& key, const std::vector<double>& values, int rows,
                         int cols) {
  return key + ": !!opencv-matrix\n   rows: " + std::to_string(rows) +
         "\n   cols: " + std::to_string(cols) + "\n   dt: d\n   data: " + List(values) + "\n";
}

std::vector<NamedText> Opencv(const StereoRig& rig) {
  const auto distortion = [](const std::string& key, const CameraIntrinsics& c) {
    const std::vector<double> values =
        c.lens == LensModel::kNone ? std::vector<double>(5, 0) : c.distortion;
    return OpencvMatrix(key, values, 1, static_cast<int>(values.size()));
  };
  const Se3 T_R_L = rig.T_L_R.inverse();  // cv::stereoCalibrate: p_R = R p_L + T
  return {
      {"stereo.yml", "%YAML:1.0\n---\nimage_width: " + std::to_string(rig.left.width) +
                         "\nimage_height: " + std::to_string(rig.left.height) +
                         "\nfisheye_model: " + (rig.left.lens == LensModel::kFisheye ? "1" : "0") +
                         "\n" + OpencvMatrix("M1", RowMajor(CameraMatrix(rig.left)), 3, 3) +
                         distortion("D1", rig.left) +
                         OpencvMatrix("M2", RowMajor(CameraMatrix(rig.right)), 3, 3) +
                         distortion("D2", rig.right) +
                         OpencvMatrix("R", RowMajor(T_R_L.rotation.toRotationMatrix()), 3, 3) +
                         OpencvMatrix("T", RowMajor(T_R_L.translation), 3, 1)}};
}

std::vector<NamedText> OrbSlam3(const StereoRig& rig) {
  const bool is_fisheye = rig.left.lens == LensModel::kFisheye;
  const auto camera = [&](const std::string& name, const CameraIntrinsics& c) {
    const char* const keys[] = {"fx", "fy", "cx", "cy"};
    const char* const radial[] = {"k1", "k2", "p1", "p2"};
    const char* const fisheye[] = {"k1", "k2", "k3", "k4"};
    const std::vector<double> intrinsics = Intrinsics(c);
    const std::vector<double> distortion = FourCoefficients(c, "orbslam3");
    std::string text;
    for (std::size_t i = 0; i < 4; ++i)
      text += name + "." + keys[i] + ": " + Exact(intrinsics[i]) + "\n";
    for (std::size_t i = 0; i < 4; ++i)
      text += name + "." + (is_fisheye ? fisheye : radial)[i] + ": " + Exact(distortion[i]) + "\n";
    return text;
  };
  return {
      {"orbslam3.yaml", "%YAML:1.0\nFile.version: \"1.0\"\nCamera.type: \"" +
                            std::string(is_fisheye ? "KannalaBrandt8" : "PinHole") + "\"\n" +
                            camera("Camera1", rig.left) + camera("Camera2", rig.right) +
                            "Camera.width: " + std::to_string(rig.left.width) +
                            "\nCamera.height: " + std::to_string(rig.left.height) + "\n" +
                            OpencvMatrix("Stereo.T_c1_c2", RowMajor(rig.T_L_R.matrix()), 4, 4)}};
}

std::vector<NamedText> Ros(const StereoRig& rig, const StereoRectifier& rectifier) {
  const auto matrix = [](const std::string& key, const std::vector<double>& values, int rows,
                         int cols) {
    return key + ":\n  rows: " + std::to_string(rows) + "\n  cols: " + std::to_string(cols) +
           "\n  data: " + List(values) + "\n";
  };
  const StereoCamera& p = rectifier.camera();
  const auto camera = [&](const std::string& name, const CameraIntrinsics& c,
                          const Eigen::Matrix3d& R, double tx) {
    const std::vector<double> distortion =
        c.lens == LensModel::kNone ? std::vector<double>(5, 0) : c.distortion;
    return "image_width: " + std::to_string(c.width) +
           "\nimage_height: " + std::to_string(c.height) + "\ncamera_name: " + name + "\n" +
           matrix("camera_matrix", RowMajor(CameraMatrix(c)), 3, 3) + "distortion_model: " +
           LensName(c, distortion.size() > 5 ? "rational_polynomial" : "plumb_bob", "equidistant") +
           "\n" +
           matrix("distortion_coefficients", distortion, 1, static_cast<int>(distortion.size())) +
           matrix("rectification_matrix", RowMajor(R), 3, 3) +
           matrix("projection_matrix",
                  {p.fx_px, 0, p.cx_px, tx, 0, p.fy_px, p.cy_px, 0, 0, 0, 1, 0}, 3, 4);
  };
  return {{"left.yaml", camera("left", rig.left, rectifier.R_rect_left(), 0)},
          {"right.yaml",
           camera("right", rig.right, rectifier.R_rect_right(), -p.fx_px * p.baseline_m)}};
}

std::vector<NamedText> CalibJson(const StereoCamera& camera) {
  nlohmann::ordered_json json;
  json["fx"] = camera.fx_px;
  json["fy"] = camera.fy_px;
  json["cx"] = camera.cx_px;
  json["cy"] = camera.cy_px;
  json["baseline_m"] = camera.baseline_m;
  json["width"] = camera.width;
  json["height"] = camera.height;
  return {{"calib.json", json.dump(2) + "\n"}};
}

}  // namespace

const std::vector<std::string>& WrittenFormats() {
  static const std::vector<std::string> formats = {"kalibr", "ros",      "opencv",
                                                   "euroc",  "orbslam3", "calib.json"};
  return formats;
}

std::vector<NamedText> WriteRig(const StereoRig& rig, const StereoRectifier& rectifier,
                                const std::string& format) {
  if (format == "calib.json") return CalibJson(rectifier.camera());
  if (rig.are_images_rectified) {
    throw InputError("the images are rectified, and " + format +
                     " is for images that are not: only calib.json can be written");
  }
  if (format == "kalibr") return Kalibr(rig);
  if (format == "ros") return Ros(rig, rectifier);
  if (format == "opencv") return Opencv(rig);
  if (format == "euroc") return Euroc(rig);
  if (format == "orbslam3") return OrbSlam3(rig);
  throw InputError("format '" + format + "' cannot be written");
}

}  // namespace airdos
