#include "processes/node/process_cli.h"

#include <algorithm>
#include <exception>
#include <filesystem>
#include <fstream>
#include <iostream>

#include "common/util/error.h"
#include "common/util/version.h"
#include "processes/node/lcm_transport.h"

namespace airdos {
namespace {

int FailInOneLine(const CLI::App& app, std::string what, int exit_code) {
  // The texts of libraries may have several lines.
  while (!what.empty() && what.back() == '\n') what.pop_back();
  std::replace(what.begin(), what.end(), '\n', ' ');
  std::cerr << app.get_name() << ": " << what << std::endl;
  return exit_code;
}

}  // namespace

std::string ConfigFolder() {
  std::error_code ignored;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", ignored);
  const std::filesystem::path installed =
      program.parent_path().parent_path() / "share" / "airdos" / "config";
  if (std::filesystem::is_directory(installed, ignored)) return installed.string();
  return AIRDOS_SOURCE_CONFIG_DIR;
}

void AddCommonOptions(const std::string& config_name, CLI::App* app, CommonArguments* arguments) {
  arguments->lcm_url = DefaultLcmUrl();
  arguments->config_file = ConfigFolder() + "/" + config_name + ".yaml";
  app->add_option("--lcm-url", arguments->lcm_url, "Where the other processes are (LCM URL)")
      ->capture_default_str();
  app->add_option("--config", arguments->config_file, "YAML file with the options")
      ->capture_default_str();
  app->add_option("--set", arguments->overrides, "section.key=value: replaces one value of it")
      ->expected(1)
      ->multi_option_policy(CLI::MultiOptionPolicy::TakeAll);
  app->add_option("--resolved-config", arguments->resolved_config,
                  "File to write all options to with the values in force");
  app->set_version_flag("--version", std::string(kVersion));
}

ConfigReader ReadConfig(const CommonArguments& arguments) {
  ConfigReader config = ConfigReader::FromFile(arguments.config_file);
  for (const std::string& assignment : arguments.overrides) config.Override(assignment);
  return config;
}

void FinishConfig(const ConfigReader& config, const CommonArguments& arguments) {
  config.Finish();
  if (arguments.resolved_config.empty()) return;
  std::ofstream file(arguments.resolved_config);
  file << config.Resolved();
  file.close();
  if (!file) throw InputError(arguments.resolved_config + ": cannot be written");
}

int RunProgram(int argc, char** argv, CLI::App* app, const std::function<int()>& body) {
  try {
    app->parse(argc, argv);
    return body();
  } catch (const CLI::ParseError& error) {
    if (error.get_exit_code() == 0) return app->exit(error);  // --help, --version
    return FailInOneLine(*app, error.what(), kExitBadInput);
  } catch (const InputError& error) {
    return FailInOneLine(*app, error.what(), kExitBadInput);
  } catch (const std::exception& error) {
    return FailInOneLine(*app, error.what(), 1);
  }
}

}  // namespace airdos
