#include <gtest/gtest.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <string>
#include <vector>

#include "common/map/four_d_map.h"
#include "processes/node/log/event_log.h"
#include "tests/support/child_process.h"

// What the programs do to files that are not theirs to write, with the programs themselves.

namespace airdos {
namespace {

namespace fs = std::filesystem;

constexpr double kDeadline_s = 300;

class UserCases : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_user_cases_system_" + std::to_string(getpid()));
    fs::remove_all(folder_);
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string Path(const std::string& name) const { return (folder_ / name).string(); }
  std::string Write(const std::string& name, const std::string& text) const {
    std::ofstream(folder_ / name) << text;
    return Path(name);
  }
  static std::string TextOf(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
  }
  /// The first events of the sample log, or all of them if it has fewer.
  std::string WriteLog(const std::string& name, int num_events) const {
    EventLogReader reader(std::string(AIRDOS_SOURCE_DIR) + "/logs/road_crossing06.lcm");
    EventLogWriter writer(Path(name));
    for (int i = 0; i < num_events; ++i) {
      const auto event = reader.Next();
      if (!event) break;
      writer.Append(event->utime, event->channel, event->payload.data(), event->payload.size());
    }
    return Path(name);
  }
  static std::string Program(const std::string& name) {
    return std::string(AIRDOS_BINARY_DIR) + "/bin/" + name;
  }
  std::unique_ptr<ChildProcess> Start(std::vector<std::string> command) {
    command[0] = Program(command[0]);
    return std::make_unique<ChildProcess>(command, Path("said_" + std::to_string(num_started_++)));
  }
  /// It ends by itself, with exit code 2 and one line that has the text.
  void ExpectRefused(const std::vector<std::string>& command, const std::string& text) {
    std::string line;
    for (const std::string& word : command) line += word + " ";
    const auto process = Start(command);
    EXPECT_EQ(process->Wait(kDeadline_s).value_or(-1000), 2) << line << process->Errors();
    const std::string errors = process->Errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << line << errors;
    EXPECT_EQ(errors.rfind(command[0] + ": ", 0), 0u) << line << errors;
    EXPECT_NE(errors.find(text), std::string::npos) << line << errors;
  }
  std::vector<std::string> Names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (name.rfind("said_", 0) != 0) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  fs::path folder_;
  int num_started_ = 0;
};

TEST_F(UserCases, CaseC01NoProgramWritesOverItsInput) {
  const std::string log = WriteLog("in.lcm", 40);
  const std::string tum = Write("est.tum", "1 0 0 0 0 0 0 1\n2 1 0 0 0 0 0 1\n3 1 1 0 0 0 0 1\n");
  fs::copy(tum, Path("gt.tum"));
  const std::string runs = Write("runs.jsonl", "{}\n");
  const std::string config = Path("frontend.yaml");
  fs::copy(std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/config/frontend.yaml", config);
  {
    MapFileWriter writer(Path("map.airdos"));
    writer.Append(HeadChunk(1, "test"));
  }
  const std::string map = Path("map.airdos");
  fs::create_hard_link(log, Path("again.lcm"));
  fs::create_directories(Path("run"));
  fs::create_symlink(log, Path("run/in.lcm"));
  const std::vector<std::vector<std::string>> commands = {
      {"airdos-replay", log, "--out", log},
      {"airdos-replay", log, "--out", Path("again.lcm")},
      {"airdos-replay", log, "--timing", log},
      {"airdos-replay", "--log", log, "--run-dir", Path("run"), "--out", Path("run/in.lcm")},
      {"airdos-check", log, "--json", log},
      {"airdos-stereo-player", "--data", log, "--write-log", log},
      {"airdos-stereo-player", "--log", log, "--write-log", Path("again.lcm")},
      {"airdos-frontend", "--lcm-url", "memq://", "--config", config, "--resolved-config", config},
      {"airdos-map", "plot", map, "--out", map},
      {"airdos-evaluate", "curve", "--runs", runs, "--json", runs},
      {"airdos-evaluate", "speed", "--runs", runs, "--plot", runs},
      {"airdos-evaluate", "trajectory", "--estimate", tum, "--ground-truth", Path("gt.tum"),
       "--json", tum},
      {"airdos-evaluate", "trajectory", "--estimate", tum, "--ground-truth", Path("gt.tum"),
       "--plot", Path("gt.tum")},
      {"airdos-evaluate", "people", "--people", runs, "--joints", runs, "--estimate", tum,
       "--ground-truth", Path("gt.tum"), "--json", runs},
      {"airdos-evaluate", "detections", "--log", log, "--data", Path("run"), "--json", log},
  };
  const std::vector<std::string> before = Names();
  const std::string files[] = {log, tum, Path("gt.tum"), runs, config, map};
  std::vector<std::string> contents;
  for (const std::string& file : files) contents.push_back(TextOf(file));
  for (std::vector<std::string> command : commands) {
    ExpectRefused(command, "is an input");
    command.push_back("--force");
    ExpectRefused(command, "is an input");
  }
  for (std::size_t i = 0; i < contents.size(); ++i) EXPECT_EQ(TextOf(files[i]), contents[i]);
  EXPECT_EQ(Names(), before);
}

TEST_F(UserCases, CaseC01NoProgramReplacesAFileOfSomebodyElse) {
  const std::string log = WriteLog("in.lcm", 40);
  const std::string mine = Write("thesis.txt", "mine");
  const std::vector<std::vector<std::string>> commands = {
      {"airdos-replay", log, "--out", mine},
      {"airdos-replay", log, "--timing", mine},
      {"airdos-check", log, "--json", mine},
      {"airdos-stereo-player", log, "--write-log", mine},
      {"airdos-simulate", "--out", mine},
      {"airdos-record", "--out", mine, "--lcm-url", "memq://"},
      {"airdos-doctor", "--json", mine},
      {"airdos-frontend", "--lcm-url", "memq://", "--resolved-config", mine},
      {"airdos-evaluate", "ablation", "--json", mine},
  };
  for (const std::vector<std::string>& command : commands) ExpectRefused(command, "--force");
  EXPECT_EQ(TextOf(mine), "mine");
}

TEST_F(UserCases, CaseC06InputsOfAnotherKind) {
  ASSERT_EQ(mkfifo(Path("pipe").c_str(), 0600), 0);
  fs::create_directories(Path("folder"));
  const std::string tum = Write("gt.tum", "1 0 0 0 0 0 0 1\n");
  Write("empty", "");
  for (const std::string& input :
       {Path("pipe"), Path("folder"), std::string("/dev/zero"), Path("none"), Path("empty")}) {
    ExpectRefused({"airdos-map", "info", input}, input);
    ExpectRefused({"airdos-map", "export", input, "--out", Path("out")}, input);
    ExpectRefused({"airdos-map", "plot", input, "--out", Path("out.png")}, input);
    ExpectRefused({"airdos-evaluate", "trajectory", "--estimate", input, "--ground-truth", tum},
                  input);
    ExpectRefused({"airdos-evaluate", "trajectory", "--estimate", tum, "--ground-truth", input},
                  input);
    ExpectRefused({"airdos-evaluate", "curve", "--runs", input}, input);
    ExpectRefused({"airdos-evaluate", "detections", "--log", input, "--data", Path("folder")},
                  input);
    ExpectRefused({"airdos-calibration", "show", input}, input);
    ExpectRefused({"airdos-calibration", "convert", input, "--to", "ros", "--out", Path("out")},
                  input);
    ExpectRefused({"airdos-evaluate", "people", "--people", tum, "--joints", input, "--estimate",
                   tum, "--ground-truth", tum},
                  "");
    ExpectRefused({"airdos-frontend", "--lcm-url", "memq://", "--config", input}, "");
    EXPECT_FALSE(fs::exists(Path("out")));
  }
}

TEST_F(UserCases, CaseC07WhatCannotBeWrittenIsOneLineAndReplayLeavesNothingBehind) {
  const std::string log = WriteLog("in.lcm", 40);
  const std::vector<std::string> before = Names();
  for (const char* option : {"--out", "--timing"}) {
    ExpectRefused({"airdos-replay", log, option, Path("none/x")}, "there is no folder");
    ExpectRefused({"airdos-replay", log, option, folder_.string()}, "is a folder");
  }
  ExpectRefused({"airdos-replay", log, "--run-dir", log}, "in.lcm");
  const auto replay = Start({"airdos-replay", log, "--no-progress"});
  EXPECT_EQ(replay->Wait(kDeadline_s).value_or(-1000), 0) << replay->Errors();
  EXPECT_EQ(Names(), before);
  EXPECT_FALSE(fs::exists("airdos_map"));
}

// As a user without rights there: the superuser may write everywhere.
TEST_F(UserCases, CaseC07ReadOnlyFoldersAndUnreadableInputs) {
  const std::string log = WriteLog("in.lcm", 40);
  const std::string secret = WriteLog("secret.lcm", 40);
  fs::create_directories(Path("read_only"));
  chmod(secret.c_str(), 0);
  chmod(Path("read_only").c_str(), 0555);
  std::vector<std::string> launcher;
  if (geteuid() == 0) {
    launcher = {"setpriv", "--reuid=65534", "--regid=65534", "--clear-groups", "--"};
    std::vector<std::string> probe = launcher;
    probe.insert(probe.end(), {Program("airdos-replay"), "--version"});
    ChildProcess process(probe, Path("said"));
    if (process.Wait(kDeadline_s).value_or(-1) != 0) {
      GTEST_SKIP() << "another user cannot run the programs here: " << process.Errors();
    }
  }
  const std::string place = Path("read_only");
  const std::vector<std::vector<std::string>> commands = {
      {"airdos-replay", log, "--run-dir", place},
      {"airdos-replay", log, "--run-dir", place + "/new"},
      {"airdos-replay", log, "--out", place + "/out.lcm"},
      {"airdos-replay", secret},
      {"airdos-check", secret},
      {"airdos-check", log, "--json", place + "/findings.json"},
      {"airdos-stereo-player", log, "--write-log", place + "/out.lcm"},
      {"airdos-simulate", "--out", place + "/out.lcm"},
      {"airdos-map-recorder", "--lcm-url", "memq://", "--run-dir", place},
  };
  for (const std::vector<std::string>& words : commands) {
    std::vector<std::string> command = launcher;
    command.push_back(Program(words[0]));
    command.insert(command.end(), words.begin() + 1, words.end());
    ChildProcess process(command, Path("said"));
    EXPECT_EQ(process.Wait(kDeadline_s).value_or(-1), 2) << words[0] << process.Errors();
    const std::string errors = process.Errors();
    EXPECT_EQ(std::count(errors.begin(), errors.end(), '\n'), 1) << errors;
    EXPECT_NE(errors.find("Permission denied"), std::string::npos) << errors;
    EXPECT_NE(errors.find(words[1] == secret ? secret : place), std::string::npos) << errors;
  }
  EXPECT_TRUE(fs::is_empty(place));
}

TEST_F(UserCases, CaseC09OfTwoReplaysIntoOneFolderTheSecondIsRefused) {
  const std::string log = WriteLog("in.lcm", 400);
  const std::string run = Path("run");
  const auto first = Start({"airdos-replay", log, "--run-dir", run, "--no-progress"});
  const auto has_begun = [&] { return fs::exists(run + "/optimizer.yaml") || first->HasEnded(); };
  ASSERT_TRUE(WaitUntil(has_begun, kDeadline_s));
  first->Signal(SIGSTOP);
  ExpectRefused({"airdos-replay", log, "--run-dir", run, "--people", "off", "--out", run + "/o"},
                "another run is writing here (process " + std::to_string(first->pid()) + ")");
  EXPECT_FALSE(fs::exists(run + "/o"));
  first->Signal(SIGCONT);
  EXPECT_EQ(first->Wait(kDeadline_s).value_or(-1000), 0) << first->Errors();
  MapFileSummary summary;
  const FourDMap map = ReadFourDMap(run + "/map.airdos", &summary);
  EXPECT_TRUE(map.is_closed);
  EXPECT_GT(map.frames.size(), 3u);
  const std::string trajectory = TextOf(run + "/trajectory.tum");
  EXPECT_EQ(static_cast<std::size_t>(std::count(trajectory.begin(), trajectory.end(), '\n')),
            map.frames.size());
}

// A kill -9 loses the lock, not the map: the next run keeps it.
TEST_F(UserCases, CaseC11AReplayThatWasKilledDoesNotBlockTheFolder) {
  const std::string log = WriteLog("in.lcm", 200);
  const std::string run = Path("run");
  const auto killed =
      Start({"airdos-replay", log, "--run-dir", run, "--no-progress", "--loop", "1000"});
  constexpr std::uintmax_t kOneChunk_bytes = 1000;
  const auto has_chunk = [&run] {
    std::error_code error;
    const std::uintmax_t size = fs::file_size(run + "/map.airdos", error);
    return !error && size > kOneChunk_bytes;
  };
  ASSERT_TRUE(WaitUntil([&] { return has_chunk() || killed->HasEnded(); }, kDeadline_s));
  killed->Signal(SIGKILL);
  EXPECT_EQ(killed->Wait(kDeadline_s).value_or(-1000), -SIGKILL);
  const auto next = Start({"airdos-replay", log, "--run-dir", run, "--no-progress"});
  EXPECT_EQ(next->Wait(kDeadline_s).value_or(-1000), 0) << next->Errors();
  EXPECT_TRUE(fs::exists(run + "/map.airdos.unfinished_1"));
  EXPECT_TRUE(fs::exists(run + "/trajectory.tum"));
}

TEST_F(UserCases, AStandardOutputThatCannotBeWrittenIsAnError) {
  const std::string log = WriteLog("in.lcm", 40);
  const std::vector<std::string> commands = {
      Program("airdos-replay") + " --digest --no-progress " + log,
      Program("airdos-check") + " --odometry-frames 0 " + log,
      Program("airdos-map") + " --help",
      Program("airdos-evaluate") + " --version",
  };
  for (const std::string& command : commands) {
    for (const char* redirection : {" > /dev/full", " >&-"}) {
      ChildProcess process({"/bin/sh", "-c", "exec " + command + redirection}, Path("said"));
      EXPECT_EQ(process.Wait(kDeadline_s).value_or(-1000), 1) << command << redirection;
      const std::string errors = process.Errors();
      EXPECT_NE(errors.find(": standard output cannot be written"), std::string::npos) << errors;
    }
  }
}

// A closed standard output must not be what the log is written to.
TEST_F(UserCases, AClosedStandardOutputSpoilsNoFile) {
  const std::string log = WriteLog("in.lcm", 40);
  const std::string replay = "exec " + Program("airdos-replay") + " --no-progress " + log;
  ChildProcess open({"/bin/sh", "-c", replay + " --out " + Path("open.lcm")}, Path("said"));
  EXPECT_EQ(open.Wait(kDeadline_s).value_or(-1000), 0) << open.Errors();
  ChildProcess closed({"/bin/sh", "-c", replay + " --out " + Path("closed.lcm") + " >&-"},
                      Path("said_closed"));
  EXPECT_EQ(closed.Wait(kDeadline_s).value_or(-1000), 1);
  EXPECT_EQ(TextOf(Path("open.lcm")), TextOf(Path("closed.lcm")));
}

}  // namespace
}  // namespace airdos
