#include "processes/node/live/process_cli.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "common/util/error.h"
#include "common/util/output_files.h"
#include "common/util/suggestion.h"
#include "common/util/words.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_log.h"

namespace airdos {
std::string ConfigFolder() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path installed =
      program.parent_path().parent_path() / "share" / "airdos" / "config";
  if (std::filesystem::is_directory(installed, ignored)) return installed.string();
  return AIRDOS_SOURCE_CONFIG_DIR;
}

void AddLogLevel(std::string* level, CommandLine* app) {
  app->Add("--log-level", level, "Omit lines on stderr below this level")
      .OneOf(LogLevelNames())
      .ShowDefault();
}

void AddCommonOptions(const OptionPages& pages, CommandLine* app, CommonArguments* arguments) {
  const std::string& config_name = pages.config_name;
  arguments->lcm_url = DefaultLcmUrl();
  arguments->renamed = pages.renamed;
  arguments->config_name = config_name;
  arguments->config_file = ConfigFolder() + "/" + config_name + ".yaml";
  app->Add("--lcm-url", &arguments->lcm_url, "Where the other processes are (LCM URL)")
      .ShowDefault();
  app->AddFile("--config", &arguments->config_file,
               "YAML file with the options, or folder with " + config_name + ".yaml")
      .ShowDefault();
  app->AddRepeated("--set", &arguments->overrides,
                   "section.key=value: replaces one value of it (again for more); " + config_name +
                       ": may stand before it, as for airdos-replay");
  app->AddFile("--resolved-config", &arguments->resolved_config,
               "File to write all options to with the values in force");
  const std::vector<std::string> unheeded = {"--config", "--set"};  // pages tell of the defaults
  app->AddPage("--print-config", pages.default_file,
               "Print " + config_name + ".yaml with its comments, to start one's own from",
               unheeded);
  app->AddPage("--help-config", pages.reference,
               "Print all keys for --config and --set: default, what is allowed, unit, meaning",
               unheeded);
  app->AddForce(&arguments->force);
  AddLogLevel(&arguments->log_level, app);
}

const std::vector<std::string>& ConfigNames() {
  static const std::vector<std::string> names{"frontend",     "human_tracker",   "optimizer",
                                              "map_recorder", "person_detector", "stereo_camera",
                                              "stereo_player"};
  return names;
}

Assignment ParseAssignment(const std::string& text) {
  const std::size_t equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    throw InputError("--set '" + text +
                     "': is not of the form section.key=value or process:section.key=value");
  }
  const std::size_t colon = text.find(':');
  if (colon > equals) return {"", text};
  std::string process = text.substr(0, colon);
  std::replace(process.begin(), process.end(), '-', '_');
  const std::vector<std::string>& all = ConfigNames();
  if (std::find(all.begin(), all.end(), process) == all.end()) {
    const std::string hint = DidYouMean(process, all);
    throw InputError("--set '" + text + "': there is no process '" + process + "'" +
                     (hint.empty() ? "; there are " + JoinWords(all, ", ") : hint));
  }
  return {process, text.substr(colon + 1)};
}

std::string ConfigFileOf(const std::string& path, const std::string& config_name) {
  std::error_code ignored;
  if (!std::filesystem::is_directory(path, ignored)) return path;
  return (std::filesystem::path(path) / (config_name + ".yaml")).string();
}

ConfigReader ReadConfig(const CommonArguments& arguments) {
  ConfigReader config = ConfigReader::FromFile(
      ConfigFileOf(arguments.config_file, arguments.config_name), arguments.renamed);
  for (const std::string& text : arguments.overrides) {
    const Assignment assignment = ParseAssignment(text);
    if (!assignment.process.empty() && assignment.process != arguments.config_name) {
      throw InputError("--set '" + text + "': is meant for " + assignment.process + ", this is " +
                       arguments.config_name);
    }
    config.Override(assignment.text);
  }
  return config;
}

void FinishConfig(const ConfigReader& config, const CommonArguments& arguments) {
  config.Finish();
  if (arguments.resolved_config.empty()) return;
  const OutputFiles output(
      {arguments.resolved_config},
      {{ConfigFileOf(arguments.config_file, arguments.config_name)}, arguments.force});
  std::ofstream file(arguments.resolved_config);
  file << config.Resolved();
  file.close();
  if (!file) throw InputError(arguments.resolved_config + ": cannot be written");
}

}  // namespace airdos
