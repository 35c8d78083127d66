// Which images of a log have partners, and what is said of those that have none: counts, first ones
// and causes by value.
#include <gtest/gtest.h>

#include <string>
#include <vector>

#include "processes/node/log/log_channels.h"
#include "processes/node/log/log_pairing.h"
#include "processes/node/message/channels.h"

namespace airdos {
namespace {

constexpr char kLeft[] = "CAMERA_LEFT";
constexpr char kRight[] = "CAMERA_RIGHT";
constexpr char kMask[] = "PERSON_MASK";

/// Capture time of an image: 100 ms apart, beginning somewhere.
std::int64_t TimeOf(std::int64_t seq) { return 7000000 + 100000 * seq; }

class LogPairingTest : public testing::Test {
 protected:
  void Add(const char* channel, std::int64_t seq) { pairing_.Add(channel, {TimeOf(seq), seq, 1}); }
  void AddRange(const char* channel, std::int64_t first, std::int64_t last) {
    for (std::int64_t seq = first; seq <= last; ++seq) Add(channel, seq);
  }
  /// "error log.partners CAMERA_RIGHT 3: TEXT", a line each.
  std::string Said(bool is_cut = false) const {
    std::string text;
    for (const LogPairing::Remark& remark : pairing_.Remarks(is_cut)) {
      text += std::string(remark.is_error ? "error " : "warning ") + remark.kind + " " +
              remark.channel + (remark.seq ? " " + std::to_string(*remark.seq) : "") + ": " +
              remark.text + "\n";
    }
    return text;
  }
  LogPairing pairing_;
};

TEST_F(LogPairingTest, AFewWithoutAPartnerAreAWarningMostOfThemAnError) {
  AddRange(kLeft, 0, 9);
  for (const std::int64_t seq : {0, 1, 3, 4, 5, 7, 8, 9}) Add(kRight, seq);
  for (const std::int64_t seq : {0, 1, 2, 3}) Add(kMask, seq);
  EXPECT_EQ(Said(),
            "warning log.partners CAMERA_RIGHT: 2 of 10 left images have no message with their "
            "number and session here, the first is 2\n"
            "warning log.partners PERSON_MASK: 6 of 10 left images have no message with their "
            "number and session here, the first is 4\n");
}

TEST_F(LogPairingTest, MostRightImagesMissingIsAnError) {
  AddRange(kLeft, 0, 9);
  AddRange(kRight, 6, 9);
  EXPECT_EQ(Said().substr(0, 121),
            "error log.partners CAMERA_RIGHT: 6 of 10 left images have no message with their "
            "number and session here, the first is 0: ");
}

TEST_F(LogPairingTest, PartnersOfNoImageAreCounted) {
  AddRange(kLeft, 0, 9);
  AddRange(kRight, 2, 12);
  EXPECT_EQ(Said(),
            "warning log.partners CAMERA_RIGHT: 2 of 10 left images have no message with their "
            "number and session here, the first is 0\n"
            "warning log.partners CAMERA_RIGHT: 3 of 11 messages have a number that CAMERA_LEFT "
            "does not have\n");
  EXPECT_EQ(Said(true),
            "warning log.partners CAMERA_RIGHT: 2 of 10 left images have no message with their "
            "number and session here, the first is 0\n")
      << "they may come";
}

TEST_F(LogPairingTest, TheNewestOfACutLogMayStillGetTheirPartners) {
  AddRange(kLeft, 0, 39);
  AddRange(kRight, 0, 29);
  EXPECT_EQ(Said(true), "");
  EXPECT_EQ(Said(false),
            "warning log.partners CAMERA_RIGHT: 10 of 40 left images have no message with their "
            "number and session here, the first is 30\n");
}

TEST_F(LogPairingTest, NumbersThatDifferAreExplainedByTimeOrElseByOrder) {
  const std::string none =
      "error log.partners CAMERA_RIGHT: 10 of 10 left images have no message with their number and "
      "session here: ";
  const std::string remedy = ": give all messages of one image the same number (seq)\n";
  AddRange(kLeft, 0, 9);
  for (std::int64_t seq = 0; seq < 10; ++seq) pairing_.Add(kRight, {TimeOf(seq), seq + 500, 1});
  EXPECT_EQ(Said(), none + "where capture times agree, its numbers are those of CAMERA_LEFT + 500" +
                        remedy);

  pairing_ = LogPairing();
  AddRange(kLeft, 100, 109);
  for (std::int64_t seq = 100; seq < 110; ++seq) pairing_.Add(kRight, {seq, seq - 30, 1});
  EXPECT_EQ(Said(),
            none + "in the order of the log its numbers are those of CAMERA_LEFT - 30" + remedy);

  // Where all times are one they tell nothing.
  pairing_ = LogPairing();
  for (std::int64_t seq = 0; seq < 10; ++seq) {
    pairing_.Add(kLeft, {5, seq, 1});
    pairing_.Add(kRight, {5, seq + 500, 1});
  }
  EXPECT_EQ(Said(),
            none + "in the order of the log its numbers are those of CAMERA_LEFT + 500" + remedy);
}

TEST_F(LogPairingTest, ChannelsOfOneNumberAreNamedOnce) {
  AddRange(kLeft, 0, 4);
  for (int i = 0; i < 5; ++i) pairing_.Add(kRight, {TimeOf(i), 3, 1});
  for (int i = 0; i < 5; ++i) pairing_.Add(kMask, {TimeOf(i), 3, 1});
  EXPECT_EQ(Said(),
            "error log.numbers CAMERA_RIGHT, PERSON_MASK: all messages have number 3 (seq): number "
            "the images 0, 1, 2, …, and give every message of one image its number\n");
  EXPECT_TRUE(pairing_.HasOneNumber(kRight));
  EXPECT_FALSE(pairing_.HasOneNumber(kLeft));
}

TEST_F(LogPairingTest, APartnerIsOfTheSameSession) {
  for (const std::int64_t session : {4, 9}) {
    for (std::int64_t seq = 0; seq < 5; ++seq) {
      pairing_.Add(kLeft, {TimeOf(seq) + session, seq, session});
      pairing_.Add(kRight, {TimeOf(seq) + session, seq, session});
    }
  }
  EXPECT_EQ(Said(), "");
}

/// Adds five pairs, the right ones `times` instead of those of the left ones.
void AddPairs(const std::vector<std::int64_t>& times, LogPairing* pairing) {
  *pairing = LogPairing();
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto seq = static_cast<std::int64_t>(i);
    pairing->Add(kLeft, {TimeOf(seq), seq, 1});
    pairing->Add(kRight, {times[i], seq, 1});
  }
}

TEST_F(LogPairingTest, CaptureTimesThatDifferAreCountedFromTheFirstOn) {
  AddPairs({7000000, 7100033, 7200033, 7300033, 7400000}, &pairing_);
  EXPECT_EQ(Said(),
            "error log.utime CAMERA_RIGHT 1: has another capture time (7100033) than CAMERA_LEFT "
            "with this number (7100000), and so have 3 of 5, by + 33 us: give all messages of one "
            "image the same capture time\n");
  AddPairs({7000000, 7099960, 7199960, 7300000, 7400000}, &pairing_);
  EXPECT_NE(Said().find("and so have 2 of 5, by - 40 us"), std::string::npos) << Said();
  AddPairs({7000000, 7100000, 7200000, 7300000, 7400007}, &pairing_);
  EXPECT_EQ(Said(),
            "error log.utime CAMERA_RIGHT 4: has another capture time (7400007) than CAMERA_LEFT "
            "with this number (7400000)\n");
}

TEST_F(LogPairingTest, AThousandfoldTimeIsOfAnotherUnit) {
  const std::string unit = "one is 1000 times the other, so one of them is not in us";
  AddPairs({7000000000, 7100000000, 7200000000, 7300000000, 7400000000}, &pairing_);
  EXPECT_NE(Said().find(unit), std::string::npos) << Said();
  AddPairs({7000, 7100, 7200, 7300, 7400}, &pairing_);
  EXPECT_NE(Said().find(unit), std::string::npos) << Said();
  AddPairs({7000000000, 7100033, 7200033, 7300033, 7400033}, &pairing_);
  EXPECT_EQ(Said().find(unit), std::string::npos) << "a single one is none";
  EXPECT_NE(Said().find("and so have 5 of 5, by + 33 us"), std::string::npos) << Said();
}

// ---- Names ----

void AddBytes(const std::string& channel, std::size_t size, LogChannels* channels) {
  const std::string bytes(size, '\0');
  channels->Add(channel, bytes.data(), bytes.size());
}

TEST(LogChannelsBooksTest, MessagesAndBytesAddUp) {
  LogChannels channels;
  AddBytes("B", 1500, &channels);
  AddBytes("B", 600, &channels);
  AddBytes("A", 1, &channels);
  EXPECT_EQ(channels.num_messages("B"), 2);
  EXPECT_EQ(channels.List(), "A (1 message, 1 kB), B (2 messages, 3 kB)");
}

TEST(LogChannelsBooksTest, BeyondAThousandNamesOnlyOursAreToldApart) {
  LogChannels channels;
  for (std::size_t i = 0; i < 1000; ++i) AddBytes("N" + std::to_string(i), 1, &channels);
  AddBytes("STRANGER", 1, &channels);
  AddBytes(kLeft, 1, &channels);
  AddBytes(kLeft, 1, &channels);
  EXPECT_EQ(channels.num_messages("N999"), 1);
  EXPECT_EQ(channels.num_messages("STRANGER"), 0);
  EXPECT_EQ(channels.num_messages(kLeft), 2);
  EXPECT_NE(channels.List().find(", 1 messages on further channels"), std::string::npos);
}

TEST(LogChannelsBooksTest, TheShortestNameOfOthersIsMeant) {
  LogChannels channels;
  AddBytes("robot1/camera_left", 1, &channels);
  AddBytes("x/camera-left", 1, &channels);
  AddBytes("zoo/robot1/camera_left", 1, &channels);
  EXPECT_EQ(channels.LookAlike(kLeft), "x/camera-left");
  EXPECT_EQ(channels.LookAlike(kRight), std::nullopt);
  AddBytes(kRight, 1, &channels);
  EXPECT_EQ(channels.LookAlike(kRight), std::nullopt) << "it is the name itself";
}

}  // namespace
}  // namespace airdos
