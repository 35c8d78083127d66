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

/// Turns a recorded sequence into messages: of each frame, one on every channel (empty where the
/// data set has nothing), and the calibration before the first frame and then once a second of
/// capture time. The image number is the index in the data set. No clock, no LCM; the same frames
/// give the same bytes.
class StereoPlayer {
 public:
  /// The sequence is not owned.
  StereoPlayer(const StereoSequence* sequence, std::int64_t session,
               const ImagePackerOptions& options);

  struct Frame {
    Header header;
    std::vector<Envelope> messages;
  };
  /// Throws InputError if a file of the frame cannot be used.
  Frame Load(std::size_t index);
  /// The calibration again, for a process that came later.
  Envelope Calibration(const Header& header) const;

  std::vector<std::string> TakeNotes() { return packer_.TakeNotes(); }

 private:
  bool IsCalibrationDue(std::int64_t utime);
  /// The first 16-bit picture has the range of all of them looked up.
  void SetRangeFor(const std::vector<std::uint8_t>& file);

  const StereoSequence* sequence_;
  std::int64_t session_;
  ImagePacker packer_;
  bool is_range_known_ = false;
  std::optional<std::int64_t> calibration_utime_;  // when it was given last
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_PLAYER_STEREO_PLAYER_H_
