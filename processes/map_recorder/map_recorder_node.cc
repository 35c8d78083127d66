#include "processes/map_recorder/map_recorder_node.h"

#include <cstdio>
#include <filesystem>
#include <utility>

#include "common/map/map_export.h"
#include "common/util/error.h"
#include "common/util/free_disk.h"
#include "common/util/version.h"
#include "processes/map_recorder/earlier_maps.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr char kGroup[] = "run";  // in the folder's list
constexpr int kGroundTruthPerChunk = 10000;
constexpr std::size_t kLargeChunkBytes = 8u << 20;  // then it does not wait for its last frame

MapHuman ToMapHuman(const human_state_t& message) {
  MapHuman human;
  human.utime = message.utime;
  for (std::size_t i = 0; i < message.joint_id.size(); ++i) {
    MapJoint& joint = human.joints[message.joint_id[i]];
    joint.p_W = {message.x_W_m[i], message.y_W_m[i], message.z_W_m[i]};
    joint.p_W_measured = {message.x_W_measured_m[i], message.y_W_measured_m[i],
                          message.z_W_measured_m[i]};
  }
  for (std::size_t i = 0; i < message.segment_id.size(); ++i) {
    human.segment_lengths_m[message.segment_id[i]] = message.length_m[i];
  }
  for (std::size_t i = 0; i < message.part_id.size(); ++i) {
    MapPartMotion& motion = human.part_motions[message.part_id[i]];
    const auto& t = message.translation_m[i];
    const auto& q = message.rotation[i];
    motion.t_W = {t[0], t[1], t[2]};
    motion.R_W = Eigen::Quaternionf(q[0], q[1], q[2], q[3]);
  }
  return human;
}

void AddUpdate(const map_update_t& message, MapDelta* changes) {
  for (const frame_pose_t& pose : message.frames) {
    MapFrame frame;
    frame.utime = pose.utime;
    frame.refined = ToSe3(pose.position_W_C, pose.orientation_W_C);
    changes->SetFrame({pose.seq}, frame);
  }
  for (std::size_t i = 0; i < message.landmark_id.size(); ++i) {
    MapLandmark landmark;
    landmark.p_W =
        Eigen::Vector3d(message.x_W_m[i], message.y_W_m[i], message.z_W_m[i]).cast<float>();
    landmark.sigma_m = message.sigma_m[i];
    landmark.num_observations = message.num_observations[i];
    changes->SetLandmark({message.landmark_id[i]}, landmark);
  }
  for (const std::int64_t id : message.removed_landmark_id) changes->RemoveLandmark({id});
  for (const human_state_t& human : message.humans) {
    changes->SetHuman({human.seq}, {human.track_id}, ToMapHuman(human));
  }
}

MapFrame ToMapFrame(const state_estimate_t& message) {
  MapFrame frame;
  frame.utime = message.utime;
  frame.live = ToSe3(message.position_W_C, message.orientation_W_C);
  frame.status = message.status;
  frame.is_trusted_with_people = message.trusted == state_estimate_t::TRUSTED_WITH_PEOPLE;
  return frame;
}

const std::string& CheckedDirectory(const MapRecorderOptions& options) {
  if (options.directory.empty()) {
    throw InputError(
        "--run-dir FOLDER is missing: where are map and trajectories to go? (It is "
        "output.directory of the configuration)");
  }
  return options.directory;
}

bool SelectAll(const std::string&, const std::string&) { return true; }

}  // namespace

void MapRecorderOptions::SayOnStderr(const std::string& line) {
  std::fprintf(stderr, "map_recorder: %s\n", line.c_str());
}

MapRecorderNode::MapRecorderNode(const MapRecorderOptions& options)
    : FrameNode("map_recorder"),
      options_(options),
      results_(CheckedDirectory(options), options.rules) {
  Join(channel::kStateEstimate, &MapRecorderInputs::state);
  JoinParts(channel::kMapUpdate, &MapRecorderInputs::updates);
  Subscribe<pose_t>(channel::kGroundTruth,
                    [this](pose_t&& message) { return AddGroundTruth(message); });
  Subscribe<stereo_calibration_t>(channel::kCalibration, [this](stereo_calibration_t&& message) {
    return AddCalibration(message);
  });
  results_.RequireReplaceable(NamesToBeWritten(options_.directory), SelectAll);
}

