#include "common/calibration/calibration_file.h"

#include "common/calibration/calib_json.h"
#include "common/calibration/rig_judge.h"
#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/words.h"

namespace airdos {
namespace {

constexpr std::size_t kMaxBytes = 1000000;

CalibrationText ReadText(const std::string& path) {
  std::string text = ReadWholeFile(path, kMaxBytes);
  if (text.rfind("\xEF\xBB\xBF", 0) == 0) text.erase(0, 3);
  if (text.rfind("\xFF\xFE", 0) == 0 || text.rfind("\xFE\xFF", 0) == 0)
    throw InputError(path + ": is UTF-16: save it as UTF-8");
  return {path, text};
}

[[noreturn]] void NeedsBoth(const std::string& path, const std::string& format) {
  throw InputError(path + ": is the file of one camera (" + format +
                   "): give the left and the right one");
}

StereoRig ReadJson(const CalibrationText& file, const FormatOptions& options) {
  std::pair<int, int> size = ReadCalibJsonSize(file.path);
  if (size.first == 0) size = options.chosen_size();
  if (size.first == 0) {
    throw InputError(file.path +
                     ": does not say the images' size: say it with --size WIDTHxHEIGHT");
  }
  StereoRig rig;
  rig.format = "calib.json";
  rig.rectified = ReadCalibJson(file.path, size);
  rig.are_images_rectified = true;
  const StereoCamera& camera = *rig.rectified;
  rig.left = {camera.width, camera.height, camera.fx_px,     camera.fy_px,
              camera.cx_px, camera.cy_px,  LensModel::kNone, {}};
  rig.right = rig.left;
  rig.T_L_R.translation = Eigen::Vector3d(camera.baseline_m, 0, 0);
  return rig;
}

/// What a file may be that is no calibration of a pair, for whoever took the wrong one.
[[noreturn]] void ThrowUnknown(const CalibrationText& file) {
  const auto has = [&file](const char* text) { return file.text.find(text) != std::string::npos; };
  if (has("<opencv_storage>"))
    throw InputError(file.path + ": is OpenCV's XML, which is not read: save it as .yml");
  if (has("cam0:") || (has("fx") && has("[image]")))
    throw InputError(file.path + ": is the calibration of a single camera; a pair's is needed");
  if (has("reprojection error") && has("baseline T_1_0"))
    throw InputError(file.path + ": is Kalibr's report; give the camchain .yaml beside it");
  throw InputError(file.path + ": is no calibration file of a stereo pair that is known (" +
                   JoinWords(CalibrationFormats(), ", ") + ")");
}

StereoRig ReadOne(const CalibrationText& file, const FormatOptions& options) {
  if (IsKalibr(file)) return ReadKalibr(file);
  if (IsOrbSlam(file)) return ReadOrbSlam(file);
  if (IsZed(file)) return ReadZed(file, options);
  if (IsKitti(file)) return ReadKitti(file, options);
  if (IsOpencvStereo({file})) return ReadOpencvStereo({file}, options);
  if (IsCalibJson(file)) return ReadJson(file, options);
  if (IsRosCameraInfo(file)) NeedsBoth(file.path, "ROS camera_info");
  if (IsEurocSensor(file)) NeedsBoth(file.path, "EuRoC sensor.yaml");
  ThrowUnknown(file);
}

StereoRig ReadTwo(const CalibrationText& left, const CalibrationText& right,
                  const FormatOptions& options) {
  if (IsRosCameraInfo(left) && IsRosCameraInfo(right)) return ReadRosPair(left, right);
  if (IsEurocSensor(left) && IsEurocSensor(right)) return ReadEurocPair(left, right);
  if (IsOpencvStereo({left, right})) return ReadOpencvStereo({left, right}, options);
  throw InputError(left.path + " and " + right.path +
                   ": are no pair of calibration files that is known (ROS camera_info, EuRoC "
                   "sensor.yaml, OpenCV's intrinsics.yml and extrinsics.yml)");
}

}  // namespace

bool IsCalibJson(const CalibrationText& file) {
  const std::size_t first = file.text.find_first_not_of(" \t\r\n");
  return first != std::string::npos && file.text[first] == '{';
}

const std::vector<std::string>& CalibrationFormats() {
  static const std::vector<std::string> formats = {"Kalibr camera chain",
                                                   "ROS camera_info pair",
                                                   "OpenCV stereo YAML",
                                                   "EuRoC sensor.yaml pair",
                                                   "ORB-SLAM2/3 settings",
                                                   "KITTI calib.txt and calib_cam_to_cam.txt",
                                                   "ZED .conf",
                                                   "calib.json"};
  return formats;
}

StereoRig ReadStereoRig(const std::vector<std::string>& paths, const CalibrationOptions& options) {
  if (paths.empty() || paths.size() > 2)
    throw InputError("a calibration is one file or two, not " + std::to_string(paths.size()));
  const CalibrationText first = ReadText(paths[0]);
  StereoRig rig = paths.size() == 1 ? ReadOne(first, options.format)
                                    : ReadTwo(first, ReadText(paths[1]), options.format);
  rig.files = paths;
  const std::string where = paths.size() == 1 ? paths[0] : paths[0] + ", " + paths[1];
  JudgeRig(where, options, &rig);
  return rig;
}

}  // namespace airdos
