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

/// A program that a test runs. Killed, if it still runs, when this goes out of scope, and by the
/// kernel when the test itself dies.
class ChildProcess {
 public:
  /// `command[0]` is the program, looked up in PATH unless it has a slash. What it writes goes to
  /// `output_stem`.out and .err, which are replaced.
  ChildProcess(const std::vector<std::string>& command, const std::string& output_stem);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a signal unless it has ended.
  void Signal(int signal);
  /// Exit code, minus the signal that ended it, or nothing if it still runs after `deadline_s`.
  std::optional<int> Wait(double deadline_s);
  bool HasEnded();
  std::string Output() const;
  std::string Errors() const;
  /// Whether the text is in its output or its errors.
  bool HasSaid(const std::string& text) const;
  pid_t pid() const { return pid_; }

 private:
  std::string output_path_;
  std::string error_path_;
  pid_t pid_ = -1;
  std::optional<int> exit_code_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_CHILD_PROCESS_H_
