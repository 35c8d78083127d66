#include "processes/node/live/lcm_runner.h"

#include <gtest/gtest.h>

#include <csignal>
#include <sstream>
#include <vector>

#include "processes/node/message/codec.h"
#include "tests/support/echo_node.h"
#include "tests/support/sample_messages.h"

namespace airdos {
namespace {

/// As memq:// delivers only when it is asked to, all images are there when the first is worked on.
TEST(LcmRunnerTest, SkippedImagesGetNoFrameDone) {
  constexpr std::int64_t kLast = 9;
  InstallStopSignals();
  LcmTransport transport("memq://");
  std::vector<std::int64_t> done;
  transport.Subscribe(channel::kFrameDone, [&](const void* data, std::size_t size, std::int64_t) {
    frame_done_t message = {};
    ASSERT_TRUE(Decode(data, size, &message));
    done.push_back(message.seq);
    if (message.seq == kLast) std::raise(SIGTERM);
  });
  EchoNode node;
  LcmRunnerOptions options;
  options.process = "echo";
  options.pace = LcmRunnerOptions::Pace::kRealtime;
  options.publishes_frame_done = true;
  const ProcessLog log("p", LogLevel::kError);
  LcmRunner runner(&node, &transport, options, &log);
  runner.Start();
  const auto say = [&](const char* channel, const auto& message) {
    const std::vector<std::uint8_t> bytes = Encode(message);
    ASSERT_TRUE(transport.Publish(channel, bytes.data(), bytes.size()));
  };
  say(channel::kCalibration, Sample<stereo_calibration_t>());
  for (std::int64_t seq = 0; seq <= kLast; ++seq) {
    auto image = Sample<image_t>();
    image.seq = seq;
    say(channel::kCameraLeft, image);
    say(channel::kCameraRight, image);
  }
  runner.Run();
  EXPECT_EQ(done, std::vector<std::int64_t>{kLast});
  EXPECT_EQ(node.frames().num_skipped, kLast);
}

}  // namespace
}  // namespace airdos
