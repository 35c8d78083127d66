#include <charconv>
#include <cmath>
#include <map>
#include <sstream>
#include <system_error>
#include <tuple>

#include "common/calibration/camera_matrix.h"
#include "common/calibration/rig_formats.h"
#include "common/calibration/rigid_matrix.h"
#include "common/util/error.h"

namespace airdos {
namespace {

/// "KEY: numbers" lines; lines of other kinds (dates) are left out.
class KittiLines {
 public:
  explicit KittiLines(const CalibrationText& file) : path_(file.path) {
    std::istringstream lines(file.text);
    std::string line;
    while (std::getline(lines, line)) {
      const std::size_t colon = line.find(':');
      if (colon == std::string::npos) continue;
      std::istringstream words(line.substr(colon + 1));
      std::vector<std::string>& values = lines_[line.substr(0, colon)];
      values.clear();
      for (std::string word; words >> word;) values.push_back(word);
    }
  }
  bool Has(const std::string& key) const { return lines_.count(key) > 0; }
  std::string Where(const std::string& key) const { return path_ + ": key '" + key + "'"; }
  std::vector<double> Numbers(const std::string& key, std::size_t count) const {
    const auto line = lines_.find(key);
    if (line == lines_.end()) throw InputError(Where(key) + " is missing");
    if (line->second.size() != count) {
      throw InputError(Where(key) + " must hold " + std::to_string(count) + " numbers, holds " +
                       std::to_string(line->second.size()));
    }
    std::vector<double> numbers;
    for (const std::string& word : line->second) {
      double number = 0;
      const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), number);
      if (error != std::errc() || end != word.data() + word.size() || !std::isfinite(number)) {
        throw InputError(Where(key) + " with value '" + word + "': is no finite number");
      }
      numbers.push_back(number);
    }
    return numbers;
  }
  ProjectionMatrix Projection(const std::string& key) const {
    return ToProjection(Numbers(key, 12), Where(key));
  }

 private:
  std::string path_;
  std::map<std::string, std::vector<std::string>> lines_;
};

std::string TwoDigits(int camera) { return "0" + std::to_string(camera); }

void SetRectified(const StereoCamera& camera, StereoRig* rig) {
  rig->rectified = camera;
  rig->are_images_rectified = true;
  rig->left = {camera.width, camera.height, camera.fx_px,     camera.fy_px,
               camera.cx_px, camera.cy_px,  LensModel::kNone, {}};
  rig->right = rig->left;
  rig->T_L_R = {};
  rig->T_L_R.translation = Eigen::Vector3d(camera.baseline_m, 0, 0);
}

[[noreturn]] void ThrowNoPair(const KittiLines& lines, const std::string& key,
                              std::pair<int, int> cameras) {
  throw InputError(lines.Where(key + std::to_string(cameras.second)) + " differs from camera " +
                   std::to_string(cameras.first) +
                   "'s in more than its fourth number: no rectified pair");
}

struct RawCamera {
  CameraIntrinsics intrinsics;
  std::pair<int, int> rectified_size;
  Se3 T_i_0;  // p_i = T_i_0 * p_0
  ProjectionMatrix P;
};

std::pair<int, int> SizeAt(const KittiLines& lines, const std::string& key) {
  const std::vector<double> size = lines.Numbers(key, 2);
  return ToImageSize(size[0], size[1], lines.Where(key));
}

RawCamera ReadRawCamera(const KittiLines& lines, int number) {
  const std::string i = TwoDigits(number);
  const auto matrix = [&lines](const std::string& key) -> Eigen::Matrix3d {
    return Eigen::Map<const Eigen::Matrix<double, 3, 3, Eigen::RowMajor>>(
        lines.Numbers(key, 9).data());
  };
  RawCamera camera;
  camera.intrinsics = ToIntrinsics(matrix("K_" + i), lines.Where("K_" + i));
  std::tie(camera.intrinsics.width, camera.intrinsics.height) = SizeAt(lines, "S_" + i);
  camera.intrinsics.lens = LensModel::kRadialTangential;
  camera.intrinsics.distortion = lines.Numbers("D_" + i, 5);
  camera.rectified_size = SizeAt(lines, "S_rect_" + i);
  camera.T_i_0.rotation = Eigen::Quaterniond(ToRotation(matrix("R_" + i), lines.Where("R_" + i)));
  camera.T_i_0.translation = Eigen::Map<const Eigen::Vector3d>(lines.Numbers("T_" + i, 3).data());
  camera.P = lines.Projection("P_rect_" + i);
  return camera;
}

/// calib_cam_to_cam.txt: the size of the images says which they are.
StereoRig ReadRaw(const KittiLines& lines, const FormatOptions& options) {
  const RawCamera left = ReadRawCamera(lines, options.kitti_cameras.first);
  const RawCamera right = ReadRawCamera(lines, options.kitti_cameras.second);
  StereoRig rig;
  rig.left = left.intrinsics;
  rig.right = right.intrinsics;
  rig.T_L_R = left.T_i_0 * right.T_i_0.inverse();
  rig.rectified = RectifiedPair(left.P, right.P, left.rectified_size);
  const std::pair<int, int> raw_size = {rig.left.width, rig.left.height};
  if (options.chosen_size() == left.rectified_size && left.rectified_size != raw_size) {
    if (!rig.rectified) ThrowNoPair(lines, "P_rect_0", options.kitti_cameras);
    SetRectified(*rig.rectified, &rig);
    rig.notes.push_back("the images have the size of S_rect: they are taken as rectified");
  }
  rig.format = "KITTI raw calib_cam_to_cam.txt";
  return rig;
}

}  // namespace

bool IsKitti(const CalibrationText& file) {
  return file.text.find("P_rect_0") != std::string::npos || file.text.rfind("P0:", 0) == 0 ||
         file.text.find("\nP0:") != std::string::npos;
}

StereoRig ReadKitti(const CalibrationText& file, const FormatOptions& options) {
  const KittiLines lines(file);
  const auto [left, right] = options.kitti_cameras;
  StereoRig rig;
  if (lines.Has("P_rect_" + TwoDigits(left))) {
    rig = ReadRaw(lines, options);
  } else {
    const auto pair =
        RectifiedPair(lines.Projection("P" + std::to_string(left)),
                      lines.Projection("P" + std::to_string(right)), options.chosen_size());
    if (!pair) ThrowNoPair(lines, "P", options.kitti_cameras);
    SetRectified(*pair, &rig);
    rig.format = "KITTI calib.txt";
  }
  rig.notes.push_back("cameras " + std::to_string(left) + " and " + std::to_string(right) +
                      " of the file");
  return rig;
}

}  // namespace airdos
