#include "common/features/local_map.h"

#include <algorithm>

namespace airdos {

LandmarkId LocalMap::Add(LocalLandmark landmark) {
  const LandmarkId id = next_id_;
  ++next_id_.value;
  landmarks_.emplace(id, std::move(landmark));
  return id;
}

void LocalMap::SetPose(FrameId frame, const Se3& T_W_C) {
  poses_[frame] = T_W_C;
  while (poses_.size() > static_cast<std::size_t>(kMaxPoses)) poses_.erase(poses_.begin());
}

void LocalMap::Apply(const MapCorrection& correction) {
  const auto newest = poses_.find(correction.newest);
  std::optional<Se3> T_new_old;
  for (const auto& [frame, T_W_C] : correction.frames) {
    const auto pose = poses_.find(frame);
    if (pose == poses_.end()) continue;
    if (pose == newest) T_new_old = T_W_C * pose->second.inverse();
    pose->second = T_W_C;
  }
  if (T_new_old) {
    for (auto pose = std::next(newest); pose != poses_.end(); ++pose)
      pose->second = *T_new_old * pose->second;
  }
  for (const LandmarkId id : correction.removed) landmarks_.erase(id);
  for (const auto& [id, p_W] : correction.landmarks_W_m) {
    const auto landmark = landmarks_.find(id);
    if (landmark == landmarks_.end()) continue;
    landmark->second.p_W = p_W;
    landmark->second.is_refined = true;
  }
  for (auto& [id, landmark] : landmarks_) {
    if (landmark.is_refined) continue;
    const auto pose = poses_.find(landmark.reference_frame);
    if (pose != poses_.end()) landmark.p_W = pose->second * landmark.p_C_reference;
  }
}

// A reference frame keeps its whole image in memory.
void LocalMap::CullReferenceFrames() {
  std::map<FrameId, FrameId> last_seen;  // of each reference frame
  for (const auto& [id, landmark] : landmarks_) {
    FrameId& newest =
        last_seen.try_emplace(landmark.reference_frame, landmark.last_seen).first->second;
    if (newest < landmark.last_seen) newest = landmark.last_seen;
  }
  if (last_seen.size() <= kMaxReferenceFrames) return;
  std::vector<std::pair<std::int64_t, std::int64_t>> by_age;  // (last seen, reference frame)
  for (const auto& [reference, seen] : last_seen) by_age.emplace_back(seen.value, reference.value);
  std::sort(by_age.begin(), by_age.end());
  const auto first_kept = by_age[last_seen.size() - kMaxReferenceFrames];
  for (auto it = landmarks_.begin(); it != landmarks_.end();) {
    const FrameId reference = it->second.reference_frame;
    const bool is_surplus =
        std::make_pair(last_seen.at(reference).value, reference.value) < first_kept;
    it = is_surplus ? landmarks_.erase(it) : std::next(it);
  }
}

void LocalMap::Cull(FrameId now) {
  constexpr int kMinExpected = 10;
  for (auto it = landmarks_.begin(); it != landmarks_.end();) {
    const LocalLandmark& landmark = it->second;
    const bool is_unconfirmed = landmark.num_seen < 2 && now.value - landmark.last_seen.value >
                                                             options_.max_frames_unconfirmed;
    const bool is_not_found = landmark.num_expected >= kMinExpected &&
                              landmark.num_seen < options_.min_found_ratio * landmark.num_expected;
    it = is_unconfirmed || is_not_found ? landmarks_.erase(it) : std::next(it);
  }
  CullReferenceFrames();
  const auto limit = static_cast<std::size_t>(options_.max_landmarks);
  if (landmarks_.size() <= limit) return;
  std::vector<std::pair<std::int64_t, std::int64_t>> by_age;  // (last seen, id)
  for (const auto& [id, landmark] : landmarks_)
    by_age.emplace_back(landmark.last_seen.value, id.value);
  const std::size_t surplus = landmarks_.size() - limit;
  std::nth_element(by_age.begin(), by_age.begin() + static_cast<std::ptrdiff_t>(surplus),
                   by_age.end());
  for (std::size_t i = 0; i < surplus; ++i) landmarks_.erase(LandmarkId{by_age[i].second});
}

}  // namespace airdos
