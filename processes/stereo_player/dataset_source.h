#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_DATASET_SOURCE_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_DATASET_SOURCE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "processes/node/log/log_source.h"
#include "processes/stereo_player/stereo_player.h"

namespace airdos {

/// The frames of a data set, as made by StereoPlayer.
class DatasetSource : public FrameSource {
 public:
  /// Frames with first <= index <= last; the image number is the index. Throws InputError if the
  /// folder cannot be used or has no such frame; NextFrame() throws it if a file cannot be used.
  /// `calibration`: see SequenceOptions.
  DatasetSource(const std::string& folder, std::int64_t first, std::int64_t last,
                std::int64_t session, const ImagePackerOptions& options,
                const std::string& calibration = "");
  /// The same of a sequence that is open; `name` stands for it in messages.
  DatasetSource(std::unique_ptr<StereoSequence> sequence, const std::string& name,
                std::int64_t first, std::int64_t last, std::int64_t session,
                const ImagePackerOptions& options);

  std::vector<Envelope> NextFrame() override;
  double fraction_done() const override;
  /// First what the data set assumed, then what happened to its images.
  std::vector<std::string> TakeNotes() override;

 private:
  std::unique_ptr<StereoSequence> sequence_;
  StereoPlayer player_;
  std::vector<std::string> assumed_;  // until they have been returned
  std::size_t first_ = 0;
  std::size_t end_ = 0;
  std::size_t next_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_DATASET_SOURCE_H_
