#include "processes/node/input_check.h"

#include <filesystem>

#include "common/check/check_files.h"
#include "common/check/check_folder.h"
#include "common/util/error.h"
#include "processes/node/check_log.h"

namespace airdos {
namespace {

std::string Text(const std::string& path, const Finding& finding) {
  return (finding.where.empty() ? path : finding.where) + ": " + finding.what;
}

std::string HowToGoOn(const std::string& path, int num_errors) {
  const std::string more =
      num_errors > 1 ? " (and " + std::to_string(num_errors - 1) + " more errors)" : "";
  return more + "; 'airdos-check " + path + "' says more, --no-check goes on all the same";
}

}  // namespace

FindingList CheckInput(const std::string& path, const CheckOptions& options) {
  FindingList findings;
  if (std::filesystem::is_directory(path)) {
    CheckFolder(path, options, &findings);
  } else {
    CheckLog(path, options, &findings);
  }
  return findings;
}

void CheckBeforeRun(const std::string& path, const std::string& calibration,
                    const std::function<void(const std::string&)>& say) {
  CheckOptions options;
  options.depth = CheckOptions::Depth::kQuick;
  options.calibration = calibration;
  const FindingList findings = CheckInput(path, options);
  const Finding* first_error = nullptr;
  for (const Finding& finding : findings.findings()) {
    // What was assumed the source says itself, checked or not.
    const bool is_new = finding.kind != kAssumedKind;
    if (finding.severity == Severity::kWarning && is_new) say("warning: " + Text(path, finding));
    if (finding.severity == Severity::kError && first_error == nullptr) first_error = &finding;
  }
  if (first_error == nullptr) return;
  throw InputError(Text(path, *first_error) + HowToGoOn(path, findings.count(Severity::kError)));
}

void AddCalibrationOption(CLI::App* app, std::string* calibration) {
  app->add_option("--calibration", *calibration,
                  std::string("of a folder without one, by name: ") + kPublicCalibration +
                      " is that of the public set");
}

void AddInputCheckOptions(CLI::App* app, InputCheckOptions* options) {
  app->add_flag("--no-check", options->is_off, "play the input without a look at it beforehand");
  AddCalibrationOption(app, &options->calibration);
}

}  // namespace airdos
