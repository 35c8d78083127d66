// airdos-import: makes a log or a data set folder of a recording, or of a data set, perhaps with
// the people that another program found in it.
#include <filesystem>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/keypoints/foreign_keypoints.h"
#include "common/dataset/keypoints/keypoint_sequence.h"
#include "common/util/error.h"
#include "processes/node/check/input_check.h"
#include "processes/node/live/recording_cli.h"
#include "processes/tools/import/import.h"
#include "processes/tools/progress/progress_bar.h"

namespace airdos {
namespace {

struct Arguments {
  RecordingArguments recording;
  InputCheckOptions check;
  std::string keypoints_left;
  std::string keypoints_right;
  ImportOptions options;
  std::string encoding = "auto";
  bool no_progress = false;
};

void Say(const std::string& line) { std::cerr << "airdos-import: " << line << std::endl; }

void AddTo(CommandLine* app, Arguments* arguments) {
  arguments->recording.AddTo(app);
  AddInputCheckOptions(app, &arguments->check);
  app->AddFile("-o,--out", &arguments->options.out,
               "log to write (.lcm), or folder of a data set (no ending)")
      .Required();
  app->AddFile("--keypoints-left", &arguments->keypoints_left,
               "people found in the left images, by AlphaPose or OpenPose, as COCO results, or in "
               "lines of numbers; a file, or a folder with one an image");
  app->AddFile("--keypoints-right", &arguments->keypoints_right, "the same of the right images");
  app->Add("--first", &arguments->options.first, "first frame").NotNegative();
  app->Add("--last", &arguments->options.last, "last frame, included").NotNegative();
  app->Add("--session", &arguments->options.session, "session number of a log").ShowDefault();
  app->Add("--image-encoding", &arguments->encoding,
           "of a log: auto: files that fit unchanged, else JPEG; png: lossless, whatever the size")
      .ShowDefault()
      .OneOf({"auto", "jpeg", "png"});
  app->AddForce(&arguments->options.rules.force);
  app->AddFlag("--no-progress", &arguments->no_progress, "do not report progress");
}

void RequireFolder(const std::string& input) {
  if (!std::filesystem::is_regular_file(input)) return;  // what is not there is said on opening
  throw InputError(input +
                   ": is a file, wanted is the folder of a data set (a log needs no import, a "
                   "video is given by --video)");
}

std::unique_ptr<StereoSequence> OpenSequence(const Arguments& arguments, const std::string& input) {
  if (arguments.recording.is_given()) return arguments.recording.Open();
  return OpenStereoSequence(input, {arguments.recording.named_calibration()});
}

void Check(const Arguments& arguments, const std::string& input) {
  if (arguments.check.is_off) return;
  if (arguments.recording.is_given()) {
    CheckRecordingBeforeRun(*arguments.recording.Open(), Say);
  } else {
    // Its own keypoints do not matter where others take their place, nor do files that are not
    // read: the others may be among them.
    const auto concerns = [&arguments](const Finding& finding) {
      return arguments.keypoints_left.empty() ||
             (finding.kind.rfind("keypoints.", 0) != 0 && finding.kind != "folder.unread");
    };
    CheckBeforeRun(input, arguments.recording.named_calibration(), Say, concerns);
  }
}

/// Of what was written: exchanged left and right, people of other images, which no run would take.
void CheckPeople(const std::string& out) {
  CheckOptions options;
  options.max_frames = 1;  // pictures have been checked
  options.odometry_frames = 0;
  const FindingList findings = CheckInput(out, options);
  for (const Finding& finding : findings.findings()) {
    if (finding.kind.rfind("keypoints.", 0) != 0 || finding.severity == Severity::kNote) continue;
    const std::string text = (finding.where.empty() ? out : finding.where) + ": " + finding.what;
    if (finding.severity == Severity::kError) {
      throw InputError(text + "; it is written, but these keypoints are of no use");
    }
    Say("warning: " + text);
  }
}

std::unique_ptr<StereoSequence> WithKeypoints(std::unique_ptr<StereoSequence> sequence,
                                              const Arguments& arguments) {
  if (arguments.keypoints_left.empty()) return sequence;
  auto people = std::make_unique<KeypointSequence>(std::move(sequence),
                                                   ReadForeignKeypoints(arguments.keypoints_left),
                                                   ReadForeignKeypoints(arguments.keypoints_right));
  Say("keypoints, left: " + people->summaries()[0]);
  Say("keypoints, right: " + people->summaries()[1]);
  return people;
}

int Import(InputOptions input, Arguments arguments) {
  using Encoding = ImagePackerOptions::Encoding;
  ImportOptions& options = arguments.options;
  arguments.recording.Settle(&input);
  const bool is_recording = arguments.recording.is_given();
  const std::string path = is_recording ? "" : input.path();
  const std::string name = is_recording ? arguments.recording.name() : path;
  if (arguments.keypoints_left.empty() != arguments.keypoints_right.empty()) {
    throw InputError(
        "--keypoints-left and --keypoints-right belong together: people who are known in one image "
        "only have no distance");
  }
  RequireFolder(path);
  const ImportTarget target = ImportTargetOf(options.out);
  options.rules.inputs =
      is_recording ? arguments.recording.paths() : std::vector<std::string>{path};
  options.rules.inputs.push_back(arguments.keypoints_left);
  options.rules.inputs.push_back(arguments.keypoints_right);
  options.image.encoding = arguments.encoding == "auto"   ? Encoding::kAuto
                           : arguments.encoding == "jpeg" ? Encoding::kJpeg
                                                          : Encoding::kPng;
  CheckNoInput(options.out, options.rules.inputs);
  cv::setNumThreads(1);
  Check(arguments, path);
  ProgressBar bar;
  options.on_note = [&bar](const std::string& note) {
    bar.MakeRoom();
    Say("note: " + note);
  };
  if (!arguments.no_progress) options.on_progress = [&bar](double done) { bar.Show(done); };
  std::unique_ptr<StereoSequence> sequence =
      WithKeypoints(OpenSequence(arguments, path), arguments);
  const StereoCamera camera = sequence->camera();
  const auto import = target == ImportTarget::kLog ? ImportToLog : ImportToFolder;
  const ImportResult result = import(std::move(sequence), name, options);
  std::cout << options.out << ": " << result.num_frames << " frames of " << camera.width << " x "
            << camera.height << " px" << std::endl;
  if (!arguments.keypoints_left.empty() && !arguments.check.is_off) CheckPeople(options.out);
  return 0;
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) {
  airdos::CommandLine app(
      "Makes a log, or a data set folder, of a recording or data set: rectified, with the people "
      "that another program found.",
      "airdos-import");
  airdos::InputOptions input(&app, airdos::InputOptions::Takes::kDatasets);
  airdos::Arguments arguments;
  airdos::AddTo(&app, &arguments);
  return airdos::RunProgram(argc, argv, &app, [&] { return airdos::Import(input, arguments); });
}
