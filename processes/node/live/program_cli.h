#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace airdos {

// What the command lines of all programs share. Common names: INPUT (--data FOLDER, --log FILE),
// --out, --run-dir, --config, --set, --force, --json, --plot, --version.

/// An option that names a file or a folder, shown as FILE or FOLDER in --help.
CLI::Option* AddFile(const std::string& names, std::string* path, const std::string& text,
                     CLI::App* app);
CLI::Option* AddFolder(const std::string& names, std::string* path, const std::string& text,
                       CLI::App* app);

/// --force: see OutputRules.
void AddForce(bool* force, CLI::App* app);

/// Accepts one of the words; the message for any other word suggests a similar one. Unlike
/// CLI::IsMember, it lists the words below the text of --help.
CLI::Validator OneOf(const std::vector<std::string>& words);

/// The data set or log that a program reads, given as INPUT, --data FOLDER or --log FILE.
class InputOptions {
 public:
  explicit InputOptions(CLI::App* app);
  /// Valid after parsing. Throws InputError if it was given not at all or more than once.
  const std::string& path() const;

 private:
  std::string input_;
  std::string data_;
  std::string log_;
};

/// Parses and runs `body`. The app must have the program's name. Adds --version: name, version and
/// commit. Turns wrong options (suggesting what a mistyped one stands for) and InputError into one
/// line on stderr and kExitBadInput; other exceptions, and a failure to write to standard output,
/// into one line and exit code 1.
int RunProgram(int argc, char** argv, CLI::App* app, const std::function<int()>& body);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_