MapRecorderNode::~MapRecorderNode() {
  try {
    Finish();
  } catch (const std::exception& error) {
    options_.say(std::string("error: ") + error.what());
  }
}

void MapRecorderNode::Finish() {
  if (file_ != nullptr) CloseSession();
  const std::string failure = std::exchange(failure_, "");
  if (!failure.empty()) throw InputError("the recording is not complete: " + failure);
}

void MapRecorderNode::StartSession(const Header& header) {
  if (file_ != nullptr) CloseSession();
  session_ = header.session;
  newest_pose_.reset();
  is_time_said_ = false;
  if (num_sessions_ >= kMaxSessions) {
    throw InputError(options_.directory + ": session " + std::to_string(session_) +
                     " is not recorded: there were " + std::to_string(kMaxSessions) + " before it");
  }
  ++num_sessions_;
  prefix_ = SessionPrefix(num_sessions_);
  session_directory_ = SessionDirectory(options_.directory, num_sessions_);
  const bool is_first = num_sessions_ == 1;
  if (!is_first || !Resume(header)) {
    if (is_first) ReplaceEarlierResults();
    if (IsUnfinished(PathOf(kMapName))) KeepMap(PathOf(kMapName), options_.say);
    OpenMap(0);
    num_live_ = 0;
    Append(HeadChunk(session_, std::string("airdos map_recorder ") + kVersion));
  }
  for (const auto& [seq, truth] : ground_truth_[session_]) not_noted_.insert(seq);
  NoteGroundTruth();
}

void MapRecorderNode::ReplaceEarlierResults() {
  KeepMapsOfACutRun(options_.directory, options_.say);
  for (int number = 1; fs::exists(SessionDirectory(options_.directory, number)); ++number) {
    SayWhatIsReplaced(SessionDirectory(options_.directory, number) + "/" + kMapName, options_.say);
  }
  const std::string what = SayReplaced(results_.RemoveEarlier(SelectAll));
  if (!what.empty()) options_.say(options_.directory + ": " + what);
}

void MapRecorderNode::OpenMap(std::int64_t num_bytes) {
  const std::string path = results_.Claim(prefix_ + kMapName, kGroup);
  file_ = num_bytes > 0 ? std::make_unique<MapFileWriter>(path, num_bytes)
                        : std::make_unique<MapFileWriter>(path);
}

bool MapRecorderNode::Resume(const Header& header) {
  // A session that was not the first one lies in a folder of its own.
  int number = 1;
  std::string directory = SessionDirectory(options_.directory, number);
  std::optional<UnfinishedMap> found = FindUnfinishedMap(directory, header);
  while (!found) {
    directory = SessionDirectory(options_.directory, ++number);
    if (!fs::exists(directory)) return false;
    found = FindUnfinishedMap(directory, header);
  }
  num_sessions_ = number;
  prefix_ = SessionPrefix(number);
  session_directory_ = directory;
  OpenMap(found->num_bytes);
  num_live_ = found->num_live;
  const FourDMap& notes = found->notes;
  for (const auto& [id, frame] : notes.frames) {
    if (!frame.ground_truth) continue;
    const GroundTruth truth = {notes.ground_truth_axes, frame.utime, *frame.ground_truth};
    if (ground_truth_[session_].emplace(id.value, truth).second) ++num_ground_truth_;
  }
  if (notes.camera) cameras_[session_].try_emplace(0, *notes.camera);
  return true;
}

