// Imported logs and folders against what they were made of: the same messages, the same results.
#include "processes/tools/import/import.h"

#include <gtest/gtest.h>

#include <map>
#include <string>

#include "airdos/pose_t.hpp"
#include "common/dataset/keypoints/keypoint_sequence.h"
#include "common/dataset/recording/folder_recording.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/tools/replay/replay.h"
#include "processes/tools/replay/replay_setup.h"
#include "tests/support/input_errors.h"
#include "tests/support/scratch_folder.h"
#include "tests/support/small_sequence.h"

namespace airdos {
namespace {

namespace fs = std::filesystem;

std::vector<LogEvent> EventsOf(const std::string& path) {
  EventLogReader reader(path);
  std::vector<LogEvent> events;
  while (std::optional<LogEvent> event = reader.Next()) events.push_back(std::move(*event));
  return events;
}

class ImportTest : public ::testing::Test {
 protected:
  ImportTest() { SmallSequence::Make().Write(Set()); }
  std::string Set() const { return folder_.PathOf("set"); }
  ImportOptions To(const std::string& name, bool force = false) const {
    ImportOptions options;
    options.out = folder_.PathOf(name);
    options.rules.force = force;
    return options;
  }
  /// Digests of what the processes make of a log or folder.
  std::map<std::string, std::string> DigestsOf(const std::string& path) const {
    ReplaySetup setup;
    setup.config_dir = std::string(AIRDOS_SOURCE_DIR) + "/launch_scripts/config";
    setup.people = "on";
    const ReplayNodes replay = PrepareReplay(setup);
    const auto source = OpenFrameSource(path, 0, 1000, LogInputs::kImages, "");
    std::map<std::string, std::string> digests;
    for (const auto& [channel, entry] : Replay(source.get(), replay.nodes, {}).digests) {
      digests[channel] = entry.sha256;
    }
    return digests;
  }
  ScratchFolder folder_{"import"};
};

TEST_F(ImportTest, ALogAndAFolderGiveTheResultsOfWhatTheyWereMadeOf) {
  EXPECT_EQ(ImportToLog(OpenStereoSequence(Set()), "set", To("a.lcm")).num_frames, 14u);
  EXPECT_EQ(ImportToFolder(OpenStereoSequence(Set()), "set", To("copy")).num_frames, 14u);
  const auto wanted = DigestsOf(Set());
  ASSERT_GE(wanted.size(), 4u);
  EXPECT_EQ(DigestsOf(folder_.PathOf("a.lcm")), wanted);
  EXPECT_EQ(DigestsOf(folder_.PathOf("copy")), wanted);
}

// Of the ground truth, which is normalized each time that it is read, all but the last digit.
TEST_F(ImportTest, AFolderGivesTheMessagesOfWhatItWasMadeOf) {
  ImportToFolder(OpenStereoSequence(Set()), "set", To("copy"));
  ImportToLog(OpenStereoSequence(Set()), "set", To("a.lcm"));
  ImportToLog(OpenStereoSequence(folder_.PathOf("copy")), "copy", To("b.lcm"));
  const std::vector<LogEvent> a = EventsOf(folder_.PathOf("a.lcm"));
  const std::vector<LogEvent> b = EventsOf(folder_.PathOf("b.lcm"));
  ASSERT_EQ(a.size(), b.size());
  std::map<std::string, int> num_messages;
  for (std::size_t i = 0; i < a.size(); ++i) {
    ++num_messages[a[i].channel];
    ASSERT_EQ(a[i].channel, b[i].channel);
    EXPECT_EQ(a[i].utime, b[i].utime);
    if (a[i].channel != channel::kGroundTruth) {
      EXPECT_EQ(a[i].payload, b[i].payload) << a[i].channel << " " << i;
      continue;
    }
    pose_t pose_a, pose_b;
    ASSERT_TRUE(Decode(a[i].payload.data(), a[i].payload.size(), &pose_a));
    ASSERT_TRUE(Decode(b[i].payload.data(), b[i].payload.size(), &pose_b));
    EXPECT_EQ(pose_a.axes, pose_b.axes);
    for (int k = 0; k < 3; ++k) EXPECT_EQ(pose_a.position[k], pose_b.position[k]);
    for (int k = 0; k < 4; ++k) EXPECT_NEAR(pose_a.orientation[k], pose_b.orientation[k], 1e-15);
  }
  for (const char* channel :
       {channel::kCameraLeft, channel::kCameraRight, channel::kPersonKeypointsLeft,
        channel::kPersonKeypointsRight, channel::kPersonMask, channel::kGroundTruth}) {
    EXPECT_EQ(num_messages[channel], 14) << channel;
  }
  EXPECT_EQ(num_messages[channel::kCalibration], 2) << "one a second";
}

// One pair's left image is cut short.
TEST_F(ImportTest, PairsThatCannotBeUsedAreLeftOutAndSaid) {
  StereoRig rig;
  rig.left = rig.right = {64, 48, 70, 70, 32, 24, LensModel::kRadialTangential, {-0.1, 0, 0, 0}};
  rig.T_L_R.translation = {0.1, 0, 0};
  for (const char* name : {"l/1.png", "l/2.png", "l/3.png", "r/1.png", "r/2.png", "r/3.png"}) {
    folder_.WritePicture(name, cv::Mat(48, 64, CV_8UC1, cv::Scalar(name[2] - '0')));
  }
  const auto open = [&] {
    auto sequence = std::make_unique<RectifiedSequence>(
        std::make_unique<FolderRecording>(
            FolderRecordingOptions{folder_.PathOf("l"), folder_.PathOf("r"), "", 10.0}),
        rig);
    fs::resize_file(folder_.PathOf("l/2.png"), 60);  // after it was opened
    return sequence;
  };
  std::vector<std::string> notes;
  std::vector<double> progress;
  ImportOptions options = To("set2");
  options.on_note = [&](const std::string& note) { notes.push_back(note); };
  options.on_progress = [&](double fraction) { progress.push_back(fraction); };
  EXPECT_EQ(ImportToFolder(open(), "images", options).num_frames, 2u);
  ASSERT_FALSE(notes.empty());
  EXPECT_TRUE(Holds(notes[0], "2.png")) << notes[0];
  EXPECT_EQ(progress, (std::vector<double>{1.0 / 3, 2.0 / 3, 1}));
  const auto read = OpenStereoSequence(folder_.PathOf("set2"));
  ASSERT_EQ(read->num_frames(), 2u);
  EXPECT_EQ(read->utime(0), 0);
  EXPECT_EQ(read->utime(1), 200000) << "the time of the third pair";
  EXPECT_EQ(read->camera().fx_px, StereoRectifier(rig).camera().fx_px);
}

TEST_F(ImportTest, PeopleOfAnotherProgramAreInBoth) {
  ForeignKeypoints people;
  people.path = "FILE";
  people.program = "AlphaPose";
  people.images = {{"000003.jpg", {PersonKeypoints(18, {31, 40, 0.5F})}}};
  const auto open = [&] {
    return std::make_unique<KeypointSequence>(OpenStereoSequence(Set()), people, people);
  };
  ImportToFolder(open(), "set", To("copy"));
  ImportToLog(open(), "set", To("a.lcm"));
  ImportToLog(OpenStereoSequence(folder_.PathOf("copy")), "copy", To("b.lcm"));
  const std::vector<LogEvent> a = EventsOf(folder_.PathOf("a.lcm"));
  const std::vector<LogEvent> b = EventsOf(folder_.PathOf("b.lcm"));
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].channel == channel::kGroundTruth) continue;
    EXPECT_EQ(a[i].payload, b[i].payload) << a[i].channel << " " << i;
  }
  EXPECT_EQ(OpenStereoSequence(folder_.PathOf("copy"))->Load(3).keypoints_left.size(), 1u);
}

