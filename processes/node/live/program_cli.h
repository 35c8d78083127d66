#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_

#include <functional>
#include <string>

#include "processes/node/command_line.h"

namespace airdos {

// What the command lines of all programs share. Common names: INPUT (--data FOLDER, --log FILE),
// --out, --run-dir, --config, --set, --force, --json, --plot, --version.

/// The data set or log that a program reads, given as INPUT, --data FOLDER or --log FILE.
class InputOptions {
 public:
  /// What the program reads, as its help and messages say; what else is given is its own to refuse.
  enum class Takes { kAny, kDatasets };
  explicit InputOptions(CommandLine* line, Takes takes = Takes::kAny);
  /// Valid after parsing. Throws InputError if it was given not at all or more than once.
  const std::string& path() const;
  bool is_given() const { return !input_.empty() || !data_.empty() || !log_.empty(); }
  /// For what has been parsed as the word of another option.
  void Give(const std::string& path) { input_ = path; }

 private:
  std::string input_;
  std::string data_;
  std::string log_;
  Takes takes_;
};

/// Parses and runs `body`. The line must have the program's name. Adds --version: name, version and
/// commit. Turns wrong options (suggesting what a mistyped one stands for) and InputError into one
/// line on stderr and kExitBadInput; other exceptions, and a failure to write to standard output,
/// into one line and exit code 1.
int RunProgram(int argc, char** argv, CommandLine* line, const std::function<int()>& body);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_
