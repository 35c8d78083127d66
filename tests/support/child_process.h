#ifndef AIRDOS_TESTS_SUPPORT_CHILD_PROCESS_H_
#define AIRDOS_TESTS_SUPPORT_CHILD_PROCESS_H_

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// Polls the condition until it holds; false if it does not within `deadline_s`.
bool WaitUntil(const std::function<bool()>& condition, double deadline_s);

/// A program that a test runs. If still running, it is killed when this object goes out of scope,
/// and by the kernel when the test itself dies.
class ChildProcess {
 public:
  /// `command[0]` is the program, looked up in PATH unless it contains a slash. Its output goes to
  /// `output_stem`.out and .err, which are replaced.
  ChildProcess(const std::vector<std::string>& command, const std::string& output_stem);
  ~ChildProcess();
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;

  /// Sends a signal unless the program has ended.
  void Signal(int signal);
  /// Exit code, or minus the signal that ended it; nothing if it is still running after
  /// `deadline_s`.
  std::optional<int> Wait(double deadline_s);
  bool HasEnded();
  std::string Output() const;
  std::string Errors() const;
  /// Whether its output or its errors contain the text.
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
