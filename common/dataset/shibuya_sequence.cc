#include "common/dataset/shibuya_sequence.h"

#include <algorithm>
#include <cmath>
#include <filesystem>

#include "common/calibration/calib_json.h"
#include "common/dataset/folder_sequence.h"
#include "common/dataset/sequence_files.h"
#include "common/dataset/times_file.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr std::int64_t kMaxTimeDifferenceUs = 1000;  // times have at least ms resolution

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

/// The camera requested by name, or otherwise that of the folder.
void FillCamera(const SequenceOptions& options, FolderSequence::Contents* contents) {
  const std::string first_image = contents->left.folder + "/" + contents->left.files[0];
  const std::pair<int, int> size = ReadImageSize(first_image);
  const std::string path = contents->folder + "/calib.json";
  if (options.calibration.empty()) {
    if (!fs::exists(path)) {
      throw InputError(path + ": is not there; write " + kCalibJsonForm +
                       ", or select the camera of the public data set with --calibration " +
                       kPublicCalibration);
    }
    contents->camera = ReadCalibJson(path, size);
    return;
  }
  contents->camera = PublicCamera();
  if (size != std::make_pair(contents->camera.width, contents->camera.height)) {
    throw InputError(first_image + ": with " + std::to_string(size.first) + " x " +
                     std::to_string(size.second) +
                     " px is not that of the public data set (640 x 360), " +
                     "whose calibration '" + options.calibration + "' was selected");
  }
  if (fs::exists(path)) {
    contents->notes.push_back(path + ": is not used, as calibration '" + options.calibration +
                              "' was selected");
  }
}

/// One row of gt_pose.txt.
struct TimedPose {
  std::optional<std::int64_t> utime;
  Se3 pose;
};

/// What an unreadable line looks like: "; ...", or empty.
std::string ExplainPoseLine(const TextLine& line) {
  const std::string separators = ExplainSeparators(line);
  const auto num_commas = std::count(line.words[0].begin(), line.words[0].end(), ',');
  if (num_commas >= 7) {
    return "; this is CSV as in EuRoC's state_groundtruth (ns, position, q_w first): awk -F, "
           "'!/^#/{printf \"%.6f %s %s %s %s %s %s %s\\n\",$1*1e-9,$2,$3,$4,$6,$7,$8,$5}' makes "
           "the rows";
  }
  if (!separators.empty()) return separators;
  if (line.words.size() == 12)
    return "; rows of 3 x 4 numbers (KITTI) are read from poses.txt "
           "in the layout with calib.txt";
  return "";
}

TimedPose ParsePose(const std::string& path, const TextLine& line) {
  constexpr const char* kForm = "`t tx ty tz qx qy qz qw`, or the same without t, in each row";
  const std::string where = path + ":" + std::to_string(line.number);
  const std::string explanation = ExplainPoseLine(line);
  if (!explanation.empty()) throw InputError(where + ": must hold " + kForm + explanation);
  const std::vector<double> numbers = ParseNumbers(path, line, 0);
  const std::size_t first = numbers.size() == 8 ? 1 : 0;
  if (numbers.size() != 7 + first) {
    throw InputError(where + ": must hold " + kForm + "; holds " + std::to_string(numbers.size()) +
                     " numbers");
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
    const std::string unit = OtherTimeUnit(numbers[0], 0);
    if (!unit.empty()) {
      throw InputError(where + WrongTimeUnit(unit, "'" + line.words[0] + "'") +
                       " (EuRoC has q_w first, too: expected is qx qy qz qw)");
    }
    std::int64_t utime = 0;
    if (!ParseMicroseconds(line.words[0], &utime)) {
      throw InputError(where + ": '" + line.words[0] + "' is not a time in s");
    }
    row.utime = utime;
  }
  return row;
}

std::vector<TimedPose> ReadPoses(const std::string& path) {
  std::vector<TimedPose> rows;
  for (const TextLine& line : ReadTextLines(path)) {
    rows.push_back(ParsePose(path, line));
    if (rows.back().utime.has_value() != rows[0].utime.has_value()) {
      throw InputError(path + ":" + std::to_string(line.number) +
                       ": must hold a time like the first row, or none; holds " +
                       std::to_string(line.words.size()) + " numbers");
    }
  }
  return rows;
}

/// Index of the image taken at a time, if there is one.
std::optional<std::size_t> FindImage(const std::vector<std::int64_t>& utimes, std::int64_t utime) {
  const auto it = std::lower_bound(utimes.begin(), utimes.end(), utime - kMaxTimeDifferenceUs);
  if (it == utimes.end() || *it > utime + kMaxTimeDifferenceUs) return std::nullopt;
  return static_cast<std::size_t>(it - utimes.begin());
}

std::string RangeText(std::int64_t first_us, std::int64_t last_us) {
  return Format("%.3f .. %.3f s", 1e-6 * static_cast<double>(first_us),
                1e-6 * static_cast<double>(last_us));
}

void FillPosesByTime(const std::string& path, const std::vector<TimedPose>& rows,
                     FolderSequence::Contents* contents) {
  const std::vector<std::int64_t>& utimes = contents->utimes;
  contents->ground_truth.assign(utimes.size(), std::nullopt);
  std::size_t num_found = 0;
  for (const TimedPose& row : rows) {
    const std::optional<std::size_t> image = FindImage(utimes, *row.utime);
    if (!image) continue;
    num_found += contents->ground_truth[*image] ? 0 : 1;
    contents->ground_truth[*image] = row.pose;
  }
  if (num_found == utimes.size()) return;
  std::string note = path + ": " + std::to_string(num_found) + " of " +
                     std::to_string(utimes.size()) + " images have a pose";
  if (num_found == 0) {
    note += ": its times, " + RangeText(*rows.front().utime, *rows.back().utime) +
            ", are not those of the images, " + RangeText(utimes.front(), utimes.back());
  }
  contents->notes.push_back(note);
}

void FillGroundTruth(FolderSequence::Contents* contents) {
  const std::string path = contents->folder + "/gt_pose.txt";
  if (!fs::exists(path)) return;
  const std::vector<TimedPose> rows = ReadPoses(path);
  if (rows.empty()) {
    contents->notes.push_back(path + ": contains no pose");
    return;
  }
  std::vector<Se3> poses;
  for (const TimedPose& row : rows) poses.push_back(row.pose);
  if (rows[0].utime) {
    FillPosesByTime(path, rows, contents);
  } else {
    FillPosesByRow(path, "poses", poses, contents);
  }
  poses.clear();
  for (const std::optional<Se3>& pose : contents->ground_truth) {
    if (pose) poses.push_back(*pose);
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
  Eigen::Vector3d travel_body_m = Eigen::Vector3d::Zero();  // along each body axis, absolute values
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

std::unique_ptr<StereoSequence> OpenShibuyaSequence(const std::string& folder,
                                                    const SequenceOptions& options) {
  FolderSequence::Contents contents;
  contents.folder = folder;
  contents.left_folder = "image_0";
  contents.right_folder = "image_1";
  FillImagesAndTimes(&contents);
  FillCamera(options, &contents);
  FillGroundTruth(&contents);
  return std::make_unique<FolderSequence>(std::move(contents));
}

}  // namespace airdos
