#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROCESS_MAIN_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROCESS_MAIN_H_

#include <functional>
#include <memory>
#include <string>

#include "common/config/config_reader.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/node.h"

namespace airdos {

/// What makes one process different from another.
struct ProcessInfo {
  std::string program;      ///< name of the executable, of the process in STATUS and FRAME_DONE
  OptionPages options;      ///< <config folder>/<its config_name>.yaml is the default of --config
  std::string description;  ///< for --help
  /// Reads the node's options; the caller calls Finish().
  std::function<std::unique_ptr<Node>(ConfigReader*)> make_node;
  bool publishes_frame_done = false;
  /// Adds options of this process alone; may be empty. The arguments live as long as the process.
  std::function<void(CommandLine*, const CommonArguments&)> add_options = nullptr;
};

/// The whole main of a process that is one node: options, node, LCM, until SIGINT, SIGTERM or
/// SIGHUP. Returns the exit code: 2 for a wrong option, file, key or URL, after one line on stderr;
/// 1 where it refused to go on.
int RunNodeProcess(int argc, char** argv, const ProcessInfo& info);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROCESS_MAIN_H_
