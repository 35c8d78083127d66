#include "tests/support/two_hosts.h"

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "processes/node/message/channels.h"
#include "tests/support/live_chain.h"

// The processes spread over two hosts: player and frontend on A, human tracker, optimizer and
// recorder on B.

namespace airdos {
namespace {

const std::string kUrl = "udpm://239.255.76.67:7667?ttl=1";
constexpr std::int64_t kSession = 1;  // of the sample log

class TwoHostsTest : public testing::Test {
 protected:
  void SetUp() override {
    std::string name = testing::UnitTest::GetInstance()->current_test_info()->name();
    for (char& c : name) c = c == '/' ? '_' : c;
    folder_ = testing::TempDir() + "airdos_two_hosts_" + name + "/";
    std::filesystem::remove_all(folder_);
    std::filesystem::create_directories(folder_ + "a");
    std::filesystem::create_directories(folder_ + "b");
  }
  void TearDown() override {
    a_.reset();
    b_.reset();
    link_.reset();
    if (!HasFailure()) std::filesystem::remove_all(folder_);
  }

  void Connect(TwoHosts::Link link) {
    hosts_ = std::make_unique<TwoHosts>(link, folder_);
    if (!hosts_->obstacle().empty()) GTEST_SKIP() << hosts_->obstacle();
  }

  /// Plays images 0 to `last` and stops the processes once the recorder has (nearly) all.
  void Run(std::int64_t last, const std::string& rate, const std::string& deadline_s) {
    heard_on_a_ = std::make_unique<BusListener>(kUrl);
    hosts_->OnB([this] { heard_on_b_ = std::make_unique<BusListener>(kUrl); });
    a_ = std::make_unique<LiveChain>(folder_ + "a/", kUrl);
    b_ = std::make_unique<LiveChain>(folder_ + "b/", kUrl);
    b_->SetLauncher(hosts_->launcher_on_b());
    for (LiveChain* chain : {a_.get(), b_.get()}) {
      chain->SetNodeArguments({"--deadline-s", deadline_s});
    }
    ASSERT_NO_FATAL_FAILURE(a_->StartNode("airdos-frontend"));
    for (const char* program : {"airdos-human-tracker", "airdos-optimizer", "airdos-map-recorder"})
      ASSERT_NO_FATAL_FAILURE(b_->StartNode(program));
    WriteEvents(SampleEvents(0, last), folder_ + "input.lcm");
    ChildProcess* player =
        a_->StartPlayer(folder_ + "input.lcm", {"--pace", "realtime", "--speed", rate});
    const auto is_recorded = [&] {
      heard_on_a_->Hear();
      const bool is_all = heard_on_b_->IsDone("airdos-map-recorder", {kSession, last});
      return player->HasEnded() && is_all;
    };
    EXPECT_TRUE(heard_on_b_->HearUntil(is_recorded, LiveChain::kRun_s))
        << a_->AllErrors() << b_->AllErrors();
    EXPECT_EQ(player->Wait(0), 0) << player->Errors();
    a_->StopNodes();
    b_->StopNodes();
    heard_on_a_->Hear();
    heard_on_b_->Hear();
  }

  /// Messages that the processes say they missed, on channels that cross the link.
  std::int64_t NumMissing() {
    std::int64_t sum = 0;
    for (const char* name : {channel::kHumanObservations, channel::kMapUpdate})
      sum += a_->NumMissing("airdos-frontend", name);
    for (const char* name : {channel::kCameraLeft, channel::kCameraRight,
                             channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight}) {
      sum += b_->NumMissing("airdos-human-tracker", name);
    }
    return sum + b_->NumMissing("airdos-optimizer", channel::kStaticFeatures);
  }
  double Error_m(std::int64_t seq) const {
    const state_estimate_t& state = heard_on_b_->states().at({kSession, seq});
    const Eigen::Vector3d p_W(state.position_W_C[0], state.position_W_C[1], state.position_W_C[2]);
    return (p_W - SampleTruth().at(seq).translation).norm();
  }

