#include "processes/node/live/program_cli.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <exception>
#include <iostream>
#include <string>

#include "common/util/commit.h"
#include "common/util/error.h"
#include "common/util/version.h"
#include "processes/node/live/process_log.h"

namespace airdos {
namespace {

int FailInOneLine(const std::string& program, std::string what, int exit_code) {
  // Texts of libraries may span several lines.
  while (!what.empty() && what.back() == '\n') what.pop_back();
  std::replace(what.begin(), what.end(), '\n', ' ');
  // The journal takes a line without a level for information.
  const std::string head = StyleOfStderr() == LogStyle::kJournal ? "<3>" : "";
  std::cerr << head << program << ": " << what << std::endl;
  return exit_code;
}

/// The descriptor of a closed stream is reused by the next file that is opened, which would then
/// receive our messages. This makes writing to it fail instead, as for any file opened read-only.
void OccupyClosedStreams() {
  for (int stream = STDIN_FILENO; stream <= STDERR_FILENO; ++stream) {
    if (fcntl(stream, F_GETFD) >= 0) continue;
    const int taken = open("/dev/null", O_RDONLY);
    if (taken != stream && taken >= 0) close(taken);
  }
}

/// The exit code of a program that ended with `code`.
int WithOutputChecked(const std::string& program, int code) {
  std::cout.flush();
  if (std::cout && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return code;
  return FailInOneLine(program, "standard output cannot be written (closed, or the disk is full)",
                       code == 0 ? 1 : code);
}

}  // namespace

InputOptions::InputOptions(CommandLine* line, Takes takes) : takes_(takes) {
  const bool takes_logs = takes == Takes::kAny;
  line->Add("INPUT", &input_,
            takes_logs ? "folder of a data set, or LCM log" : "folder of a data set");
  line->AddFolder("--data", &data_, "the same as INPUT");
  CommandOption log = line->AddFile("--log", &log_, "the same as INPUT");
  if (!takes_logs) log.Hide();
}

const std::string& InputOptions::path() const {
  const std::string* path = nullptr;
  for (const std::string* given : {&input_, &data_, &log_}) {
    if (given->empty()) continue;
    if (path != nullptr) {
      throw InputError("only one input is possible: '" + *path + "' or '" + *given + "'");
    }
    path = given;
  }
  if (path == nullptr) {
    throw InputError(std::string("INPUT is missing: the folder of a data set (--data)") +
                     (takes_ == Takes::kAny ? " or an LCM log (--log)"
                                            : ", or a recording (--images, --video)"));
  }
  return *path;
}

int RunProgram(int argc, char** argv, CommandLine* line, const std::function<int()>& body) {
  OccupyClosedStreams();
  const std::string program = line->program();
  try {
    const bool is_to_run = line->Parse(argc, argv, program + " " + kVersion + " (" + kCommit + ")");
    return WithOutputChecked(program, is_to_run ? body() : 0);
  } catch (const InputError& error) {
    return FailInOneLine(program, error.what(), kExitBadInput);
  } catch (const std::exception& error) {
    return FailInOneLine(program, error.what(), 1);
  }
}

}  // namespace airdos
