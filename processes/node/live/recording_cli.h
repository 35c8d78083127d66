#ifndef AIRDOS_PROCESSES_NODE_LIVE_RECORDING_CLI_H_
#define AIRDOS_PROCESSES_NODE_LIVE_RECORDING_CLI_H_

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/dataset/recording/rectified_sequence.h"
#include "processes/node/command_line.h"
#include "processes/node/live/calibration_cli.h"
#include "processes/node/live/program_cli.h"

namespace airdos {

/// How a program is told to play a recording of unrectified images in place of INPUT: --images or
/// --video, what has to be said about them, and --calibration with its options
/// (CalibrationArguments).
class RecordingArguments {
 public:
  void AddTo(CommandLine* line);

  /// After parsing: that there is a recording with a calibration, or an input with neither options
  /// of recordings nor a calibration file; throws InputError. Takes care of the list --calibration,
  /// which may have taken INPUT for its second word.
  void Settle(InputOptions* input);

  bool is_given() const { return !images_.empty() || !video_.empty(); }
  /// The name of a calibration that goes with INPUT (SequenceOptions); empty if there is none.
  const std::string& named_calibration() const { return named_calibration_; }
  /// Of a recording; throws InputError.
  std::unique_ptr<RectifiedSequence> Open() const;
  std::string name() const;  ///< for messages
  /// What to do where the images are not rectified after all: RowWatch's `mend`.
  std::string HowToExamine() const;
  std::vector<std::string> paths() const;  ///< all that is read

 private:
  std::unique_ptr<StereoRecording> OpenRecording() const;
  void RefuseWithoutRecording() const;
  void RefuseContradictions() const;

  std::vector<std::string> images_;
  std::vector<std::string> video_;
  bool is_side_by_side_ = false;
  bool is_over_under_ = false;
  std::string times_;
  std::optional<double> rate_hz_;
  CalibrationArguments calibration_;
  std::string named_calibration_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_RECORDING_CLI_H_
