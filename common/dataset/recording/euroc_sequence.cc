#include "common/dataset/recording/euroc_sequence.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <filesystem>

#include "common/calibration/calibration_file.h"
#include "common/calibration/calibration_yaml.h"
#include "common/calibration/rigid_matrix.h"
#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/recording_times.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "common/dataset/sequence_files.h"
#include "common/util/error.h"
#include "common/util/input_file.h"
#include "common/util/text_file.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

/// The folder that holds cam0 and cam1; empty if there is none.
std::string FolderOfCameras(const std::string& folder) {
  for (const std::string& path : {folder + "/mav0", folder}) {
    if (fs::is_directory(path + "/cam0/data") && fs::is_directory(path + "/cam1/data")) return path;
  }
  return "";
}

Se3 ReadPoseInBody(const std::string& path) {
  constexpr std::size_t kMaxBytes = 1 << 20;
  const CalibrationYaml yaml = CalibrationYaml::Parse(ReadWholeFile(path, kMaxBytes), path);
  return ToSe3(yaml.Transform("T_BS"), yaml.Where("T_BS"));
}

struct TimedBody {
  std::int64_t utime = 0;
  Se3 T_W_B;
};

TimedBody ParseBody(const std::string& path, const TextLine& line) {
  TextLine split{line.number, ColumnsOf(line)};
  const std::string where = path + ":" + std::to_string(line.number) + ": ";
  constexpr std::size_t kNumColumns = 8;
  if (split.words.size() < kNumColumns) {
    throw InputError(where + "must hold a time in ns, 3 numbers of a position and 4 of a rotation");
  }
  TimedBody body;
  if (!ParseMicroseconds(split.words[0] + "e-9", &body.utime)) {
    throw InputError(where + "'" + Shown(split.words[0]) + "' is not a time in ns");
  }
  split.words.resize(kNumColumns);
  const std::vector<double> n = ParseNumbers(path, split, 1);
  body.T_W_B.translation = {n[0], n[1], n[2]};
  body.T_W_B.rotation = Eigen::Quaterniond(n[3], n[4], n[5], n[6]);
  if (std::abs(body.T_W_B.rotation.norm() - 1) > 1e-2) {
    throw InputError(where + "the quaternion is not of length 1");
  }
  body.T_W_B.rotation.normalize();
  return body;
}

std::vector<TimedBody> ReadBodies(const std::string& path) {
  std::vector<TimedBody> bodies;
  for (const TextLine& line : ReadTextLines(path)) {
    bodies.push_back(ParseBody(path, line));
    if (bodies.size() > 1 && bodies.back().utime <= bodies[bodies.size() - 2].utime) {
      throw InputError(path + ":" + std::to_string(line.number) +
                       ": the time does not come after the previous one");
    }
  }
  return bodies;
}

/// Between the two rows around the time; nothing if these are too far apart.
std::optional<Se3> BodyAt(const std::vector<TimedBody>& bodies, std::int64_t utime) {
  constexpr std::int64_t kMaxGap_us = 50000;
  const auto after =
      std::lower_bound(bodies.begin(), bodies.end(), utime,
                       [](const TimedBody& body, std::int64_t time) { return body.utime < time; });
  if (after == bodies.end()) return std::nullopt;
  if (after->utime == utime) return after->T_W_B;
  if (after == bodies.begin()) return std::nullopt;
  const TimedBody& before = *(after - 1);
  const std::int64_t gap_us = after->utime - before.utime;
  if (gap_us > kMaxGap_us) return std::nullopt;
  const double share = static_cast<double>(utime - before.utime) / static_cast<double>(gap_us);
  Se3 T_W_B;
  T_W_B.translation =
      before.T_W_B.translation + share * (after->T_W_B.translation - before.T_W_B.translation);
  T_W_B.rotation = before.T_W_B.rotation.slerp(share, after->T_W_B.rotation);
  return T_W_B;
}

/// `T_B_L`: of the left camera before rectification.
void FillGroundTruth(const std::string& path, const Se3& T_B_L, RectifiedSequence* sequence) {
  Se3 T_L_C;  // rectification turns the camera about its centre
  T_L_C.rotation = Eigen::Quaterniond(sequence->rectifier().R_rect_left()).conjugate();
  const std::vector<TimedBody> bodies = ReadBodies(path);
  std::vector<std::optional<Se3>> T_C0_C;
  std::optional<Se3> T_C0_W;
  for (std::size_t i = 0; i < sequence->num_frames(); ++i) {
    const std::optional<Se3> T_W_B = BodyAt(bodies, sequence->utime(i));
    if (!T_W_B) {
      T_C0_C.emplace_back();
      continue;
    }
    const Se3 T_W_C = *T_W_B * T_B_L * T_L_C;
    if (!T_C0_W) T_C0_W = T_W_C.inverse();
    T_C0_C.emplace_back(*T_C0_W * T_W_C);
  }
  const auto num_posed = std::count_if(T_C0_C.begin(), T_C0_C.end(),
                                       [](const std::optional<Se3>& T) { return T.has_value(); });
  if (static_cast<std::size_t>(num_posed) < T_C0_C.size()) {
    sequence->AddNote(path + ": " + std::to_string(num_posed) + " of " +
                      std::to_string(T_C0_C.size()) + " images have a pose");
  }
  if (num_posed > 0) sequence->SetGroundTruth(std::move(T_C0_C));
}

}  // namespace

bool IsEurocSequence(const std::string& folder) { return !FolderOfCameras(folder).empty(); }

std::unique_ptr<StereoSequence> OpenEurocSequence(const std::string& folder) {
  const std::string root = FolderOfCameras(folder);
  const std::string left_sensor = root + "/cam0/sensor.yaml";
  for (const std::string& path : {left_sensor, root + "/cam1/sensor.yaml"}) {
    if (!fs::exists(path)) {
      throw InputError(path +
                       ": is not there; with another calibration, play the images with "
                       "--images " +
                       root + "/cam0 " + root + "/cam1 --calibration FILE");
    }
  }
  FolderRecordingOptions options;
  options.left = root + "/cam0/data";
  options.right = root + "/cam1/data";
  const std::string times = root + "/cam0/data.csv";
  if (fs::exists(times)) options.times = times;
  auto recording = std::make_unique<FolderRecording>(options);
  CalibrationOptions calibration;
  calibration.format.image_size = recording->image_size();
  const StereoRig rig = ReadStereoRig({left_sensor, root + "/cam1/sensor.yaml"}, calibration);
  auto sequence = std::make_unique<RectifiedSequence>(std::move(recording), rig);
  const std::string truth = root + "/state_groundtruth_estimate0/data.csv";
  if (fs::exists(truth)) FillGroundTruth(truth, ReadPoseInBody(left_sensor), sequence.get());
  return sequence;
}

}  // namespace airdos
