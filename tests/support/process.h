#ifndef AIRDOS_TESTS_SUPPORT_PROCESS_H_
#define AIRDOS_TESTS_SUPPORT_PROCESS_H_

#include <sys/types.h>

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace airdos {

/// True as soon as `condition` holds, false if it did not within `deadline_s`.
bool PollUntil(const std::function<bool()>& condition, double deadline_s);

/// One child process whose output goes to a file. It is killed with this object, and by the kernel
/// if the test itself dies.
class Process {
 public:
  /// `arguments[0]` is the program (looked up in PATH unless it has a slash). Standard output and
  /// error are appended to `output_path`.
  Process(const std::vector<std::string>& arguments, const std::string& output_path);
  ~Process();
  Process(const Process&) = delete;
  Process& operator=(const Process&) = delete;

  pid_t pid() const { return pid_; }
  bool is_running();
  /// Sends a signal unless it has ended.
  void Signal(int number);
  /// Exit code, 128 + signal if one ended it; nothing if it still runs after `deadline_s`.
  std::optional<int> Wait(double deadline_s);
  /// Whether its output (of former processes with the same file, too) holds the text.
  bool HasSaid(const std::string& text) const;
  std::string Output() const;

 private:
  pid_t pid_ = -1;
  std::string output_path_;
  std::optional<int> exit_code_;
};

/// Moves this process into a network namespace of its own in which multicast works. Returns what
/// prevents it, empty if nothing does.
std::string EnterOwnNetwork();

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_PROCESS_H_
