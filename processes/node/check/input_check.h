#ifndef AIRDOS_PROCESSES_NODE_CHECK_INPUT_CHECK_H_
#define AIRDOS_PROCESSES_NODE_CHECK_INPUT_CHECK_H_

#include <functional>
#include <string>

#include "common/check/check_input.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "processes/node/command_line.h"

namespace airdos {

/// Checks a folder or a log, like airdos-check.
FindingList CheckInput(const std::string& path, const CheckOptions& options);

/// Runs the quick check before a program works on `path`. Passes each warning to `say`, one line
/// each ("warning: WHERE: WHAT"), except the data set's assumptions, which FrameSource::TakeNotes()
/// reports to whoever opens it. Throws InputError with the first error ("WHERE: WHAT"), the number
/// of further errors, and how to learn more or proceed anyway. `concerns`: which findings count;
/// empty: all.
void CheckBeforeRun(const std::string& path, const std::string& calibration,
                    const std::function<void(const std::string&)>& say,
                    const std::function<bool(const Finding&)>& concerns = {});

/// The same for a recording: whether its calibration fits the first images (JudgeRigCheck()).
void CheckRecordingBeforeRun(const RectifiedSequence& sequence,
                             const std::function<void(const std::string&)>& say);

/// --no-check and --calibration of a program that plays an input.
struct InputCheckOptions {
  bool is_off = false;
  std::string calibration;  ///< SequenceOptions::calibration
};
/// Adds --no-check alone.
void AddInputCheckOptions(CommandLine* app, InputCheckOptions* options);
/// Adds --calibration alone.
void AddCalibrationOption(CommandLine* app, std::string* calibration);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_INPUT_CHECK_H_
