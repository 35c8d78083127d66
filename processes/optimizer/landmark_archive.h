#ifndef AIRDOS_PROCESSES_OPTIMIZER_LANDMARK_ARCHIVE_H_
#define AIRDOS_PROCESSES_OPTIMIZER_LANDMARK_ARCHIVE_H_

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/optimization/window/sliding_window.h"

namespace airdos {

/// What was told of each landmark last, so that it can be told again to whoever comes late: a few
/// each frame, in order of their numbers, round and round.
class LandmarkArchive {
 public:
  static constexpr std::size_t kMaxLandmarks = 100000;
  static constexpr std::size_t kRepeatedPerFrame = 200;

  explicit LandmarkArchive(std::size_t max_landmarks = kMaxLandmarks)
      : max_landmarks_(max_landmarks) {}

  /// Takes what a frame tells. Beyond the limit the oldest landmarks, those of the lowest numbers,
  /// are forgotten. True if this happens for the first time.
  bool Add(const MapChanges& changes);
  /// The next ones in turn, at most kRepeatedPerFrame and each at most once.
  std::vector<MapChanges::Landmark> NextRepeated();

  std::size_t size() const { return landmarks_.size(); }

 private:
  std::size_t max_landmarks_;
  std::map<LandmarkId, MapChanges::Landmark> landmarks_;
  std::optional<LandmarkId> last_repeated_;
  bool is_full_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_OPTIMIZER_LANDMARK_ARCHIVE_H_
