// The frames of a log: where each begins, which messages are believed, how sessions follow on one
// another; and the log itself where it was damaged, by sizes worked out by hand.
#include <gtest/gtest.h>
#include <sys/resource.h>
#include <unistd.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "common/util/error.h"
#include "processes/node/log/foreign_file.h"
#include "processes/node/log/log_source.h"
#include "processes/node/log/looped_source.h"
#include "processes/node/message/channels.h"
#include "tests/node/fake_nodes.h"

namespace airdos {
namespace {

using Bytes = std::vector<std::uint8_t>;

// "L", "R", "C", "S" for the left and right images, the calibration and static features.
std::string ChannelOf(char letter) {
  return letter == 'L'   ? channel::kCameraLeft
         : letter == 'R' ? channel::kCameraRight
         : letter == 'C' ? channel::kCalibration
                         : channel::kStaticFeatures;
}

struct Entry {
  char letter;
  std::int64_t session;
  std::int64_t seq;
};

class LogSourceBooksTest : public testing::Test {
 protected:
  LogSourceBooksTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = testing::TempDir() + "airdos_log_source_" + std::to_string(getpid()) + info->name();
  }
  ~LogSourceBooksTest() override { std::filesystem::remove(path_); }

  void Write(const std::vector<Entry>& entries) const {
    EventLogWriter log(path_);
    for (const Entry& entry : entries) {
      const Envelope message = TextEnvelope(ChannelOf(entry.letter), entry.seq, "", entry.session);
      log.Append(0, message.channel, message.payload.data(), message.payload.size());
    }
  }
  /// "L7.0 R7.0 | L7.1": channel, session and number of each message, frames apart.
  static std::string Frames(LogSource* source) {
    std::string text;
    for (auto frame = source->NextFrame(); !frame.empty(); frame = source->NextFrame()) {
      text += text.empty() ? "" : "| ";
      for (const Envelope& message : frame) {
        const Header header = *PeekHeader(message.payload.data(), message.payload.size());
        text += message.channel == channel::kCalibration      ? "C"
                : message.channel == channel::kStaticFeatures ? "S"
                : message.channel == channel::kCameraLeft     ? "L"
                                                              : "R";
        text += std::to_string(header.session) + "." + std::to_string(header.seq) + " ";
      }
    }
    return text;
  }
  std::string FramesOf(const std::vector<Entry>& entries) {
    Write(entries);
    LogSource source(path_);
    std::string text = Frames(&source);
    notes_ = source.TakeNotes();
    return text;
  }
  /// What the first note says behind the path.
  std::string FirstNote() const { return notes_.empty() ? "" : notes_[0].substr(path_.size() + 2); }

