#include "processes/node/log/event_log.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <lcm/lcm-cpp.hpp>
#include <random>

#include "common/util/error.h"
#include "processes/node/log/log_source.h"

namespace airdos {
namespace {

class EventLogTest : public testing::Test {
 protected:
  EventLogTest() {
    const auto* info = testing::UnitTest::GetInstance()->current_test_info();
    path_ = testing::TempDir() + "airdos_event_log_" + info->name() + ".lcm";
  }
  ~EventLogTest() override { std::filesystem::remove(path_); }

  // `num` events of different sizes on two channels; returns the offset of each.
  std::vector<std::size_t> WriteEvents(int num) {
    EventLogWriter writer(path_);
    std::vector<std::size_t> offsets;
    for (int i = 0; i < num; ++i) {
      offsets.push_back(static_cast<std::size_t>(writer.num_bytes()));
      const std::vector<std::uint8_t> payload = PayloadOf(i);
      writer.Write(i, 1000 + i, i % 2 == 0 ? "EVEN" : "ODD", payload.data(), payload.size());
    }
    return offsets;
  }
  static std::vector<std::uint8_t> PayloadOf(int i) {
    return std::vector<std::uint8_t>(static_cast<std::size_t>(100 * i),
                                     static_cast<std::uint8_t>(i));
  }
  std::string Bytes() const {
    std::ifstream file(path_, std::ios::binary);
    return std::string(std::istreambuf_iterator<char>(file), {});
  }
  void SetBytes(const std::string& bytes) const {
    std::ofstream(path_, std::ios::binary | std::ios::trunc) << bytes;
  }
  // Numbers of the events that the reader finds; each must be as it was written.
  std::vector<int> ReadNumbers(EventLogReader* reader) const {
    std::vector<int> numbers;
    while (const auto event = reader->Next()) {
      const int i = static_cast<int>(event->number);
      numbers.push_back(i);
      EXPECT_EQ(event->utime, 1000 + i);
      EXPECT_EQ(event->channel, i % 2 == 0 ? "EVEN" : "ODD");
      EXPECT_EQ(event->payload, PayloadOf(i));
    }
    return numbers;
  }
  static std::vector<int> AllBut(int num, const std::vector<int>& lost) {
    std::vector<int> numbers;
    for (int i = 0; i < num; ++i) {
      if (std::find(lost.begin(), lost.end(), i) == lost.end()) numbers.push_back(i);
    }
    return numbers;
  }

