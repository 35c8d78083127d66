#include "processes/optimizer/landmark_archive.h"

#include <algorithm>

namespace airdos {

bool LandmarkArchive::Add(const MapChanges& changes) {
  for (const MapChanges::Landmark& landmark : changes.landmarks) {
    landmarks_.insert_or_assign(landmark.id, landmark);
  }
  for (const LandmarkId id : changes.removed) landmarks_.erase(id);
  if (landmarks_.size() <= max_landmarks_) return false;
  while (landmarks_.size() > max_landmarks_) landmarks_.erase(landmarks_.begin());
  const bool is_first = !is_full_;
  is_full_ = true;
  return is_first;
}

std::vector<MapChanges::Landmark> LandmarkArchive::NextRepeated() {
  std::vector<MapChanges::Landmark> repeated;
  const std::size_t count = std::min(kRepeatedPerFrame, landmarks_.size());
  auto next = last_repeated_ ? landmarks_.upper_bound(*last_repeated_) : landmarks_.begin();
  while (repeated.size() < count) {
    if (next == landmarks_.end()) next = landmarks_.begin();
    repeated.push_back(next->second);
    last_repeated_ = next->first;
    ++next;
  }
  return repeated;
}

}  // namespace airdos
