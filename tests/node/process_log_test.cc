#include "processes/node/live/process_log.h"

#include <gtest/gtest.h>
#include <stdlib.h>
#include <sys/stat.h>
#include <unistd.h>

#include <sstream>
#include <string>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr std::int64_t kTime_us = 1767225599999999;  // the last microsecond of 2025

std::string Said(LogStyle style, LogLevel least) {
  std::ostringstream out;
  const ProcessLog log("airdos-echo", least, style, &out, [] { return kTime_us; });
  log.Error("e");
  log.Warning("w");
  log.Info("i");
  log.Debug("d");
  return out.str();
}

TEST(ProcessLogTest, ALineHasItsTimeProgramAndLevel) {
  EXPECT_EQ(Said(LogStyle::kTimed, LogLevel::kDebug),
            "2025-12-31T23:59:59.999Z airdos-echo: error: e\n"
            "2025-12-31T23:59:59.999Z airdos-echo: warning: w\n"
            "2025-12-31T23:59:59.999Z airdos-echo: info: i\n"
            "2025-12-31T23:59:59.999Z airdos-echo: debug: d\n");
}

// The numbers are those of sd-daemon(3).
TEST(ProcessLogTest, TheJournalGetsThePriorityAndAddsTheRest) {
  EXPECT_EQ(Said(LogStyle::kJournal, LogLevel::kDebug), "<3>e\n<4>w\n<6>i\n<7>d\n");
}

TEST(ProcessLogTest, WhatIsLessGraveIsLeftOut) {
  EXPECT_EQ(Said(LogStyle::kJournal, LogLevel::kError), "<3>e\n");
  EXPECT_EQ(Said(LogStyle::kJournal, LogLevel::kWarning), "<3>e\n<4>w\n");
  EXPECT_EQ(Said(LogStyle::kJournal, LogLevel::kInfo), "<3>e\n<4>w\n<6>i\n");
  std::ostringstream out;
  const ProcessLog log("p", LogLevel::kInfo, LogStyle::kJournal, &out, nullptr);
  EXPECT_TRUE(log.Says(LogLevel::kInfo));
  EXPECT_FALSE(log.Says(LogLevel::kDebug));
}

TEST(ProcessLogTest, ALineThatSaysItsLevelKeepsIt) {
  std::ostringstream out;
  const ProcessLog log("p", LogLevel::kInfo, LogStyle::kJournal, &out, nullptr);
  log.Relay("error: of a file");
  log.Relay("warning: of a log: error: within");
  log.Relay("debug: is left out");
  log.Relay("no level: error: within");
  EXPECT_EQ(out.str(), "<3>of a file\n<4>of a log: error: within\n<6>no level: error: within\n");
}

// Texts carry names of files and what was in them: none may pass for a line of the process.
TEST(ProcessLogTest, ATextIsOneLine) {
  std::ostringstream out;
  const ProcessLog log("p", LogLevel::kInfo, LogStyle::kJournal, &out, nullptr);
  log.Info("a\n<3>b\tc\x1b[31md\x7f\r\xc3\xa4");
  EXPECT_EQ(out.str(), "<6>a <3>b c [31md  \xc3\xa4\n");
}

TEST(ProcessLogTest, TimesAreThoseOfTheCalendar) {
  EXPECT_EQ(IsoTime(0), "1970-01-01T00:00:00.000Z");
  EXPECT_EQ(IsoTime(951782400001000), "2000-02-29T00:00:00.001Z");
  EXPECT_EQ(IsoTime(-1), "1969-12-31T23:59:59.999Z");
}

TEST(ProcessLogTest, LevelsAreWords) {
  EXPECT_EQ(ParseLogLevel("error"), LogLevel::kError);
  EXPECT_EQ(ParseLogLevel("debug"), LogLevel::kDebug);
  ASSERT_EQ(LogLevelNames().size(), 4u);
  for (const std::string& name : LogLevelNames()) EXPECT_NO_THROW(ParseLogLevel(name)) << name;
  try {
    ParseLogLevel("warn");
    ADD_FAILURE() << "no level";
  } catch (const InputError& error) {
    EXPECT_NE(std::string(error.what()).find("warning"), std::string::npos) << error.what();
  }
}

TEST(ProcessLogTest, TheJournalIsKnownByItsFile) {
  struct stat file = {};
  ASSERT_EQ(fstat(STDERR_FILENO, &file), 0);
  const std::string device = std::to_string(file.st_dev);
  unsetenv("JOURNAL_STREAM");
  EXPECT_EQ(StyleOfStderr(), LogStyle::kTimed);
  setenv("JOURNAL_STREAM", (device + ":" + std::to_string(file.st_ino)).c_str(), 1);
  EXPECT_EQ(StyleOfStderr(), LogStyle::kJournal);
  // A service's child whose standard error goes to a file has the variable as well.
  setenv("JOURNAL_STREAM", (device + ":" + std::to_string(file.st_ino + 1)).c_str(), 1);
  EXPECT_EQ(StyleOfStderr(), LogStyle::kTimed);
  setenv("JOURNAL_STREAM", "", 1);
  EXPECT_EQ(StyleOfStderr(), LogStyle::kTimed);
  unsetenv("JOURNAL_STREAM");
}

}  // namespace
}  // namespace airdos
