#ifndef AIRDOS_PROCESSES_OPTIMIZER_LANDMARK_ARCHIVE_H_
#define AIRDOS_PROCESSES_OPTIMIZER_LANDMARK_ARCHIVE_H_

#include <cstddef>
#include <map>
#include <optional>
#include <vector>

#include "common/optimization/window/sliding_window.h"

namespace airdos {

/// The last published state of each landmark, so that landmarks can be repeated for receivers that
/// start late: a few per frame, in order of their numbers, cyclically.
class LandmarkArchive {
 public:
  static constexpr std::size_t kMaxLandmarks = 100000;
  static constexpr std::size_t kRepeatedPerFrame = 200;

  explicit LandmarkArchive(std::size_t max_landmarks = kMaxLandmarks)
      : max_landmarks_(max_landmarks) {}

  /// Records what a frame publishes. Beyond the limit, the oldest landmarks (those with the lowest
  /// numbers) are forgotten. Returns true when this happens for the first time.
  bool Add(const MapChanges& changes);
  /// The next landmarks in turn: at most kRepeatedPerFrame, and each at most once.
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
