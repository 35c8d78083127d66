#include "tests/support/process.h"

#include <fcntl.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <iterator>
#include <thread>

namespace airdos {

bool PollUntil(const std::function<bool()>& condition, double deadline_s) {
  const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(deadline_s);
  while (!condition()) {
    if (std::chrono::steady_clock::now() > end) return false;
    std::this_thread::sleep_for(std::chrono::milliseconds(20));
  }
  return true;
}

Process::Process(const std::vector<std::string>& arguments, const std::string& output_path)
    : output_path_(output_path) {
  std::vector<char*> argv;
  for (const std::string& argument : arguments) argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  pid_ = fork();
  if (pid_ != 0) return;
  prctl(PR_SET_PDEATHSIG, SIGKILL);
  const int output = open(output_path.c_str(), O_WRONLY | O_CREAT | O_APPEND, 0644);
  dup2(output, STDOUT_FILENO);
  dup2(output, STDERR_FILENO);
  execvp(argv[0], argv.data());
  dprintf(STDERR_FILENO, "%s: cannot be started: %s\n", argv[0], std::strerror(errno));
  _exit(127);
}

Process::~Process() {
  Signal(SIGKILL);
  Wait(10);
}

bool Process::is_running() { return !Wait(0); }

void Process::Signal(int number) {
  if (is_running()) kill(pid_, number);
}

std::optional<int> Process::Wait(double deadline_s) {
  PollUntil(
      [this] {
        if (exit_code_) return true;
        int status = 0;
        if (waitpid(pid_, &status, WNOHANG) != pid_) return false;
        exit_code_ = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
        return true;
      },
      deadline_s);
  return exit_code_;
}

std::string Process::Output() const {
  std::ifstream file(output_path_, std::ios::binary);
  return std::string(std::istreambuf_iterator<char>(file), {});
}

bool Process::HasSaid(const std::string& text) const {
  return Output().find(text) != std::string::npos;
}

std::string EnterOwnNetwork() {
  if (unshare(CLONE_NEWNET) != 0 && unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return std::string("no network namespace can be made (unshare: ") + std::strerror(errno) + ")";
  }
  const char* const commands =
      "ip link set lo up && ip link set lo multicast on && ip route add 224.0.0.0/4 dev lo";
  if (std::system(commands) != 0) return "the network namespace cannot be set up with `ip`";
  return "";
}

}  // namespace airdos
