#ifndef AIRDOS_PROCESSES_TOOLS_DATASET_SOURCE_H_
#define AIRDOS_PROCESSES_TOOLS_DATASET_SOURCE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "processes/node/log_source.h"
#include "processes/stereo_player/stereo_player.h"

namespace airdos {

/// The frames of a data set as airdos-stereo-player publishes them, without a log in between. The
/// session is always kSession, so that runs can be compared.
class DatasetSource : public FrameSource {
 public:
  static constexpr std::int64_t kSession = 1;

  /// Frames with first_seq <= seq <= last_seq. Throws InputError if the folder cannot be used or
  /// has none of these; so does NextFrame() for a file.
  DatasetSource(const std::string& folder, std::int64_t first_seq, std::int64_t last_seq);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  /// What the player would have said about the images that were too large.
  std::string damage() const override { return notes_; }

 private:
  std::unique_ptr<StereoSequence> sequence_;
  StereoPlayer player_;
  std::size_t first_ = 0;
  std::size_t end_ = 0;
  std::size_t next_ = 0;
  std::string notes_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DATASET_SOURCE_H_
