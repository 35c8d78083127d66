#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROCESS_CLI_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROCESS_CLI_H_

#include <string>
#include <vector>

#include "common/config/config_reader.h"
#include "common/config/option_pages.h"
#include "processes/node/live/program_cli.h"

namespace airdos {

/// The options that all processes share.
struct CommonArguments {
  std::string lcm_url;
  std::string config_name;  ///< the process in --set's values, and its file in a config folder
  std::string config_file;  ///< or the folder with <config_name>.yaml
  std::vector<std::string> overrides;  ///< "section.key=value", or with "process:" before it
  std::string resolved_config;         ///< file to write; empty: none
  bool force = false;                  ///< see OutputRules
  RenamedKeys renamed;                 ///< of the configuration
  std::string log_level = "info";      ///< one of LogLevelNames()
};

/// --log-level, of every process.
void AddLogLevel(std::string* level, CommandLine* app);

/// Adds --lcm-url, --config, --set, --resolved-config, --force, --log-level, and --print-config and
/// --help-config, which print a page and end the program; the defaults are those of this
/// installation.
void AddCommonOptions(const OptionPages& pages, CommandLine* app, CommonArguments* arguments);

/// The folder with the YAML files: ../share/airdos/config next to an installed program, else that
/// of the source tree.
std::string ConfigFolder();

/// The processes' names in configurations: those that --set knows.
const std::vector<std::string>& ConfigNames();

/// A value of --set.
struct Assignment {
  std::string process;  ///< of ConfigNames(), or empty
  std::string text;     ///< "section.key=value"
};
/// Reads "process:section.key=value" (a process may be spelled with - for _), or without process.
/// Throws InputError for another form or process.
Assignment ParseAssignment(const std::string& text);

/// The file of `config_name` that --config means: the path itself, or a file in the folder.
std::string ConfigFileOf(const std::string& path, const std::string& config_name);

/// Reads the file and applies the overrides. Throws InputError, also for one of another process.
ConfigReader ReadConfig(const CommonArguments& arguments);

/// To be called when all options were read: throws InputError if the file has one more, and writes
/// the values in force to the file that --resolved-config names, if any: see CheckOutputFile().
void FinishConfig(const ConfigReader& config, const CommonArguments& arguments);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROCESS_CLI_H_
