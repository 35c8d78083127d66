#include "common/dataset/shibuya_sequence.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "common/dataset/folder_sequence.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxJsonBytes = 100000;
constexpr std::int64_t kMaxTimeDifferenceUs = 1000;  // times are written with at least ms

StereoCamera PublicCamera() {
  StereoCamera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx_px = camera.fy_px = 772.5483399593904;
  camera.cx_px = 320;
  camera.cy_px = 180;
  camera.baseline_m = 0.25;
  return camera;
}

double ReadNumber(const nlohmann::json& json, const std::string& path, const std::string& key) {
  if (!json.contains(key)) throw InputError(path + ": key '" + key + "' is missing");
  if (!json[key].is_number()) {
    // Its value may be nested more deeply than dump() bears.
    throw InputError(path + ": key '" + key + "' with a value of type " + json[key].type_name() +
                     ": must be a number");
  }
  return json[key].get<double>();
}

StereoCamera ReadCalibJson(const std::string& path, std::pair<int, int> size) {
  const std::vector<std::uint8_t> text = ReadBytes(path);
  if (text.size() > kMaxJsonBytes) {
    throw InputError(path + ": holds more than " + std::to_string(kMaxJsonBytes) + " bytes");
  }
  const nlohmann::json json = nlohmann::json::parse(text, nullptr, /*allow_exceptions=*/false);
  if (!json.is_object()) throw InputError(path + ": is no JSON object");
  StereoCamera camera;
  std::tie(camera.width, camera.height) = size;
  for (const auto& [key, actual] : {std::make_pair("width", size.first), {"height", size.second}}) {
    if (json.contains(key) && ReadNumber(json, path, key) != actual) {
      throw InputError(path + ": key '" + key + "' with value '" + json[key].dump() +
                       "': the first image has " + std::to_string(actual) + " px");
    }
  }
  camera.fx_px = ReadNumber(json, path, "fx");
  camera.fy_px = ReadNumber(json, path, "fy");
  camera.cx_px = ReadNumber(json, path, "cx");
  camera.cy_px = ReadNumber(json, path, "cy");
  camera.baseline_m = ReadNumber(json, path, "baseline_m");
  if (!camera.IsValid()) {
    throw InputError(path + ": no pinhole pair for images of " + std::to_string(camera.width) +
                     " x " + std::to_string(camera.height) + " px");
  }
  return camera;
}

void FillCamera(FolderSequence::Contents* contents) {
  const std::string first_image =
      contents->folder + "/" + contents->left_folder + "/" + contents->left_names[0];
  const std::pair<int, int> size = ReadImageSize(first_image);
  const std::string path = contents->folder + "/calib.json";
  if (fs::exists(path)) {
    contents->camera = ReadCalibJson(path, size);
    return;
  }
  contents->camera = PublicCamera();
  if (size != std::make_pair(contents->camera.width, contents->camera.height)) {
    throw InputError(path + ": is not there, and " + first_image + " with " +
                     std::to_string(size.first) + " x " + std::to_string(size.second) +
                     " px is not of the public set (640 x 360)");
  }
  contents->notes.push_back(path +
                            " is not there: the calibration of the public TartanAir-Shibuya set is "
                            "used (f 772.548 px, centre 320 180, baseline 0.25 m)");
}

/// One row of gt_pose.txt.
struct TimedPose {
  std::optional<std::int64_t> utime;
  Se3 pose;
};

