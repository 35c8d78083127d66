// Each process' table of options, against the structs that it binds, the file in
// launch_scripts/config and what users may write: all that can be told of an option without running
// anything.
#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "common/config/option_pages.h"
#include "common/util/error.h"
#include "processes/frontend/frontend_options.h"
#include "processes/human_tracker/human_tracker_options.h"
#include "processes/map_recorder/map_recorder_options.h"
#include "processes/optimizer/optimizer_options.h"
#include "processes/person_detector/person_detector_options.h"
#include "processes/stereo_camera/camera_options.h"
#include "processes/stereo_player/player_options.h"

namespace airdos {
namespace {

/// A table of options that live as long.
struct Process {
  std::shared_ptr<void> options;
  OptionTable table;
};

template <class Options>
Process Make() {
  auto options = std::make_shared<Options>();
  OptionTable table = TableOf(options.get());
  return {options, table};
}

const std::vector<std::function<Process()>>& Makers() {
  static const std::vector<std::function<Process()>> makers{
      Make<FrontendOptions>,    Make<HumanTrackerOptions>,   Make<OptimizerOptions>,
      Make<MapRecorderOptions>, Make<PersonDetectorOptions>, Make<PlayerOptions>,
      Make<CameraOptions>};
  return makers;
}

std::string TextOf(const std::string& path) {
  std::ifstream file(AIRDOS_SOURCE_DIR "/" + path);
  EXPECT_TRUE(file) << path;
  return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

std::string PathOf(const OptionTable& table) {
  return "launch_scripts/config/" + table.name() + ".yaml";
}

ConfigReader FileOf(const OptionTable& table) {
  return ConfigReader::FromFile(AIRDOS_SOURCE_DIR "/" + PathOf(table), table.renamed());
}

std::string MessageOf(const std::function<void()>& call) {
  try {
    call();
  } catch (const InputError& error) {
    return error.what();
  }
  return "no error";
}

std::string NumberText(double number) {
  std::ostringstream text;
  text.precision(17);
  text << number;
  return text.str();
}

/// Another value than the one now, allowed, and near to it.
std::string OtherValue(const Option& option) {
  const std::string now = option.value();
  if (option.kind == Option::Kind::kSwitch) return now == "true" ? "false" : "true";
  if (option.kind == Option::Kind::kChoice)
    return option.words.front() == now ? option.words.back() : option.words.front();
  if (option.kind == Option::Kind::kText || option.kind == Option::Kind::kWords) return "other";
  if (option.kind == Option::Kind::kWholes) return NumberText(option.range->max);
  const double number = std::stod(now);
  double step = option.kind == Option::Kind::kWhole ? 1 : std::max(number / 16, 1.0 / 1024);
  if (number + step > option.range->max) step = -step;
  return NumberText(number + step);
}

/// The option read alone.
std::string MessageOfReading(const Process& process, const Option& option,
                             const std::string& value) {
  ConfigReader config = FileOf(process.table);
  config.Override(option.key + "=" + value);
  return MessageOf([&] { option.read(&config); });
}

TEST(OptionsWiringTest, TheFileIsWhatItsTableWrites) {
  for (const auto& make : Makers()) {
    const Process process = make();
    EXPECT_EQ(TextOf(PathOf(process.table)), ConfigFileText(process.table))
        << "after a change of the table: airdos-<process> --print-config > "
        << PathOf(process.table);
  }
}

TEST(OptionsWiringTest, EachKeySetsItsOwnMembersAndNoOther) {
  for (const auto& make : Makers()) {
    const Process before = make();
    for (std::size_t i = 0; i < before.table.options().size(); ++i) {
      const Option& option = before.table.options()[i];
      SCOPED_TRACE(option.key);
      const Process after = make();
      ConfigReader config = FileOf(before.table);
      const std::string other = OtherValue(option);
      config.Override(option.key + "=" + other);
      after.table.Read(&config);
      EXPECT_NO_THROW(config.Finish());
      for (std::size_t k = 0; k < before.table.options().size(); ++k) {
        const std::string value = after.table.options()[k].value();
        if (k != i) {
          EXPECT_EQ(value, before.table.options()[k].value()) << before.table.options()[k].key;
        } else if (option.kind == Option::Kind::kNumber) {
          EXPECT_EQ(std::stod(value), std::stod(other));
        } else {
          EXPECT_EQ(value, other);
        }
      }
    }
  }
}

TEST(OptionsWiringTest, EachKeyStandsOnceAndSoDoesEachMember) {
  for (const auto& make : Makers()) {
    std::set<std::string> keys;
    std::set<const void*> members;
    const Process process = make();
    for (const Option& option : process.table.options()) {
      EXPECT_TRUE(keys.insert(option.key).second) << option.key;
      for (const void* member : option.members)
        EXPECT_TRUE(members.insert(member).second) << option.key << ": has another one's member";
      for (const std::string& help : option.help) EXPECT_NE(help, "") << option.key;
    }
  }
}

TEST(OptionsWiringTest, TheBoundsAreAllowedAndWhatIsBeyondIsRefused) {
  for (const auto& make : Makers()) {
    const Process process = make();
    for (const Option& option : process.table.options()) {
      SCOPED_TRACE(option.key);
      std::vector<std::string> good, bad;
      if (option.range) {
        const auto [min, max] = *option.range;
        good = {NumberText(min), NumberText(max)};
        const bool is_whole = option.kind != Option::Kind::kNumber;
        const double below = is_whole ? min - 1 : min > 0 ? min * 0.999 : -1e-3;
        bad = {NumberText(below), NumberText(is_whole ? max + 1 : max * 1.001), "nan", "many"};
        if (is_whole) bad.push_back(NumberText(min + 0.5));
      } else if (option.kind == Option::Kind::kChoice) {
        good = option.words;
        bad = {option.words.front() + "x", "0"};
      } else if (option.kind == Option::Kind::kSwitch) {
        good = {"true", "false"};
        bad = {"2", "yes"};
      }
      for (const std::string& value : good)
        EXPECT_EQ(MessageOfReading(process, option, value), "no error");
      for (const std::string& value : bad) {
        const std::string message = MessageOfReading(process, option, value);
        EXPECT_NE(message.find("key '" + option.key + "' with value '" + value + "': must "),
                  std::string::npos)
            << message;
      }
    }
  }
}

TEST(OptionsWiringTest, AKeyOfAnEarlierVersionIsAnsweredWithTheNewOne) {
  std::size_t num_renamed = 0;
  for (const auto& make : Makers()) {
    const Process process = make();
    std::set<std::string> keys;
    for (const Option& option : process.table.options()) keys.insert(option.key);
    for (const auto& [old, now] : process.table.renamed()) {
      EXPECT_EQ(keys.count(old), 0u) << old;
      EXPECT_EQ(keys.count(now), 1u) << now;
      const std::string expected = "key '" + old + "' is called '" + now + "' now";
      ConfigReader config = FileOf(process.table);
      EXPECT_EQ(MessageOf([&, key = old] { config.Override(key + "=1"); }),
                AIRDOS_SOURCE_DIR "/" + PathOf(process.table) + ": " + expected);
      const std::string text = ConfigFileText(process.table) + old + ": 1\n";
      EXPECT_EQ(MessageOf([&] { ConfigReader::FromString(text, "old", process.table.renamed()); }),
                "old: " + expected);
      ++num_renamed;
    }
  }
  EXPECT_EQ(num_renamed, 21u);
}

std::set<std::string> WordsOf(const std::string& text) {
  std::set<std::string> words;
  std::string word;
  for (const char letter : text + "_") {
    if (letter != '_' && letter != '.') {
      word += letter;
    } else if (!word.empty()) {
      words.insert(word);
      word.clear();
    }
  }
  return words;
}

/// Key and member of every line that adds an option, as the source says them. A key without its
/// section is one of both networks of the person detector.
std::vector<std::pair<std::string, std::string>> LinesOf(const std::string& path) {
  const std::string text = TextOf(path);
  const std::regex line(
      R"re(Add(?:Shared|Choice<\w+>)?\(\s*(?:key\()?"(\w+\.?\w+)"\)?,\s*(?:noise\(|\{)?&([\w:.>-]+))re");
  std::vector<std::pair<std::string, std::string>> lines;
  for (std::sregex_iterator it(text.begin(), text.end(), line), end; it != end; ++it) {
    const std::string member = (*it)[2];
    lines.emplace_back((*it)[1], member.substr(member.find_last_of(".>:") + 1));
  }
  return lines;
}

// What two members of one default would leave unseen if they were exchanged: every word of a
// member's name is in its key.
TEST(OptionsWiringTest, KeysSayTheirMembersNames) {
  const std::map<std::string, std::string> others = {
      {"masks.dilation_px", "mask_dilation_px"},
      {"people.max_static", "max_static_for_people"},
      {"tracking.min_seen", "min_seen_to_report"},
      {"joints.refine", "is_refined"},
      {"joints.min_score", "min_joint_score"},
      {"joints.min_number", "min_joints"},
      {"people.rigidity", "use_rigidity"},
      {"people.motion", "use_motion"},
      {"people.huber_sigmas", "huber_dynamic_sigmas"}};
  const std::string paths[] = {"frontend/frontend_options.cc",
                               "human_tracker/human_tracker_options.cc",
                               "optimizer/optimizer_options.cc",
                               "map_recorder/map_recorder_options.cc",
                               "person_detector/person_detector_options.cc",
                               "stereo_player/player_options.cc",
                               "stereo_camera/camera_options.cc"};
  for (std::size_t i = 0; i < Makers().size(); ++i) {
    const auto lines = LinesOf("processes/" + paths[i]);
    const auto num_twice = std::count_if(lines.begin(), lines.end(), [](const auto& key_member) {
      return key_member.first.find('.') == std::string::npos;
    });
    EXPECT_EQ(lines.size() + static_cast<std::size_t>(num_twice),
              Makers()[i]().table.options().size())
        << paths[i];
    for (const auto& [key, member] : lines) {
      const auto other = others.find(key);
      if (other != others.end()) {
        EXPECT_EQ(member, other->second) << key;
        continue;
      }
      const std::set<std::string> in_key = WordsOf(key), in_member = WordsOf(member);
      EXPECT_TRUE(std::includes(in_key.begin(), in_key.end(), in_member.begin(), in_member.end()))
          << key << " sets " << member;
    }
  }
}

TEST(OptionsWiringTest, TheOptimizerLooksAtPeopleOnlyWhereTheyAreOn) {
  const std::pair<const char*, PeopleMode> modes[] = {
      {"off", PeopleMode::kOff}, {"mask_only", PeopleMode::kMaskOnly}, {"on", PeopleMode::kOn}};
  const Process optimizer = Make<OptimizerOptions>();
  for (const auto& [text, mode] : modes) {
    ConfigReader config = FileOf(optimizer.table);
    config.Override(std::string("people.mode=") + text);
    const OptimizerOptions options = ReadOptimizerOptions(&config);
    EXPECT_EQ(options.people, mode);
    EXPECT_EQ(options.window.bundle.use_people, mode == PeopleMode::kOn);
  }
  const std::pair<const char*, MotionForm> forms[] = {
      {"velocity", MotionForm::kVelocity},
      {"velocity_track", MotionForm::kVelocityTrack},
      {"se3_parts", MotionForm::kSe3Parts}};
  for (const auto& [text, form] : forms) {
    ConfigReader config = FileOf(optimizer.table);
    config.Override(std::string("people.motion_form=") + text);
    EXPECT_EQ(ReadOptimizerOptions(&config).window.bundle.motion_form, form);
  }
}

TEST(OptionsWiringTest, OneValueForAllStepsThatNeedIt) {
  const Process tracker = Make<HumanTrackerOptions>();
  ConfigReader config = FileOf(tracker.table);
  for (const char* text : {"keypoints.min_confidence=0.125", "keypoints.sigma_min_px=0.875",
                           "range.min_depth_m=0.625", "range.max_depth_m=41"})
    config.Override(text);
  const HumanTrackerOptions options = ReadHumanTrackerOptions(&config);
  EXPECT_EQ(options.matcher.min_confidence, 0.125);
  EXPECT_EQ(options.triangulator.min_confidence, 0.125);
  EXPECT_EQ(options.track.min_confidence, 0.125);
  EXPECT_EQ(options.matcher.noise.min_px, 0.875);
  EXPECT_EQ(options.triangulator.noise.min_px, 0.875);
  EXPECT_EQ(options.track.noise.min_px, 0.875);
  EXPECT_EQ(options.matcher.min_depth_m, 0.625);
  EXPECT_EQ(options.triangulator.min_depth_m, 0.625);
  EXPECT_EQ(options.matcher.max_depth_m, 41);
  EXPECT_EQ(options.triangulator.max_depth_m, 41);
}

}  // namespace
}  // namespace airdos