TEST_F(ImportTest, FirstLastAndSessionAreKept) {
  ImportOptions options = To("a.lcm");
  options.first = 3;
  options.last = 5;
  options.session = 77;
  EXPECT_EQ(ImportToLog(OpenStereoSequence(Set()), "set", options).num_frames, 3u);
  const std::vector<LogEvent> events = EventsOf(options.out);
  const Header first = *PeekHeader(events.front().payload.data(), events.front().payload.size());
  const Header last = *PeekHeader(events.back().payload.data(), events.back().payload.size());
  EXPECT_EQ(first.seq, 3);
  EXPECT_EQ(last.seq, 5);
  EXPECT_EQ(first.session, 77);
  EXPECT_EQ(events.front().utime, first.utime);
  options.out = folder_.PathOf("part");
  EXPECT_EQ(ImportToFolder(OpenStereoSequence(Set()), "set", options).num_frames, 3u);
  EXPECT_EQ(OpenStereoSequence(options.out)->utime(0), OpenStereoSequence(Set())->utime(3));
  options.first = 14;
  options.last = 20;
  options.out = folder_.PathOf("none");
  EXPECT_TRUE(Holds(ErrorOf([&] { ImportToFolder(OpenStereoSequence(Set()), "set", options); }),
                    "set: has frames 0 to 13"));
  EXPECT_FALSE(fs::exists(options.out));
}

TEST_F(ImportTest, ALogIsReplacedOnlyByForceAndNeverHalf) {
  ImportToLog(OpenStereoSequence(Set()), "set", To("a.lcm"));
  const auto size = fs::file_size(folder_.PathOf("a.lcm"));
  EXPECT_TRUE(Holds(ErrorOf([&] { ImportToLog(OpenStereoSequence(Set()), "set", To("a.lcm")); }),
                    "a.lcm: exists; --force replaces it"));
  auto sequence = OpenStereoSequence(Set());
  fs::resize_file(Set() + "/image_0/000009.png", 100);
  EXPECT_TRUE(Holds(ErrorOf([&] { ImportToLog(std::move(sequence), "set", To("a.lcm", true)); }),
                    "000009.png"));
  EXPECT_EQ(fs::file_size(folder_.PathOf("a.lcm")), size);
  EXPECT_FALSE(fs::exists(folder_.PathOf("a.lcm.part")));
  ImportOptions options = To("a.lcm", true);
  options.last = 2;
  ImportToLog(OpenStereoSequence(Set()), "set", options);
  EXPECT_LT(fs::file_size(folder_.PathOf("a.lcm")), size / 2);
}

TEST_F(ImportTest, TheNameTellsWhatIsWritten) {
  for (const char* name : {"a.lcm", "a.lcmlog", "x/b.LOG"}) {
    EXPECT_EQ(ImportTargetOf(name), ImportTarget::kLog) << name;
  }
  fs::create_directory(folder_.PathOf("of.2026"));
  for (const std::string& name :
       {std::string("a"), std::string("a.b/"), folder_.PathOf("of.2026")}) {
    EXPECT_EQ(ImportTargetOf(name), ImportTarget::kFolder) << name;
  }
  EXPECT_TRUE(Holds(ErrorOf([] { ImportTargetOf("a.mp4"); }), "neither a log"));
  EXPECT_NE(ErrorOf([] { ImportTargetOf(""); }), "");
}

}  // namespace
}  // namespace airdos
