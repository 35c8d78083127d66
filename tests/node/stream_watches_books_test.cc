// What is said of streams while a run goes on: when it is judged, from which frames, and how often
// it is said.
#include <gtest/gtest.h>

#include <optional>
#include <string>
#include <vector>

#include "processes/node/live/own_output.h"
#include "processes/node/partner_watch.h"
#include "processes/node/stray_watch.h"

namespace airdos {
namespace {

TEST(LookScheduleTest, LooksAfterTenAndThenAfterEachHundred) {
  LookSchedule schedule;
  std::string due;
  for (int frame = 1; frame <= 350; ++frame) {
    if (schedule.IsDue()) due += std::to_string(frame) + " ";
  }
  EXPECT_EQ(due, "10 100 200 300 ");
}

constexpr std::int64_t kSession = 4;

/// A left image every 100 ms and what came with it.
class PartnerWatchTest : public testing::Test {
 protected:
  void Add(bool has_partner, std::int64_t offset_us = 0) {
    const Header left = {100000 * seq_, seq_, kSession};
    left_numbers_.AddNew(left);
    std::optional<Header> partner;
    if (has_partner) {
      partner = Header{left.utime + offset_us, seq_, kSession};
      right_numbers_.AddNew(*partner);
    }
    const std::string text = watch_.Add(left, partner, left_numbers_, right_numbers_);
    ++seq_;
    if (!text.empty()) said_ += std::to_string(seq_) + ": " + text + "\n";
  }
  void AddMany(int count, bool has_partner, std::int64_t offset_us = 0) {
    for (int i = 0; i < count; ++i) Add(has_partner, offset_us);
  }

