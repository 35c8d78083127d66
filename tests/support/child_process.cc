#include "tests/support/child_process.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <fstream>
#include <sstream>
#include <stdexcept>
#include <thread>

namespace airdos {
namespace {

std::string Contents(const std::string& path) {
  std::ifstream file(path);
  std::ostringstream text;
  text << file.rdbuf();
  return text.str();
}

void Redirect(const std::string& path, int descriptor) {
  const int file = open(path.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0644);
  if (file < 0 || dup2(file, descriptor) < 0) _exit(126);
  close(file);
}

}  // namespace

bool WaitUntil(const std::function<bool()>& condition, double deadline_s) {
  const auto deadline =
      std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > deadline) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  return true;
}

ChildProcess::ChildProcess(const std::vector<std::string>& command, const std::string& output_stem)
    : output_stem_(output_stem), pid_(fork()) {
  if (pid_ < 0) throw std::runtime_error("fork failed");
  if (pid_ > 0) return;
  Redirect(output_stem + ".out", STDOUT_FILENO);
  Redirect(output_stem + ".err", STDERR_FILENO);
  std::vector<char*> arguments;
  for (const std::string& argument : command) {
    arguments.push_back(const_cast<char*>(argument.c_str()));
  }
  arguments.push_back(nullptr);
  execv(arguments[0], arguments.data());
  _exit(127);
}

ChildProcess::~ChildProcess() {
  if (HasEnded()) return;
  Signal(SIGKILL);
  Wait(60);
}

void ChildProcess::Signal(int signal) const { kill(pid_, signal); }

bool ChildProcess::HasEnded() {
  if (exit_code_) return true;
  int status = 0;
  if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
  exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : -WTERMSIG(status);
  return true;
}

std::optional<int> ChildProcess::Wait(double deadline_s) {
  WaitUntil([this] { return HasEnded(); }, deadline_s);
  return exit_code_;
}

std::string ChildProcess::Output() const { return Contents(output_stem_ + ".out"); }
std::string ChildProcess::Errors() const { return Contents(output_stem_ + ".err"); }

}  // namespace airdos
