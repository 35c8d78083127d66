#ifndef AIRDOS_PROCESSES_NODE_RUN_TALLY_H_
#define AIRDOS_PROCESSES_NODE_RUN_TALLY_H_

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>

#include "airdos/state_estimate_t.hpp"
#include "airdos/static_features_t.hpp"

namespace airdos {

/// Where the poses of a run came from, frame by frame: determines its closing summary and its exit
/// code. Takes STATE_ESTIMATE and, before it, STATIC_FEATURES of the same frame if available;
/// ignores other channels and messages that do not decode.
class RunTally {
 public:
  /// Numbers of frames by origin of their pose.
  struct Counts {
    std::int64_t num_frames = 0;       ///< with a STATE_ESTIMATE
    std::int64_t num_from_images = 0;  ///< with static landmarks in view
    std::int64_t num_from_people = 0;  ///< from people only
    /// From the camera's previous motion; a frontend that sees people may have used them as well.
    std::int64_t num_predicted = 0;
    std::int64_t num_without_pose = 0;
    std::int64_t num_static_features = 0;  ///< in all frames
  };

  void Take(const std::string& channel, const void* data, std::size_t size);
  void Take(const static_features_t& features);
  void Take(const state_estimate_t& estimate);
  Counts Count() const;

 private:
  enum class Source { kNone, kImages, kPeople, kPrediction };
  using FrameKey = std::pair<std::int64_t, std::int64_t>;  // (session, seq)

  void Add(Source source);

  static constexpr std::size_t kMaxOpenFrames = 1000;
  std::set<FrameKey> with_features_;  // frames whose estimate has not arrived yet
  Counts counts_;
};

/// "from images 98, from people 1, predicted only 1" and, if there are any, ", without a pose 2".
std::string ToText(const RunTally::Counts& counts);

/// Why a run was in vain, with the remedy; empty if it was not, or if it had no frame.
std::string WhyInVain(const RunTally::Counts& counts);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_RUN_TALLY_H_
