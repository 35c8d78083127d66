#ifndef AIRDOS_PROCESSES_NODE_LIVE_PROCESS_LOG_H_
#define AIRDOS_PROCESSES_NODE_LIVE_PROCESS_LOG_H_

#include <cstdint>
#include <functional>
#include <ostream>
#include <string>
#include <vector>

namespace airdos {

/// How grave a line is; the numbers are those of syslog and the journal.
enum class LogLevel { kError = 3, kWarning = 4, kInfo = 6, kDebug = 7 };

/// The words of --log-level, the gravest first: error, warning, info, debug.
const std::vector<std::string>& LogLevelNames();
/// The level of one of these words. Throws InputError for another one.
LogLevel ParseLogLevel(const std::string& name);

/// Whom the lines are for.
enum class LogStyle {
  kTimed,    ///< a terminal or a file: "2026-03-01T12:34:56.789Z PROGRAM: LEVEL: TEXT"
  kJournal,  ///< systemd's journal, which knows time and program: "<4>TEXT"
};

/// kJournal where JOURNAL_STREAM, as systemd sets it, names the file that is standard error; a
/// service whose standard error goes somewhere else inherits the variable all the same.
LogStyle StyleOfStderr();

/// "2026-03-01T12:34:56.789Z" of microseconds since the epoch.
std::string IsoTime(std::int64_t utime);

/// What a running process tells people: one line each, with its time and level. Control characters
/// in a text, such as line breaks, become spaces: whatever a message or a file brought with it
/// cannot begin a line of its own.
class ProcessLog {
 public:
  using Clock = std::function<std::int64_t()>;  ///< wall clock, us since the epoch

  /// To standard error, in the style that fits it. Lines less grave than `least` are left out.
  ProcessLog(const std::string& program, LogLevel least);
  /// `out` is not owned.
  ProcessLog(const std::string& program, LogLevel least, LogStyle style, std::ostream* out,
             Clock clock);

  void Error(const std::string& text) const { Say(LogLevel::kError, text); }
  void Warning(const std::string& text) const { Say(LogLevel::kWarning, text); }
  void Info(const std::string& text) const { Say(LogLevel::kInfo, text); }
  void Debug(const std::string& text) const { Say(LogLevel::kDebug, text); }
  /// A line that says its own level: "error: TEXT", "warning: TEXT"; anything else is information.
  void Relay(const std::string& line) const;
  /// Whether lines of this level are said, for texts that cost something.
  bool Says(LogLevel level) const { return level <= least_; }

 private:
  void Say(LogLevel level, const std::string& text) const;

  std::string program_;
  LogLevel least_;
  LogStyle style_;
  std::ostream* out_;
  Clock clock_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_PROCESS_LOG_H_
