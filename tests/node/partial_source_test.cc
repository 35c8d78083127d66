#include "processes/node/log/partial_source.h"

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "common/util/error.h"
#include "processes/node/message/channels.h"
#include "processes/stereo_player/player_loop.h"
#include "processes/tools/replay/replay_setup.h"
#include "tests/support/input_errors.h"

namespace airdos {
namespace {

/// Frames that are given.
class FixedSource : public FrameSource {
 public:
  explicit FixedSource(std::vector<std::vector<Envelope>> frames) : frames_(std::move(frames)) {}
  std::vector<Envelope> NextFrame() override {
    return next_ == frames_.size() ? std::vector<Envelope>() : frames_[next_++];
  }
  double fraction_done() const override { return 0.25; }
  std::vector<std::string> TakeNotes() override { return {"a note"}; }

 private:
  std::vector<std::vector<Envelope>> frames_;
  std::size_t next_ = 0;
};

TEST(PartialSourceTest, LeavesOutItsChannelsAndNothingElse) {
  const std::vector<std::vector<Envelope>> frames = {
      {{"A", {1}}, {"B", {2}}, {"C", {3}}}, {{"B", {4}}}, {{"B", {5}}, {"A", {6}}}};
  PartialSource source(std::make_unique<FixedSource>(frames), {"B"});
  std::vector<Envelope> frame = source.NextFrame();
  ASSERT_EQ(frame.size(), 2u);
  EXPECT_EQ(frame[0].channel, "A");
  EXPECT_EQ(frame[1].channel, "C");
  // Nothing is left of the second frame, which is not the end.
  frame = source.NextFrame();
  ASSERT_EQ(frame.size(), 1u);
  EXPECT_EQ(frame[0].payload[0], 6);
  EXPECT_TRUE(source.NextFrame().empty());
  EXPECT_EQ(source.fraction_done(), 0.25);
  EXPECT_EQ(source.TakeNotes().size(), 1u);
}

TEST(PartialSourceTest, WordsStandForChannels) {
  EXPECT_EQ(ChannelsOfPeople("--without", {"masks"}),
            std::vector<std::string>{channel::kPersonMask});
  EXPECT_EQ(ChannelsOfPeople("--without", {"keypoints", "masks"}).size(), 3u);
  EXPECT_EQ(ErrorOf([] { ChannelsOfPeople("--without", {"people"}); }),
            "--without: 'people' is neither keypoints nor masks");
}

TEST(PartialSourceTest, ADetectorTakesThePlaceOfTheRecordedOne) {
  PartialSource source(OpenFrameSource(AIRDOS_SOURCE_DIR "/logs/road_crossing06.lcm"),
                       ChannelsOfPeople("--detect", {"keypoints", "masks"}));
  int num_frames = 0;
  int num_images = 0;
  for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
    ++num_frames;
    for (const Envelope& message : frame) {
      EXPECT_EQ(message.channel.find("PERSON"), std::string::npos);
      num_images += message.channel == channel::kCameraLeft ? 1 : 0;
    }
  }
  EXPECT_EQ(num_frames, 50);
  EXPECT_EQ(num_images, 50);
}

TEST(PartialSourceTest, ThePlayerLeavesOutWhatItIsTold) {
  PlayerOptions options;
  options.data = AIRDOS_SOURCE_DIR "/logs/road_crossing06.lcm";
  options.last = 3;
  options.without = {"masks"};
  const std::unique_ptr<FrameSource> source = OpenPlayerSource(options, 1);
  int num_masks = 0;
  int num_keypoints = 0;
  for (auto frame = source->NextFrame(); !frame.empty(); frame = source->NextFrame()) {
    for (const Envelope& message : frame) {
      num_masks += message.channel == channel::kPersonMask ? 1 : 0;
      num_keypoints += message.channel == channel::kPersonKeypointsLeft ? 1 : 0;
    }
  }
  EXPECT_EQ(num_masks, 0);
  EXPECT_EQ(num_keypoints, 4);
}

}  // namespace
}  // namespace airdos
