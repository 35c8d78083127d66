// In which order frames are completed at the end of the input, on both kinds of bus.
#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <vector>

#include "processes/node/bus/fifo_bus.h"
#include "processes/node/bus/parallel_bus.h"
#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

std::string Shown(const Envelope& message) {
  frame_done_t text;
  EXPECT_TRUE(Decode(message.payload.data(), message.payload.size(), &text));
  return message.channel + std::to_string(text.seq);
}

using Strings = std::vector<std::string>;

struct Wiring {
  std::string name;  // of the node; it publishes on OUT_name
  Strings inputs;
};

/// What the observers see of the nodes once the messages came and no more do.
Strings SeenAtTheEnd(Bus* bus, const std::vector<Wiring>& wirings,
                     const std::vector<std::vector<Envelope>>& frames) {
  std::vector<std::unique_ptr<TextNode>> nodes;
  for (const Wiring& wiring : wirings) {
    const std::string output = "OUT_" + wiring.name;
    nodes.push_back(std::make_unique<TextNode>(wiring.name, wiring.inputs, output));
    bus->AddNode(nodes.back().get(), {output});
  }
  Strings seen;
  bus->AddObserver([&seen](const Envelope& message) {
    if (message.channel[0] == 'O') seen.push_back(Shown(message));
  });
  for (const std::vector<Envelope>& frame : frames) bus->PublishFrame(frame);
  bus->Finish();
  return seen;
}

void ExpectSeen(const std::vector<Wiring>& wirings,
                const std::vector<std::vector<Envelope>>& frames, const Strings& expected) {
  FifoBus serial;
  EXPECT_EQ(SeenAtTheEnd(&serial, wirings, frames), expected);
  ParallelBus parallel;
  EXPECT_EQ(SeenAtTheEnd(&parallel, wirings, frames), expected);
}

TEST(BusOrder, OfNodesThatWaitForNobodyTheFirstByNameComesFirst) {
  for (const Strings& names : {Strings{"a", "b", "c"}, {"c", "a", "b"}, {"b", "c", "a"}}) {
    std::vector<Wiring> wirings;
    std::vector<std::vector<Envelope>> frames(2);
    for (const std::string& name : names) {
      wirings.push_back({name, {"IN_" + name, "NEVER_" + name}});
      for (int seq = 0; seq < 2; ++seq)
        frames[static_cast<std::size_t>(seq)].push_back(TextEnvelope("IN_" + name, seq, "x"));
    }
    ExpectSeen(wirings, frames, {"OUT_a0", "OUT_a1", "OUT_b0", "OUT_b1", "OUT_c0", "OUT_c1"});
  }
}

// What a node lacks may come from one that has nothing yet, but will once a third is completed.
TEST(BusOrder, WhoWaitsForAnotherOverAThirdComesAfterIt) {
  ExpectSeen({{"a", {"IN_a", "OUT_b"}}, {"b", {"OUT_c"}}, {"c", {"IN_c", "NEVER_c"}}},
             {{TextEnvelope("IN_a", 0, "x"), TextEnvelope("IN_c", 0, "x")}},
             {"OUT_c0", "OUT_b0", "OUT_a0"});
}

}  // namespace
}  // namespace airdos
