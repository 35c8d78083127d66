// Images that are not rectified never give a trajectory in silence: the frontend counts and says
// it, a camera says it, and so does whatever plays them.
#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <memory>
#include <string>
#include <vector>

#include "airdos/process_status_t.hpp"
#include "processes/node/check/watched_source.h"
#include "processes/node/live/lcm_runner.h"
#include "processes/node/message/figures.h"
#include "processes/stereo_camera/camera_messages.h"
#include "processes/tools/replay/replay.h"
#include "tests/node/frontend_walk.h"

namespace airdos {
namespace {

constexpr int kNumFrames = 12;
constexpr char kNotRectified[] = "the images are not rectified: rows of matches differ by ";

cv::Mat MovedDown(const cv::Mat& image, int rows) {
  cv::Mat moved = cv::Mat::zeros(image.size(), image.type());
  image.rowRange(0, image.rows - rows).copyTo(moved.rowRange(rows, image.rows));
  return moved;
}

/// The walk, its right images moved down.
class WalkSource : public FrameSource {
 public:
  explicit WalkSource(int rows, int num_frames = kNumFrames)
      : rows_(rows), num_frames_(num_frames) {}
  std::vector<Envelope> NextFrame() override {
    if (next_ == num_frames_) return {};
    const int k = next_++;
    std::vector<Envelope> frame;
    if (k == 0) frame.push_back({channel::kCalibration, Encode(Calibration())});
    frame.push_back({channel::kCameraLeft, Encode(Left(k))});
    frame.push_back({channel::kCameraRight, Encode(ImageOf(MovedDown(Walk(k).right, rows_), k))});
    return frame;
  }
  double fraction_done() const override { return static_cast<double>(next_) / num_frames_; }
  std::vector<std::string> TakeNotes() override {
    return next_ == 1 ? std::vector<std::string>{"a note of its own"} : std::vector<std::string>();
  }

 private:
  int rows_;
  int num_frames_;
  int next_ = 0;
};

FrontendOptions Alone() {
  FrontendOptions options = WithoutFeedback();
  options.use_people = false;
  options.use_masks = false;
  return options;
}

bool Says(const std::vector<std::string>& lines, const std::string& begin) {
  return std::any_of(lines.begin(), lines.end(),
                     [&](const std::string& line) { return line.rfind(begin, 0) == 0; });
}

struct Frontend {
  explicit Frontend(int rows) : node(Alone()) {
    WalkSource source(rows);
    for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
      for (const Envelope& message : frame)
        node.Receive(message.channel, message.payload.data(), message.payload.size());
      StepAll(&node);
      if (node.channels().count(figure::kRowError_millipx) > 0 && first_known < 0)
        first_known = node.frames().num_done;
    }
  }
  double RowError_px() const {
    return 1e-3 * static_cast<double>(node.channels().at(figure::kRowError_millipx).num_received);
  }
  FrontendNode node;
  std::int64_t first_known = -1;
};

TEST(UnrectifiedInputTest, TheFrontendCountsTheRowErrorAndSaysTheCommand) {
  Frontend good(0);
  EXPECT_LT(good.RowError_px(), 0.3);
  EXPECT_EQ(good.first_known, 5);
  EXPECT_TRUE(good.node.TakeWarnings().empty());
  Frontend bad(4);
  EXPECT_NEAR(bad.RowError_px(), 4, 0.1);
  const std::vector<std::string> warnings = bad.node.TakeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_EQ(warnings[0].rfind(kNotRectified, 0), 0u) << warnings[0];
  EXPECT_NE(warnings[0].find("airdos-stereo-player --images LEFT RIGHT --calibration FILE"),
            std::string::npos)
      << warnings[0];
}

/// As memq:// delivers only when it is asked to, all messages are there when the first is worked
/// on.
TEST(UnrectifiedInputTest, TheFrontendProcessSaysItOnStderrAndInStatus) {
  InstallStopSignals();
  LcmTransport transport("memq://");
  int num_done = 0;
  transport.Subscribe(channel::kFrameDone, [&](const void*, std::size_t, std::int64_t) {
    if (++num_done == kNumFrames) std::raise(SIGTERM);
  });
  FrontendNode node(Alone());
  LcmRunnerOptions options;
  options.process = "airdos-frontend";
  options.publishes_frame_done = true;
  const ProcessLog log("airdos-frontend", LogLevel::kInfo);
  testing::internal::CaptureStderr();
  LcmRunner runner(&node, &transport, options, &log);
  runner.Start();
  WalkSource source(4);
  for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
    for (const Envelope& message : frame)
      transport.Publish(message.channel, message.payload.data(), message.payload.size());
  }
  runner.Run();
  process_status_t last = {};  // which it says before it stops
  transport.Subscribe(channel::kStatus, [&](const void* data, std::size_t size, std::int64_t) {
    ASSERT_TRUE(Decode(data, size, &last));
  });
  while (transport.Poll(0)) {
  }
  const std::string said = testing::internal::GetCapturedStderr();
  EXPECT_NE(said.find(std::string("airdos-frontend: warning: ") + kNotRectified), said.npos)
      << said;
  EXPECT_NE(said.find("info: row_error_millipx: "), said.npos) << said;
  const auto figure = std::find_if(
      last.channels.begin(), last.channels.end(),
      [](const channel_status_t& entry) { return entry.channel == "row_error_millipx"; });
  ASSERT_NE(figure, last.channels.end());
  EXPECT_NEAR(static_cast<double>(figure->num_received), 4000, 100);
  EXPECT_TRUE(Says(last.warnings, kNotRectified));
}

