#include "processes/node/frame_joiner.h"

#include <gtest/gtest.h>

#include <random>
#include <string>
#include <vector>

namespace airdos {
namespace {

using Arrival = FrameJoiner::Arrival;

Header At(std::int64_t seq, std::int64_t session = 7) { return {1000 * seq, seq, session}; }

Arrival Add(FrameJoiner* joiner, int input, std::int64_t seq, std::int64_t session = 7) {
  FrameJoiner::Key key;
  return joiner->Add(input, At(seq, session), &key);
}

/// The next frame in work, as "seq" and "seq-" with the missing inputs; empty if none is settled.
std::string Work(FrameJoiner* joiner) {
  const auto frame = joiner->Oldest();
  if (!frame || !frame->settled) return "";
  std::string text = std::to_string(frame->header.session) + "/" + std::to_string(frame->key.seq);
  for (const int input : frame->missing) text += "-" + std::to_string(input);
  std::int64_t num_skipped = 0;
  joiner->FinishOldest(&num_skipped);
  return text + " ";
}

TEST(FrameJoinerTest, WaitsForAllInputs) {
  FrameJoiner joiner(2, 0);
  EXPECT_EQ(Add(&joiner, 0, 0), Arrival::kNew);
  EXPECT_EQ(Work(&joiner), "");
  EXPECT_EQ(joiner.Oldest()->missing, std::vector<int>{1});
  EXPECT_EQ(Add(&joiner, 1, 0), Arrival::kNew);
  EXPECT_EQ(Work(&joiner), "7/0 ");
  EXPECT_FALSE(joiner.Oldest());
}

TEST(FrameJoinerTest, CountsImageNumbersThatNeverCame) {
  FrameJoiner joiner(1, 0);
  std::int64_t num_skipped = -1;
  Add(&joiner, 0, 3);
  joiner.FinishOldest(&num_skipped);
  EXPECT_EQ(num_skipped, 0);
  Add(&joiner, 0, 7);
  joiner.FinishOldest(&num_skipped);
  EXPECT_EQ(num_skipped, 3);
  Add(&joiner, 0, 0, 8);
  joiner.FinishOldest(&num_skipped);
  EXPECT_EQ(num_skipped, 0);
}

TEST(FrameJoinerTest, ADuplicateIsToldFromALateMessage) {
  FrameJoiner joiner(2, 0);
  EXPECT_EQ(Add(&joiner, 0, 5), Arrival::kNew);
  EXPECT_EQ(Add(&joiner, 0, 5), Arrival::kDuplicate);
  EXPECT_EQ(Add(&joiner, 0, 4), Arrival::kLate);
}

TEST(FrameJoinerTest, AnOvertakenInputIsGivenUp) {
  FrameJoiner joiner(2, 0);
  Add(&joiner, 0, 1);
  Add(&joiner, 0, 2);
  Add(&joiner, 1, 2);
  EXPECT_EQ(Work(&joiner), "7/1-1 ");
  EXPECT_EQ(Work(&joiner), "7/2 ");
}

TEST(FrameJoinerTest, TheReorderWindowDelaysGivingUp) {
  FrameJoiner joiner(2, 1);
  Add(&joiner, 0, 0);
  Add(&joiner, 1, 1);
  EXPECT_EQ(Work(&joiner), "") << "0 may still come on input 1";
  EXPECT_EQ(Add(&joiner, 1, 0), Arrival::kNew);
  EXPECT_EQ(Work(&joiner), "7/0 ");
  Add(&joiner, 1, 3);
  EXPECT_EQ(Add(&joiner, 1, 1), Arrival::kLate) << "beyond the window";
}

TEST(FrameJoinerTest, WithAWindowAFrameWaitsForOneThatMayComeBeforeIt) {
  FrameJoiner joiner(1, 1);
  Add(&joiner, 0, 0);
  EXPECT_EQ(Work(&joiner), "7/0 ");
  Add(&joiner, 0, 2);
  EXPECT_EQ(Work(&joiner), "") << "1 may still come";
  Add(&joiner, 0, 1);
  EXPECT_EQ(Work(&joiner), "7/1 ");
  EXPECT_EQ(Work(&joiner), "7/2 ");
}

TEST(FrameJoinerTest, ANewSessionSettlesTheOldOneAndStartsOver) {
  FrameJoiner joiner(2, 0);
  Add(&joiner, 0, 8);
  Add(&joiner, 0, 0, 3);  // a smaller session number is not an older session
  EXPECT_EQ(Work(&joiner), "");
  Add(&joiner, 1, 0, 3);
  EXPECT_EQ(Work(&joiner), "7/8-1 ");
  EXPECT_EQ(Work(&joiner), "3/0 ");
  EXPECT_EQ(Add(&joiner, 0, 9), Arrival::kLate) << "the channel is in the new session";
}

TEST(FrameJoinerTest, WhereAChannelHasSessionsInAnotherOrderItLosesOne) {
  FrameJoiner joiner(2, 0);
  Add(&joiner, 0, 0, 5);
  Add(&joiner, 0, 0, 6);
  EXPECT_EQ(Add(&joiner, 1, 0, 6), Arrival::kNew);
  EXPECT_EQ(Add(&joiner, 1, 0, 5), Arrival::kLate);
  EXPECT_EQ(Work(&joiner), "5/0-1 ");
  EXPECT_EQ(Work(&joiner), "6/0 ");
}

TEST(FrameJoinerTest, SessionsAreForgottenAfterAThousandOthers) {
  FrameJoiner joiner(1, 0);
  for (std::int64_t session = 1000; session < 4000; ++session) {
    Add(&joiner, 0, 0, session);
    Work(&joiner);
  }
  EXPECT_EQ(joiner.num_sessions_known(), FrameJoiner::kMaxSessions);
  EXPECT_EQ(Add(&joiner, 0, 1, 3000), Arrival::kLate) << "one of the last thousand";
  EXPECT_EQ(Add(&joiner, 0, 1, 2999), Arrival::kNew) << "as if it had never been there";
}

TEST(FrameJoinerTest, AMessageItsChannelOvertookIsLateHoweverFarTheOthersAre) {
  FrameJoiner behind(2, 0);
  Add(&behind, 0, 0);
  Add(&behind, 0, 2);
  EXPECT_EQ(Add(&behind, 0, 1), Arrival::kLate);
}

TEST(FrameJoinerTest, ANonsensicalNumberDoesNotMakeAllThatFollowsLate) {
  FrameJoiner joiner(1, 0);
  Add(&joiner, 0, 5);
  EXPECT_EQ(Add(&joiner, 0, 6 + FrameJoiner::kMaxAhead), Arrival::kTooFar);
  EXPECT_EQ(Add(&joiner, 0, 6), Arrival::kNew);
}

TEST(FrameJoinerTest, AnAnnouncedInputOvertakesButDoesNotArrive) {
  FrameJoiner joiner(2, 0);
  FrameJoiner::Key key;
  Add(&joiner, 0, 0);
  Add(&joiner, 0, 1);
  EXPECT_EQ(joiner.Announce(1, At(1), &key), Arrival::kNew);
  EXPECT_EQ(Work(&joiner), "7/0-1 ");
  EXPECT_EQ(Work(&joiner), "");
  EXPECT_EQ(Add(&joiner, 1, 1), Arrival::kNew);
  EXPECT_EQ(joiner.Announce(1, At(1), &key), Arrival::kDuplicate);
  EXPECT_EQ(Work(&joiner), "7/1 ");
}

TEST(FrameJoinerTest, NewestCompleteLooksPastIncompleteFrames) {
  FrameJoiner joiner(2, 0);
  EXPECT_FALSE(joiner.NewestComplete());
  for (const std::int64_t seq : {0, 1}) {
    Add(&joiner, 0, seq);
    Add(&joiner, 1, seq);
  }
  Add(&joiner, 0, 2);
  EXPECT_EQ(joiner.NewestComplete()->seq, 1);
}

/// Messages of one channel: losses, duplicates, swaps, two sessions.
std::vector<Header> DamagedChannel(std::mt19937* random) {
  std::vector<Header> messages;
  for (const std::int64_t session : {50, 20}) {
    messages.push_back(At(0, session));  // sessions appear on every channel, in the same order
    for (std::int64_t seq = 1; seq < 30; ++seq) {
      const auto dice = (*random)() % 10;
      if (dice == 0) continue;
      messages.push_back(At(seq, session));
      if (dice == 1) messages.push_back(messages.back());
      if (dice == 2 && seq > 3) messages.push_back(At(seq - 3, session));
      if (dice == 3 && messages[messages.size() - 2].session == session) {
        std::swap(messages[messages.size() - 1], messages[messages.size() - 2]);
      }
    }
  }
  return messages;
}

/// Interleaves the channels at random, each in its own order, and works whenever it can.
std::string RunInterleaved(const std::vector<std::vector<Header>>& channels, int reorder_window,
                           std::mt19937* random) {
  FrameJoiner joiner(static_cast<int>(channels.size()), reorder_window);
  std::vector<std::size_t> next(channels.size(), 0);
  std::string text;
  std::size_t num_left = 0;
  for (const auto& channel : channels) num_left += channel.size();
  while (num_left > 0) {
    const std::size_t input = (*random)() % channels.size();
    if (next[input] == channels[input].size()) continue;
    FrameJoiner::Key key;
    joiner.Add(static_cast<int>(input), channels[input][next[input]++], &key);
    --num_left;
    if ((*random)() % 3 == 0) continue;  // busy
    for (std::string frame = Work(&joiner); !frame.empty(); frame = Work(&joiner)) text += frame;
  }
  for (std::string frame = Work(&joiner); !frame.empty(); frame = Work(&joiner)) text += frame;
  return text;
}

TEST(FrameJoinerTest, TheInterleavingOfChannelsChangesNothing) {
  for (const int reorder_window : {0, 1, 2}) {
    for (unsigned seed = 0; seed < 20; ++seed) {
      std::mt19937 random(seed);
      std::vector<std::vector<Header>> channels;
      for (int i = 0; i < 3; ++i) channels.push_back(DamagedChannel(&random));
      const std::string reference = RunInterleaved(channels, reorder_window, &random);
      EXPECT_GT(reference.size(), 200u);
      for (int run = 0; run < 20; ++run) {
        ASSERT_EQ(RunInterleaved(channels, reorder_window, &random), reference)
            << "seed " << seed << " window " << reorder_window;
      }
    }
  }
}

}  // namespace
}  // namespace airdos
