// airdos-evaluate: how good an estimate is, given the truth.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <exception>
#include <opencv2/core.hpp>

#include "common/util/error.h"
#include "common/util/version.h"
#include "processes/tools/evaluate_command.h"

int main(int argc, char** argv) {
  cv::setNumThreads(1);
  CLI::App app("How good an estimate is, given the truth");
  app.set_version_flag("--version", airdos::kVersion);
  app.require_subcommand(1);
  airdos::AddTrajectoryCommand(&app);
  airdos::AddPeopleCommand(&app);
  airdos::AddCurveCommand(&app);
  airdos::AddSpeedCommand(&app);
  airdos::AddAblationCommand(&app);
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : airdos::kExitBadInput;
  } catch (const airdos::InputError& error) {
    std::fprintf(stderr, "airdos-evaluate: %s\n", error.what());
    return airdos::kExitBadInput;
  } catch (const std::exception& error) {
    std::fprintf(stderr, "airdos-evaluate: %s\n", error.what());
    return 1;
  }
  return 0;
}
