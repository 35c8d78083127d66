#include "processes/node/log/looped_source.h"

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

/// Frames 5 to 7, with a calibration at the beginning.
class ThreeFrames : public FrameSource {
 public:
  std::vector<Envelope> NextFrame() override {
    if (next_ == 8) return {};
    std::vector<Envelope> frame;
    if (next_ == 5) frame.push_back(TextEnvelope("CALIBRATION", 5, "calibration"));
    frame.push_back(TextEnvelope("IMAGE", next_, "image " + std::to_string(next_)));
    ++next_;
    return frame;
  }
  double fraction_done() const override { return static_cast<double>(next_ - 5) / 3; }
  std::vector<std::string> TakeNotes() override { return {}; }

 private:
  std::int64_t next_ = 5;
};

frame_done_t Decoded(const Envelope& envelope) {
  frame_done_t message;
  EXPECT_TRUE(Decode(envelope.payload.data(), envelope.payload.size(), &message));
  return message;
}

TEST(LoopedSourceTest, NumbersAndTimesGoOnAndTheRestStays) {
  LoopedSource source([] { return std::make_unique<ThreeFrames>(); }, 3);
  std::int64_t seq = 5;
  for (; seq < 14; ++seq) {
    const std::vector<Envelope> frame = source.NextFrame();
    ASSERT_EQ(frame.size(), (seq - 5) % 3 == 0 ? 2u : 1u);
    for (const Envelope& message : frame) {
      EXPECT_EQ(Decoded(message).seq, seq);
      EXPECT_EQ(Decoded(message).utime, 1000 * seq);
      EXPECT_EQ(Decoded(message).session, 7);
    }
    EXPECT_EQ(Decoded(frame.back()).process, "image " + std::to_string(5 + (seq - 5) % 3));
    EXPECT_NEAR(source.fraction_done(), static_cast<double>(seq - 4) / 9, 1e-12);
  }
  EXPECT_TRUE(source.NextFrame().empty());
}

TEST(LoopedSourceTest, OnceIsTheSourceItself) {
  LoopedSource source([] { return std::make_unique<ThreeFrames>(); }, 1);
  ThreeFrames plain;
  for (int i = 0; i < 4; ++i) {
    const std::vector<Envelope> got = source.NextFrame();
    const std::vector<Envelope> expected = plain.NextFrame();
    ASSERT_EQ(got.size(), expected.size());
    for (std::size_t k = 0; k < got.size(); ++k) EXPECT_EQ(got[k].payload, expected[k].payload);
  }
}

}  // namespace
}  // namespace airdos
