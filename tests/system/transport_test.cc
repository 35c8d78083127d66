#include <gtest/gtest.h>

#include <algorithm>
#include <csignal>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <sstream>
#include <string>
#include <utility>
#include <vector>

#include "airdos/frame_done_t.hpp"
#include "processes/node/live/lcm_runner.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/node.h"
#include "tests/support/child_process.h"
#include "tests/support/private_network.h"

// What a peer that sends faster than we work costs: as many messages as the queue holds, no more.

namespace airdos {
namespace {

const std::string kUrl = "udpm://239.255.76.67:7667?ttl=0";
constexpr int kTooMany = 500;
constexpr int kOneMore = 1;  // LCM drops a message where more than the capacity wait

/// Whether LCM's threads have taken everything from the sockets of this network.
bool SocketsAreEmpty() {
  std::ifstream table("/proc/self/net/udp");
  std::string line;
  std::getline(table, line);
  int num_sockets = 0;
  while (std::getline(table, line)) {
    std::istringstream fields(line);
    std::string slot, local, remote, state, queues;  // queues: hexadecimal, "sent:received"
    fields >> slot >> local >> remote >> state >> queues;
    const std::size_t colon = queues.find(':');
    if (colon == std::string::npos || std::stoul(queues.substr(colon + 1), nullptr, 16) != 0) {
      return false;
    }
    ++num_sockets;
  }
  return num_sockets > 0;
}

/// Sends `num_messages`, numbered, and hears each of them before the next.
void SendAndHear(const std::string& channel, int num_messages) {
  LcmTransport witness(kUrl);
  int num_heard = 0;
  witness.Subscribe(channel, [&](const void*, std::size_t, std::int64_t) { ++num_heard; });
  for (int number = 0; number < num_messages; ++number) {
    ASSERT_TRUE(witness.Publish(channel, &number, sizeof(number)));
    constexpr int kPoll_ms = 1000;
    while (num_heard <= number && witness.Poll(kPoll_ms)) {
    }
  }
  ASSERT_EQ(num_heard, num_messages);
}

/// Sends numbered messages while the transport under test, which has subscribed, does not poll.
/// Somebody else does, so that nothing is lost before the queues. Returns once each message waits
/// in a queue or is dropped: LCM's thread takes them in order, so where the sockets are empty only
/// the one after the flood, on a channel of its own, can be on its way into the queue.
void Flood(int num_messages) {
  ASSERT_NO_FATAL_FAILURE(SendAndHear("FLOOD", num_messages));
  ASSERT_NO_FATAL_FAILURE(SendAndHear("AFTER_THE_FLOOD", 1));
  constexpr double kDeadline_s = 60.0;
  ASSERT_TRUE(WaitUntil(SocketsAreEmpty, kDeadline_s));
}

void PollUntilQuiet(LcmTransport* busy) {
  constexpr int kQuiet_ms = 200;
  while (busy->Poll(kQuiet_ms)) {
  }
}

class TransportTest : public testing::Test {
 protected:
  void SetUp() override {
    const std::string obstacle = EnterPrivateNetwork(true);
    if (!obstacle.empty()) GTEST_SKIP() << obstacle;
  }
};

// Beyond the bound the newest are dropped: their numbers are missing afterwards.
TEST_F(TransportTest, TheQueueOfAChannelIsBounded) {
  constexpr int kMax = LcmTransport::kMaxQueuedOfChannel;
  LcmTransport busy(kUrl);
  std::vector<int> numbers;
  busy.Subscribe("FLOOD", [&](const void* data, std::size_t size, std::int64_t) {
    numbers.push_back(-1);
    ASSERT_EQ(size, sizeof(int));
    std::memcpy(&numbers.back(), data, size);
  });
  ASSERT_NO_FATAL_FAILURE(Flood(kMax + kTooMany));
  PollUntilQuiet(&busy);
  ASSERT_EQ(numbers.size(), static_cast<std::size_t>(kMax + kOneMore));
  EXPECT_EQ(numbers.front(), 0);
  EXPECT_LT(numbers.back(), kMax + kTooMany - 1) << "the newest one";
}

TEST_F(TransportTest, TheQueueOfARecorderIsBounded) {
  LcmTransport busy(kUrl);
  int num_heard = 0;
  busy.SubscribeAll([&](const std::string& channel, const void*, std::size_t, std::int64_t) {
    if (channel != "AFTER_THE_FLOOD") ++num_heard;
  });
  ASSERT_NO_FATAL_FAILURE(Flood(LcmTransport::kMaxQueuedOfAll + kTooMany));
  PollUntilQuiet(&busy);
  EXPECT_EQ(num_heard, LcmTransport::kMaxQueuedOfAll + kOneMore);
}

/// A node that answers each message with two more: whoever takes in all there is never ends.
class FloodedNode : public Node {
 public:
  static constexpr int kMost = 20000;

  explicit FloodedNode(LcmTransport* sender) : Node("flooded"), sender_(sender) {
    Subscribe<frame_done_t>("FLOOD", [this](frame_done_t&&) {
      ++num_since_work_;
      if (++num_received_ >= kMost) std::raise(SIGTERM);
      SendTwo();
      return std::string();
    });
  }
  void SendTwo() {
    frame_done_t message = {};
    message.process = "anybody";
    const std::vector<std::uint8_t> bytes = Encode(message);
    for (int i = 0; i < 2; ++i) sender_->Publish("FLOOD", bytes.data(), bytes.size());
  }
  bool Step() override {
    if (num_since_work_ == 0) SendTwo();  // the flood has not begun, or all of it was lost
    most_between_work_ = std::max(most_between_work_, std::exchange(num_since_work_, 0));
    return false;
  }
  bool CompleteOldest() override { return false; }
  void SkipToNewest() override {}
  std::string waiting_for() const override { return ""; }
  std::size_t num_pending() const override { return 0; }

  int num_received() const { return num_received_; }
  int most_between_work() const { return most_between_work_; }

 private:
  LcmTransport* sender_;
  int num_received_ = 0;
  int num_since_work_ = 0;
  int most_between_work_ = 0;
};

// The last one: from SIGTERM on nothing runs.
TEST_F(TransportTest, AFloodDoesNotKeepAProcessFromItsWork) {
  InstallStopSignals();
  LcmTransport sender(kUrl);
  LcmTransport transport(kUrl);
  FloodedNode node(&sender);
  LcmRunnerOptions options;
  options.process = "flooded";
  options.pace = LcmRunnerOptions::Pace::kRealtime;
  const ProcessLog log(options.process, LogLevel::kError);
  LcmRunner runner(&node, &transport, options, &log);
  runner.Start();
  runner.Run();
  EXPECT_GE(node.num_received(), FloodedNode::kMost);
  EXPECT_GT(node.most_between_work(), 0);
  EXPECT_LE(node.most_between_work(), LcmRunner::kMaxDrained + kOneMore);
}

}  // namespace
}  // namespace airdos
