#include "processes/node/bus/fifo_bus.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

using Traffic = std::map<std::string, std::vector<std::vector<std::uint8_t>>>;

// The shape of the real chain: two nodes see the images, a third joins them and feeds back to the
// first, a fourth listens.
std::vector<std::unique_ptr<TextNode>> MakeChain() {
  std::vector<std::unique_ptr<TextNode>> nodes;
  nodes.push_back(std::make_unique<TextNode>("front", std::vector<std::string>{"IMAGE", "MASK"},
                                             "FEATURES", "POSE"));
  nodes.push_back(
      std::make_unique<TextNode>("people", std::vector<std::string>{"IMAGE", "KEYS"}, "PEOPLE"));
  nodes.push_back(std::make_unique<TextNode>(
      "a_solver", std::vector<std::string>{"FEATURES", "PEOPLE"}, "POSE"));
  nodes.push_back(
      std::make_unique<TextNode>("a_listener", std::vector<std::string>{"POSE"}, "MAP"));
  return nodes;
}

// What the last node of the chain makes of the first frame.
constexpr char kMapOfFrame0[] =
    "a_listener(a_solver(front(IMAGE0,MASK0,back -),people(IMAGE0,KEYS0,),),-,)";

std::string TextOf(const std::vector<std::uint8_t>& payload) {
  frame_done_t message;
  EXPECT_TRUE(Decode(payload.data(), payload.size(), &message));
  return message.process;
}

// Runs the chain with its nodes in the given order over the messages.
Traffic RunChain(const std::vector<Envelope>& messages, const std::vector<int>& order) {
  const auto nodes = MakeChain();
  FifoBus bus;
  const std::vector<std::string> outputs{"FEATURES", "PEOPLE", "POSE", "MAP"};
  for (const int i : order) {
    const auto slot = static_cast<std::size_t>(i);
    bus.AddNode(nodes[slot].get(), {outputs[slot]});
  }
  Traffic traffic;
  bus.AddObserver([&](const Envelope& m) { traffic[m.channel].push_back(m.payload); });
  for (const Envelope& message : messages) bus.Publish(message);
  bus.Finish();
  for (const auto& node : nodes) EXPECT_EQ(node->num_pending(), 0u) << node->name();
  return traffic;
}

std::vector<Envelope> WholeInput(int num_frames) {
  std::vector<Envelope> messages;
  for (int seq = 0; seq < num_frames; ++seq) {
    for (const std::string channel : {"IMAGE", "KEYS", "MASK"})
      messages.push_back(TextEnvelope(channel, seq, channel + std::to_string(seq)));
  }
  return messages;
}

// Drops some of the messages, among them those of the last frames.
std::vector<Envelope> PatchyInput(int num_frames) {
  std::vector<Envelope> messages = WholeInput(num_frames);
  std::vector<Envelope> patchy;
  for (std::size_t i = 0; i < messages.size(); ++i) {
    const bool is_tail = i + 12 >= messages.size();
    if (i % 7 == 3 || (is_tail && i % 3 != 0)) continue;
    patchy.push_back(messages[i]);
  }
  return patchy;
}

TEST(FifoBusTest, DeliversBreadthFirst) {
  TextNode left("left", {"IN"}, "LEFT");
  TextNode right("right", {"IN"}, "RIGHT");
  TextNode deep("deep", {"LEFT"}, "DEEP");
  FifoBus bus;
  for (TextNode* node : {&left, &deep, &right}) bus.AddNode(node);
  std::vector<std::string> channels;
  bus.AddObserver([&](const Envelope& m) { channels.push_back(m.channel); });
  bus.Publish(TextEnvelope("IN", 0, "x"));
  EXPECT_EQ(channels, (std::vector<std::string>{"IN", "LEFT", "RIGHT", "DEEP"}));
}

