// The processes under a service manager: READY and STOPPING, and what the journal gets.
#include <gtest/gtest.h>
#include <signal.h>
#include <sys/stat.h>

#include <cstdio>
#include <memory>
#include <opencv2/core.hpp>
#include <opencv2/videoio.hpp>
#include <regex>
#include <string>
#include <vector>

#include "tests/support/child_process.h"
#include "tests/support/notify_socket.h"
#include "tests/support/private_network.h"
#include "tests/support/scratch_folder.h"

namespace airdos {
namespace {

constexpr int kDeadline_s = 60;  // a busy machine

const std::vector<std::string> kPrograms{
    "airdos-frontend",      "airdos-human-tracker", "airdos-optimizer", "airdos-map-recorder",
    "airdos-stereo-camera", "airdos-stereo-player", "airdos-record"};

class ServiceProcessTest : public testing::TestWithParam<std::string> {
 protected:
  void SetUp() override {
    const std::string reason = EnterPrivateNetwork(true);
    if (!reason.empty()) GTEST_SKIP() << reason;
  }

  std::string stem() const { return folder_.PathOf("process"); }
  std::string socket() const { return folder_.PathOf("notify"); }
  /// As the service manager starts it.
  std::unique_ptr<ChildProcess> Start(const std::vector<std::string>& options) {
    const std::string err = folder_.Write("process.err");
    std::remove((stem() + ".out").c_str());  // it must not be asked while it holds another's READY
    struct stat file = {};
    stat(err.c_str(), &file);
    std::vector<std::string> command{
        "env", "NOTIFY_SOCKET=" + socket(),
        "JOURNAL_STREAM=" + std::to_string(file.st_dev) + ":" + std::to_string(file.st_ino),
        std::string(AIRDOS_BINARY_DIR) + "/bin/" + GetParam()};
    if (GetParam() == "airdos-map-recorder") {
      command.insert(command.end(), {"--run-dir", folder_.PathOf("run")});
    } else if (GetParam() == "airdos-record") {
      command.insert(command.end(), {"--out", folder_.PathOf("record.lcm")});
    } else if (GetParam() == "airdos-stereo-camera") {
      command.insert(command.end(),
                     {"--video", WriteVideo(), "--side-by-side", "--rate", "0.1", "--calibration",
                      folder_.Write("calib.json", R"({"fx": 100, "fy": 100,
                                         "cx": 32, "cy": 24, "baseline_m": 0.25})")});
    } else if (GetParam() == "airdos-stereo-player") {  // nobody is READY, so it waits
      command.insert(
          command.end(),
          {"--data", std::string(AIRDOS_SOURCE_DIR) + "/logs/road_crossing06.lcm", "--no-check"});
    }
    command.insert(command.end(), options.begin(), options.end());
    return std::make_unique<ChildProcess>(command, stem());
  }

  /// A stereo camera's, of 200 s at 0.1 images a second.
  std::string WriteVideo() const {
    const std::string path = folder_.PathOf("both.avi");
    cv::VideoWriter writer(path, cv::CAP_FFMPEG, cv::VideoWriter::fourcc('M', 'J', 'P', 'G'), 10,
                           {128, 48}, true);
    for (int i = 0; i < 20; ++i) writer.write(cv::Mat(48, 128, CV_8UC3, cv::Scalar::all(90)));
    return path;
  }

  ScratchFolder folder_{"service_process"};
};

TEST_P(ServiceProcessTest, SaysWhenItIsReadyAndWhenItStops) {
  const NotifySocket manager(socket());
  const auto process = Start({});
  const std::string first = manager.Next(kDeadline_s);
  ASSERT_EQ(first.find("READY=1\nSTATUS="), 0u) << first << process->Errors();
  EXPECT_NE(first.find("\nWATCHDOG=1"), std::string::npos) << first;
  EXPECT_TRUE(process->HasSaid(GetParam() + " READY version ")) << process->Output();
  const std::string second = manager.Next(kDeadline_s);  // a sign of life
  EXPECT_EQ(second.find("STATUS="), 0u) << second;
  EXPECT_NE(second.find("\nWATCHDOG=1"), std::string::npos) << second;
  process->Signal(SIGTERM);
  EXPECT_EQ(process->Wait(kDeadline_s), 0) << process->Errors();
  std::string last;
  for (std::string next = manager.NextNow(); !next.empty(); next = manager.NextNow()) last = next;
  EXPECT_EQ(last.find("STOPPING=1\nSTATUS="), 0u) << last;
}

// Each line that it says has a priority, and none a time; --log-level holds.
TEST_P(ServiceProcessTest, TheJournalGetsPriorities) {
  for (const std::string level : {"info", "warning"}) {
    const auto process = Start({"--log-level", level});
    // A manager that is not there is warned of before READY.
    ASSERT_TRUE(WaitUntil([&] { return process->HasSaid(" READY "); }, kDeadline_s))
        << process->Errors();
    process->Signal(SIGTERM);
    EXPECT_EQ(process->Wait(kDeadline_s), 0);
    const std::string errors = process->Errors();
    const std::string lines = level == "info" ? "(<[46]>.*\n)+" : "(<4>.*\n)+";
    EXPECT_TRUE(std::regex_match(errors, std::regex(lines))) << level << ": " << errors;
    EXPECT_EQ(errors.find("<4>the service manager cannot be told"), 0u) << errors;
    // The one that has only the end of its recording to tell does so on stdout.
    const bool has_last_word = level == "info" && GetParam() != "airdos-record";
    EXPECT_EQ(errors.find("<6>") != std::string::npos, has_last_word) << errors;
    if (GetParam() == "airdos-record") std::remove(folder_.PathOf("record.lcm").c_str());
  }
}

TEST_P(ServiceProcessTest, TheJournalGetsWrongUseAsAnError) {
  const auto process = Start({"--log-level", "warn"});
  EXPECT_EQ(process->Wait(kDeadline_s), 2);
  const std::string errors = process->Errors();
  EXPECT_EQ(errors.find("<3>" + GetParam() + ": "), 0u) << errors;
  EXPECT_NE(errors.find("'warn' is none of error, warning"), std::string::npos) << errors;
  EXPECT_EQ(errors.find('\n'), errors.size() - 1) << errors;
}

INSTANTIATE_TEST_SUITE_P(EachProcess, ServiceProcessTest, testing::ValuesIn(kPrograms),
                         [](const testing::TestParamInfo<std::string>& program) {
                           return std::regex_replace(program.param, std::regex("-"), "_");
                         });

}  // namespace
}  // namespace airdos
