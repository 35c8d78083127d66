// Which frame is next and what is never to come, at the limits.
#include <gtest/gtest.h>

#include <cstdint>
#include <tuple>
#include <vector>

#include "processes/node/frame_joiner.h"

namespace airdos {
namespace {

using Arrival = FrameJoiner::Arrival;

Arrival Add(int input, std::int64_t seq, FrameJoiner* joiner, std::int64_t session = 7) {
  FrameJoiner::Key key;
  Header header;
  header.seq = seq;
  header.session = session;
  header.utime = 1000 * seq + session;
  return joiner->Add(input, header, &key);
}

// With room for two, image 5 overtakes 2 (2 + 2 < 5) and not 3; an older one that comes in between
// does not take that back.
TEST(FrameJoinerValues, TheNewestStaysTheNewestWhenAnOlderOneComes) {
  FrameJoiner joiner(1, 2);
  EXPECT_EQ(Add(0, 5, &joiner), Arrival::kNew);
  EXPECT_EQ(Add(0, 4, &joiner), Arrival::kNew);
  EXPECT_EQ(Add(0, 2, &joiner), Arrival::kLate);
  EXPECT_EQ(Add(0, 3, &joiner), Arrival::kNew);
  EXPECT_EQ(Add(0, 3, &joiner), Arrival::kDuplicate);
}

TEST(FrameJoinerValues, AFrameIsSettledOnceNothingOlderCanCome) {
  FrameJoiner joiner(2, 2);
  Add(0, 3, &joiner);
  Add(1, 3, &joiner);
  ASSERT_TRUE(joiner.Oldest());
  EXPECT_TRUE(joiner.Oldest()->missing.empty());
  EXPECT_FALSE(joiner.Oldest()->settled) << "2 may still come";
  Add(0, 4, &joiner);
  Add(1, 4, &joiner);
  EXPECT_FALSE(joiner.Oldest()->settled);
  Add(0, 5, &joiner);
  EXPECT_FALSE(joiner.Oldest()->settled) << "on the other channel";
  Add(1, 5, &joiner);
  EXPECT_TRUE(joiner.Oldest()->settled) << "2 + 2 < 5";
  std::int64_t num_skipped = -1;
  joiner.FinishOldest(&num_skipped);
  EXPECT_EQ(num_skipped, 0) << "before the first nothing is known";
  EXPECT_EQ(joiner.Oldest()->key.seq, 4);
  EXPECT_TRUE(joiner.Oldest()->settled) << "the next of the last";
  EXPECT_EQ(Add(0, 3, &joiner), Arrival::kLate) << "done";
}

TEST(FrameJoinerValues, WhatIsMissingIsAwaitedUntilItIsOvertaken) {
  FrameJoiner joiner(3, 1);
  Add(0, 0, &joiner);
  Add(2, 0, &joiner);
  EXPECT_EQ(joiner.Oldest()->missing, std::vector<int>{1});
  EXPECT_EQ(joiner.Oldest()->awaited, std::vector<int>{1});
  EXPECT_FALSE(joiner.NewestComplete());
  Add(1, 1, &joiner);
  EXPECT_EQ(joiner.Oldest()->awaited, std::vector<int>{1}) << "0 + 1 < 1 is not so";
  Add(1, 2, &joiner);
  EXPECT_EQ(joiner.Oldest()->missing, std::vector<int>{1});
  EXPECT_TRUE(joiner.Oldest()->awaited.empty());
  EXPECT_TRUE(joiner.Oldest()->settled);
  EXPECT_EQ(joiner.Oldest()->header.utime, 7);
  EXPECT_EQ(joiner.Oldest()->header.session, 7);
}

TEST(FrameJoinerValues, SkippedNumbersAreCountedWithinASession) {
  FrameJoiner joiner(1, 0);
  std::int64_t num_skipped = -1;
  for (const auto& [seq, session, expected] :
       {std::tuple<std::int64_t, std::int64_t, std::int64_t>{4, 7, 0},
        {5, 7, 0},
        {9, 7, 3},
        {2, 8, 0},
        {4, 8, 1}}) {
    Add(0, seq, &joiner, session);
    joiner.FinishOldest(&num_skipped);
    EXPECT_EQ(num_skipped, expected) << seq;
  }
}

TEST(FrameJoinerValues, TheNewestCompleteIsTheNewest) {
  FrameJoiner joiner(2, 1);
  for (const std::int64_t seq : {0, 1, 2, 3}) Add(0, seq, &joiner);
  EXPECT_FALSE(joiner.NewestComplete());
  Add(1, 0, &joiner);
  Add(1, 1, &joiner);
  EXPECT_EQ(joiner.NewestComplete()->seq, 1);
  Add(1, 2, &joiner);
  EXPECT_EQ(joiner.NewestComplete()->seq, 2);
  EXPECT_EQ(joiner.NewestComplete(1)->seq, 1);
  EXPECT_EQ(joiner.NewestComplete(2)->seq, 0);
  EXPECT_FALSE(joiner.NewestComplete(3));
}

// A million ahead may be; one more is nonsense, or all that follows were late.
TEST(FrameJoinerValues, ANumberTooFarAheadIsNotTaken) {
  FrameJoiner joiner(1, 2);
  Add(0, 10, &joiner);
  EXPECT_EQ(Add(0, 10 + 1000001, &joiner), Arrival::kTooFar);
  EXPECT_EQ(Add(0, 11, &joiner), Arrival::kNew);
  EXPECT_EQ(Add(0, 11 + 1000000, &joiner), Arrival::kNew);
  EXPECT_EQ(Add(0, 5000000, &joiner, 8), Arrival::kNew) << "another session begins where it likes";
}

}  // namespace
}  // namespace airdos
