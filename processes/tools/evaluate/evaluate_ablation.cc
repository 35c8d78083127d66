#include <cstdint>
#include <cstdio>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "common/simulation/settings.h"
#include "common/util/json_file.h"
#include "common/util/output_files.h"
#include "processes/tools/evaluate/ablation.h"
#include "processes/tools/evaluate/ablation_report.h"
#include "processes/tools/evaluate/do_no_harm.h"
#include "processes/tools/evaluate/evaluate_command.h"

namespace airdos {
namespace {

struct AblationArguments {
  std::vector<std::string> groups;
  bool do_no_harm = false;
  int num_sequences = 0;
  std::uint64_t seed = 1;
  std::string json;
  bool force = false;
};

void RunAblationCommand(AblationArguments arguments) {
  const OutputFiles outputs({arguments.json}, {{}, arguments.force});
  const bool do_no_harm = arguments.do_no_harm;
  if (arguments.groups.empty()) arguments.groups = do_no_harm ? SettingNames() : PaperGroups();
  if (arguments.num_sequences == 0) arguments.num_sequences = do_no_harm ? 100 : 10;
  nlohmann::json json;
  const auto show = [](const std::string& text) {
    std::fputs(text.c_str(), stdout);
    std::fflush(stdout);
  };
  if (do_no_harm) show(DoNoHarmTitle());
  for (const std::string& setting : arguments.groups) {
    if (do_no_harm) {
      const DoNoHarmSetting runs = RunDoNoHarm(DefaultDoNoHarmOptions(), setting, arguments.seed,
                                               arguments.num_sequences, nullptr);
      show(ToLine(runs));
      json.push_back(ToJson(runs));
    } else {
      const AblationGroup group =
          RunAblation({}, setting, arguments.seed, arguments.num_sequences, nullptr);
      show(ToTable(group) + "\n");
      json.push_back(ToJson(group));
    }
  }
  if (!arguments.json.empty()) WriteJson(json, arguments.json);
}

}  // namespace

void AddAblationCommand(CommandLine* app) {
  const auto arguments = std::make_shared<AblationArguments>();
  CommandLine command = app->AddCommand(
      "ablation", "The paper's table: bundle adjustment of simulated sequences, with and without");
  command
      .Add("--groups", &arguments->groups,
           "settings of the simulator (default: the paper's four groups)")
      .OneOf(SettingNames());
  command.AddFlag("--do-no-harm", &arguments->do_no_harm,
                  "instead: how people affect the camera's errors, in every setting");
  command
      .Add("--sequences", &arguments->num_sequences, "of each group (default: 10; do-no-harm: 100)")
      .Positive();
  command.Add("--seed", &arguments->seed, "of each group's first sequence").ShowDefault();
  command.AddFile("--json", &arguments->json, "JSON file for all figures");
  command.AddForce(&arguments->force);
  command.OnGiven([arguments] { RunAblationCommand(*arguments); });
}

}  // namespace airdos
