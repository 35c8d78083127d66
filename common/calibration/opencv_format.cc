#include <tuple>

#include "common/calibration/calibration_yaml.h"
#include "common/calibration/camera_matrix.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

using Names = std::vector<std::string>;

// What people call the matrices of cv::stereoCalibrate; its sample writes the first of each.
const Names kCamera1 = {"M1",
                        "K1",
                        "cameraMatrix1",
                        "camera_matrix_1",
                        "cameraMatrixL",
                        "camera_matrix_left",
                        "left_camera_matrix",
                        "K_left",
                        "KL",
                        "mtx_l",
                        "mtxL"};
const Names kCamera2 = {"M2",
                        "K2",
                        "cameraMatrix2",
                        "camera_matrix_2",
                        "cameraMatrixR",
                        "camera_matrix_right",
                        "right_camera_matrix",
                        "K_right",
                        "KR",
                        "mtx_r",
                        "mtxR"};
const Names kDistortion1 = {"D1",
                            "distCoeffs1",
                            "dist_coeffs_1",
                            "distCoeffsL",
                            "distortion_coefficients_left",
                            "dist_coeffs_left",
                            "left_distortion_coefficients",
                            "D_left",
                            "DL",
                            "dist_l",
                            "distL"};
const Names kDistortion2 = {"D2",
                            "distCoeffs2",
                            "dist_coeffs_2",
                            "distCoeffsR",
                            "distortion_coefficients_right",
                            "dist_coeffs_right",
                            "right_distortion_coefficients",
                            "D_right",
                            "DR",
                            "dist_r",
                            "distR"};
const Names kRotation = {"R", "rotation", "rotation_matrix", "Rotation"};
const Names kTranslation = {"T", "translation", "translation_vector", "Translation", "t"};
const Names kWidth = {"image_width", "width", "imageWidth"};
const Names kHeight = {"image_height", "height", "imageHeight"};
const Names kSize = {"image_size", "imageSize", "size", "img_size", "resolution"};

/// The maps of one or two files as if they were one.
class OpencvMaps {
 public:
  explicit OpencvMaps(const std::vector<CalibrationText>& files) {
    for (const CalibrationText& file : files)
      maps_.push_back(CalibrationYaml::Parse(file.text, file.path));
  }
  /// The map that has one of the names, and that name.
  std::optional<std::pair<const CalibrationYaml*, std::string>> Find(const Names& names) const {
    for (const std::string& name : names) {
      for (const CalibrationYaml& map : maps_) {
        if (map.Has(name)) return std::make_pair(&map, name);
      }
    }
    return std::nullopt;
  }
  std::pair<const CalibrationYaml*, std::string> Get(const Names& names) const {
    if (const auto found = Find(names)) return *found;
    std::string where = maps_.front().path();
    for (std::size_t i = 1; i < maps_.size(); ++i) where += ", " + maps_[i].path();
    throw InputError(where + ": key '" + names.front() + "' is missing (or '" + names[1] + "', '" +
                     names[2] + "')");
  }

 private:
  std::vector<CalibrationYaml> maps_;
};

/// Fisheye or not, where the file says so.
std::optional<LensModel> SaidLens(const OpencvMaps& maps) {
  for (const char* key : {"fisheye_model", "fisheye", "is_fisheye"}) {
    if (const auto found = maps.Find({key})) {
      const std::string value = found->first->Text(found->second);
      return value == "1" || value == "true" ? LensModel::kFisheye : LensModel::kRadialTangential;
    }
  }
  for (const char* key : {"distortion_model", "camera_model", "model"}) {
    const auto found = maps.Find({key});
    if (!found) continue;
    const std::string value = found->first->Text(found->second);
    if (value.find("fisheye") != std::string::npos || value.find("equi") != std::string::npos) {
      return LensModel::kFisheye;
    }
    return LensModel::kRadialTangential;
  }
  return std::nullopt;
}

std::pair<int, int> SizeOf(const OpencvMaps& maps) {
  if (const auto size = maps.Find(kSize)) {
    const std::vector<double> numbers = size->first->Numbers(size->second, 2);
    return ToImageSize(numbers[0], numbers[1], size->first->Where(size->second));
  }
  const auto width = maps.Find(kWidth);
  const auto height = maps.Find(kHeight);
  if (!width || !height) return {0, 0};
  return ToImageSize(width->first->Number(width->second), height->first->Number(height->second),
                     width->first->Where(width->second));
}

CameraIntrinsics ReadCamera(const OpencvMaps& maps, const Names& matrix_names,
                            const Names& distortion_names) {
  const auto [matrix_map, matrix_name] = maps.Get(matrix_names);
  CameraIntrinsics camera =
      ToIntrinsics(matrix_map->Matrix3(matrix_name), matrix_map->Where(matrix_name));
  const auto [distortion_map, distortion_name] = maps.Get(distortion_names);
  camera.distortion = distortion_map->Numbers(distortion_name);
  std::tie(camera.width, camera.height) = SizeOf(maps);
  return camera;
}

void ChooseLens(const OpencvMaps& maps, const FormatOptions& options, StereoRig* rig) {
  const std::optional<LensModel> said = SaidLens(maps);
  const LensModel lens = options.lens.value_or(said.value_or(LensModel::kRadialTangential));
  rig->left.lens = rig->right.lens = lens;
  if (!options.lens && !said && rig->left.distortion.size() == 4) {
    rig->is_lens_assumed = true;
    rig->notes.push_back(
        "the 4 distortion coefficients are taken as k1 k2 p1 p2; if they are of cv::fisheye, say "
        "--lens fisheye");
  }
}

}  // namespace

bool IsOpencvStereo(const std::vector<CalibrationText>& files) {
  try {
    const OpencvMaps maps(files);
    return maps.Find(kCamera1).has_value() && maps.Find(kCamera2).has_value();
  } catch (const InputError&) {
    return false;
  }
}

StereoRig ReadOpencvStereo(const std::vector<CalibrationText>& files,
                           const FormatOptions& options) {
  const OpencvMaps maps(files);
  StereoRig rig;
  rig.format = "OpenCV stereo calibration";
  rig.left = ReadCamera(maps, kCamera1, kDistortion1);
  rig.right = ReadCamera(maps, kCamera2, kDistortion2);
  ChooseLens(maps, options, &rig);
  const auto [rotation_map, rotation_name] = maps.Get(kRotation);
  const auto [translation_map, translation_name] = maps.Get(kTranslation);
  const std::vector<double> t = translation_map->Numbers(translation_name, 3);
  // cv::stereoCalibrate: p_R = R p_L + T.
  Se3 T_R_L;
  T_R_L.rotation = Eigen::Quaterniond(
      ToRotation(rotation_map->Matrix3(rotation_name), rotation_map->Where(rotation_name)));
  T_R_L.translation = Eigen::Vector3d(t[0], t[1], t[2]);
  rig.T_L_R = T_R_L.inverse();
  return rig;
}

}  // namespace airdos