  std::string path_;
};

TEST_F(EventLogTest, GivesBackWhatWasWritten) {
  WriteEvents(20);
  EventLogReader reader(path_);
  EXPECT_EQ(ReadNumbers(&reader), AllBut(20, {}));
  EXPECT_EQ(reader.num_lost(), 0);
  EXPECT_EQ(reader.num_bytes_skipped(), 0);
  EXPECT_EQ(reader.position_bytes(), reader.num_bytes());
}

TEST_F(EventLogTest, LcmReadsWhatIsWritten) {
  WriteEvents(20);
  lcm::LogFile log(path_, "r");
  ASSERT_TRUE(log.good());
  for (int i = 0; i < 20; ++i) {
    const lcm::LogEvent* event = log.readNextEvent();
    ASSERT_NE(event, nullptr);
    EXPECT_EQ(event->eventnum, i);
    EXPECT_EQ(event->timestamp, 1000 + i);
    EXPECT_EQ(event->channel, i % 2 == 0 ? "EVEN" : "ODD");
    const auto* data = static_cast<const std::uint8_t*>(event->data);
    EXPECT_EQ(std::vector<std::uint8_t>(data, data + event->datalen), PayloadOf(i));
  }
  EXPECT_EQ(log.readNextEvent(), nullptr);
}

TEST_F(EventLogTest, ReadsWhatLcmWrote) {
  {
    lcm::LogFile log(path_, "w");
    ASSERT_TRUE(log.good());
    for (int i = 0; i < 20; ++i) {
      std::vector<std::uint8_t> payload = PayloadOf(i);
      lcm::LogEvent event;
      event.eventnum = i;
      event.timestamp = 1000 + i;
      event.channel = i % 2 == 0 ? "EVEN" : "ODD";
      event.datalen = static_cast<int>(payload.size());
      event.data = payload.data();
      ASSERT_EQ(log.writeEvent(&event), 0);
    }
  }
  EventLogReader reader(path_);
  EXPECT_EQ(ReadNumbers(&reader), AllBut(20, {}));
}

TEST_F(EventLogTest, MissingEmptyOrForeignFileIsBadInput) {
  EXPECT_THROW(EventLogReader("/nonexistent/x.lcm"), InputError);
  EXPECT_THROW(EventLogReader reader(testing::TempDir()), InputError);
  SetBytes("");
  EXPECT_THROW(EventLogReader reader(path_), InputError);
  SetBytes(std::string(200000, 'x'));
  EXPECT_THROW(EventLogReader reader(path_), InputError);
  EXPECT_THROW(EventLogWriter("/nonexistent/x.lcm"), InputError);
}

TEST_F(EventLogTest, DamagedSyncWordLosesOneEvent) {
  const auto offsets = WriteEvents(20);
  std::string bytes = Bytes();
  bytes[offsets[7]] = 0;
  SetBytes(bytes);
  EventLogReader reader(path_);
  EXPECT_EQ(ReadNumbers(&reader), AllBut(20, {7}));
  EXPECT_EQ(reader.num_lost(), 1);
  EXPECT_EQ(reader.num_bytes_skipped(), static_cast<int>(offsets[8] - offsets[7]));
}

TEST_F(EventLogTest, DamagedLengthsLoseOneEvent) {
  const auto offsets = WriteEvents(20);
  const std::string whole = Bytes();
  // Offset in the event and value: lengths negative, beyond the file, within the file but wrong.
  const std::vector<std::pair<std::size_t, std::string>> damages{
      {24, "\x7f\xff\xff\xff"},           {24, "\xff\xff\xff\xff"},
      {24, std::string("\0\0\x07\0", 4)}, {24, std::string("\0\0\0\x01", 4)},
      {20, "\x7f\xff\xff\xff"},           {20, std::string("\0\0\0\0", 4)},
      {20, std::string("\0\0\0\x10", 4)}};
  for (const auto& [offset, value] : damages) {
    std::string bytes = whole;
    bytes.replace(offsets[7] + offset, 4, value);
    SetBytes(bytes);
    EventLogReader reader(path_);
    EXPECT_EQ(ReadNumbers(&reader), AllBut(20, {7})) << "length at " << offset;
    EXPECT_EQ(reader.num_lost(), 1);
  }
}

TEST_F(EventLogTest, TruncatedEndLosesTheLastEvent) {
  const auto offsets = WriteEvents(20);
  const std::string whole = Bytes();
  for (const std::size_t size : {offsets[19] + 1, offsets[19] + 30, whole.size() - 1}) {
    SetBytes(whole.substr(0, size));
    EventLogReader reader(path_);
    EXPECT_EQ(ReadNumbers(&reader), AllBut(20, {19}));
    EXPECT_EQ(reader.num_lost(), 1);
  }
}

TEST_F(EventLogTest, CountsEveryEventOfALostStretch) {
  const auto offsets = WriteEvents(20);
  std::string bytes = Bytes();
  for (std::size_t i = offsets[3] + 2; i < offsets[9] + 2; ++i) bytes[i] = 'x';
  SetBytes(bytes);
  EventLogReader reader(path_);
  EXPECT_EQ(ReadNumbers(&reader), AllBut(20, {3, 4, 5, 6, 7, 8, 9}));
  EXPECT_EQ(reader.num_lost(), 7);
}

TEST_F(EventLogTest, PayloadThatHoldsAWholeEventIsNotTakenApart) {
  WriteEvents(3);
  const std::string inner = Bytes();
  {
    EventLogWriter writer(path_);
    writer.Append(1, "OUTER", inner.data(), inner.size());
    writer.Append(2, "OUTER", inner.data(), inner.size());
  }
  EventLogReader reader(path_);
  for (int i = 0; i < 2; ++i) {
    const auto event = reader.Next();
    ASSERT_TRUE(event);
    EXPECT_EQ(event->channel, "OUTER");
    EXPECT_EQ(event->payload.size(), inner.size());
  }
  EXPECT_FALSE(reader.Next());
}

TEST_F(EventLogTest, RandomDamageEndsAndLosesLittle) {
  WriteEvents(40);
  const std::string whole = Bytes();
  std::mt19937 random(1);
  for (int run = 0; run < 200; ++run) {
    std::string bytes = whole;
    for (int i = 0; i < 5; ++i) bytes[random() % bytes.size()] = static_cast<char>(random());
    SetBytes(bytes);
    EventLogReader reader(path_);
    int num_events = 0;
    while (reader.Next()) ++num_events;
    EXPECT_GE(num_events, 35);
    EXPECT_LE(num_events, 40);
  }
}

// Every header claims most of the file: work that grew with the square of its size would not end.
TEST_F(EventLogTest, HostileLengthsCostLinearWork) {
  std::string header("\xED\xA1\xDA\x01", 4);
  header +=
      std::string(16, '\0') + std::string("\0\0\0\x01", 4) + std::string("\x01\0\0\0", 4) + "C";
  std::string bytes;
  while (bytes.size() < (20u << 20)) bytes += header;
  SetBytes(bytes);
  EventLogReader reader(path_);
  std::int64_t num_events = 0;
  while (const auto event = reader.Next()) ++num_events;
  EXPECT_GE(num_events, 1);
  EXPECT_LE(num_events, 3);
}

TEST_F(EventLogTest, FullDiskIsSaidAndKeepsWhatWasWritten) {
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before;
  getrlimit(RLIMIT_FSIZE, &before);
  const rlimit limit{10000, before.rlim_max};
  setrlimit(RLIMIT_FSIZE, &limit);
  std::string message;
  int num_written = 0;
  {
    EventLogWriter writer(path_);
    try {
      for (int i = 0; i < 100; ++i, ++num_written) {
        const auto payload = PayloadOf(i);
        writer.Write(i, 1000 + i, i % 2 == 0 ? "EVEN" : "ODD", payload.data(), payload.size());
      }
    } catch (const WriteError& error) {
      message = error.what();
    }
    EXPECT_THROW(writer.Append(0, "EVEN", nullptr, 0), WriteError);
  }
  setrlimit(RLIMIT_FSIZE, &before);
  EXPECT_NE(message.find(path_ + ": cannot be written: File too large"), std::string::npos)
      << message;
  EventLogReader reader(path_);
  EXPECT_EQ(ReadNumbers(&reader), AllBut(num_written, {}));
  EXPECT_EQ(reader.num_lost(), 0);
  EXPECT_GT(num_written, 10);
}

}  // namespace
}  // namespace airdos
