#include <map>
#include <utility>

#include "common/human/skeleton.h"
#include "common/map/byte_io.h"
#include "common/map/four_d_map.h"

namespace airdos {
namespace {

constexpr std::uint32_t kChangesType = 2;

// Flags of a frame record.
constexpr std::uint8_t kHasLive = 1;
constexpr std::uint8_t kHasRefined = 2;
constexpr std::uint8_t kHasGroundTruth = 4;
constexpr std::uint8_t kTrustedWithPeople = 8;

// Minimum size of each kind of record, to bound counts.
constexpr std::size_t kFrameBytes = 18;
constexpr std::size_t kLandmarkBytes = 28;
constexpr std::size_t kHumanBytes = 36;
constexpr std::size_t kJointBytes = 25;
constexpr std::size_t kSegmentBytes = 5;
constexpr std::size_t kMotionBytes = 29;

void WritePose(const Se3& pose, ByteWriter* writer) {
  for (int i = 0; i < 3; ++i) writer->F64(pose.translation[i]);
  writer->F64(pose.rotation.w());
  writer->F64(pose.rotation.x());
  writer->F64(pose.rotation.y());
  writer->F64(pose.rotation.z());
}

Se3 ReadPose(ByteReader* reader) {
  Se3 pose;
  for (int i = 0; i < 3; ++i) pose.translation[i] = reader->F64();
  pose.rotation.w() = reader->F64();
  pose.rotation.x() = reader->F64();
  pose.rotation.y() = reader->F64();
  pose.rotation.z() = reader->F64();
  return pose;
}

void WriteVector(const Eigen::Vector3f& v, ByteWriter* writer) {
  for (int i = 0; i < 3; ++i) writer->F32(v[i]);
}

Eigen::Vector3f ReadVector(ByteReader* reader) {
  Eigen::Vector3f v;
  for (int i = 0; i < 3; ++i) v[i] = reader->F32();
  return v;
}

void WriteFrame(FrameId id, const MapFrame& frame, ByteWriter* writer) {
  writer->I64(id.value);
  writer->I64(frame.utime);
  writer->U8(static_cast<std::uint8_t>((frame.live ? kHasLive : 0) |
                                       (frame.refined ? kHasRefined : 0) |
                                       (frame.ground_truth ? kHasGroundTruth : 0) |
                                       (frame.is_trusted_with_people ? kTrustedWithPeople : 0)));
  writer->U8(static_cast<std::uint8_t>(frame.status));
  if (frame.live) WritePose(*frame.live, writer);
  if (frame.refined) WritePose(*frame.refined, writer);
  if (frame.ground_truth) WritePose(*frame.ground_truth, writer);
}

MapFrame ReadFrame(ByteReader* reader) {
  MapFrame frame;
  frame.utime = reader->I64();
  const std::uint8_t flags = reader->U8();
  frame.status = static_cast<std::int8_t>(reader->U8());
  frame.is_trusted_with_people = (flags & kTrustedWithPeople) != 0;
  if ((flags & kHasLive) != 0) frame.live = ReadPose(reader);
  if ((flags & kHasRefined) != 0) frame.refined = ReadPose(reader);
  if ((flags & kHasGroundTruth) != 0) frame.ground_truth = ReadPose(reader);
  return frame;
}

void WriteHuman(const MapHuman& human, ByteWriter* writer) {
  writer->I64(human.utime);
  writer->U32(static_cast<std::uint32_t>(human.joints.size()));
  for (const auto& [id, joint] : human.joints) {
    writer->U8(static_cast<std::uint8_t>(id));
    WriteVector(joint.p_W, writer);
    WriteVector(joint.p_W_measured, writer);
  }
  writer->U32(static_cast<std::uint32_t>(human.segment_lengths_m.size()));
  for (const auto& [id, length_m] : human.segment_lengths_m) {
    writer->U8(static_cast<std::uint8_t>(id));
    writer->F32(length_m);
  }
  writer->U32(static_cast<std::uint32_t>(human.part_motions.size()));
  for (const auto& [id, motion] : human.part_motions) {
    writer->U8(static_cast<std::uint8_t>(id));
    WriteVector(motion.t_W, writer);
    writer->F32(motion.R_W.w());
    WriteVector(motion.R_W.vec(), writer);
  }
}

MapHuman ReadHuman(ByteReader* reader) {
  MapHuman human;
  human.utime = reader->I64();
  for (std::uint32_t n = reader->Count(kJointBytes); n > 0; --n) {
    MapJoint& joint = human.joints[reader->U8()];
    joint.p_W = ReadVector(reader);
    joint.p_W_measured = ReadVector(reader);
  }
  for (std::uint32_t n = reader->Count(kSegmentBytes); n > 0; --n) {
    const int id = reader->U8();
    human.segment_lengths_m[id] = reader->F32();
  }
  for (std::uint32_t n = reader->Count(kMotionBytes); n > 0; --n) {
    MapPartMotion& motion = human.part_motions[reader->U8()];
    motion.t_W = ReadVector(reader);
    motion.R_W.w() = reader->F32();
    motion.R_W.vec() = ReadVector(reader);
  }
  return human;
}

void Merge(const MapFrame& newer, MapFrame* frame) {
  if (newer.utime != 0) frame->utime = newer.utime;
  if (newer.live) {
    frame->live = newer.live;
    frame->status = newer.status;
    frame->is_trusted_with_people = newer.is_trusted_with_people;
  }
  if (newer.refined) frame->refined = newer.refined;
  if (newer.ground_truth) frame->ground_truth = newer.ground_truth;
}

/// Part motions start at the previous frame. The last report of a person comes when that frame has
/// left the optimizer's window, and so has no motions: the ones already known are kept.
void Merge(const MapHuman& newer, MapHuman* human) {
  std::map<int, MapPartMotion> known = std::move(human->part_motions);
  *human = newer;
  if (human->part_motions.empty()) human->part_motions = std::move(known);
}

}  // namespace

void MapDelta::SetFrame(FrameId id, const MapFrame& frame) { Merge(frame, &frames_[id]); }

void MapDelta::SetLandmark(LandmarkId id, const MapLandmark& landmark) {
  removed_.erase(id);
  landmarks_[id] = landmark;
}

void MapDelta::RemoveLandmark(LandmarkId id) {
  landmarks_.erase(id);
  removed_.insert(id);
}

void MapDelta::SetHuman(FrameId frame, HumanId human, const MapHuman& state) {
  Merge(state, &humans_[{frame, human}]);
}

bool MapDelta::empty() const {
  return frames_.empty() && landmarks_.empty() && removed_.empty() && humans_.empty();
}

std::size_t MapDelta::ApproximateBytes() const {
  constexpr std::size_t kWholeFrameBytes = kFrameBytes + 3 * 56;
  const std::size_t whole_human_bytes = kHumanBytes + kNumJoints * kJointBytes +
                                        kNumSegments * kSegmentBytes + kNumParts * kMotionBytes;
  return frames_.size() * kWholeFrameBytes + landmarks_.size() * kLandmarkBytes +
         removed_.size() * sizeof(std::int64_t) + humans_.size() * whole_human_bytes;
}

void MapDelta::Apply(FourDMap* map) const {
  for (const auto& [id, frame] : frames_) Merge(frame, &map->frames[id]);
  for (const LandmarkId id : removed_) map->landmarks.erase(id);
  for (const auto& [id, landmark] : landmarks_) map->landmarks[id] = landmark;
  for (const auto& [key, human] : humans_) Merge(human, &map->humans[key]);
}

MapChunk MapDelta::ToChunk() const {
  ByteWriter writer;
  writer.U32(static_cast<std::uint32_t>(frames_.size()));
  for (const auto& [id, frame] : frames_) WriteFrame(id, frame, &writer);
  writer.U32(static_cast<std::uint32_t>(landmarks_.size()));
  for (const auto& [id, landmark] : landmarks_) {
    writer.I64(id.value);
    WriteVector(landmark.p_W, &writer);
    writer.F32(landmark.sigma_m);
    writer.U32(static_cast<std::uint32_t>(landmark.num_observations));
  }
  writer.U32(static_cast<std::uint32_t>(removed_.size()));
  for (const LandmarkId id : removed_) writer.I64(id.value);
  writer.U32(static_cast<std::uint32_t>(humans_.size()));
  for (const auto& [key, human] : humans_) {
    writer.I64(key.first.value);
    writer.I64(key.second.value);
    WriteHuman(human, &writer);
  }
  return {kChangesType, writer.Take()};
}

bool MapDelta::FromChunk(const MapChunk& chunk) {
  *this = MapDelta();
  if (chunk.type != kChangesType) return false;
  ByteReader reader(chunk.bytes.data(), chunk.bytes.size());
  for (std::uint32_t n = reader.Count(kFrameBytes); n > 0; --n) {
    const FrameId id = {reader.I64()};
    frames_[id] = ReadFrame(&reader);
  }
  for (std::uint32_t n = reader.Count(kLandmarkBytes); n > 0; --n) {
    MapLandmark& landmark = landmarks_[LandmarkId{reader.I64()}];
    landmark.p_W = ReadVector(&reader);
    landmark.sigma_m = reader.F32();
    landmark.num_observations = static_cast<std::int32_t>(reader.U32());
  }
  for (std::uint32_t n = reader.Count(sizeof(std::int64_t)); n > 0; --n) {
    removed_.insert(LandmarkId{reader.I64()});
  }
  for (std::uint32_t n = reader.Count(kHumanBytes); n > 0; --n) {
    const FrameId frame = {reader.I64()};
    const HumanId human = {reader.I64()};
    humans_[{frame, human}] = ReadHuman(&reader);
  }
  return reader.ok() && reader.num_left() == 0;
}

}  // namespace airdos
