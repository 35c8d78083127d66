#ifndef AIRDOS_TESTS_SUPPORT_FAULT_FIXTURE_H_
#define AIRDOS_TESTS_SUPPORT_FAULT_FIXTURE_H_

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "processes/node/message/channels.h"
#include "tests/support/live_chain.h"
#include "tests/support/private_network.h"

namespace airdos {

/// A test of the whole chain in its own network and folder. The folder is kept if the test fails.
class FaultTest : public testing::Test {
 protected:
  static constexpr char kUrl[] = "udpm://239.255.76.67:7667?ttl=0";
  static constexpr std::int64_t kSession = 1;  // session of the sample log

  void SetUp() override {
    const std::string obstacle = EnterPrivateNetwork(true);
    if (!obstacle.empty()) GTEST_SKIP() << obstacle;
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    std::replace(name.begin(), name.end(), '/', '_');
    folder_ = testing::TempDir() + "airdos_fault_" + name + "/";
    StartAfresh();
  }
  void TearDown() override {
    chain_.reset();
    listener_.reset();
    if (!folder_.empty() && !HasFailure()) std::filesystem::remove_all(folder_);
  }

  /// Starts without running processes or recordings.
  void StartAfresh() {
    chain_.reset();
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_);
    listener_ = std::make_unique<BusListener>(kUrl);
    chain_ = std::make_unique<LiveChain>(folder_, kUrl);
  }

  std::string Write(const std::vector<LogEvent>& events) {
    WriteEvents(events, folder_ + "input.lcm");
    return folder_ + "input.lcm";
  }

  /// Listens until the player has ended and the recorder has finished the frame.
  void HearTheEnd(std::int64_t last_seq, std::int64_t session = kSession) {
    ChildProcess* player = chain_->process("airdos-stereo-player");
    EXPECT_TRUE(listener_->HearUntil([&] { return player->HasEnded(); }, LiveChain::kRun_s));
    EXPECT_EQ(player->Wait(0), 0) << player->Errors();
    const auto is_done = [&] {
      return listener_->IsDone("airdos-map-recorder", {session, last_seq});
    };
    EXPECT_TRUE(listener_->HearUntil(is_done, LiveChain::kRun_s))
        << "newest estimate of " << listener_->states().size() << "\n"
        << chain_->AllErrors();
  }

  /// Distance (m) of a frame's estimate from the true camera position; in W, not aligned.
  double Error_m(std::int64_t seq, std::int64_t session = kSession) const {
    static const std::map<std::int64_t, Se3> truth = SampleTruth();
    const state_estimate_t& state = listener_->states().at({session, seq});
    const Eigen::Vector3d p_W(state.position_W_C[0], state.position_W_C[1], state.position_W_C[2]);
    return (p_W - truth.at(seq).translation).norm();
  }
  /// The largest error of the frames `first` to `last` that have an estimate.
  double WorstError_m(std::int64_t first, std::int64_t last) const {
    double worst_m = 0;
    for (std::int64_t seq = first; seq <= last; ++seq) {
      if (listener_->states().count({kSession, seq}) > 0) worst_m = std::max(worst_m, Error_m(seq));
    }
    return worst_m;
  }

  /// Counters of a channel in the last STATUS of a process, which it also sends when it stops.
  channel_status_t Counters(const std::string& program, const std::string& channel) const {
    const process_status_t& status = listener_->statuses().at(program);
    for (const channel_status_t& counters : status.channels) {
      if (counters.channel == channel) return counters;
    }
    ADD_FAILURE() << program << " does not hear " << channel;
    return {};
  }
  void StopAndHear() {
    chain_->StopNodes();
    listener_->Hear();
  }

  std::string folder_;
  std::unique_ptr<BusListener> listener_;
  std::unique_ptr<LiveChain> chain_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_FAULT_FIXTURE_H_
