#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_

#include <CLI/CLI.hpp>
#include <functional>
#include <string>
#include <vector>

namespace airdos {

// What the command lines of all programs have in common. Their words: INPUT (--data FOLDER, --log
// FILE), --out, --run-dir, --config, --set, --force, --json, --plot, --version.

/// An option that names a file or a folder; --help shows it as FILE or FOLDER.
CLI::Option* AddFile(const std::string& names, std::string* path, const std::string& text,
                     CLI::App* app);
CLI::Option* AddFolder(const std::string& names, std::string* path, const std::string& text,
                       CLI::App* app);

/// --force: see OutputRules.
void AddForce(bool* force, CLI::App* app);

/// One of the words; the message for another one names that which it is near to. Unlike
/// CLI::IsMember the words are shown below --help's text.
CLI::Validator OneOf(const std::vector<std::string>& words);

/// The data set or log that a program reads: INPUT, --data FOLDER and --log FILE are the same.
class InputOptions {
 public:
  explicit InputOptions(CLI::App* app);
  /// After parsing. Throws InputError where it was not given, or more than once.
  const std::string& path() const;

 private:
  std::string input_;
  std::string data_;
  std::string log_;
};

/// Parses and runs `body`. The app must have the program's name. Adds --version: name, version and
/// commit. Turns wrong options (a mistyped one is answered with that which it is near to) and
/// InputError into one line on stderr and kExitBadInput, other exceptions into one line and 1, and
/// so a standard output that could not be written.
int RunProgram(int argc, char** argv, CLI::App* app, const std::function<int()>& body);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROGRAM_CLI_H_
