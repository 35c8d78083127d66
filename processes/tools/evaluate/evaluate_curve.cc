#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <utility>
#include <vector>

#include "common/evaluation/help_curve.h"
#include "common/evaluation/help_curve_plot.h"
#include "common/evaluation/trajectory_plot.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate/evaluate_command.h"

namespace airdos {
namespace {

struct CurveArguments {
  std::string runs;
  std::string json;
  std::string plot;
  bool force = false;
};

void RunCurve(const CurveArguments& arguments) {
  const OutputFiles outputs({arguments.json, arguments.plot}, {{arguments.runs}, arguments.force});
  std::vector<CappedRun> runs = ReadCappedRuns(arguments.runs);
  HelpCurve curve;
  try {
    curve = ComputeHelpCurve(std::move(runs));
  } catch (const InputError& error) {
    throw InputError(arguments.runs + ": " + error.what());
  }
  std::fputs(ToMarkdown(curve).c_str(), stdout);
  if (!arguments.json.empty()) WriteJson(ToJson(curve), arguments.json);
  if (!arguments.plot.empty()) WritePng(DrawHelpCurve(curve), arguments.plot);
}

}  // namespace

void AddCurveCommand(CommandLine* app) {
  const auto arguments = std::make_shared<CurveArguments>();
  CommandLine command =
      app->AddCommand("curve", "When people help: errors against the number of static features");
  command
      .AddFile(
          "--runs", &arguments->runs,
          "JSON lines as written by launch_scripts/benchmark/benchmark_people_help.sh, one per run")
      .Required();
  command.AddFile("--json", &arguments->json, "JSON file for all figures");
  command.AddFile("--plot", &arguments->plot, "PNG file for a plot of the curve");
  command.AddForce(&arguments->force);
  command.OnGiven([arguments] { RunCurve(*arguments); });
}

}  // namespace airdos
