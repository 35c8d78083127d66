#ifndef AIRDOS_PROCESSES_STEREO_PLAYER_STEREO_PLAYER_H_
#define AIRDOS_PROCESSES_STEREO_PLAYER_STEREO_PLAYER_H_

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "processes/node/message/header.h"
#include "processes/node/node.h"
#include "processes/stereo_player/image_packer.h"

namespace airdos {

/// Converts a recorded sequence to messages: for each frame, one on every channel (empty if the
/// data set has nothing), and the calibration before the first frame and then once per second of
/// capture time. The image number is the index in the data set. No clock, no LCM; the same frames
/// give the same bytes.
class StereoPlayer {
 public:
  /// The sequence is not owned.
  StereoPlayer(const StereoSequence* sequence, std::int64_t session,
               const ImagePackerOptions& options);

  /// The messages of one frame.
  struct Frame {
    Header header;
    std::vector<Envelope> messages;
  };
  /// No messages where the sequence turns out to lack the frame. Throws InputError if a file of the
  /// frame cannot be used.
  Frame Load(std::size_t index);
  /// The calibration again, for a process that started later.
  Envelope Calibration(const Header& header) const;

  std::vector<std::string> TakeNotes();

 private:
  bool IsCalibrationDue(std::int64_t utime);
  /// On the first 16-bit picture, determines the range of all of them.
  void SetRangeFor(const std::vector<std::uint8_t>& file);

  const StereoSequence* sequence_;
  std::int64_t session_;
  ImagePacker packer_;
  bool is_range_known_ = false;
  std::optional<std::int64_t> calibration_utime_;  // when it was last published
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_STEREO_PLAYER_H_