  std::string path_;
  std::vector<std::string> notes_;
};

TEST_F(LogSourceBooksTest, AHeaderIsTheseBytes) {
  Bytes bytes(33, 0xEE);
  for (std::uint8_t i = 0; i < 24; ++i) bytes[8 + i] = i;
  const Header header = *PeekHeader(bytes.data(), 32);
  EXPECT_EQ(header.utime, 0x0001020304050607);
  EXPECT_EQ(header.seq, 0x08090A0B0C0D0E0F);
  EXPECT_EQ(header.session, 0x1011121314151617);
  EXPECT_FALSE(PeekHeader(bytes.data(), 31));

  Bytes written(33, 0xEE);
  WriteHeader(header, written.data(), 31);
  EXPECT_EQ(written, Bytes(33, 0xEE)) << "too short: nothing is done";
  WriteHeader(header, written.data(), 32);
  EXPECT_EQ(written, bytes);
}

TEST_F(LogSourceBooksTest, AFrameEndsBeforeTheFirstMessageOfANewerOne) {
  EXPECT_EQ(FramesOf({{'C', 7, 0},
                      {'L', 7, 0},
                      {'R', 7, 0},
                      {'L', 7, 1},
                      {'R', 7, 1},
                      {'R', 7, 0},  // late
                      {'L', 8, 0},  // newer, whatever its number
                      {'R', 8, 0},
                      {'R', 7, 1},  // the end of a session among the next one
                      {'L', 8, 1}}),
            "C7.0 L7.0 R7.0 | L7.1 R7.1 R7.0 | L8.0 R8.0 | R7.1 | L8.1 ");
}

// A frame without end is handed out in pieces.
TEST_F(LogSourceBooksTest, AFrameHasAtMostAHundredMessages) {
  Write(std::vector<Entry>(150, {'L', 7, 3}));
  LogSource source(path_);
  EXPECT_EQ(source.NextFrame().size(), 100u);
  EXPECT_EQ(source.NextFrame().size(), 50u);
  EXPECT_TRUE(source.NextFrame().empty());
}

TEST_F(LogSourceBooksTest, TheRangeHoldsBothItsEnds) {
  std::vector<Entry> entries{{'C', 7, 0}};
  for (std::int64_t seq = 0; seq < 6; ++seq) entries.push_back({'L', 7, seq});
  entries.push_back({'C', 7, 5});
  entries.push_back({'R', 7, 4});  // late, from behind what is not wanted any more
  Write(entries);
  LogSource source(path_, 2, 4);
  EXPECT_EQ(Frames(&source), "C7.0 | L7.2 | L7.3 | L7.4 R7.4 ");
  LogSource none(path_, 6);
  EXPECT_EQ(Frames(&none), "C7.0 | C7.5 ") << "calibrations from before are kept";
}

TEST_F(LogSourceBooksTest, FeaturesAreInputOnlyWhereTheyAreAskedFor) {
  Write({{'L', 7, 0}, {'S', 7, 0}, {'L', 7, 1}, {'S', 7, 1}});
  LogSource images(path_);
  EXPECT_EQ(Frames(&images), "L7.0 | L7.1 ");
  constexpr auto kMin = std::numeric_limits<std::int64_t>::min();
  constexpr auto kMax = std::numeric_limits<std::int64_t>::max();
  LogSource features(path_, kMin, kMax, LogInputs::kFeatures);
  EXPECT_EQ(Frames(&features), "L7.0 S7.0 | L7.1 S7.1 ");
  EXPECT_TRUE(features.TakeNotes().empty()) << "nobody asks for the right images";
}

TEST_F(LogSourceBooksTest, SessionsGetNewNumbersInTheOrderInWhichTheyCome) {
  Write(
      {{'L', 9, 0}, {'L', 9, 1}, {'L', 5, 0}, {'L', 5, 1}, {'R', 9, 1}, {'L', 6, 0}, {'L', 6, 1}});
  LogSource source(path_);
  source.RenumberSessions(100);
  EXPECT_EQ(Frames(&source), "L100.0 | L100.1 | L101.0 | L101.1 | R100.1 | L102.0 | L102.1 ");
}

TEST_F(LogSourceBooksTest, WhatFitsToNothingAroundItIsLeftOut) {
  const std::string expected = "L7.0 | L7.1 | L7.2 | L7.3 ";
  // A flipped bit of the session, of the number, and of its sign.
  for (const Entry& wrong : {Entry{'R', 1031, 1}, Entry{'R', 7, 1025}, Entry{'R', 7, -5}}) {
    EXPECT_EQ(FramesOf({{'L', 7, 0}, {'L', 7, 1}, wrong, {'L', 7, 2}, {'L', 7, 3}}), expected)
        << wrong.session << " " << wrong.seq;
    EXPECT_EQ(FirstNote(),
              "1 messages skipped: their session or image number does not fit their neighbours");
  }
}

TEST_F(LogSourceBooksTest, ALaterOneThatIsTooFarAheadAgreesToNothing) {
  constexpr std::int64_t kMost = FrameJoiner::kMaxAhead;
  EXPECT_EQ(
      FramesOf({{'L', 7, 0}, {'L', 7, 9000}, {'L', 7, 9001 + kMost}, {'L', 7, 1}, {'L', 7, 2}}),
      "L7.0 | L7.1 | L7.2 ");
  EXPECT_EQ(FirstNote(),
            "2 messages skipped: their session or image number does not fit their neighbours");
  EXPECT_EQ(FramesOf({{'L', 7, 0}, {'L', 7, 9000}, {'L', 7, 9000 + kMost}, {'L', 7, 1}}),
            "L7.0 | L7.9000 L7.1 ")
      << "the first two agree, the third agrees with nothing behind it";
}

// The next number needs nobody to agree, not even behind one that came late.
TEST_F(LogSourceBooksTest, TheNextNumberIsBelieved) {
  std::vector<Entry> entries{{'L', 7, 0}, {'L', 7, 1}, {'L', 7, 2}, {'R', 7, 0}, {'L', 7, 3}};
  for (std::int64_t seq = 0; seq < 30; ++seq) entries.push_back({'L', 8, seq});
  EXPECT_EQ(FramesOf(entries).substr(0, 35), "L7.0 | L7.1 | L7.2 R7.0 | L7.3 | L8");
}

TEST_F(LogSourceBooksTest, TheLastMessageIsBelieved) {
  EXPECT_EQ(FramesOf({{'L', 7, 0}, {'L', 7, 1}, {'L', 7, 50}}), "L7.0 | L7.1 | L7.50 ");
  EXPECT_EQ(FramesOf({{'L', 7, 0}, {'L', 7, 1}, {'L', 9, 0}}), "L7.0 | L7.1 | L9.0 ");
}

TEST_F(LogSourceBooksTest, OneOfTheSixteenBehindItMustAgree) {
  for (const std::int64_t num_between : {15, 16}) {
    std::vector<Entry> entries{{'L', 7, 0}, {'L', 9, 0}};
    for (std::int64_t k = 1; k <= num_between; ++k) entries.push_back({'L', 7, k});
    entries.push_back({'L', 9, 1});
    entries.push_back({'L', 9, 2});
    const std::string text = FramesOf(entries);
    EXPECT_EQ(text.find("L9.0") != std::string::npos, num_between == 15) << text;
    EXPECT_NE(text.find("L9.1"), std::string::npos) << text;
  }
}

// The end of a session may come among those of the eighth one behind it, not later.
TEST_F(LogSourceBooksTest, EightSessionsAreRemembered) {
  std::vector<Entry> entries;
  for (std::int64_t session = 1; session <= 9; ++session) {
    entries.push_back({'L', session, 0});
    entries.push_back({'L', session, 1});
  }
  entries.push_back({'R', 1, 1});  // forgotten
  entries.push_back({'R', 2, 1});
  entries.push_back({'R', 9, 1});
  for (std::int64_t seq = 2; seq < 20; ++seq) entries.push_back({'L', 9, seq});
  const std::string text = FramesOf(entries);
  EXPECT_NE(text.find("| L9.0 | L9.1 | R2.1 | R9.1 | L9.2 |"), std::string::npos) << text;
  EXPECT_EQ(FirstNote(),
            "1 messages skipped: their session or image number does not fit their neighbours");
}

TEST_F(LogSourceBooksTest, MessagesWithoutAHeaderAreCounted) {
  Write({{'L', 7, 0}, {'L', 7, 1}});
  {
    const std::string bytes = [this] {
      std::ifstream file(path_, std::ios::binary);
      return std::string(std::istreambuf_iterator<char>(file), {});
    }();
    EventLogWriter log(path_);
    for (int i = 0; i < 3; ++i) log.Append(0, channel::kCameraLeft, bytes.data(), 31);
    const Envelope message = TextEnvelope(channel::kCameraLeft, 0, "", 7);
    log.Append(0, message.channel, message.payload.data(), message.payload.size());
  }
  LogSource source(path_);
  EXPECT_EQ(Frames(&source), "L7.0 ");
  EXPECT_EQ(source.TakeNotes().at(0), path_ + ": 3 messages skipped: too short for a header");
}

// ---- The file ----

class EventLogBooksTest : public LogSourceBooksTest {
 protected:
  std::string Bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }
  void SetBytes(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  /// Events with these numbers on channel "AB", each of 28 bytes of head, 2 of name and `size`.
  void WriteNumbers(const std::vector<std::int64_t>& numbers, std::size_t size) const {
    EventLogWriter log(path_);
    const std::string payload(size, 'p');
    for (const std::int64_t number : numbers) log.Write(number, 5, "AB", payload.data(), size);
  }
  static std::vector<std::int64_t> Numbers(EventLogReader* reader) {
    std::vector<std::int64_t> numbers;
    while (const auto event = reader->Next()) numbers.push_back(event->number);
    return numbers;
  }
};

TEST_F(EventLogBooksTest, SizesAndPlacesAreThoseWorkedOutByHand) {
  {
    EventLogWriter log(path_);
    log.Write(3, 5, "AB", "xyz", 3);
    EXPECT_EQ(log.num_bytes(), 33);
    log.Write(4, 6, "LONGER", nullptr, 0);
    EXPECT_EQ(log.num_bytes(), 33 + 34);
    EXPECT_EQ(log.num_events(), 2);
  }
  const std::string head("\xED\xA1\xDA\x01\0\0\0\0\0\0\0\3\0\0\0\0\0\0\0\5\0\0\0\2\0\0\0\3", 28);
  EXPECT_EQ(Bytes().substr(0, 33), head + "ABxyz");
  EventLogReader reader(path_);
  EXPECT_EQ(reader.num_bytes(), 67);
  EXPECT_EQ(reader.Next()->utime, 5);
  EXPECT_EQ(reader.position_bytes(), 33);
  EXPECT_EQ(reader.Next()->channel, "LONGER");
  EXPECT_EQ(reader.position_bytes(), 67);
}

// Each event has 100 bytes: the 2nd is lost, and of the others the 5th to the 7th.
TEST_F(EventLogBooksTest, LostEventsAndBytesOfTwoPlacesAddUp) {
  WriteNumbers({10, 11, 12, 13, 14, 15, 16, 17, 18}, 70);
  std::string bytes = Bytes();
  ASSERT_EQ(bytes.size(), 900u);
  bytes[100] = 'x';
  for (std::size_t i = 401; i < 701; ++i) bytes[i] = 'x';
  SetBytes(bytes);
  EventLogReader reader(path_);
  EXPECT_EQ(Numbers(&reader), (std::vector<std::int64_t>{10, 12, 13, 18}));
  EXPECT_EQ(reader.num_bytes_skipped(), 100 + 400);
  EXPECT_EQ(reader.num_lost(), 1 + 4);
}

// A number that jumps is not believed where the bytes that were skipped could not hold so many.
TEST_F(EventLogBooksTest, NoMoreEventsAreLostThanHadRoom) {
  WriteNumbers({10, 11, 500}, 70);
  std::string bytes = Bytes();
  bytes[100] = 'x';
  SetBytes(bytes);
  EventLogReader reader(path_);
  EXPECT_EQ(Numbers(&reader), (std::vector<std::int64_t>{10, 500}));
  EXPECT_EQ(reader.num_lost(), 1);
}

// What is searched for lies across the border of two pieces that are read.
TEST_F(EventLogBooksTest, AnEventIsFoundWhereverItBegins) {
  for (std::size_t size = 65530; size < 65545; ++size) {
    {
      EventLogWriter log(path_);
      const std::string payload(size, 'p');
      log.Write(1, 5, "AB", "x", 1);
      log.Write(2, 5, "AB", payload.data(), size - 30);
      log.Write(3, 5, "AB", "x", 1);
    }
    std::string bytes = Bytes();
    bytes[31] = 'x';
    SetBytes(bytes);
    EventLogReader reader(path_);
    EXPECT_EQ(Numbers(&reader), (std::vector<std::int64_t>{1, 3})) << size;
    EXPECT_EQ(reader.num_bytes_skipped(), static_cast<std::int64_t>(size)) << size;
  }
}

TEST_F(EventLogBooksTest, ALogThatIsBeingWrittenIsNotEmptied) {
  EventLogWriter first(path_);
  first.Append(5, "AB", "xyz", 3);
  try {
    EventLogWriter second(path_);
    ADD_FAILURE() << "two writers would leave a mixture";
  } catch (const InputError& error) {
    EXPECT_EQ(error.what(), path_ + ": cannot be written: another program is writing it");
  }
  EXPECT_EQ(Bytes().size(), 33u);
}

// Half an event may lie at the end of a log that could not be written: nothing may come behind it.
TEST_F(EventLogBooksTest, AfterAFailedWriteTheLogIsClosed) {
  std::signal(SIGXFSZ, SIG_IGN);  // then write() fails as on a full disk
  EventLogWriter log(path_);
  log.Append(5, "AB", "xyz", 3);
  rlimit before = {};
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{40, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  EXPECT_THROW(log.Append(6, "AB", "xyz", 3), WriteError);
  setrlimit(RLIMIT_FSIZE, &before);
  try {
    log.Append(7, "AB", "xyz", 3);
    ADD_FAILURE();
  } catch (const WriteError& error) {
    EXPECT_EQ(error.what(),
              path_ + ": is closed after a failed write; the 1 events before are kept");
  }
  EXPECT_EQ(Bytes().size(), 33u);
}

TEST(ForeignFileTest, AFormatIsKnownByTheBytesInItsPlace) {
  Bytes tar(300, 0);
  EXPECT_EQ(DescribeForeignFile(tar), "");
  for (std::size_t i = 0; i < 5; ++i) tar[257 + i] = static_cast<std::uint8_t>("ustar"[i]);
  EXPECT_EQ(DescribeForeignFile(tar), "is a tar archive: unpack it first");
  Bytes moved(tar.begin() + 257, tar.end());
  EXPECT_EQ(DescribeForeignFile(moved), "");
  tar.resize(200);
  EXPECT_EQ(DescribeForeignFile(tar), "") << "ends before that place";
}

// ---- The same once more ----

/// Frames 5 and 6, a message of frame 5 at the end, and the same note twice.
class LateEnd : public FrameSource {
 public:
  std::vector<Envelope> NextFrame() override {
    const std::int64_t seqs[] = {5, 6, 5};
    if (next_ == 3) return {};
    return {TextEnvelope("IMAGE", seqs[next_++], "")};
  }
  double fraction_done() const override { return static_cast<double>(next_) / 3; }
  std::vector<std::string> TakeNotes() override { return {"a note"}; }

 private:
  int next_ = 0;
};

TEST(LoopedSourceBooksTest, TheNewestImageEndsALoop) {
  LoopedSource source([] { return std::make_unique<LateEnd>(); }, 2);
  std::string text;
  for (auto frame = source.NextFrame(); !frame.empty(); frame = source.NextFrame()) {
    const Header header = *PeekHeader(frame[0].payload.data(), frame[0].payload.size());
    text += std::to_string(header.seq) + " at " + std::to_string(header.utime) + ", ";
  }
  EXPECT_EQ(text, "5 at 5000, 6 at 6000, 5 at 5000, 7 at 7000, 8 at 8000, 7 at 7000, ");
  EXPECT_EQ(source.TakeNotes(), std::vector<std::string>{"a note"});
  EXPECT_TRUE(source.TakeNotes().empty()) << "said once";
}

}  // namespace
}  // namespace airdos
