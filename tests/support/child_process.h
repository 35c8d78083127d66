#ifndef AIRDOS_TESTS_SUPPORT_CHILD_PROCESS_H_
#define AIRDOS_TESTS_SUPPORT_CHILD_PROCESS_H_

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// Asks again and again until the answer is yes; false if it is still no after `deadline_s`.
bool WaitUntil(const std::function<bool()>& condition, double deadline_s);

/// A program that a test runs. Killed, if it still runs, when this goes out of scope.
class ChildProcess {
 public:
  /// What it writes goes to `output_stem`.out and .err.
  ChildProcess(const std::vector<std::string>& command, const std::string& output_stem);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  void Signal(int signal) const;
  /// Exit code, minus the signal that ended it, or nothing if it still runs after `deadline_s`.
  std::optional<int> Wait(double deadline_s);
  bool HasEnded();
  std::string Output() const;
  std::string Errors() const;
  pid_t pid() const { return pid_; }

 private:
  std::string output_stem_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_CHILD_PROCESS_H_
