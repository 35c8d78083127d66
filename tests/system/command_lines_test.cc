#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/child_process.h"

// Every program's command line: one vocabulary, --help that can be read, --version, and an answer
// to a mistyped option.

namespace airdos {
namespace {

namespace fs = std::filesystem;

struct Answer {
  int exit_code = -1;
  std::string output;
  std::string errors;
};

class CommandLineTest : public testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() / ("airdos_command_lines_" + std::to_string(getpid()));
    fs::create_directories(folder_);
  }
  void TearDown() override { fs::remove_all(folder_); }

  static std::vector<std::string> Programs() {
    const std::set<std::string> only_for_tests = {"airdos-echo", "airdos-lossy-link",
                                                  "airdos-message-judge"};
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(fs::path(AIRDOS_BINARY_DIR) / "bin")) {
      const std::string name = entry.path().filename().string();
      if (name.rfind("airdos-", 0) == 0 && only_for_tests.count(name) == 0) names.push_back(name);
    }
    std::sort(names.begin(), names.end());
    return names;
  }
  /// With the program alone, and with each of its commands before the arguments.
  static std::vector<std::vector<std::string>> CommandsOf(const std::string& program) {
    if (program == "airdos-map") return {{}, {"info"}, {"export"}, {"plot"}};
    if (program == "airdos-calibration") return {{}, {"show"}, {"convert"}, {"check"}};
    if (program == "airdos-evaluate")
      return {{}, {"trajectory"}, {"people"}, {"detections"}, {"curve"}, {"speed"}, {"ablation"}};
    return {{}};
  }
  Answer Run(const std::string& program, std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), std::string(AIRDOS_BINARY_DIR) + "/bin/" + program);
    ChildProcess process(arguments, (folder_ / "said").string());
    constexpr double kDeadline_s = 60;
    const int code = process.Wait(kDeadline_s).value_or(-1000);
    return {code, process.Output(), process.Errors()};
  }
  fs::path folder_;
};

/// An option in --help: its names, what is shown behind them, and its text.
struct HelpEntry {
  std::string name;
  std::string kind;
  std::string text;
};

std::vector<HelpEntry> EntriesOf(const std::string& help) {
  static const std::regex start("^  (?:-\\w,)?(--[a-z-]+|INPUT)([^ ]*)(?: ([A-Z]+))?(.*)$");
  std::vector<HelpEntry> entries;
  std::istringstream lines(help);
  for (std::string line; std::getline(lines, line);) {
    std::smatch match;
    if (std::regex_match(line, match, start)) {
      entries.push_back({match[1], match[3], match[4]});
    } else if (!entries.empty() && line.rfind("          ", 0) == 0) {
      entries.back().text += line;
    }
  }
  return entries;
}

// Files and folders have the same names everywhere.
const std::set<std::string> kVocabulary = {
    "--calibration", "INPUT", "--data", "--log", "--out", "--run-dir", "--config", "--json",
    "--plot", "--timing", "--resolved-config", "--write-log",
    // What is compared with what.
    "--estimate", "--ground-truth", "--times", "--people", "--joints", "--runs", "--solver",
    "--keypoints-left", "--keypoints-right"};

TEST_F(CommandLineTest, EachHelpTextCanBeRead) {
  ASSERT_GE(Programs().size(), 14u);
  for (const std::string& program : Programs()) {
    for (std::vector<std::string> arguments : CommandsOf(program)) {
      const std::string title = program + (arguments.empty() ? "" : " " + arguments[0]);
      const bool is_command = !arguments.empty();
      arguments.push_back("--help");
      const Answer answer = Run(program, arguments);
      EXPECT_EQ(answer.exit_code, 0) << title;
      EXPECT_EQ(answer.errors, "") << title;
      std::istringstream lines(answer.output);
      for (std::string line; std::getline(lines, line);) EXPECT_LE(line.size(), 120u) << line;
      if (!is_command) {
        EXPECT_NE(answer.output.find("--version"), std::string::npos) << title;
      }
      const std::vector<HelpEntry> entries = EntriesOf(answer.output);
      const bool is_only_commands = program == "airdos-map" || program == "airdos-calibration";
      EXPECT_GE(entries.size(), is_command || is_only_commands ? 1u : 2u) << title;
      for (const HelpEntry& entry : entries) {
        const std::size_t letter = entry.text.find_first_not_of(" ");
        EXPECT_NE(letter, std::string::npos) << title << ": " << entry.name << " has no text";
        if (entry.kind == "FILE" || entry.kind == "FOLDER") {
          EXPECT_EQ(kVocabulary.count(entry.name), 1u) << title << ": " << entry.name;
        }
      }
    }
  }
}

// Whoever can write a file can be told to replace one.
TEST_F(CommandLineTest, WhoeverWritesFilesKnowsForce) {
  const std::set<std::string> written = {
      "--out", "--json", "--plot", "--timing", "--resolved-config", "--write-log"};
  for (const std::string& program : Programs()) {
    for (std::vector<std::string> arguments : CommandsOf(program)) {
      arguments.push_back("--help");
      const std::vector<HelpEntry> entries = EntriesOf(Run(program, arguments).output);
      const auto has = [&entries](const std::function<bool(const std::string&)>& is) {
        return std::any_of(entries.begin(), entries.end(),
                           [&is](const HelpEntry& entry) { return is(entry.name); });
      };
      if (!has([&](const std::string& name) { return written.count(name) > 0; })) continue;
      EXPECT_TRUE(has([](const std::string& name) { return name == "--force"; }))
          << program << " " << arguments[0];
    }
  }
}