TEST(FifoBusTest, FeedbackOfTheRightFrameReachesTheLoop) {
  const Traffic traffic = RunChain(WholeInput(6), {0, 1, 2, 3});
  ASSERT_EQ(traffic.at("FEATURES").size(), 6u);
  ASSERT_EQ(traffic.at("MAP").size(), 6u);
  for (std::size_t seq = 0; seq < 6; ++seq) {
    const std::string back =
        seq < 2 ? "-" : std::to_string(TextOf(traffic.at("POSE")[seq - 2]).size());
    const std::string number = std::to_string(seq);
    EXPECT_EQ(TextOf(traffic.at("FEATURES")[seq]),
              "front(IMAGE" + number + ",MASK" + number + ",back " + back + ")");
  }
}

TEST(FifoBusTest, OrderOfNodesDoesNotChangeWhatChannelsCarry) {
  for (const auto& input : {WholeInput(20), PatchyInput(20), PatchyInput(3)}) {
    std::vector<int> order{0, 1, 2, 3};
    const Traffic reference = RunChain(input, order);
    if (input.size() == 60) {  // nothing was left out
      EXPECT_EQ(TextOf(reference.at("MAP")[0]), kMapOfFrame0);
    }
    EXPECT_GE(reference.size(), 5u);
    while (std::next_permutation(order.begin(), order.end())) {
      EXPECT_EQ(RunChain(input, order), reference)
          << "order " << order[0] << order[1] << order[2] << order[3];
    }
  }
}

TEST(FifoBusTest, InterleavingOfChannelsDoesNotChangeWhatTheyCarry) {
  const std::vector<Envelope> input = WholeInput(20);
  const Traffic reference = RunChain(input, {0, 1, 2, 3});
  EXPECT_EQ(reference.at("MAP").size(), 20u);
  EXPECT_EQ(TextOf(reference.at("MAP")[0]), kMapOfFrame0);
  std::vector<Envelope> by_channel = input;
  std::stable_sort(by_channel.begin(), by_channel.end(),
                   [](const Envelope& a, const Envelope& b) { return a.channel < b.channel; });
  EXPECT_EQ(RunChain(by_channel, {0, 1, 2, 3}), reference);
}

TEST(FifoBusTest, FinishCompletesUpstreamFirst) {
  // The last frame lacks its mask and its keypoints: the solver must still see both outputs.
  std::vector<Envelope> input = WholeInput(5);
  input.resize(input.size() - 2);
  const Traffic traffic = RunChain(input, {3, 2, 1, 0});
  ASSERT_EQ(traffic.at("POSE").size(), 5u);
  const std::string features = TextOf(traffic.at("FEATURES")[4]);
  const std::string people = TextOf(traffic.at("PEOPLE")[4]);
  EXPECT_NE(features.find("IMAGE4,-,"), std::string::npos) << features;
  EXPECT_NE(people.find("IMAGE4,-,"), std::string::npos) << people;
  EXPECT_EQ(TextOf(traffic.at("POSE")[4]), "a_solver(" + features + "," + people + ",)");
}

TEST(FifoBusTest, FinishEndsWhereNodesWaitForEachOther) {
  TextNode a("a", {"IN", "FROM_B"}, "FROM_A");
  TextNode b("b", {"IN", "FROM_A"}, "FROM_B");
  FifoBus bus;
  bus.AddNode(&b);
  bus.AddNode(&a);
  int num_outputs = 0;
  bus.AddObserver([&](const Envelope& m) { num_outputs += m.channel != "IN" ? 1 : 0; });
  for (int seq = 0; seq < 4; ++seq) bus.Publish(TextEnvelope("IN", seq, "x"));
  EXPECT_EQ(num_outputs, 0);
  bus.Finish();
  EXPECT_EQ(num_outputs, 8);
}

TEST(FifoBusTest, BadBytesAreCountedAndPassedOver) {
  TextNode node("node", {"IN"}, "OUT");
  FifoBus bus;
  bus.AddNode(&node);
  int num_outputs = 0;
  bus.AddObserver([&](const Envelope& m) { num_outputs += m.channel == "OUT" ? 1 : 0; });
  bus.Publish({"IN", {1, 2, 3}});
  bus.Publish({"IN", {}});
  bus.Publish(TextEnvelope("IN", 0, "x"));
  bus.Finish();
  EXPECT_EQ(num_outputs, 1);
  EXPECT_EQ(node.channels().at("IN").num_rejected, 2);
}

}  // namespace
}  // namespace airdos
