#ifndef AIRDOS_PROCESSES_NODE_CHECK_INPUT_CHECK_H_
#define AIRDOS_PROCESSES_NODE_CHECK_INPUT_CHECK_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>

#include "common/check/check_input.h"

namespace airdos {

/// Looks at a folder or a log as airdos-check does.
FindingList CheckInput(const std::string& path, const CheckOptions& options);

/// The quick part of it, before a program works on `path`: hands each warning to `say`, a line each
/// ("warning: WHERE: WHAT"), but for what the data set assumed: FrameSource::TakeNotes() says that
/// of whoever opens it. Throws InputError with the first error ("WHERE: WHAT"), the number of
/// others, and how to learn more or go on all the same.
void CheckBeforeRun(const std::string& path, const std::string& calibration,
                    const std::function<void(const std::string&)>& say);

/// --no-check and --calibration of a program that plays an input.
struct InputCheckOptions {
  bool is_off = false;
  std::string calibration;  ///< SequenceOptions::calibration
};
void AddInputCheckOptions(CLI::App* app, InputCheckOptions* options);
/// --calibration alone.
void AddCalibrationOption(CLI::App* app, std::string* calibration);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_CHECK_INPUT_CHECK_H_
