#include "processes/node/check/input_check.h"

#include <algorithm>
#include <cstddef>
#include <filesystem>
#include <opencv2/imgproc.hpp>
#include <vector>

#include "common/check/check_files.h"
#include "common/check/check_folder.h"
#include "common/check/check_rig.h"
#include "common/util/error.h"
#include "processes/node/check/check_log.h"

namespace airdos {
namespace {

std::string Text(const std::string& path, const Finding& finding) {
  return (finding.where.empty() ? path : finding.where) + ": " + finding.what;
}

cv::Mat Grey(const cv::Mat& image) {
  if (image.channels() == 1) return image;
  cv::Mat grey;
  cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

/// Some of the first pairs: of a video, all before a pair have to be decoded for it.
std::vector<RawPair> FirstPairs(StereoRecording* recording) {
  constexpr std::size_t kNumPairs = 6;
  constexpr std::size_t kStep = 5;
  const std::size_t step =
      std::max<std::size_t>(1, std::min(kStep, recording->num_pairs() / kNumPairs));
  std::vector<RawPair> pairs;
  for (std::size_t i = 0; i < recording->num_pairs() && pairs.size() < kNumPairs; i += step) {
    const std::optional<RecordedPair> pair = recording->Load(i);
    if (pair) pairs.push_back({Grey(pair->left), Grey(pair->right)});
  }
  return pairs;
}

std::string HowToGoOn(const std::string& path, std::size_t num_errors) {
  const std::string more =
      num_errors > 1 ? " (and " + std::to_string(num_errors - 1) + " more errors)" : "";
  return more + "; 'airdos-check " + path + "' says more; --no-check continues anyway";
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
                    const std::function<void(const std::string&)>& say,
                    const std::function<bool(const Finding&)>& concerns) {
  CheckOptions options;
  options.depth = CheckOptions::Depth::kQuick;
  options.calibration = calibration;
  const FindingList findings = CheckInput(path, options);
  std::vector<std::string> errors;
  std::vector<std::string> warnings;
  for (const Finding& finding : findings.findings()) {
    // Assumptions are reported by the source itself, checked or not. And in a damaged log every
    // intact event is worth playing, for example in a recording that ended with a power cut.
    if (concerns && !concerns(finding)) continue;
    const bool is_known = finding.kind == kAssumedKind;
    const bool is_survived = finding.kind == kLogDamagedKind;
    if (finding.severity == Severity::kError && !is_survived) {
      errors.push_back(Text(path, finding));
    } else if (finding.severity != Severity::kNote && !is_known) {
      warnings.push_back("warning: " + Text(path, finding));
    }
  }
  if (!errors.empty()) throw InputError(errors[0] + HowToGoOn(path, errors.size()));
  for (const std::string& warning : warnings) say(warning);
}

void CheckRecordingBeforeRun(const RectifiedSequence& sequence,
                             const std::function<void(const std::string&)>& say) {
  const std::string name = sequence.recording()->name();
  const std::vector<RawPair> pairs = FirstPairs(sequence.recording());
  if (pairs.empty()) throw InputError(name + ": none of its first pairs can be used");
  FindingList findings;
  const std::string where = sequence.rig().files.empty() ? name : sequence.rig().files[0];
  JudgeRigCheck(sequence.rig(), pairs, MeasureRig(sequence.rectifier(), pairs), where, &findings);
  for (const Finding& finding : findings.findings()) {
    if (finding.severity == Severity::kError) {
      throw InputError(Text(name, finding) +
                       "; 'airdos-calibration check' says more; --no-check continues anyway");
    }
    if (finding.severity == Severity::kWarning) say("warning: " + Text(name, finding));
  }
}

void AddCalibrationOption(CommandLine* app, std::string* calibration) {
  app->Add("--calibration", calibration,
           std::string("of a folder without one, by name: ") + kPublicCalibration +
               " is that of the public set");
}

void AddInputCheckOptions(CommandLine* app, InputCheckOptions* options) {
  app->AddFlag("--no-check", &options->is_off, "play the input without checking it first");
}

}  // namespace airdos