void MapRecorderNode::NoteGroundTruth() {
  MapDelta changes;
  std::int8_t axes = pose_t::AXES_INVALID;
  for (const std::int64_t seq : not_noted_) {
    const auto truth = ground_truth_[session_].find(seq);
    if (truth == ground_truth_[session_].end()) continue;
    MapFrame frame;
    frame.utime = truth->second.utime;
    frame.ground_truth = truth->second.pose;
    axes = truth->second.axes;
    changes.SetFrame({seq}, frame);
  }
  std::optional<StereoCamera> camera;
  const auto cameras = cameras_.find(session_);
  if (cameras != cameras_.end()) camera = cameras->second.begin()->second;
  not_noted_.clear();
  try {
    if (notes_ == nullptr) {
      notes_ = std::make_unique<MapFileWriter>(results_.Claim(prefix_ + kNotesName, kGroup));
      notes_->Append(HeadChunk(session_, ""));
    }
    if (!changes.empty()) notes_->Append(changes.ToChunk());
    notes_->Append(EndChunk(camera, axes));
  } catch (const InputError&) {  // the map itself will say that the disk is full
  }
}

void MapRecorderNode::ProcessFrame(const Header& header, MapRecorderInputs inputs) {
  if (file_ == nullptr) return;  // the disk failed
  const bool has_pose = inputs.state && inputs.state->status != state_estimate_t::STATUS_INVALID;
  if (has_pose) {
    changes_.SetFrame({header.seq}, ToMapFrame(*inputs.state));
    WatchTime(header);
    ++num_live_;
  }
  for (const map_update_t& update : inputs.updates) {
    AddUpdate(update, &changes_);
    if (changes_.ApproximateBytes() > kLargeChunkBytes) WriteChunk();
  }
  TakeOldGroundTruth(header.seq);
  if (++num_frames_in_chunk_ >= options_.chunk_frames) WriteChunk();
}

void MapRecorderNode::WatchTime(const Header& header) {
  const bool goes_back = newest_pose_ && header.utime <= newest_pose_->utime;
  if (!goes_back) {
    newest_pose_ = header;
    return;
  }
  if (is_time_said_) return;
  is_time_said_ = true;
  Warn("times go back: image " + std::to_string(header.seq) + " is not later than image " +
       std::to_string(newest_pose_->seq) + " (utime " + std::to_string(header.utime) + " and " +
       std::to_string(newest_pose_->utime) +
       "); the map has such poses, the trajectory files leave them out");
}

// The newest one stays: the end of the map needs its axes.
void MapRecorderNode::TakeOldGroundTruth(std::int64_t seq) {
  const auto poses = ground_truth_.find(session_);
  if (poses == ground_truth_.end()) return;
  while (poses->second.size() > 1 && poses->second.begin()->first < seq - kGroundTruthLag) {
    SetGroundTruth(*poses->second.begin());
    poses->second.erase(poses->second.begin());
    --num_ground_truth_;
  }
}

std::string MapRecorderNode::AddCalibration(const stereo_calibration_t& message) {
  std::map<std::int64_t, StereoCamera>& cameras = cameras_[message.session];
  cameras[message.seq] = ToStereoCamera(message);
  cameras.erase(std::next(cameras.begin()), cameras.end());  // the earliest is enough
  if (cameras_.size() > kMaxSessionsAhead) {
    const auto oldest = cameras_.begin();  // sources choose growing numbers
    cameras_.erase(oldest->first == session_ ? std::next(oldest) : oldest);
  }
  return "";
}

std::string MapRecorderNode::AddGroundTruth(const pose_t& message) {
  if (ground_truth_.count(message.session) == 0 && ground_truth_.size() > kMaxSessionsAhead)
    return "too many sessions without a frame";
  if (num_ground_truth_ >= kMaxGroundTruth) return "too many ground truth poses";
  std::map<std::int64_t, GroundTruth>& poses = ground_truth_[message.session];
  const GroundTruth truth = {message.axes, message.utime,
                             ToSe3(message.position, message.orientation)};
  if (!poses.emplace(message.seq, truth).second) {
    ++counters(channel::kGroundTruth).num_duplicate;
    return "";
  }
  ++num_ground_truth_;
  if (file_ != nullptr && message.session == session_) not_noted_.insert(message.seq);
  if (not_noted_.size() >= kGroundTruthPerNote) NoteGroundTruth();
  return "";
}