TEST(UnrectifiedInputTest, WhateverPlaysThemSaysSoAndChangesNothing) {
  RowWatch rows("do this");
  WatchedSource source(std::make_unique<WalkSource>(4), "walk.lcm", &rows);
  WalkSource plain(4);
  std::vector<std::string> notes;
  for (auto frame = plain.NextFrame(); !frame.empty(); frame = plain.NextFrame()) {
    const std::vector<Envelope> same = source.NextFrame();
    ASSERT_EQ(same.size(), frame.size());
    EXPECT_EQ(same.back().payload, frame.back().payload);
    for (const std::string& note : source.TakeNotes()) notes.push_back(note);
  }
  EXPECT_EQ(source.fraction_done(), 1);
  ASSERT_EQ(notes.size(), 2u);
  EXPECT_EQ(notes[0], "a note of its own");
  EXPECT_EQ(notes[1].rfind(std::string("warning: walk.lcm: ") + kNotRectified, 0), 0u) << notes[1];
  EXPECT_NE(notes[1].find("; do this"), std::string::npos);

  // Opened again, as in a loop: it is not said again.
  WatchedSource again(std::make_unique<WalkSource>(4), "walk.lcm", &rows);
  while (!again.NextFrame().empty()) EXPECT_FALSE(Says(again.TakeNotes(), "warning: "));
}

TEST(UnrectifiedInputTest, AtTheEndItIsSaidThatNothingIsKnown) {
  RowWatch rows("do this");
  constexpr int kAlmostAll = 191;  // nothing is left to be matched
  WatchedSource source(std::make_unique<WalkSource>(kAlmostAll), "walk.lcm", &rows);
  std::vector<std::string> notes;
  for (bool is_end = false; !is_end;) {
    is_end = source.NextFrame().empty();
    notes = source.TakeNotes();
  }
  EXPECT_TRUE(Says(notes, "warning: walk.lcm: hardly anything"));
}

/// Hands out one frame again and again.
class OneFrameSource : public FrameSource {
 public:
  explicit OneFrameSource(std::vector<Envelope> frame) : frame_(std::move(frame)) {}
  std::vector<Envelope> NextFrame() override { return frame_; }
  double fraction_done() const override { return 0; }
  std::vector<std::string> TakeNotes() override { return {}; }

