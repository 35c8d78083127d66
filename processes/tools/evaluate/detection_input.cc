#include "processes/tools/evaluate/detection_input.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <map>
#include <memory>
#include <optional>
#include <set>

#include "common/dataset/keypoint_file.h"
#include "common/dataset/stereo_sequence.h"
#include "common/evaluation/people_files.h"
#include "common/evaluation/trajectory_file.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "processes/tools/evaluate/keypoint_log.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kSameTimeS = 0.001;
constexpr double kSameCameraPx = 0.5;
constexpr double kSameBaseline = 0.001;  // relative

double Seconds(std::int64_t utime) { return 1e-6 * static_cast<double>(utime); }

/// Finds what belongs to a time.
class TimeIndex {
 public:
  void Add(double time_s, std::size_t index) { index_of_.emplace(time_s, index); }
  std::optional<std::size_t> Find(double time_s) const {
    const auto first = index_of_.lower_bound(time_s - kSameTimeS);
    const auto end = index_of_.upper_bound(time_s + kSameTimeS);
    const auto nearest = std::min_element(first, end, [&](const auto& a, const auto& b) {
      return std::abs(a.first - time_s) < std::abs(b.first - time_s);
    });
    if (nearest == end) return std::nullopt;
    return nearest->second;
  }
  std::size_t size() const { return index_of_.size(); }
  std::string Range() const {
    return index_of_.empty() ? "none"
                             : Format("%.3f to %.3f s", index_of_.begin()->first,
                                      std::prev(index_of_.end())->first);
  }

 private:
  std::map<double, std::size_t> index_of_;
};

/// Who really was where, and the camera, by time.
class Truth {
 public:
  /// Empty if the folder has no true joints.
  explicit Truth(const std::string& folder) {
    std::string joints = folder + "/joints_gt.json.gz";
    if (!fs::exists(joints)) joints = folder + "/joints_gt.json";
    if (!fs::exists(joints)) return;
    people_ = ReadTruePeople(joints);
    camera_ = ReadTrajectory(folder + "/gt_tum_optical.txt");
    if (!camera_.has_times || !camera_.has_rotations) {
      throw InputError(camera_.path +
                       ": wanted are poses of the left camera with times and rotations (TUM), in "
                       "optical axes, in the world of the true joints");
    }
    for (std::size_t i = 0; i < people_.size(); ++i) people_at_.Add(people_[i].time_s, i);
    for (std::size_t i = 0; i < camera_.poses.size(); ++i) {
      camera_at_.Add(camera_.poses[i].time_s, i);
    }
  }

  bool is_empty() const { return people_.empty(); }
  std::optional<TrueScene> At(double time_s) const {
    const std::optional<std::size_t> people = people_at_.Find(time_s);
    const std::optional<std::size_t> camera = camera_at_.Find(time_s);
    if (!people || !camera) return std::nullopt;
    return TrueScene{people_[*people].people, camera_.poses[*camera]};
  }

 private:
  std::vector<TruePeople> people_;
  Trajectory camera_;
  TimeIndex people_at_;
  TimeIndex camera_at_;
};

std::vector<BodyKeypoints> ReadPeopleFile(const std::string& path) {
  std::vector<BodyKeypoints> people;
  const KeypointFile file = ReadKeypoints(path);
  for (const PersonKeypoints& person : file.people) {
    std::vector<BodyKeypoint> keypoints;
    for (const Keypoint& joint : person) {
      keypoints.push_back({joint.u_px, joint.v_px, joint.confidence});
    }
    const std::optional<BodyKeypoints> body =
        file.layout ? MapToBody(*file.layout, keypoints) : std::nullopt;
    if (body) people.push_back(*body);
  }
  return people;
}

void CheckCamera(const StereoCamera& logged, const StereoCamera& camera, const std::string& where) {
  const auto is_same_px = [](double a, double b) { return std::abs(a - b) <= kSameCameraPx; };
  if (logged.width == camera.width && logged.height == camera.height &&
      is_same_px(logged.fx_px, camera.fx_px) && is_same_px(logged.fy_px, camera.fy_px) &&
      is_same_px(logged.cx_px, camera.cx_px) && is_same_px(logged.cy_px, camera.cy_px) &&
      std::abs(logged.baseline_m / camera.baseline_m - 1) <= kSameBaseline) {
    return;
  }
  const auto describe = [](const StereoCamera& c) {
    return Format("%d x %d px, fx %.2f, fy %.2f, cx %.2f, cy %.2f, baseline %.4f m", c.width,
                  c.height, c.fx_px, c.fy_px, c.cx_px, c.cy_px, c.baseline_m);
  };
  throw InputError(where + ": different cameras (" + describe(logged) + "; " + describe(camera) +
                   ")");
}

bool AreSame(const BodyKeypoint& a, const BodyKeypoint& b) {
  return a.u_px == b.u_px && a.v_px == b.v_px && a.confidence == b.confidence;
}

bool AreSamePeople(const std::vector<BodyKeypoints>& a, const std::vector<BodyKeypoints>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const BodyKeypoints& x, const BodyKeypoints& y) {
                      return std::equal(x.begin(), x.end(), y.begin(), AreSame);
                    });
}