void MapRecorderNode::SetGroundTruth(const std::pair<const std::int64_t, GroundTruth>& pose) {
  MapFrame frame;
  frame.utime = pose.second.utime;
  frame.ground_truth = pose.second.pose;
  changes_.SetFrame({pose.first}, frame);
}

void MapRecorderNode::Append(const MapChunk& chunk) {
  try {
    const std::string why = WhyDiskIsFull(session_directory_);
    if (!why.empty()) throw InputError(session_directory_ + ": " + why + ": recording ends");
    file_->Append(chunk);
  } catch (const InputError& error) {
    failure_ = error.what();
    file_.reset();  // said once: nothing more is written
    throw;
  }
}

void MapRecorderNode::WriteChunk() {
  const MapDelta changes = std::exchange(changes_, MapDelta());
  num_frames_in_chunk_ = 0;
  if (!changes.empty()) Append(changes.ToChunk());
}

void MapRecorderNode::CloseSession() {
  WriteChunk();
  const std::map<std::int64_t, GroundTruth>& poses = ground_truth_[session_];
  std::int8_t axes = pose_t::AXES_INVALID;
  for (const auto& pose : poses) {
    SetGroundTruth(pose);
    axes = pose.second.axes;
    if (++num_frames_in_chunk_ >= kGroundTruthPerChunk) WriteChunk();
  }
  WriteChunk();
  num_ground_truth_ -= poses.size();
  ground_truth_.erase(session_);
  std::optional<StereoCamera> camera;
  const auto cameras = cameras_.find(session_);
  if (cameras != cameras_.end()) camera = cameras->second.begin()->second;
  cameras_.erase(session_);
  Append(EndChunk(camera, axes));
  const std::int64_t num_bytes = file_->num_bytes();
  file_.reset();
  notes_.reset();
  not_noted_.clear();
  std::error_code ignored;
  fs::remove(PathOf(kNotesName), ignored);

  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(PathOf(kMapName), &summary);
  CompareWithRecorded(map, summary, num_bytes);
  if (options_.export_at_end) {
    ExportMap(map, prefix_, prefix_.empty() ? kExportGroup : kGroup, &results_);
    for (const std::string& name : ExportNames(options_.directory, prefix_)) {
      if (results_.IsListed(name) || !fs::exists(results_.PathOf(name))) continue;
      options_.say(results_.PathOf(name) + ": was there before and is not of this run");  // --force
    }
  }
  results_.Finish();
}

void MapRecorderNode::CompareWithRecorded(const FourDMap& map, const MapFileSummary& summary,
                                          std::int64_t num_bytes) const {
  const std::size_t num_live = CountLive(map);
  std::string difference;
  if (!summary.drop_reason.empty() || summary.num_bytes_used != num_bytes) {
    difference = std::to_string(summary.num_bytes_used) + " bytes of it can be read, " +
                 std::to_string(num_bytes) + " were written";
  } else if (num_live != num_live_) {
    difference = "holds " + std::to_string(num_live) + " frames with a live pose, " +
                 std::to_string(num_live_) + " were recorded";
  } else if (map.session != session_ || !map.is_closed) {
    difference = "is not the closed map of session " + std::to_string(session_);
  }
  if (difference.empty()) return;
  throw InputError(PathOf(kMapName) + ": " + difference +
                   "; did something else write into it? Record again");
}

MapRecorderOptions ReadMapRecorderOptions(ConfigReader* config) {
  MapRecorderOptions options;
  config->Read("output.directory", &options.directory);
  config->Read("output.chunk_frames", &options.chunk_frames, 1, 1000);
  config->Read("output.export_at_end", &options.export_at_end);
  return options;
}

std::unique_ptr<Node> MakeMapRecorderNode(ConfigReader* config) {
  return std::make_unique<MapRecorderNode>(ReadMapRecorderOptions(config));
}

}  // namespace airdos
