#include "processes/node/bus/parallel_bus.h"

#include <gtest/gtest.h>

#include <atomic>
#include <functional>
#include <memory>
#include <random>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "common/util/error.h"
#include "processes/node/bus/fifo_bus.h"
#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

using Frames = std::vector<std::vector<Envelope>>;

/// Takes a random while for each frame, so that threads overtake each other in every way.
class SlowNode : public TextNode {
 public:
  template <class... Arguments>
  explicit SlowNode(std::uint64_t seed, Arguments&&... arguments)
      : TextNode(std::forward<Arguments>(arguments)...), random_(seed) {}

 protected:
  void ProcessFrame(const Header& header, TextInputs inputs) override {
    const std::uint64_t num_turns = random_() % 4 == 0 ? random_() % 20000 : 0;
    for (std::uint64_t i = 0; i < num_turns; ++i) ++turns_;
    TextNode::ProcessFrame(header, std::move(inputs));
  }

 private:
  std::mt19937_64 random_;
  std::atomic<std::uint64_t> turns_{0};
};

/// As exacting about its feedback as the front end: it is rejected outside of its time, and a frame
/// that had to start without it tells the next ones not to wait.
class FrontNode : public SlowNode {
 public:
  explicit FrontNode(std::uint64_t seed)
      : SlowNode(seed, "front", std::vector<std::string>{"PEOPLE", "MASK"}, "FEATURES") {
    Subscribe<frame_done_t>("POSE", [this](frame_done_t&& message) -> std::string {
      if (message.session != session_) return "of another session";
      if (message.seq < before_last_seq_) return "too late";
      newest_ = message.seq;
      is_silent_ = false;
      return "";
    });
  }

 protected:
  std::vector<std::string> MissingFeedback(const Header& header) const override {
    if (header.session != session_ || is_silent_ || !LacksFeedback()) return {};
    return {"POSE"};
  }
  void StartSession(const Header& header) override {
    session_ = header.session;
    num_frames_ = 0;
    before_last_seq_ = last_seq_ = newest_ = -1;
    is_silent_ = false;
  }
  void ProcessFrame(const Header& header, TextInputs inputs) override {
    if (LacksFeedback()) is_silent_ = true;
    const std::string mask = inputs.second ? inputs.second->process : "-";
    inputs.second = TextMessage(header.seq, mask + (is_silent_ ? " silent" : " told"));
    SlowNode::ProcessFrame(header, std::move(inputs));
    before_last_seq_ = last_seq_;
    last_seq_ = header.seq;
    ++num_frames_;
  }

 private:
  bool LacksFeedback() const { return num_frames_ >= 2 && newest_ < before_last_seq_; }

  std::int64_t session_ = 0;
  std::int64_t num_frames_ = 0;
  std::int64_t before_last_seq_ = -1;
  std::int64_t last_seq_ = -1;
  std::int64_t newest_ = -1;
  bool is_silent_ = false;
};

class ThrowingNode : public TextNode {
 public:
  using TextNode::TextNode;

 protected:
  void ProcessFrame(const Header& header, TextInputs inputs) override {
    if (header.seq == 5) throw InputError("disk: full");
    TextNode::ProcessFrame(header, std::move(inputs));
  }
};

using Channels = std::vector<std::string>;

// The shape of the real chain, with the people in the front end's frames as well.
std::vector<std::unique_ptr<Node>> MakeChain(std::uint64_t seed) {
  std::vector<std::unique_ptr<Node>> nodes;
  nodes.push_back(std::make_unique<FrontNode>(seed));
  nodes.push_back(
      std::make_unique<SlowNode>(seed + 1, "people", Channels{"IMAGE", "KEYS"}, "PEOPLE"));
  nodes.push_back(
      std::make_unique<SlowNode>(seed + 2, "solver", Channels{"FEATURES", "PEOPLE"}, "POSE"));
  nodes.push_back(
      std::make_unique<SlowNode>(seed + 3, "a_listener", Channels{"POSE", "TRUTH"}, "MAP"));
  return nodes;
}
const std::vector<std::string> kOutputs{"FEATURES", "PEOPLE", "POSE", "MAP"};

