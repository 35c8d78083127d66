#ifndef AIRDOS_PROCESSES_NODE_PROCESS_CLI_H_
#define AIRDOS_PROCESSES_NODE_PROCESS_CLI_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

#include "common/config/config_reader.h"

namespace airdos {

/// The options that all processes share.
struct CommonArguments {
  std::string lcm_url;
  std::string config_file;
  std::vector<std::string> overrides;  ///< "section.key=value"
  std::string resolved_config;         ///< file to write; empty: none
};

/// Adds --lcm-url, --config, --set, --resolved-config and --version; the defaults are those of this
/// installation. `config_name` is the name of the process' file in the config folder, without
/// .yaml.
void AddCommonOptions(const std::string& config_name, CLI::App* app, CommonArguments* arguments);

/// The folder with the YAML files: ../share/airdos/config next to an installed program, else that
/// of the source tree.
std::string ConfigFolder();

/// Reads the file and applies the overrides. Throws InputError.
ConfigReader ReadConfig(const CommonArguments& arguments);

/// To be called when all options were read: throws InputError if the file has one more, and writes
/// the values in force to the file that --resolved-config names, if any.
void FinishConfig(const ConfigReader& config, const CommonArguments& arguments);

/// Parses and runs `body`; turns wrong options and InputError into one line on stderr and
/// kExitBadInput, other exceptions into one line and 1.
int RunProgram(int argc, char** argv, CLI::App* app, const std::function<int()>& body);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_PROCESS_CLI_H_
