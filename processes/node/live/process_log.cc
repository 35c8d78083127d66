#include "processes/node/live/process_log.h"

#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <iostream>
#include <utility>

#include "common/util/error.h"
#include "common/util/suggestion.h"

namespace airdos {
namespace {

struct NamedLevel {
  LogLevel level;
  const char* name;
};
constexpr std::array<NamedLevel, 4> kLevels{{{LogLevel::kError, "error"},
                                             {LogLevel::kWarning, "warning"},
                                             {LogLevel::kInfo, "info"},
                                             {LogLevel::kDebug, "debug"}}};

std::string NameOf(LogLevel level) {
  for (const NamedLevel& known : kLevels) {
    if (known.level == level) return known.name;
  }
  return "info";
}

std::int64_t SystemClock_us() {
  return std::chrono::duration_cast<std::chrono::microseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

std::string InOneLine(std::string text) {
  const auto is_control = [](unsigned char c) { return c < ' ' || c == 0x7f; };
  std::replace_if(text.begin(), text.end(), is_control, ' ');
  return text;
}

}  // namespace

const std::vector<std::string>& LogLevelNames() {
  static const std::vector<std::string> names = [] {
    std::vector<std::string> list;
    for (const NamedLevel& known : kLevels) list.emplace_back(known.name);
    return list;
  }();
  return names;
}

LogLevel ParseLogLevel(const std::string& name) {
  for (const NamedLevel& known : kLevels) {
    if (known.name == name) return known.level;
  }
  throw InputError("--log-level '" + name + "': is none of error, warning, info, debug" +
                   DidYouMean(name, LogLevelNames()));
}

LogStyle StyleOfStderr() {
  const char* stream = std::getenv("JOURNAL_STREAM");
  struct stat file = {};
  if (stream == nullptr || fstat(STDERR_FILENO, &file) != 0) return LogStyle::kTimed;
  const std::string name = std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino);
  return name == stream ? LogStyle::kJournal : LogStyle::kTimed;
}

std::string IsoTime(std::int64_t utime) {
  constexpr std::int64_t kSecond_us = 1000000;
  // Rounded down, before the epoch too.
  const std::int64_t within_us = ((utime % kSecond_us) + kSecond_us) % kSecond_us;
  const std::time_t seconds = (utime - within_us) / kSecond_us;
  std::tm parts = {};
  gmtime_r(&seconds, &parts);
  std::array<char, 64> text = {};
  const std::size_t size = std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%S", &parts);
  std::snprintf(text.data() + size, text.size() - size, ".%03dZ",
                static_cast<int>(within_us / 1000));
  return text.data();
}

ProcessLog::ProcessLog(const std::string& program, LogLevel least)
    : ProcessLog(program, least, StyleOfStderr(), &std::cerr, SystemClock_us) {}

ProcessLog::ProcessLog(const std::string& program, LogLevel least, LogStyle style,
                       std::ostream* out, Clock clock)
    : program_(program), least_(least), style_(style), out_(out), clock_(std::move(clock)) {}

void ProcessLog::Relay(const std::string& line) const {
  for (const NamedLevel& known : kLevels) {
    const std::string head = std::string(known.name) + ": ";
    if (line.compare(0, head.size(), head) == 0) return Say(known.level, line.substr(head.size()));
  }
  Info(line);
}

void ProcessLog::Say(LogLevel level, const std::string& text) const {
  if (!Says(level)) return;
  // At one go, so that the lines of several processes on one terminal stay whole.
  const std::string head = style_ == LogStyle::kJournal
                               ? "<" + std::to_string(static_cast<int>(level)) + ">"
                               : IsoTime(clock_()) + " " + program_ + ": " + NameOf(level) + ": ";
  *out_ << head + InOneLine(text) + "\n" << std::flush;
}

}  // namespace airdos
