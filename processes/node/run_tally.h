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

/// Where the poses of a run came from, frame by frame: what is said at its end, and what its exit
/// code goes by. Fed with STATE_ESTIMATE, and before it STATIC_FEATURES of the same frame if there
/// are any; other channels and what does not decode are passed over.
class RunTally {
 public:
  struct Counts {
    std::int64_t num_frames = 0;       ///< with a STATE_ESTIMATE
    std::int64_t num_from_images = 0;  ///< posed, with static landmarks in view
    std::int64_t num_from_people = 0;  ///< posed by people alone
    /// By how the camera moved before; a front end that sees people may have let them guide it.
    std::int64_t num_predicted = 0;
    std::int64_t num_without_pose = 0;
    std::int64_t num_static_features = 0;  ///< of all frames
  };

  void Take(const std::string& channel, const void* data, std::size_t size);
  void Take(const static_features_t& features);
  void Take(const state_estimate_t& estimate);
  Counts Count() const;

 private:
  enum class Source { kNone, kImages, kPeople, kPrediction };
  using FrameKey = std::pair<std::int64_t, std::int64_t>;  // session, seq

  void Add(Source source);

  static constexpr std::size_t kMaxOpenFrames = 1000;
  std::set<FrameKey> with_features_;  // frames whose estimate has not come
  Counts counts_;
};

/// "from images 98, from people 1, predicted only 1", and ", without a pose 2" where there are any.
std::string ToText(const RunTally::Counts& counts);

/// Why a run was in vain, with what to do; empty for a run that was not, or that had no frame.
std::string WhyInVain(const RunTally::Counts& counts);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_RUN_TALLY_H_
