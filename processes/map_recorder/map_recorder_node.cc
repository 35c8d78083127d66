#include "processes/map_recorder/map_recorder_node.h"

#include <cstdio>
#include <utility>

#include "common/util/error.h"
#include "processes/map_recorder/map_recorder_messages.h"

namespace airdos {
namespace {

constexpr int kGroundTruthPerChunk = 10000;
constexpr std::size_t kLargeChunkBytes = 8u << 20;  // such a chunk is closed early

}  // namespace

void MapRecorderOptions::SayOnStderr(const std::string& line) {
  std::fprintf(stderr, "map_recorder: %s\n", line.c_str());
}

MapRecorderNode::MapRecorderNode(const MapRecorderOptions& options)
    : FrameNode("map_recorder"),
      options_(options),
      files_(options.directory, options.rules, options.say) {
  Join(channel::kStateEstimate, &MapRecorderInputs::state);
  JoinParts(channel::kMapUpdate, &MapRecorderInputs::updates);
  Subscribe<pose_t>(channel::kGroundTruth,
                    [this](pose_t&& message) { return AddGroundTruth(message); });
  Subscribe<stereo_calibration_t>(channel::kCalibration, [this](stereo_calibration_t&& message) {
    return AddCalibration(message);
  });
}

MapRecorderNode::~MapRecorderNode() {
  try {
    Finish();
  } catch (const std::exception& error) {
    options_.say(std::string("error: ") + error.what());
  }
}

void MapRecorderNode::Finish() {
  if (files_.is_open()) CloseSession();
  const std::string failure = files_.TakeFailure();
  if (!failure.empty()) throw InputError("the recording is not complete: " + failure);
}

void MapRecorderNode::StartSession(const Header& header) {
  if (files_.is_open()) CloseSession();
  session_ = header.session;
  newest_pose_.reset();
  is_time_said_ = false;
  const std::optional<UnfinishedMap> earlier = files_.Open(header);
  num_live_ = earlier ? earlier->num_live : 0;
  if (earlier) TakeNotes(earlier->notes);
  for (const auto& [seq, truth] : ground_truth_[session_]) not_noted_.insert(seq);
  NoteGroundTruth();
}

void MapRecorderNode::TakeNotes(const FourDMap& notes) {
  for (const auto& [id, frame] : notes.frames) {
    if (!frame.ground_truth) continue;
    const GroundTruth truth = {notes.ground_truth_axes, frame.utime, *frame.ground_truth};
    if (ground_truth_[session_].emplace(id.value, truth).second) ++num_ground_truth_;
  }
  if (notes.camera) cameras_[session_].try_emplace(0, *notes.camera);
}

std::optional<StereoCamera> MapRecorderNode::Camera() const {
  const auto cameras = cameras_.find(session_);
  if (cameras == cameras_.end()) return std::nullopt;
  return cameras->second.begin()->second;
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
  not_noted_.clear();
  files_.Note(session_, changes, Camera(), axes);
}

void MapRecorderNode::ProcessFrame(const Header& header, MapRecorderInputs inputs) {
  if (!files_.is_open()) return;  // after a disk failure
  const bool has_pose = inputs.state && inputs.state->status != state_estimate_t::STATUS_INVALID;
  if (has_pose) {
    changes_.SetFrame({header.seq}, ToMapFrame(*inputs.state));
    WatchTime(header);
    ++num_live_;
  }
  for (const map_update_t& update : inputs.updates) {
    AddTo(update, &changes_);
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
       "); the map contains such poses, the trajectory files omit them");
}

// The newest one is kept: the end of the map needs its axes.
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
  cameras.erase(std::next(cameras.begin()), cameras.end());  // only the earliest is needed
  if (cameras_.size() > kMaxSessionsAhead) {
    const auto oldest = cameras_.begin();  // sources choose increasing numbers
    cameras_.erase(oldest->first == session_ ? std::next(oldest) : oldest);
  }
  return "";
}

std::string MapRecorderNode::AddGroundTruth(const pose_t& message) {
  if (ground_truth_.count(message.session) == 0 && ground_truth_.size() > kMaxSessionsAhead)
    return "too many sessions without a frame";
  if (num_ground_truth_ >= options_.max_ground_truth) return "too many ground truth poses";
  std::map<std::int64_t, GroundTruth>& poses = ground_truth_[message.session];
  const GroundTruth truth = {message.axes, message.utime,
                             ToSe3(message.position, message.orientation)};
  if (!poses.emplace(message.seq, truth).second) {
    ++counters(channel::kGroundTruth).num_duplicate;
    return "";
  }
  ++num_ground_truth_;
  if (files_.is_open() && message.session == session_) not_noted_.insert(message.seq);
  if (not_noted_.size() >= kGroundTruthPerNote) NoteGroundTruth();
  return "";
}

void MapRecorderNode::SetGroundTruth(const std::pair<const std::int64_t, GroundTruth>& pose) {
  MapFrame frame;
  frame.utime = pose.second.utime;
  frame.ground_truth = pose.second.pose;
  changes_.SetFrame({pose.first}, frame);
}

void MapRecorderNode::WriteChunk() {
  const MapDelta changes = std::exchange(changes_, MapDelta());
  num_frames_in_chunk_ = 0;
  if (!changes.empty()) files_.Append(changes.ToChunk());
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
  const MapChunk end = EndChunk(Camera(), axes);
  cameras_.erase(session_);
  not_noted_.clear();
  files_.Close(end, {session_, num_live_}, options_.export_at_end);
}

std::unique_ptr<Node> MakeMapRecorderNode(ConfigReader* config) {
  return std::make_unique<MapRecorderNode>(ReadMapRecorderOptions(config));
}

}  // namespace airdos