  std::string folder_;
  std::unique_ptr<TwoHosts> hosts_;
  std::unique_ptr<BusListener> heard_on_a_;
  std::unique_ptr<BusListener> heard_on_b_;
  std::unique_ptr<LiveChain> a_;
  std::unique_ptr<LiveChain> b_;
  std::unique_ptr<ChildProcess> link_;
};

// A good cable, 30 stereo images a second. Lost: nothing; the bytes are those of one process.
TEST_F(TwoHostsTest, SayWhatOneProcessSays) {
  Connect(TwoHosts::Link::kCable);
  if (IsSkipped()) return;
  ASSERT_NO_FATAL_FAILURE(Run(24, "3", "200"));
  EXPECT_EQ(NumMissing(), 0);
  const std::string expected = ReplayDigests(folder_ + "input.lcm", folder_);
  EXPECT_EQ(heard_on_a_->digests(), expected);
  EXPECT_EQ(heard_on_b_->digests(), expected);
}

/// Lost messages that somebody must miss. Of the last two frames nobody needs MAP_UPDATE.
std::int64_t NumLost(const std::string& said, std::int64_t last) {
  std::istringstream lines(said);
  std::string line;
  std::int64_t num_lost = 0;
  while (std::getline(lines, line)) {
    std::istringstream words(line);
    std::string lost, name;
    std::int64_t seq = 0;
    if (!(words >> lost >> name >> seq) || lost != "lost") continue;
    const bool is_update = name == channel::kMapUpdate && seq <= last - 2;
    const bool is_needed = name == channel::kCameraLeft || name == channel::kCameraRight ||
                           name == channel::kPersonKeypointsLeft ||
                           name == channel::kPersonKeypointsRight ||
                           name == channel::kStaticFeatures || name == channel::kHumanObservations;
    num_lost += is_update || is_needed ? 1 : 0;
  }
  return num_lost;
}

/// Frames before the first STATIC_FEATURES that arrived: of these nothing is known.
std::size_t NumBlindFrames(const std::string& said) {
  std::size_t seq = 0;
  const auto is_lost = [&] {
    return said.find(std::string("lost ") + channel::kStaticFeatures + " " + std::to_string(seq) +
                     "\n") != std::string::npos;
  };
  while (is_lost()) ++seq;
  return seq;
}

struct Loss {
  int percent;
  int seed;
};
class LossyLinkTest : public TwoHostsTest, public testing::WithParamInterface<Loss> {};

// Datagrams come 20 ms late, and 1 or 10 % of them never (10: as when every 1500-byte packet of a
// large message may be lost, 1 % of them). Lost: these messages, each of them counted by whoever
// needed it. Not lost: the run, the trajectory.
TEST_P(LossyLinkTest, LossIsCountedAndTheTrajectorySurvives) {
  constexpr std::int64_t kLast = 24;
  Connect(TwoHosts::Link::kNothing);
  if (IsSkipped()) return;
  link_ = std::make_unique<ChildProcess>(
      std::vector<std::string>{std::string(AIRDOS_BINARY_DIR) + "/bin/airdos-lossy-link",
                               hosts_->network_of_b(), std::to_string(GetParam().percent), "20",
                               std::to_string(GetParam().seed)},
      folder_ + "link");
  ASSERT_TRUE(WaitUntil([this] { return link_->HasSaid("READY"); }, LiveChain::kStart_s))
      << link_->Errors();
  ASSERT_NO_FATAL_FAILURE(Run(kLast, "1", "1"));
  const std::int64_t num_lost = NumLost(link_->Output(), kLast);
  std::printf("lost on the link: %d, missed: %d, error at the end: %.3f m\n",
              static_cast<int>(num_lost), static_cast<int>(NumMissing()), Error_m(kLast));
  EXPECT_GT(num_lost, 0);
  EXPECT_GE(NumMissing(), num_lost);
  EXPECT_EQ(heard_on_b_->states().size() + NumBlindFrames(link_->Output()),
            static_cast<std::size_t>(kLast + 1));
  EXPECT_LT(Error_m(kLast), 0.3);
}
INSTANTIATE_TEST_SUITE_P(Percent, LossyLinkTest,
                         testing::Values(Loss{1, 3}, Loss{10, 1}, Loss{10, 2}, Loss{10, 3}),
                         [](const auto& instance) {
                           return std::to_string(instance.param.percent) + "_seed_" +
                                  std::to_string(instance.param.seed);
                         });

// The same through the kernel's netem, where it has that.
TEST_F(TwoHostsTest, SurviveNetem) {
  constexpr std::int64_t kLast = 24;
  Connect(TwoHosts::Link::kCable);
  if (IsSkipped()) return;
  for (const bool is_on_b : {false, true}) {
    const std::string interface = is_on_b ? "veth_b" : "veth_a";
    const std::string failure =
        hosts_->Shell("tc qdisc add dev " + interface + " root netem loss 1% delay 20ms", is_on_b);
    if (!failure.empty()) GTEST_SKIP() << "this kernel has no netem: " << failure;
  }
  ASSERT_NO_FATAL_FAILURE(Run(kLast, "1", "1"));
  EXPECT_GT(NumMissing(), 0);
  EXPECT_EQ(heard_on_b_->states().size(), static_cast<std::size_t>(kLast + 1));
  EXPECT_LT(Error_m(kLast), 0.3);
}

}  // namespace
}  // namespace airdos
