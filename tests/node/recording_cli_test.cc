// How player and replay are told of a recording, and what they make of it.
#include "processes/node/live/recording_cli.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <string>
#include <vector>

#include "airdos/image_t.hpp"
#include "common/util/format.h"
#include "processes/node/check/input_check.h"
#include "processes/node/message/channels.h"
#include "processes/stereo_player/dataset_source.h"
#include "tests/support/folder_test.h"
#include "tests/support/input_errors.h"
#include "tests/support/rendered_scene.h"

namespace airdos {
namespace {

/// The command line of a program that plays.
struct Parsed {
  explicit Parsed(std::vector<std::string> words) : line("", "program"), input(&line) {
    recording.AddTo(&line);
    words.insert(words.begin(), "program");
    std::vector<char*> argv;
    for (std::string& word : words) argv.push_back(word.data());
    line.Parse(static_cast<int>(argv.size()), argv.data(), "");
    recording.Settle(&input);
  }
  CommandLine line;
  InputOptions input;
  RecordingArguments recording;
};

std::string Refusal(const std::vector<std::string>& words) {
  return ErrorOf([&] { Parsed parsed(words); });
}

TEST(RecordingArgumentsTest, ACalibrationByNameGoesWithAnInput) {
  for (const std::vector<std::string>& words :
       {std::vector<std::string>{"folder", "--calibration", "name"},
        {"--calibration", "name", "folder"},
        {"--calibration", "name", "--data", "folder"}}) {
    const Parsed parsed(words);
    EXPECT_FALSE(parsed.recording.is_given());
    EXPECT_EQ(parsed.input.path(), "folder");
    EXPECT_EQ(parsed.recording.named_calibration(), "name");
  }
  EXPECT_EQ(Parsed({"folder"}).recording.named_calibration(), "");
  EXPECT_TRUE(Holds(Refusal({"folder", "--calibration", "a", "b"}), "go with --images or --video"));
}

TEST(RecordingArgumentsTest, WithoutCalibrationNothingRuns) {
  EXPECT_TRUE(Holds(Refusal({"--images", "l", "r"}), "--images: the calibration is missing"));
  EXPECT_TRUE(Holds(Refusal({"--video", "l", "r"}), "--video: the calibration is missing"));
}

TEST(RecordingArgumentsTest, ContradictionsAreRefused) {
  const auto refusal = [](std::vector<std::string> words) {
    words.insert(words.end(), {"--calibration", "c"});
    return Refusal(words);
  };
  EXPECT_TRUE(Holds(refusal({"in", "--images", "l", "r"}), "only one input is possible"));
  EXPECT_TRUE(Holds(refusal({"--images", "l", "--video", "v"}), "excludes"));
  EXPECT_TRUE(Holds(refusal({"--video", "v"}), "--side-by-side or --over-under?"));
  EXPECT_TRUE(Holds(refusal({"--video", "l", "r", "--side-by-side"}), "there are two"));
  EXPECT_TRUE(Holds(refusal({"--video", "v", "--side-by-side", "--over-under"}), "exclude"));
  EXPECT_TRUE(Holds(refusal({"--images", "l", "--over-under"}), "are for --video"));
  EXPECT_TRUE(Holds(refusal({"--video", "l", "r", "--times", "t"}), "--times is for --images"));
  EXPECT_TRUE(Holds(refusal({"--images", "l", "--times", "t", "--rate", "5"}), "exclude"));
  EXPECT_TRUE(Holds(refusal({"--images", "l", "--rate", "0"}), "--rate: must lie between"));
  EXPECT_TRUE(Holds(Refusal({"in", "--rate", "2"}), "--rate: is for recordings"));
  EXPECT_TRUE(Holds(Refusal({"in", "--times", "t"}), "--times: is for recordings"));
}

class RecordingSourceTest : public FolderTest {
 protected:
  RecordingSourceTest() : FolderTest("recording_source_test") {
    const RenderedScene scene(3);
    const StereoCamera camera = SmallStereoCamera();
    for (int i = 0; i < 4; ++i) {
      const StereoPair pair = scene.Render(camera, SwayingPath(i));
      scratch_.WritePicture(Format("l/%03d.png", i), pair.left);
      scratch_.WritePicture(Format("r/%03d.png", i), pair.right);
    }
    Write("calib.json",
          Format(R"({"fx": %.17g, "fy": %.17g, "cx": %.17g, "cy": %.17g, "baseline_m": %.17g})",
                 camera.fx_px, camera.fy_px, camera.cx_px, camera.cy_px, camera.baseline_m));
  }
  RecordingArguments Arguments(const std::string& left, const std::string& right) const {
    return Parsed({"--images", Path(left), Path(right), "--rate", "10", "--calibration",
                   Path("calib.json"), "--rectified"})
        .recording;
  }
};

TEST_F(RecordingSourceTest, ADamagedPairIsSkippedAndSaid) {
  std::string bytes = TextOf("l/001.png");
  for (std::size_t i = 60; i < bytes.size() - 40; ++i) bytes[i] = 'x';
  Write("l/001.png", bytes);
  const RecordingArguments arguments = Arguments("l", "r");
  DatasetSource source(arguments.Open(), arguments.name(), 0, 100, 7, {});
  source.TakeNotes();
  std::vector<std::int64_t> seqs;
  for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
    for (const Envelope& message : frame) {
      image_t image;
      if (message.channel != channel::kCameraLeft) continue;
      ASSERT_TRUE(Decode(message.payload.data(), message.payload.size(), &image));
      EXPECT_EQ(image.utime, 100000 * image.seq);
      seqs.push_back(image.seq);
    }
  }
  EXPECT_EQ(seqs, (std::vector<std::int64_t>{0, 2, 3}));
  const std::vector<std::string> notes = source.TakeNotes();
  ASSERT_EQ(notes.size(), 1u);
  EXPECT_TRUE(Holds(notes[0], "l/001.png") && Holds(notes[0], ": skipped")) << notes[0];
}

TEST_F(RecordingSourceTest, TheCheckBeforeARunFindsExchangedCameras) {
  const auto refusal = [&](const std::string& left, const std::string& right) {
    const auto sequence = Arguments(left, right).Open();
    return ErrorOf([&] { CheckRecordingBeforeRun(*sequence, [](const std::string&) {}); });
  };
  EXPECT_EQ(refusal("l", "r"), "");
  EXPECT_TRUE(Holds(refusal("r", "l"), "exchanged")) << refusal("r", "l");
}

}  // namespace
}  // namespace airdos