struct Outcome {
  std::vector<std::pair<std::string, std::vector<std::uint8_t>>> traffic;  // in the order seen
  std::vector<std::tuple<std::string, std::int64_t, std::int64_t, std::int64_t, std::int64_t>>
      counters;
  std::vector<std::int64_t> frames;
};

Outcome RunBus(Bus* bus, const std::vector<std::unique_ptr<Node>>& nodes, const Frames& input) {
  Outcome outcome;
  for (std::size_t i = 0; i < nodes.size(); ++i) bus->AddNode(nodes[i].get(), {kOutputs[i]});
  bus->AddObserver([&](const Envelope& m) { outcome.traffic.emplace_back(m.channel, m.payload); });
  for (const std::vector<Envelope>& frame : input) bus->PublishFrame(frame);
  bus->Finish();
  for (const auto& node : nodes) {
    EXPECT_EQ(node->num_pending(), 0u) << node->name();
    for (const auto& [channel, seen] : node->channels()) {
      outcome.counters.emplace_back(node->name() + " " + channel, seen.num_received,
                                    seen.num_missing, seen.num_duplicate, seen.num_rejected);
    }
    outcome.frames.push_back(node->frames().num_done);
    outcome.frames.push_back(node->frames().num_incomplete);
  }
  return outcome;
}

// What may happen to a message, in parts of a thousand.
struct Mishaps {
  unsigned lost = 0;
  unsigned twice = 0;
  unsigned corrupt = 0;
  unsigned late = 0;         // comes a frame later
  unsigned new_session = 0;  // of a frame
};

Frames MakeInput(int num_frames, const Mishaps& mishaps, std::uint64_t seed) {
  std::mt19937_64 random(seed);
  const auto happens = [&](unsigned thousandth) { return random() % 1000 < thousandth; };
  Frames frames;
  std::vector<Envelope> late;
  std::int64_t session = 7;
  std::int64_t seq = 0;
  for (int i = 0; i < num_frames; ++i, ++seq) {
    if (happens(mishaps.new_session)) {
      ++session;
      seq = static_cast<std::int64_t>(random() % 3);
      late.clear();
    }
    std::vector<Envelope> frame = std::exchange(late, {});
    for (const std::string channel : {"IMAGE", "KEYS", "TRUTH", "MASK"}) {
      Envelope message = TextEnvelope(channel, seq, channel + std::to_string(i), session);
      if (happens(mishaps.lost)) continue;
      if (happens(mishaps.corrupt)) message.payload.resize(message.payload.size() - 1);
      (happens(mishaps.late) ? late : frame).push_back(message);
      if (happens(mishaps.twice)) frame.push_back(message);
    }
    if (!frame.empty()) frames.push_back(frame);
  }
  return frames;
}

void ExpectSameAsFifo(const Frames& input, std::uint64_t seed) {
  FifoBus fifo;
  const auto fifo_nodes = MakeChain(seed);
  const Outcome expected = RunBus(&fifo, fifo_nodes, input);
  const auto nodes = MakeChain(seed);  // outlive the bus
  ParallelBus parallel;
  const Outcome got = RunBus(&parallel, nodes, input);
  ASSERT_EQ(got.traffic.size(), expected.traffic.size()) << "seed " << seed;
  for (std::size_t i = 0; i < expected.traffic.size(); ++i) {
    ASSERT_EQ(got.traffic[i], expected.traffic[i])
        << "seed " << seed << " message " << i << ": " << got.traffic[i].first << " instead of "
        << expected.traffic[i].first;
  }
  EXPECT_EQ(got.counters, expected.counters) << "seed " << seed;
  EXPECT_EQ(got.frames, expected.frames) << "seed " << seed;
}

TEST(ParallelBusTest, CarriesWhatFifoBusCarriesInItsOrder) {
  for (std::uint64_t seed = 0; seed < 20; ++seed) ExpectSameAsFifo(MakeInput(100, {}, seed), seed);
}

TEST(ParallelBusTest, WithMessagesLostDoubledCorruptAndLate) {
  for (std::uint64_t seed = 0; seed < 40; ++seed) {
    Mishaps mishaps;
    if (seed % 2 == 0) mishaps.lost = 100;
    if (seed % 3 == 0) mishaps.twice = 100;
    if (seed % 5 < 2) mishaps.corrupt = 50;
    if (seed % 7 < 3) mishaps.late = 100;
    if (seed % 4 < 2) mishaps.new_session = 60;
    ExpectSameAsFifo(MakeInput(100, mishaps, seed), seed);
  }
}

