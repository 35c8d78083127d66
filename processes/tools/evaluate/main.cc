// airdos-evaluate: measures how good an estimate is, given the truth.
#include <opencv2/core.hpp>

#include "processes/node/live/program_cli.h"
#include "processes/tools/evaluate/evaluate_command.h"

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  airdos::CommandLine app("Measures how good an estimate is, given the truth", "airdos-evaluate");
  app.RequireCommand();
  airdos::AddTrajectoryCommand(&app);
  airdos::AddPeopleCommand(&app);
  airdos::AddDetectionsCommand(&app);
  airdos::AddCurveCommand(&app);
  airdos::AddSpeedCommand(&app);
  airdos::AddAblationCommand(&app);
  // Each command runs as soon as it has been parsed.
  return airdos::RunProgram(argc, argv, &app, [] { return 0; });
}