 private:
  std::vector<Envelope> frame_;
};

TEST(UnrectifiedInputTest, OnlyGoodPairsAreLookedAt) {
  const image_t left = ImageOf(Walk(0).left, 3);
  const image_t right = ImageOf(MovedDown(Walk(0).right, 4), 3);
  const auto error_px = [&](const image_t& other, const std::string& channel) {
    RowWatch rows("");
    WatchedSource source(std::make_unique<OneFrameSource>(std::vector<Envelope>{
                             {channel::kCameraLeft, Encode(left)}, {channel, Encode(other)}}),
                         "", &rows);
    for (int k = 0; k < kNumFrames; ++k) source.NextFrame();
    return rows.error_px();
  };
  EXPECT_TRUE(error_px(right, channel::kCameraRight));
  EXPECT_FALSE(error_px(right, "CAMERA_THIRD"));
  image_t other = right;
  other.seq = 4;
  EXPECT_FALSE(error_px(other, channel::kCameraRight));
  other = right;
  other.session = 1;
  EXPECT_FALSE(error_px(other, channel::kCameraRight));
  other = right;
  other.utime += 20001;
  EXPECT_FALSE(error_px(other, channel::kCameraRight));
  other = right;
  other.data.resize(100);
  other.num_bytes = 100;
  EXPECT_FALSE(error_px(other, channel::kCameraRight)) << "cut short";
  EXPECT_FALSE(error_px(ImageOf(MovedDown(Walk(0).right, 4)(cv::Rect(0, 0, 200, 150)).clone(), 3),
                        channel::kCameraRight))
      << "of another size";
}

TEST(UnrectifiedInputTest, ReplaySaysAtOnceWhatNodesWarnOf) {
  for (const bool is_parallel : {false, true}) {
    std::vector<ReplayNode> nodes;
    nodes.push_back({std::make_unique<FrontendNode>(Alone()), {channel::kStaticFeatures}});
    ReplayOptions options;
    options.is_parallel = is_parallel;
    double fraction = 0;
    options.on_progress = [&](double done) { fraction = done; };
    std::vector<std::string> said;
    double said_at = 1;
    options.on_remark = [&](const std::string& remark) {
      said.push_back(remark);
      said_at = fraction;
    };
    constexpr int kMany = 40;
    WalkSource source(4, kMany);
    const ReplayResult result = Replay(&source, nodes, options);
    ASSERT_EQ(said.size(), 2u);
    EXPECT_EQ(said[0], "a note of its own");
    const std::string begin = std::string("frontend: warning: ") + kNotRectified;
    EXPECT_EQ(said[1].rfind(begin, 0), 0u) << said[1];
    EXPECT_TRUE(Says(result.remarks, begin)) << "in the summary as well";
    if (!is_parallel) {
      EXPECT_LT(said_at, 0.25);
    }
  }
}

TEST(UnrectifiedInputTest, ACameraWhoseCalibrationDoesNotFitSaysSo) {
  const StereoCamera small = SmallStereoCamera();
  StereoRig rig;
  rig.are_images_rectified = true;
  rig.rectified = small;
  const StereoRectifier rectifier(rig);
  const auto notes = [&](int rows) {
    CameraMessages messages(&rectifier, {});
    for (int k = 0; k < kNumFrames; ++k) {
      CapturedPair pair;
      pair.utime = 100000 * k;
      pair.left = Walk(k).left;
      pair.right = MovedDown(Walk(k).right, rows);
      messages.Pack(pair);
    }
    return messages.TakeNotes();
  };
  EXPECT_FALSE(Says(notes(0), "warning: "));
  EXPECT_TRUE(Says(notes(4), std::string("warning: ") + kNotRectified));
}

}  // namespace
}  // namespace airdos