TEST(ParallelBusTest, WhereAChannelFallsSilentForLong) {
  for (const std::string silent : {"MASK", "KEYS"}) {
    Frames input = MakeInput(1300, {}, 1);
    for (std::size_t i = 10; i < 1200; ++i) {
      std::vector<Envelope> rest;
      for (const Envelope& message : input[i]) {
        if (message.channel != silent) rest.push_back(message);
      }
      input[i] = rest;
    }
    SCOPED_TRACE(silent);
    ExpectSameAsFifo(input, 1);
  }
}

TEST(ParallelBusTest, AFrameOfVeryManyMessages) {
  Frames input = MakeInput(100, {}, 3);
  std::vector<Envelope> all;
  for (const auto& frame : input) all.insert(all.end(), frame.begin(), frame.end());
  ExpectSameAsFifo({input[0], input[1], all, input[99]}, 3);
}

TEST(ParallelBusTest, RunsFramesInParallelAndHoldsFew) {
  const auto nodes = MakeChain(1);
  ParallelBus bus;
  const Outcome outcome = RunBus(&bus, nodes, MakeInput(3000, {}, 1));
  EXPECT_EQ(bus.num_stalls(), 0);
  EXPECT_EQ(outcome.frames.front(), 3000);
  // 8 messages a frame; queued once more at each of the up to two nodes that take them.
  EXPECT_LE(bus.max_held(), (ParallelBus::kFramesInFlight + 1) * 8 * 3);
}

TEST(ParallelBusTest, NodesThatWaitForEachOther) {
  const auto run = [](auto bus) {
    TextNode a("a", {"IN", "FROM_B"}, "FROM_A");
    TextNode b("b", {"IN", "FROM_A"}, "FROM_B");
    bus->AddNode(&b, {"FROM_B"});
    bus->AddNode(&a, {"FROM_A"});
    std::string traffic;
    bus->AddObserver([&](const Envelope& message) { traffic += message.channel + " "; });
    for (int seq = 0; seq < 4; ++seq) bus->PublishFrame({TextEnvelope("IN", seq, "x")});
    bus->Finish();
    bus.reset();
    return traffic;
  };
  EXPECT_EQ(run(std::make_unique<ParallelBus>()), run(std::make_unique<FifoBus>()));
}

TEST(ParallelBusTest, AnExceptionOfANodeReachesTheCaller) {
  for (const bool is_last : {false, true}) {
    for (const int num_frames : {6, 100}) {  // at the end and in between
      auto nodes = MakeChain(4);
      if (is_last) {
        nodes.back() = std::make_unique<ThrowingNode>("a_listener", Channels{"POSE"}, "MAP");
      } else {
        nodes.front() =
            std::make_unique<ThrowingNode>("front", Channels{"PEOPLE", "MASK"}, "FEATURES", "POSE");
      }
      ParallelBus bus;
      EXPECT_THROW(RunBus(&bus, nodes, MakeInput(num_frames, {}, 4)), InputError);
    }
  }
}

TEST(ParallelBusTest, AnExceptionOfAnObserverEndsTheRun) {
  const auto nodes = MakeChain(4);
  ParallelBus bus;
  int num_seen = 0;
  bus.AddObserver([&](const Envelope&) {
    if (++num_seen == 50) throw InputError("disk: full");
  });
  EXPECT_THROW(RunBus(&bus, nodes, MakeInput(100, {}, 4)), InputError);
}

TEST(ParallelBusTest, SettleShowsAllThatWasCaused) {
  const auto nodes = MakeChain(2);
  ParallelBus bus;
  for (std::size_t i = 0; i < nodes.size(); ++i) bus.AddNode(nodes[i].get(), {kOutputs[i]});
  std::size_t num_seen = 0;
  bus.AddObserver([&](const Envelope&) { ++num_seen; });
  for (const auto& frame : MakeInput(5, {}, 2)) bus.PublishFrame(frame);
  bus.Settle();
  EXPECT_EQ(num_seen, 40u);
}

}  // namespace
}  // namespace airdos
