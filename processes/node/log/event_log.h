#ifndef AIRDOS_PROCESSES_NODE_LOG_EVENT_LOG_H_
#define AIRDOS_PROCESSES_NODE_LOG_EVENT_LOG_H_

#include <cstddef>
#include <cstdint>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

namespace airdos {

// Event logs in LCM's format, as written by lcm-logger and read by lcm-logplayer, but without LCM:
// we choose the timestamps, damage is survived, and every write is checked. An event consists of,
// in big-endian order: int32 sync word 0xEDA1DA01, int64 number, int64 utime, int32 length of the
// channel name, int32 length of the data, name, data.

/// One message in a log.
struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;  ///< us; the writer chooses the clock
  std::string channel;
  std::vector<std::uint8_t> payload;
};

/// Reads a log sequentially. After damage it continues with the next plausible event; no length in
/// the file is trusted before it has been checked against the file size and kMaxPayloadBytes. Run
/// time is linear in the file size, whatever the file contains.
class EventLogReader {
 public:
  static constexpr std::int64_t kMaxPayloadBytes = 64 << 20;

  /// Throws InputError if the file cannot be read, has another format (recognised by its first
  /// bytes, so that a long video is not searched for events) or contains no event at all. Never
  /// blocks on a pipe.
  explicit EventLogReader(const std::string& path);

  /// The next event, or nothing at the end of the file.
  std::optional<LogEvent> Next();

  /// Number of events lost to damage so far, judging by the numbers of the neighbouring events.
  std::int64_t num_lost() const { return num_lost_; }
  std::int64_t num_bytes_skipped() const { return num_bytes_skipped_; }
  std::int64_t num_bytes() const { return num_bytes_; }
  std::int64_t position_bytes() const { return position_bytes_; }
  const std::string& path() const { return path_; }

 private:
  /// An event's fixed-size fields and position.
  struct EventHeader {
    std::int64_t number = 0;
    std::int64_t utime = 0;
    std::int64_t channel_bytes = 0;
    std::int64_t payload_bytes = 0;
    std::int64_t end = 0;  // offset of the first byte after the event
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::optional<LogEvent> ReadEvent();
  bool ReadAt(std::int64_t offset, void* bytes, std::size_t size) const;
  std::optional<EventHeader> HeaderAt(std::int64_t offset) const;
  bool IsBoundary(std::int64_t offset) const;
  // First plausible event in [from, to); with `is_followed`, one that is directly followed by
  // another event or the end of the file.
  std::optional<std::int64_t> FindHeader(std::int64_t from, std::int64_t to,
                                         bool is_followed) const;
  // The first event after bytes that belong to none, if its number shows that it is the next one:
  // then the bytes are the rest of the event with this header.
  std::optional<std::int64_t> SuccessorBehind(const EventHeader& header) const;
  void CountLost(std::int64_t num_bytes, const EventHeader* next);

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::int64_t num_bytes_ = 0;
  std::int64_t offset_ = 0;          // position of the next header
  std::int64_t position_bytes_ = 0;  // end of the last event that Next() returned
  std::int64_t num_lost_ = 0;
  std::int64_t num_bytes_skipped_ = 0;
  std::int64_t last_number_ = -1;
  std::optional<LogEvent> first_;
};

/// A log could not be written completely, for example because the disk is full. What was written
/// before is intact.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a log. Each event is handed to the operating system at once, so nothing written is lost
/// if the process is killed.
class EventLogWriter {
 public:
  /// Replaces an existing file. Throws InputError if the file cannot be created, or if another
  /// writer is using it.
  explicit EventLogWriter(const std::string& path);
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// Whether a log can hold such an event: a name of 1..63 characters without control characters,
  /// and at most EventLogReader::kMaxPayloadBytes.
  static bool Accepts(const std::string& channel, std::size_t size);
  /// The event must satisfy Accepts(). Throws WriteError if it cannot be written completely; the
  /// log then ends with the previous event and accepts no more.
  void Write(std::int64_t number, std::int64_t utime, const std::string& channel, const void* data,
             std::size_t size);
  /// Writes an event numbered consecutively, starting at 0.
  void Append(std::int64_t utime, const std::string& channel, const void* data, std::size_t size) {
    Write(num_events_, utime, channel, data, size);
  }
  /// Flushes everything to disk. Throws WriteError.
  void Sync();

  std::int64_t num_events() const { return num_events_; }
  std::int64_t num_bytes() const { return num_bytes_; }

 private:
  [[noreturn]] void Fail(const std::string& what);

  std::string path_;
  int file_ = -1;
  bool has_failed_ = false;
  std::int64_t num_events_ = 0;
  std::int64_t num_bytes_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LOG_EVENT_LOG_H_