  PartnerWatch watch_{"CAMERA_RIGHT", "right image", false};
  StrayWatch left_numbers_{"CAMERA_LEFT", true};
  StrayWatch right_numbers_{"CAMERA_RIGHT", false};
  std::int64_t seq_ = 0;
  std::string said_;
};

TEST_F(PartnerWatchTest, OneInFiveMayBeLost) {
  AddMany(1, false);
  AddMany(9, true);  // a tenth of them
  for (int i = 10; i < 100; ++i) Add(i % 6 != 0);
  EXPECT_EQ(said_, "");
  for (int i = 100; i < 200; ++i) Add(i % 4 != 0);
  EXPECT_EQ(said_,
            "200: no right image came for 25 of 100 left images: CAMERA_RIGHT skips images, or "
            "loses them in transit; airdos-doctor checks the network\n");
  AddMany(200, false);
  EXPECT_EQ(said_.find('\n'), said_.size() - 1) << "said once";
}

// What was before the last look is judged already.
TEST_F(PartnerWatchTest, EachLookIsOfTheFramesSinceTheOneBefore) {
  AddMany(100, true);
  AddMany(80, true);
  AddMany(20, false);
  EXPECT_EQ(said_,
            "200: no right image came for 20 of 100 left images: CAMERA_RIGHT skips images, or "
            "loses them in transit; airdos-doctor checks the network\n");
}

TEST_F(PartnerWatchTest, HalfAnImageApartIsTooMuch) {
  AddMany(200, true, 49000);
  EXPECT_EQ(said_, "") << "of 100 ms";
  AddMany(100, true, -51000);
  EXPECT_EQ(said_,
            "300: CAMERA_RIGHT is 0.051 s away from the left image of the same number (median): do "
            "both drivers count from the same image and use the same clock?\n");
  AddMany(200, true, -51000);
  EXPECT_EQ(said_.find('\n'), said_.size() - 1) << "said once";
}

// Cameras of a thousand images a second: half of their interval is within what clocks may differ.
TEST_F(PartnerWatchTest, TwoMillisecondsAreNoOffset) {
  std::string said;
  for (std::int64_t seq = 0; seq < 100; ++seq) {
    const Header left = {1000 * seq, seq, kSession};
    const Header right = {1000 * seq + 1500, seq, kSession};
    left_numbers_.AddNew(left);
    right_numbers_.AddNew(right);
    said += watch_.Add(left, right, left_numbers_, right_numbers_);
  }
  EXPECT_EQ(said, "");
}

TEST_F(PartnerWatchTest, ADetectorThatSpokeMayNotFallSilent) {
  watch_ = PartnerWatch("PERSON_MASK", "person mask", true);
  AddMany(10, true);
  AddMany(90, false);
  EXPECT_EQ(said_.find("100: no person mask came for 90 of 90 left images: PERSON_MASK counts from "
                       "0, the left images from 0"),
            0u)
      << said_;
}

// ---- Numbers that come again ----

class StrayWatchTest : public testing::Test {
 protected:
  void New(std::int64_t seq, std::int64_t session = 1) { watch_.AddNew({10 * seq, seq, session}); }
  bool Refused(std::int64_t seq, std::int64_t session = 1) {
    return !watch_.AddRefused({10 * seq, seq, session}).empty();
  }
  StrayWatch watch_{"CAMERA_LEFT", true};
};

TEST_F(StrayWatchTest, TheFirstOfItsSessionIsThatOfTheNewest) {
  EXPECT_FALSE(watch_.newest());
  New(5, 1);
  New(6, 1);
  New(2, 9);
  New(3, 9);
  EXPECT_EQ(watch_.first_of_session()->seq, 2);
  EXPECT_EQ(watch_.first_of_session()->session, 9);
  EXPECT_EQ(watch_.newest()->seq, 3);
}

TEST_F(StrayWatchTest, ThreeInARowAreASecondPlay) {
  for (std::int64_t seq = 0; seq < 20; ++seq) New(seq);
  EXPECT_FALSE(Refused(3));
  EXPECT_FALSE(Refused(4));
  EXPECT_FALSE(Refused(4)) << "the same one twice is no third";
  EXPECT_TRUE(Refused(6));
  EXPECT_FALSE(Refused(7)) << "said once for each play";
}

// Between messages that are taken, those that come again must follow on one another.
TEST_F(StrayWatchTest, BetweenNewOnesTheyMustCount) {
  for (std::int64_t seq = 0; seq < 20; ++seq) New(seq);
  for (std::int64_t k = 0; k < 8; ++k) {
    New(20 + k);
    EXPECT_FALSE(Refused(2 * k)) << "strays, each further on than the one before";
  }
  for (std::int64_t k = 0; k < 3; ++k) {
    New(30 + k);
    EXPECT_EQ(Refused(3 + k), k == 2);
  }
}

TEST_F(StrayWatchTest, AnEarlierSessionComesAgainWhateverItsNumbers) {
  for (std::int64_t seq = 0; seq < 5; ++seq) New(seq, 1);
  for (std::int64_t seq = 0; seq < 5; ++seq) New(seq, 2);
  EXPECT_FALSE(Refused(100, 1));
  EXPECT_FALSE(Refused(101, 1));
  EXPECT_EQ(watch_.AddRefused({1, 102, 1})
                .find("session 1 was already processed, session 2 came after it"),
            0u);
}

// What comes too late is counted from the last one that was taken on.
TEST_F(StrayWatchTest, LateOnesAreForgottenWhenOneIsTaken) {
  New(0);
  EXPECT_FALSE(Refused(5));
  EXPECT_FALSE(Refused(6));
  New(7);
  EXPECT_FALSE(Refused(8));
  EXPECT_FALSE(Refused(9));
  EXPECT_EQ(watch_.AddRefused({100, 10, 1}).find("CAMERA_LEFT: image 10 comes after that frame"),
            0u);
}

// ---- What this process said itself ----

class OwnOutputBooksTest : public testing::Test {
 protected:
  void Say(const std::string& text) { own_.AddSaid("OUT", text.data(), text.size()); }
  bool IsForeign(const std::string& text) {
    return own_.IsForeign("OUT", text.data(), text.size());
  }
  OwnOutput own_;
};

TEST_F(OwnOutputBooksTest, WhatIsSaidTwiceIsHeardTwice) {
  for (int i = 0; i < 10; ++i) Say("the same");
  for (int i = 0; i < 10; ++i) EXPECT_FALSE(IsForeign("the same")) << i;
  EXPECT_FALSE(IsForeign("the same")) << "doubled";
  EXPECT_FALSE(IsForeign("the same")) << "doubled once more";
  EXPECT_TRUE(IsForeign("the same"));
}

// A network that doubles a message now and then is no second process: after a hundred messages it
// is forgiven.
TEST_F(OwnOutputBooksTest, AHundredMessagesMakeUpForTwoThatWereDoubled) {
  for (const int num_between : {99, 100}) {
    own_ = OwnOutput();
    const auto say_and_hear = [&](const std::string& text) {
      Say(text);
      EXPECT_FALSE(IsForeign(text));
    };
    for (const char* text : {"a", "b"}) {
      say_and_hear(text);
      EXPECT_FALSE(IsForeign(text));
    }
    for (int i = 0; i < num_between; ++i) say_and_hear(std::to_string(i));
    say_and_hear("c");
    EXPECT_EQ(IsForeign("c"), num_between == 99);
  }
}

TEST_F(OwnOutputBooksTest, OnlyTheNewestFourThousandAreRemembered) {
  for (std::size_t i = 0; i <= OwnOutput::kMaxRemembered; ++i) Say(std::to_string(i));
  EXPECT_TRUE(IsForeign("0")) << "forgotten";
  EXPECT_FALSE(IsForeign("1"));
}

}  // namespace
}  // namespace airdos