/// Whether the detections are nothing but the people given with the data set.
bool AreGivenOnes(const std::vector<DetectionFrame>& frames) {
  bool is_anybody_there = false;
  for (const DetectionFrame& frame : frames) {
    for (std::size_t side = 0; side < kNumImages; ++side) {
      const auto& detected = frame.detected[side];
      const auto& given = frame.given[side];
      if (!detected) continue;
      if (!given || !AreSamePeople(*detected, *given)) return false;
      is_anybody_there = is_anybody_there || !detected->empty();
    }
  }
  return is_anybody_there;
}

void Note(const std::string& text, Remarks* remarks) { remarks->push_back({false, text}); }

/// A warning about `num` things of a file; none if there are none.
void Warn(const std::string& path, std::size_t num, const std::string& text, Remarks* remarks) {
  if (num > 0) remarks->push_back({true, path + ": " + std::to_string(num) + " " + text});
}

void NoteLog(const std::string& path, const KeypointLog& log, Remarks* remarks) {
  std::set<std::int64_t> sessions;
  std::array<std::size_t, kNumImages> num_missing = {};
  for (const auto& [key, frame] : log.frames) {
    sessions.insert(key.first);
    for (std::size_t side = 0; side < kNumImages; ++side) {
      num_missing[side] += frame.people[side] ? 0 : 1;
    }
  }
  if (sessions.size() > 1) {
    Note(Format("%s: %zu sessions, all of which count", path.c_str(), sessions.size()), remarks);
  }
  if (!log.camera) Note(path + ": no CALIBRATION; the data set's is taken", remarks);
  Warn(path, static_cast<std::size_t>(log.num_lost), "messages of it are damaged", remarks);
  Warn(path, log.num_invalid, "messages with keypoints are invalid", remarks);
  Warn(path, log.num_again,
       "messages are of an image that has keypoints already; the first ones count", remarks);
  const std::string of_frames = "of " + std::to_string(log.frames.size()) + " frames have no ";
  Warn(path, num_missing[kLeftImage], of_frames + "keypoints of the left image", remarks);
  Warn(path, num_missing[kRightImage], of_frames + "keypoints of the right image", remarks);
}

/// What is known about frames of a data set.
class DataSet {
 public:
  explicit DataSet(const std::string& folder)
      : sequence_(OpenStereoSequence(folder)), truth_(folder) {
    for (std::size_t i = 0; i < sequence_->num_frames(); ++i) {
      frame_at_.Add(Seconds(sequence_->utime(i)), i);
    }
    if (truth_.is_empty() && !sequence_->has_people()) {
      throw InputError(folder +
                       ": has neither true joints (joints_gt.json.gz) nor keypoints to compare "
                       "with");
    }
  }

  const StereoCamera& camera() const { return sequence_->camera(); }
  bool has_truth() const { return !truth_.is_empty(); }
  bool has_given() const { return sequence_->has_people(); }
  const TimeIndex& times() const { return frame_at_; }

  DetectionFrame Frame(std::size_t index, const PeopleOfPair& detected) const {
    DetectionFrame frame;
    frame.detected = detected;
    frame.truth = truth_.At(Seconds(sequence_->utime(index)));
    if (has_given()) {
      const FrameFiles files = sequence_->files(index);
      frame.given = {ReadPeopleFile(files.keypoints_left), ReadPeopleFile(files.keypoints_right)};
    }
    return frame;
  }

 private:
  std::unique_ptr<StereoSequence> sequence_;
  Truth truth_;
  TimeIndex frame_at_;
};

}  // namespace

DetectionInput ReadDetections(const std::string& log_path, const std::string& folder) {
  const KeypointLog log = ReadKeypointLog(log_path);
  const DataSet data(folder);
  DetectionInput input;
  input.camera = data.camera();
  if (log.camera) CheckCamera(*log.camera, input.camera, log_path + " and " + folder);
  NoteLog(log_path, log, &input.remarks);
  TimeIndex log_times;
  std::set<std::size_t> known;
  std::size_t num_without_truth = 0;
  for (const auto& [key, frame] : log.frames) {
    log_times.Add(Seconds(frame.utime), log_times.size());
    const std::optional<std::size_t> index = data.times().Find(Seconds(frame.utime));
    if (!index) continue;
    known.insert(*index);
    input.frames.push_back(data.Frame(*index, frame.people));
    num_without_truth += input.frames.back().truth ? 0 : 1;
  }
  if (input.frames.empty()) {
    throw InputError(log_path + " and " + folder + " have no time in common: " + log_times.Range() +
                     "; " + data.times().Range());
  }
  Warn(log_path, log.frames.size() - input.frames.size(),
       "frames are at times that the data set does not have; they do not count", &input.remarks);
  Warn(folder, data.times().size() - known.size(),
       "images have no keypoints in the log; they do not count", &input.remarks);
  if (!data.has_truth()) {
    Note(folder + ": no joints_gt.json.gz, so people are compared with the given ones only",
         &input.remarks);
  } else {
    Warn(folder, num_without_truth, "frames have no true joints, or no true pose", &input.remarks);
  }
  if (!data.has_given()) Note(folder + ": no keypoints are given", &input.remarks);
  if (AreGivenOnes(input.frames)) {
    input.remarks.push_back(
        {true, log_path + ": its keypoints are those given with " + folder + ": no detector ran"});
  }
  return input;
}

}  // namespace airdos