// What one starts an own configuration from is the file that is installed, comments and all.
TEST_F(CommandLineTest, EachProcessPrintsItsConfigurationAndWhatItMeans) {
  const std::map<std::string, std::string> configs = {{"airdos-frontend", "frontend"},
                                                      {"airdos-human-tracker", "human_tracker"},
                                                      {"airdos-map-recorder", "map_recorder"},
                                                      {"airdos-optimizer", "optimizer"},
                                                      {"airdos-person-detector", "person_detector"},
                                                      {"airdos-stereo-camera", "stereo_camera"},
                                                      {"airdos-stereo-player", "stereo_player"}};
  for (const auto& [program, config] : configs) {
    std::ifstream file(AIRDOS_SOURCE_DIR "/launch_scripts/config/" + config + ".yaml");
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    const Answer printed = Run(program, {"--print-config"});
    EXPECT_EQ(printed.exit_code, 0) << program;
    EXPECT_EQ(printed.output, text) << program;
    EXPECT_EQ(printed.errors, "") << program;
    const Answer reference = Run(program, {"--help-config"});
    EXPECT_EQ(reference.exit_code, 0) << program;
    EXPECT_NE(reference.output.find(" to "), std::string::npos) << program;
    const Answer refused = Run(program, {"--print-config", "--set", "a.b=1"});
    EXPECT_EQ(refused.exit_code, 2) << program;
    EXPECT_EQ(refused.output, "") << program;
    EXPECT_EQ(refused.errors, program + ": --print-config excludes --set\n");
  }
}

TEST_F(CommandLineTest, EachProgramSaysItsVersionAndCommit) {
  for (const std::string& program : Programs()) {
    for (std::vector<std::string> arguments : CommandsOf(program)) {
      arguments.push_back("--version");
      const Answer answer = Run(program, arguments);
      EXPECT_EQ(answer.exit_code, 0) << program;
      const std::regex wanted(program + R"( \d+\.\d+\.\d+ \(([0-9a-f]{7,}|unknown)\)\n)");
      EXPECT_TRUE(std::regex_match(answer.output, wanted)) << answer.output;
    }
  }
}

TEST_F(CommandLineTest, AMistypedOptionIsAnsweredInOneLine) {
  for (const std::string& program : Programs()) {
    for (const std::vector<std::string>& command : CommandsOf(program)) {
      for (const std::string option : {"--versoin", "--no-such-thing"}) {
        std::vector<std::string> arguments = command;
        arguments.push_back(option);
        const Answer answer = Run(program, arguments);
        EXPECT_EQ(answer.exit_code, 2) << program;
        EXPECT_EQ(answer.errors, program + ": there is no option '" + option + "'" +
                                     (option == "--versoin" ? "; did you mean '--version'?\n"
                                                            : " (see --help)\n"));
        EXPECT_EQ(answer.output, "");
      }
    }
  }
}

TEST_F(CommandLineTest, MistypedCommandsAndChoicesAreAnswered) {
  EXPECT_EQ(Run("airdos-map", {"exprot", "x"}).errors,
            "airdos-map: there is no command 'exprot'; did you mean 'export'?\n");
  EXPECT_EQ(Run("airdos-evaluate", {"trajectroy"}).errors,
            "airdos-evaluate: there is no command 'trajectroy'; did you mean 'trajectory'?\n");
  EXPECT_EQ(Run("airdos-calibration", {"shwo", "x.yaml"}).errors,
            "airdos-calibration: there is no command 'shwo'; did you mean 'show'?\n");
  EXPECT_EQ(Run("airdos-calibration", {"convert", "x.yaml", "--to", "kalibir"}).errors,
            "airdos-calibration: --to: 'kalibir' is none of kalibr, ros, opencv, euroc, orbslam3, "
            "calib.json; did you mean 'kalibr'?\n");
  EXPECT_EQ(Run("airdos-replay", {"x", "--people", "mask-only"}).errors,
            "airdos-replay: --people: 'mask-only' is none of off, mask_only, on; did you mean "
            "'mask_only'?\n");
  EXPECT_EQ(Run("airdos-replay", {"a", "b"}).errors,
            "airdos-replay: one argument too many: 'b' (see --help)\n");
  EXPECT_EQ(Run("airdos-replay", {"a", "--log", "b"}).errors,
            "airdos-replay: only one input is possible: 'a' or 'b'\n");
  for (const char* program : {"airdos-replay", "airdos-check", "airdos-stereo-player"}) {
    const Answer answer = Run(program, {});
    EXPECT_EQ(answer.exit_code, 2);
    EXPECT_NE(answer.errors.find("INPUT is missing"), std::string::npos) << answer.errors;
  }
  // Who reads no log does not offer to.
  EXPECT_EQ(Run("airdos-import", {"--out", "x"}).errors,
            "airdos-import: INPUT is missing: the folder of a data set (--data), or a recording "
            "(--images, --video)\n");
  EXPECT_EQ(Run("airdos-import", {"--help"}).output.find("LCM log"), std::string::npos);
}

TEST_F(CommandLineTest, SetMayNameTheProcessItIsMeantFor) {
  const Answer other = Run("airdos-frontend", {"--set", "optimizer:people.mode=on"});
  EXPECT_EQ(other.exit_code, 2);
  EXPECT_EQ(other.errors,
            "airdos-frontend: --set 'optimizer:people.mode=on': is meant for optimizer, this is "
            "frontend\n");
  const Answer own = Run("airdos-human-tracker", {"--set", "human-tracker:no.such=1"});
  EXPECT_EQ(own.exit_code, 2);
  EXPECT_NE(own.errors.find("key 'no.such' with value '1'"), std::string::npos) << own.errors;
}

}  // namespace
}  // namespace airdos
