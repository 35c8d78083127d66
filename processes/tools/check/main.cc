// airdos-check: checks whether a folder or a log can be used, before using it.
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/node/check/input_check.h"
#include "processes/node/live/program_cli.h"

int main(int argc, char** argv) {
  airdos::CommandLine app(
      "Reports what is wrong with a recorded sequence or an LCM log before it is used: one line "
      "per "
      "finding. Exit code 0: it can be used; 1: there are errors; 2: wrong arguments.",
      "airdos-check");
  std::string json_path;
  bool force = false;
  airdos::CheckOptions options;
  const airdos::InputOptions input_options(&app);
  bool is_quick = false;
  app.AddFlag("--quick", &is_quick, "only what replay and player check before they start");
  app.AddFlag("--all", &options.all, "check the pictures of all frames");
  airdos::AddCalibrationOption(&app, &options.calibration);
  app.Add("--max-frames", &options.max_frames, "number of frames whose pictures are checked")
      .Within(1, 1000000)
      .ShowDefault();
  app.Add("--odometry-frames", &options.odometry_frames,
          "frames of visual odometry to compare with the ground truth; 0: none")
      .Within(0, 1000)
      .ShowDefault();
  app.AddFile("--json", &json_path, "file to write the findings to");
  app.AddForce(&force);

  return airdos::RunProgram(argc, argv, &app, [&] {
    const std::string& input = input_options.path();
    const airdos::OutputFiles outputs({json_path}, {{input}, force});
    if (is_quick) options.depth = airdos::CheckOptions::Depth::kQuick;
    const airdos::FindingList findings = airdos::CheckInput(input, options);
    findings.Print(input, &std::cout);
    if (!json_path.empty()) airdos::WriteJson(findings.ToJson(input), json_path);
    return findings.has_errors() ? 1 : 0;
  });
}
