#include "common/dataset/folder_writer.h"

#include <cinttypes>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "common/dataset/image_file.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/json_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kGroup[] = "import";
constexpr char kCalibration[] = "calib.json";

/// What a reader would take for a part of the data set.
const std::vector<std::string>& PartsOfDataset() {
  static const std::vector<std::string> parts = {
      "image_0",     "image_1",     "image_2",         "image_3",     "image_l",  "image_r",
      "alphapose_0", "alphapose_1", "rcnnseg_image_0", "mav0",        "cam0",     "cam1",
      "calib.txt",   "calib.json",  "times.txt",       "gt_pose.txt", "poses.txt"};
  return parts;
}

/// Files that belong to somebody else would mix with ours.
void RefuseForeignParts(const OutputFolder& folder) {
  const auto refuse = [&folder](const std::string& name) {
    if (folder.IsListed(name)) return;
    throw InputError(folder.PathOf(name) +
                     ": was not written by airdos-import, and would be taken for a part of the "
                     "data set; choose another folder");
  };
  for (const std::string& part : PartsOfDataset()) {
    const fs::path path = folder.PathOf(part);
    if (fs::is_directory(path)) {
      for (const fs::directory_entry& entry : fs::recursive_directory_iterator(path)) {
        if (!entry.is_directory()) refuse(entry.path().lexically_relative(folder.path()).string());
      }
    } else if (fs::exists(fs::symlink_status(path))) {
      refuse(part);
    }
  }
}

/// The path, if it may be written to.
const std::string& RequireEmpty(const std::string& path, bool force) {
  std::error_code error;
  if (force || !fs::is_directory(path, error) || fs::is_empty(path, error)) return path;
  throw InputError(path + ": is not empty; --force replaces what airdos-import wrote there");
}

std::string EndingOfImage(const std::vector<std::uint8_t>& file) {
  return !file.empty() && file[0] == 0xFF ? ".jpg" : ".png";
}

/// Exact, without floating point.
std::string Seconds(std::int64_t utime) {
  constexpr std::int64_t kPerSecond = 1000000;
  const std::uint64_t size =
      utime < 0 ? 0 - static_cast<std::uint64_t>(utime) : static_cast<std::uint64_t>(utime);
  return (utime < 0 ? "-" : "") +
         Format("%" PRIu64 ".%06" PRIu64, size / kPerSecond, size % kPerSecond);
}

// Of body and world: NED's x is forward (z), y right (x), z down (y). A permutation loses no digit.
Se3 NedOf(const Se3& optical) {
  const Eigen::Vector3d& t = optical.translation;
  const Eigen::Quaterniond& q = optical.rotation;
  Se3 ned;
  ned.translation = {t.z(), t.x(), t.y()};
  ned.rotation = Eigen::Quaterniond(q.w(), q.z(), q.x(), q.y());
  return ned;
}

}  // namespace

FolderWriter::FolderWriter(const std::string& path, const OutputRules& rules)
    : folder_(RequireEmpty(path, rules.force), rules) {
  RefuseForeignParts(folder_);
  folder_.RemoveEarlier(
      [](const std::string&, const std::string& group) { return group == kGroup; });
}

void FolderWriter::Write(const std::string& name, const void* data, std::size_t size) {
  const std::string path = folder_.Claim(name, kGroup);
  std::ofstream file(path, std::ios::binary | std::ios::trunc);
  file.write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
  file.close();
  if (!file) throw InputError(path + ": cannot be written (is the disk full?)");
}

void FolderWriter::Write(const std::string& name, const std::string& text) {
  Write(name, text.data(), text.size());
}

void FolderWriter::AddPeople(const std::string& folder, const std::string& number,
                             const std::vector<PersonKeypoints>& people) {
  if (people.empty()) return;
  std::string rows;
  for (const PersonKeypoints& person : people) {
    for (const Keypoint& joint : person) {
      rows += Format("%.9g %.9g %.9g ", static_cast<double>(joint.u_px),
                     static_cast<double>(joint.v_px), static_cast<double>(joint.confidence));
    }
    rows.back() = '\n';
  }
  Write(folder + "/" + number + ".txt", rows);
}

void FolderWriter::Add(const SequenceFrame& frame, TrajectoryAxes axes) {
  const std::string number = Format("%06zu", num_frames_++);
  const auto write = [&](const std::string& folder, const std::vector<std::uint8_t>& file) {
    Write(folder + "/" + number + EndingOfImage(file), file.data(), file.size());
  };
  const auto write_image = [&](const std::string& folder, const std::vector<std::uint8_t>& file,
                               const cv::Mat& pixels) {
    write(folder, file.empty() && !pixels.empty() ? EncodePng(pixels) : file);
  };
  write_image("image_0", frame.left_image_file, frame.left_pixels);
  write_image("image_1", frame.right_image_file, frame.right_pixels);
  if (!frame.person_mask_file.empty()) write("rcnnseg_image_0", frame.person_mask_file);
  AddPeople("alphapose_0", number, frame.keypoints_left);
  AddPeople("alphapose_1", number, frame.keypoints_right);
  const std::string time = Seconds(frame.utime);
  times_ += time + "\n";
  if (!frame.ground_truth) return;
  const Se3 pose =
      axes == TrajectoryAxes::kOptical ? NedOf(*frame.ground_truth) : *frame.ground_truth;
  const Eigen::Vector3d& t = pose.translation;
  const Eigen::Quaterniond& q = pose.rotation;
  poses_ += time + Format(" %.17g %.17g %.17g %.17g %.17g %.17g %.17g\n", t.x(), t.y(), t.z(),
                          q.x(), q.y(), q.z(), q.w());
}

void FolderWriter::Finish(const StereoCamera& camera) {
  if (num_frames_ == 0) throw InputError(folder_.path() + ": there is no frame to write");
  Write("times.txt", times_);
  if (!poses_.empty()) Write("gt_pose.txt", poses_);
  const nlohmann::json calibration = {{"fx", camera.fx_px},
                                      {"fy", camera.fy_px},
                                      {"cx", camera.cx_px},
                                      {"cy", camera.cy_px},
                                      {"baseline_m", camera.baseline_m},
                                      {"width", camera.width},
                                      {"height", camera.height}};
  Write(kCalibration, JsonText(calibration) + "\n");
  folder_.Finish();
}

}  // namespace airdos
