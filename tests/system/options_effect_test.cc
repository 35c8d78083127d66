// Every option of the configuration files changes what its process does, on the first frames of the
// sample log or on frames made worse than these; else it is in the list at the end, with the test
// that covers it.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <map>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <ostream>
#include <set>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "airdos/image_t.hpp"
#include "airdos/person_keypoints_t.hpp"
#include "airdos/person_mask_t.hpp"
#include "common/config/config_reader.h"
#include "common/util/error.h"
#include "processes/frontend/frontend_node.h"
#include "processes/human_tracker/human_tracker_node.h"
#include "processes/node/bus/fifo_bus.h"
#include "processes/node/log/channel_digests.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/optimizer/optimizer_node.h"

namespace airdos {
namespace {

struct Process {
  std::string name;
  std::unique_ptr<Node> (*make)(ConfigReader*);
};
/// In names of tests; else GoogleTest shows the bytes, which differ from run to run.
void PrintTo(const Process& process, std::ostream* out) { *out << process.name; }
const Process kProcesses[] = {{"human_tracker", MakeHumanTrackerNode},
                              {"frontend", MakeFrontendNode},
                              {"optimizer", MakeOptimizerNode}};

using Values = std::map<std::string, std::string>;  // by process:key

std::unique_ptr<Node> MakeNode(const Process& process, const Values& values) {
  ConfigReader config =
      ConfigReader::FromFile(AIRDOS_SOURCE_DIR "/launch_scripts/config/" + process.name + ".yaml");
  for (const auto& [key, value] : values) {
    const std::size_t colon = key.find(':');
    if (key.substr(0, colon) == process.name) config.Override(key.substr(colon + 1) + "=" + value);
  }
  return process.make(&config);
}

template <class Message, class Change>
void Edit(Change change, Envelope* envelope) {
  Message message;
  ASSERT_TRUE(Decode(envelope->payload.data(), envelope->payload.size(), &message));
  change(&message);
  envelope->payload = Encode(message);
}

void Blacken(image_t* image) {
  image->encoding = image_t::ENCODING_RAW_GRAY8;
  image->num_bytes = image->width * image->height;
  image->data.assign(static_cast<std::size_t>(image->num_bytes), 0);
}

void RemoveMask(person_mask_t* mask) {
  mask->encoding = person_mask_t::ENCODING_NONE;
  mask->num_bytes = 0;
  mask->data.clear();
}

void RemovePeople(person_keypoints_t* people) {
  people->num_people = 0;
  people->u_px.clear();
  people->v_px.clear();
  people->confidence.clear();
}

/// Nobody has more than a doubtful right half; every other person is seen by the left image alone.
void DoubtPeople(bool is_right, person_keypoints_t* people) {
  for (std::size_t i = 0; i < people->confidence.size(); ++i) {
    for (std::size_t joint = 2; joint < 5; ++joint) people->confidence[i][joint] *= 0.3F;
    if (is_right && i % 2 == 0) people->confidence[i].assign(people->confidence[i].size(), 0);
  }
}

/// What comes in, and the settings of all processes under which an option is looked at.
struct Scene {
  std::string name;
  int num_frames;
  Values values;
  std::function<void(std::int64_t seq, Envelope*)> edit;
};

std::vector<Scene> Scenes() {
  const auto as_it_is = [](std::int64_t, Envelope*) {};
  const auto without_masks = [](std::int64_t, Envelope* envelope) {
    if (envelope->channel == channel::kPersonMask) Edit<person_mask_t>(RemoveMask, envelope);
  };
  const auto interrupted = [](std::int64_t seq, Envelope* envelope) {
    const bool is_image =
        envelope->channel == channel::kCameraLeft || envelope->channel == channel::kCameraRight;
    const bool is_right = envelope->channel == channel::kPersonKeypointsRight;
    const bool is_people = is_right || envelope->channel == channel::kPersonKeypointsLeft;
    if (is_people && seq >= 4 && seq < 6) Edit<person_keypoints_t>(RemovePeople, envelope);
    if (is_image && seq >= 7 && seq < 9) Edit<image_t>(Blacken, envelope);
    if (is_people && seq >= 10) {
      Edit<person_keypoints_t>(
          [is_right](person_keypoints_t* people) { DoubtPeople(is_right, people); }, envelope);
    }
  };
  const Values starved = {{"frontend:tracking.max_observations", "4"},
                          {"optimizer:trust.max_relative_sigma", "1"}};
  const Values short_memory = {{"frontend:map.min_found_ratio", "0.9"},
                               {"optimizer:window.frames", "3"},
                               {"optimizer:window.key_frame_interval", "2"},
                               {"optimizer:window.key_frame_max_shared", "0"},
                               {"optimizer:window.max_key_frames", "1"},
                               {"optimizer:window.forget_after_frames", "2"},
                               {"optimizer:people.motion_form", "se3_parts"},
                               {"human_tracker:tracking.max_motion_per_height", "0.06"}};
  return {{"as it is", 12, {}, as_it_is},
          {"interrupted", 14, {}, interrupted},
          {"starved", 14, starved, without_masks},
          {"short memory", 20, short_memory, interrupted}};
}

/// All that travels when the chain runs on a scene, in its order.
std::vector<Envelope> Record(const Scene& scene) {
  cv::setNumThreads(1);
  std::vector<std::unique_ptr<Node>> nodes;
  FifoBus bus;
  for (const Process& process : kProcesses) {
    nodes.push_back(MakeNode(process, scene.values));
    bus.AddNode(nodes.back().get());
  }
  std::vector<Envelope> messages;
  bus.AddObserver([&messages](const Envelope& message) { messages.push_back(message); });
  LogSource source(AIRDOS_SOURCE_DIR "/logs/road_crossing06.lcm", 0, scene.num_frames - 1);
  for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
    for (Envelope& message : frame) {
      const auto header = PeekHeader(message.payload.data(), message.payload.size());
      scene.edit(header->seq, &message);
    }
    bus.PublishFrame(std::move(frame));
  }
  return messages;
}

const std::vector<std::vector<Envelope>>& Recordings() {
  static const std::vector<std::vector<Envelope>> recordings = [] {
    std::vector<std::vector<Envelope>> all;
    for (const Scene& scene : Scenes()) all.push_back(Record(scene));
    return all;
  }();
  return recordings;
}

/// Of what the process publishes alone, with the others' messages as they were recorded.
std::string DigestOf(const Process& process, const Values& values,
                     const std::vector<Envelope>& messages) {
  const std::unique_ptr<Node> node = MakeNode(process, values);
  const std::vector<std::string> inputs = node->input_channels();
  ChannelDigests digests;
  for (const Envelope& message : messages) {
    if (std::find(inputs.begin(), inputs.end(), message.channel) == inputs.end()) continue;
    node->Receive(message.channel, message.payload.data(), message.payload.size());
    while (node->Step()) {
    }
    for (const Envelope& output : node->TakeOutput())
      digests.Add(output.channel, output.payload.data(), output.payload.size());
  }
  std::string text;
  for (const auto& [channel, entry] : digests.Result()) text += channel + entry.sha256;
  return text;
}

/// Values to try instead; those that the option does not allow are passed over.
std::vector<std::string> OtherValues(const std::string& value) {
  if (value == "true") return {"false"};
  if (value == "false") return {"true"};
  if (value == "on") return {"off"};
  if (value == "velocity" || value == "se3_parts") return {"velocity_track"};
  if (value == "structured") return {"ceres"};
  const double number = std::stod(value);
  std::vector<std::string> others;
  for (const double factor : {3.0, 1 / 3.0, 30.0, 1 / 30.0}) {
    const bool is_whole = value.find('.') == std::string::npos;
    std::ostringstream text;
    text << (is_whole ? std::round(factor * number) : factor * number);
    if (text.str() != value) others.push_back(text.str());
  }
  if (number == 0) others = {"1"};
  return others;
}

/// The scene and value in which it shows; empty if in none.
std::string WhereItShows(const Process& process, const std::string& key, const std::string& value) {
  static std::map<std::pair<std::string, std::size_t>, std::string> unchanged;
  const std::vector<Scene> scenes = Scenes();
  for (std::size_t i = 0; i < scenes.size(); ++i) {
    const std::string option = process.name + ":" + key;
    const auto set = scenes[i].values.find(option);
    std::string& before = unchanged[{process.name, i}];
    if (before.empty()) before = DigestOf(process, scenes[i].values, Recordings()[i]);
    for (const std::string& other :
         OtherValues(set == scenes[i].values.end() ? value : set->second)) {
      Values values = scenes[i].values;
      values[option] = other;
      try {
        if (DigestOf(process, values, Recordings()[i]) != before)
          return scenes[i].name + ", " + other;
      } catch (const InputError&) {  // not allowed
      }
    }
  }
  return "";
}

/// Options that show in no scene: a test of their own covers them.
struct Covered {
  std::string option;
  std::string file;  ///< below tests/
  std::string test;
};
const Covered kCovered[] = {
    {"optimizer:window.forget_after_frames", "estimator/window_test.cc", "MemoryIsBounded"},
    {"frontend:motion.angular_ceiling_rad_s2", "unit/features/camera_motion_filter_test.cc",
     "TheLearntAccelerationStaysWithinItsBounds"},
    {"map_recorder:output.directory", "node/map_recorder_values_test.cc",
     "EachKeyOfTheConfigurationIsInForce"},
    {"map_recorder:output.chunk_frames", "node/map_recorder_values_test.cc",
     "EachKeyOfTheConfigurationIsInForce"},
    {"map_recorder:output.export_at_end", "node/map_recorder_values_test.cc",
     "EachKeyOfTheConfigurationIsInForce"},
    {"person_detector:network.file", "node/person_detector_node_test.cc",
     "AMissingNetworkIsSaidWithItsKey"},
    {"person_detector:network.input", "unit/perception/network_files_test.cc",
     "TheInputMayBeAnyNode"},
    {"person_detector:network.outputs", "unit/perception/pose_networks_test.cc",
     "MoveNetOutputsAreThoseThatAreNamed"},
    {"person_detector:network.width_px", "unit/perception/network_files_test.cc",
     "TheImageKeepsItsShape"},
    {"person_detector:network.height_px", "unit/perception/network_files_test.cc",
     "TheImageKeepsItsShape"},
    {"person_detector:network.short_side_px", "unit/perception/network_files_test.cc",
     "TheSizeFollowsTheShapeOfTheImage"},
    {"person_detector:network.layout", "unit/perception/pose_networks_test.cc",
     "MoveNetMayHaveItsChannelsAtLast"},
    {"person_detector:network.colours", "unit/perception/pose_networks_test.cc",
     "ColoursMayComeInTheOtherOrder"},
    {"person_detector:network.mean_red", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:network.mean_green", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:network.mean_blue", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:network.scale_red", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:network.scale_green", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:network.scale_blue", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:network.min_score", "unit/perception/pose_networks_test.cc",
     "MoveNetHeedsItsLimits"},
    {"person_detector:network.max_overlap", "unit/perception/pose_networks_test.cc",
     "OfTwoBoxesThatAreOneTheBetterStays"},
    {"person_detector:network.max_people", "unit/perception/pose_networks_test.cc",
     "MoveNetHeedsItsLimits"},
    {"person_detector:boxes.file", "node/person_detector_node_test.cc",
     "AMissingNetworkIsSaidWithItsKey"},
    {"person_detector:boxes.input", "unit/perception/network_files_test.cc",
     "TheInputMayBeAnyNode"},
    {"person_detector:boxes.outputs", "unit/perception/pose_networks_test.cc",
     "MoveNetOutputsAreThoseThatAreNamed"},
    {"person_detector:boxes.width_px", "unit/perception/network_files_test.cc",
     "TheImageKeepsItsShape"},
    {"person_detector:boxes.height_px", "unit/perception/network_files_test.cc",
     "TheImageKeepsItsShape"},
    {"person_detector:boxes.short_side_px", "unit/perception/network_files_test.cc",
     "TheSizeFollowsTheShapeOfTheImage"},
    {"person_detector:boxes.layout", "unit/perception/pose_networks_test.cc",
     "MoveNetMayHaveItsChannelsAtLast"},
    {"person_detector:boxes.colours", "unit/perception/pose_networks_test.cc",
     "ColoursMayComeInTheOtherOrder"},
    {"person_detector:boxes.mean_red", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:boxes.mean_green", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:boxes.mean_blue", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:boxes.scale_red", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:boxes.scale_green", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:boxes.scale_blue", "unit/perception/network_files_test.cc",
     "GreyLevelsBecomeTheNumbersOfTheNetwork"},
    {"person_detector:boxes.min_score", "unit/perception/pose_networks_test.cc",
     "MoveNetHeedsItsLimits"},
    {"person_detector:boxes.max_overlap", "unit/perception/pose_networks_test.cc",
     "OfTwoBoxesThatAreOneTheBetterStays"},
    {"person_detector:boxes.max_people", "unit/perception/pose_networks_test.cc",
     "MoveNetHeedsItsLimits"},
    {"person_detector:network.head", "unit/perception/person_detector_test.cc",
     "TheHeadDecidesTheNetwork"},
    {"person_detector:joints.min_score", "unit/perception/person_detector_test.cc",
     "JointsAndPeopleMustBeCertain"},
    {"person_detector:joints.min_number", "unit/perception/person_detector_test.cc",
     "JointsAndPeopleMustBeCertain"},
    {"person_detector:stereo.right", "unit/perception/person_detector_test.cc",
     "PeopleAreFoundAlongTheRows"},
    {"person_detector:time.detect_every", "unit/perception/person_detector_test.cc",
     "BetweenDetectionsJointsFollowTheImage"},
    {"person_detector:masks.use", "unit/perception/person_detector_test.cc",
     "MasksAreLeftOutOnRequest"},
    {"person_detector:masks.use_network", "unit/perception/person_detector_test.cc",
     "ALargePersonIsMarkedByTheNetwork"},
    {"person_detector:masks.file", "unit/perception/person_detector_test.cc",
     "ALargePersonIsMarkedByTheNetwork"},
    {"person_detector:masks.input", "unit/perception/person_detector_test.cc",
     "ALargePersonIsMarkedByTheNetwork"},
    {"person_detector:masks.outputs", "unit/perception/person_detector_test.cc",
     "ALargePersonIsMarkedByTheNetwork"},
    {"person_detector:masks.side_px", "unit/perception/person_detector_test.cc",
     "ALargePersonIsMarkedByTheNetwork"},
    {"person_detector:masks.image_short_side_px", "unit/perception/person_detector_test.cc",
     "TheMaskNetworkLooksAtTheWholeImage"},
    {"person_detector:masks.min_height_px", "unit/perception/person_detector_test.cc",
     "ALargePersonIsMarkedByTheNetwork"},
    {"stereo_player:lockstep.wait_for", "node/lockstep_gate_test.cc", "StartsWhenAllAreReady"},
    {"stereo_player:lockstep.frames_in_flight", "node/lockstep_gate_test.cc",
     "KeepsFramesInFlightByTheSlowest"},
    {"stereo_player:image.max_image_bytes", "node/stereo_player_test.cc",
     "LargeImagesGetTheBestQualityThatFits"},
    {"stereo_player:image.jpeg_qualities", "node/stereo_player_test.cc",
     "LargeImagesGetTheBestQualityThatFits"},
    {"stereo_camera:capture.max_waiting", "node/camera_capture_test.cc",
     "TheOldestIsDroppedForANewerOneAndSaidNowAndThen"},
    {"stereo_camera:capture.stall_s", "node/camera_capture_test.cc",
     "DevicesAreLostWhenTheyAreGoneOrSilent"},
    {"stereo_camera:capture.retry_s", "node/camera_capture_test.cc",
     "ALostSourceIsSaidOnceWaitedForAndGoneOnWith"},
    {"stereo_camera:capture.max_skew_ms", "node/camera_capture_test.cc",
     "ImagesThatAreNotTakenTogetherAreWarnedOfOnce"},
    {"stereo_camera:capture.complain_s", "node/camera_capture_test.cc",
     "TheOldestIsDroppedForANewerOneAndSaidNowAndThen"},
    {"stereo_camera:image.max_image_bytes", "node/camera_messages_test.cc",
     "TheQualityIsLoweredUntilImagesFitAndRaisedAgain"},
    {"stereo_camera:image.jpeg_qualities", "node/camera_messages_test.cc",
     "TheQualityIsLoweredUntilImagesFitAndRaisedAgain"},
};

/// Of all configuration files: process:key, and its value.
Values AllOptions() {
  Values options;
  const std::filesystem::path folder = AIRDOS_SOURCE_DIR "/launch_scripts/config";
  for (const auto& file : std::filesystem::directory_iterator(folder)) {
    if (file.path().extension() != ".yaml") continue;
    std::istringstream lines(ConfigReader::FromFile(file.path()).Resolved());
    for (std::string line; std::getline(lines, line);) {
      const std::size_t colon = line.find(": ");
      options[file.path().stem().string() + ":" + line.substr(0, colon)] = line.substr(colon + 2);
    }
  }
  return options;
}

std::set<std::string> CoveredOptions() {
  std::set<std::string> covered;
  for (const Covered& entry : kCovered) covered.insert(entry.option);
  return covered;
}

class OptionsOfAProcessTest : public testing::TestWithParam<Process> {};

TEST_P(OptionsOfAProcessTest, EachChangesSomethingOrHasItsTest) {
  const Process& process = GetParam();
  const std::set<std::string> covered = CoveredOptions();
  int num_options = 0;
  for (const auto& [option, value] : AllOptions()) {
    const std::size_t colon = option.find(':');
    if (option.substr(0, colon) != process.name) continue;
    ++num_options;
    if (covered.count(option) > 0) continue;
    EXPECT_NE(WhereItShows(process, option.substr(colon + 1), value), "")
        << option << " changes nothing: give it a scene, or a test and a line in the list";
  }
  EXPECT_GT(num_options, 20);
}

INSTANTIATE_TEST_SUITE_P(Processes, OptionsOfAProcessTest, testing::ValuesIn(kProcesses),
                         [](const testing::TestParamInfo<Process>& process) {
                           return process.param.name;
                         });

TEST(OptionsEffectTest, EachOptionIsOfAProcessThatIsRunHereOrHasItsTest) {
  std::set<std::string> covered = CoveredOptions();
  const Values options = AllOptions();
  EXPECT_GT(options.size(), 100u);
  for (const auto& [option, value] : options) {
    if (covered.erase(option) > 0) continue;
    const std::string name = option.substr(0, option.find(':'));
    EXPECT_TRUE(std::any_of(std::begin(kProcesses), std::end(kProcesses),
                            [&](const Process& process) { return process.name == name; }))
        << option << ": of no process that is run here";
  }
  for (const std::string& option : covered) ADD_FAILURE() << option << ": there is no such option";
}

TEST(OptionsEffectTest, TheTestsThatAreNamedExist) {
  for (const Covered& entry : kCovered) {
    std::ifstream file(AIRDOS_SOURCE_DIR "/tests/" + entry.file);
    const std::string text{std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
    EXPECT_NE(text.find(", " + entry.test + ") {"), std::string::npos)
        << entry.file << " " << entry.test;
  }
}

}  // namespace
}  // namespace airdos