std::vector<TimedPose> ReadPoses(const std::string& path) {
  std::vector<TimedPose> rows;
  for (const TextLine& line : ReadTextLines(path)) {
    const std::vector<double> numbers = ParseNumbers(path, line, 0);
    const std::size_t first = numbers.size() == 8 ? 1 : 0;
    const std::string where = path + ":" + std::to_string(line.number);
    if (numbers.size() != 7 + first ||
        (!rows.empty() && rows[0].utime.has_value() != (first == 1))) {
      throw InputError(where + ": must hold `t tx ty tz qx qy qz qw`, or the same without t, in " +
                       "each row; holds " + std::to_string(numbers.size()) + " numbers");
    }
    const double* const n = numbers.data() + first;
    TimedPose row;
    row.pose.translation = {n[0], n[1], n[2]};
    row.pose.rotation = Eigen::Quaterniond(n[6], n[3], n[4], n[5]);
    if (std::abs(row.pose.rotation.norm() - 1) > 1e-2) {
      throw InputError(where + ": the quaternion is not of length 1");
    }
    row.pose.rotation.normalize();
    if (first == 1) {
      std::int64_t utime = 0;
      if (!ParseMicroseconds(line.words[0], &utime)) {
        throw InputError(where + ": '" + line.words[0] + "' is no time in s");
      }
      row.utime = utime;
    }
    rows.push_back(row);
  }
  return rows;
}

/// Index of the image that a row belongs to, if any: by time, or by its number where it has none.
std::optional<std::size_t> FindImage(const std::vector<std::int64_t>& utimes, const TimedPose& row,
                                     std::size_t row_index) {
  if (!row.utime) {
    return row_index < utimes.size() ? std::make_optional(row_index) : std::nullopt;
  }
  const auto it = std::lower_bound(utimes.begin(), utimes.end(), *row.utime - kMaxTimeDifferenceUs);
  if (it == utimes.end() || *it > *row.utime + kMaxTimeDifferenceUs) return std::nullopt;
  return static_cast<std::size_t>(it - utimes.begin());
}

void FillGroundTruth(FolderSequence::Contents* contents) {
  const std::string path = contents->folder + "/gt_pose.txt";
  if (!fs::exists(path)) return;
  const std::vector<TimedPose> rows = ReadPoses(path);
  contents->ground_truth.resize(contents->utimes.size());
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const std::optional<std::size_t> image = FindImage(contents->utimes, rows[i], i);
    if (image) contents->ground_truth[*image] = rows[i].pose;
  }
  std::vector<Se3> poses;
  for (const std::optional<Se3>& pose : contents->ground_truth) {
    if (pose) poses.push_back(*pose);
  }
  if (poses.size() != contents->utimes.size()) {
    contents->notes.push_back(path + ": " + std::to_string(poses.size()) + " of " +
                              std::to_string(contents->utimes.size()) + " images have a pose");
  }
  contents->axes = TrajectoryAxes::kNed;
  if (ContradictsNed(poses)) {
    contents->axes = TrajectoryAxes::kUnknown;
    contents->notes.push_back(path +
                              ": the layout says NED axes, but the camera would then lie on its "
                              "side or travel along its vertical axis: axes unknown");
  }
}

}  // namespace

bool ContradictsNed(const std::vector<Se3>& T_world_body) {
  if (T_world_body.empty()) return false;
  double sum_of_cosines = 0;
  Eigen::Vector3d travel_body_m = Eigen::Vector3d::Zero();  // per body axis, without sign
  for (std::size_t i = 0; i < T_world_body.size(); ++i) {
    const Se3& pose = T_world_body[i];
    sum_of_cosines += (pose.rotation * Eigen::Vector3d::UnitZ()).z();
    if (i == 0) continue;
    const Eigen::Vector3d step_m = pose.translation - T_world_body[i - 1].translation;
    travel_body_m += (pose.rotation.conjugate() * step_m).cwiseAbs();
  }
  constexpr double kCosine60Deg = 0.5;
  if (sum_of_cosines < kCosine60Deg * static_cast<double>(T_world_body.size())) return true;
  return travel_body_m.z() > 3 * std::max(travel_body_m.x(), travel_body_m.y());
}

std::unique_ptr<StereoSequence> OpenShibuyaSequence(const std::string& folder) {
  FolderSequence::Contents contents;
  contents.folder = folder;
  contents.left_folder = "image_0";
  contents.right_folder = "image_1";
  FillImagesAndTimes(&contents);
  FillCamera(&contents);
  FillGroundTruth(&contents);
  return std::make_unique<FolderSequence>(std::move(contents));
}

}  // namespace airdos
