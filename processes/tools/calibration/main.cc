// airdos-calibration: what a calibration file says, whether it fits images, and the same in another
// format.
#include <filesystem>
#include <fstream>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/calibration/rig_writer.h"
#include "common/check/check_shift.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/node/live/calibration_cli.h"
#include "processes/node/live/program_cli.h"
#include "processes/tools/calibration/image_folders.h"
#include "processes/tools/calibration/rig_text.h"

namespace airdos {
namespace {

struct Arguments {
  CalibrationArguments calibration;
  std::vector<std::string> images;
  int num_pairs = 20;
  std::string format;
  std::string out;
  std::string json;
  bool force = false;
};

int Show(const Arguments& arguments) {
  const OutputFiles outputs({arguments.json}, {arguments.calibration.paths(), arguments.force});
  const StereoRig rig = arguments.calibration.Read();
  const StereoRectifier rectifier(rig, arguments.calibration.rectifier_options());
  std::cout << RigText(rig, rectifier);
  if (!arguments.json.empty()) WriteJson(RigJson(rig, rectifier), arguments.json);
  return 0;
}

int Convert(const Arguments& arguments) {
  const StereoRig rig = arguments.calibration.Read();
  const StereoRectifier rectifier(rig, arguments.calibration.rectifier_options());
  const std::vector<NamedText> files = WriteRig(rig, rectifier, arguments.format);
  std::vector<std::string> paths;
  for (const NamedText& file : files)
    paths.push_back((std::filesystem::path(arguments.out) / file.name).string());
  const OutputFiles outputs(paths, {arguments.calibration.paths(), arguments.force});
  for (std::size_t i = 0; i < files.size(); ++i) {
    std::ofstream stream(paths[i], std::ios::binary);
    stream << files[i].text << std::flush;
    if (!stream) throw InputError(paths[i] + ": cannot be written");
    std::cout << paths[i] << "\n";
  }
  return 0;
}

int Check(const Arguments& arguments) {
  const ImageFolders folders(arguments.images[0], arguments.images[1]);
  const std::vector<RawPair> pairs = folders.Sample(static_cast<std::size_t>(arguments.num_pairs));
  const StereoRig rig =
      arguments.calibration.Read({pairs.front().left.cols, pairs.front().left.rows});
  const StereoRectifier rectifier(rig, arguments.calibration.rectifier_options());
  std::cout << RigText(rig, rectifier);
  for (const std::string& note : folders.TakeNotes()) std::cout << "note: " << note << "\n";
  const RigCheck check = MeasureRig(rectifier, pairs);
  std::cout << RigCheckText(check);
  const std::string& file = arguments.calibration.paths().front();
  FindingList findings;
  JudgeRigCheck(rig, pairs, check, file, &findings);
  constexpr std::size_t kNumPlaces = 8;
  CheckShift(RectifiedFolders(folders, rectifier), kNumPlaces, &findings);
  findings.Print(file, &std::cout);
  return findings.has_errors() ? 1 : 0;
}

CommandLine AddCommand(const std::string& name, const std::string& text, Arguments* arguments,
                       CommandLine* app) {
  CommandLine command = app->AddCommand(name, text);
  arguments->calibration.AddTo("INPUT", &command).Required();
  return command;
}

int Run(int argc, char** argv) {
  CommandLine app(
      "What a stereo calibration says, whether it fits images, and the same in another format. "
      "Exit code 0: it can be used; 1: it does not fit the images; 2: it cannot be read.",
      "airdos-calibration");
  app.RequireCommand();
  Arguments arguments;
  CommandLine show =
      AddCommand("show", "Print cameras, baseline and the rectified pair", &arguments, &app);
  show.AddFile("--json", &arguments.json, "file to write the same to");
  show.AddForce(&arguments.force);
  CommandLine convert =
      AddCommand("convert", "Write the same calibration in another format", &arguments, &app);
  convert.Add("--to", &arguments.format, "format to write").OneOf(WrittenFormats()).Required();
  convert.AddFolder("--out", &arguments.out, "folder to write to").Required();
  convert.AddForce(&arguments.force);
  CommandLine check = AddCommand("check", "Hold a calibration against images", &arguments, &app);
  check.Add("--images", &arguments.images, "folders of the left and the right images as recorded")
      .ShownAs("LEFT RIGHT")
      .Words(2, 2)
      .Required();
  check.Add("--pairs", &arguments.num_pairs, "pairs to look at").Within(1, 10000).ShowDefault();
  return RunProgram(argc, argv, &app, [&] {
    if (show.is_given()) return Show(arguments);
    if (convert.is_given()) return Convert(arguments);
    return Check(arguments);
  });
}

}  // namespace
}  // namespace airdos

int main(int argc, char** argv) { return airdos::Run(argc, argv); }
