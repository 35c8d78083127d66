#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/evaluation/speed_report.h"
#include "common/evaluation/trajectory_plot.h"
#include "common/util/error.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate/evaluate_command.h"

namespace airdos {
namespace {

struct SpeedArguments {
  std::string runs;
  std::string solver;
  std::string json;
  std::string plot;
  bool force = false;
};

void RunSpeed(const SpeedArguments& arguments) {
  const OutputFiles outputs({arguments.json, arguments.plot},
                            {{arguments.runs, arguments.solver}, arguments.force});
  std::vector<ChainSpeed> chains;
  std::vector<SolveTime> solves;
  if (!arguments.runs.empty()) chains = ReadChainSpeeds(arguments.runs);
  if (!arguments.solver.empty()) solves = ReadSolveTimes(arguments.solver);
  if (chains.empty() && solves.empty()) throw InputError("no figures: --runs, --solver or both");
  std::fputs(ToMarkdown(chains, solves).c_str(), stdout);
  if (!arguments.json.empty()) WriteJson(ToJson(chains, solves), arguments.json);
  if (!arguments.plot.empty()) WritePng(DrawSpeed(chains, solves), arguments.plot);
}

}  // namespace

void AddSpeedCommand(CommandLine* app) {
  const auto arguments = std::make_shared<SpeedArguments>();
  CommandLine command = app->AddCommand("speed", "Speed of the chain and its solver");
  command.AddFile(
      "--runs", &arguments->runs,
      "JSON lines as written by launch_scripts/benchmark/benchmark_speed.sh, one per sequence");
  command.AddFile("--solver", &arguments->solver, "JSON of airdos_solver_benchmark");
  command.AddFile("--json", &arguments->json, "JSON file for all figures");
  command.AddFile("--plot", &arguments->plot, "PNG file for plots of how they scale");
  command.AddForce(&arguments->force);
  command.OnGiven([arguments] { RunSpeed(*arguments); });
}

}  // namespace airdos
