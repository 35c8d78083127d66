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

// Event logs in LCM's format, as lcm-logger writes and lcm-logplayer reads them, without LCM: the
// timestamps are ours, damage is survived, and every write is checked. One event is, in big-endian
// order: int32 sync word 0xEDA1DA01, int64 number, int64 utime, int32 length of the channel's name,
// int32 length of the data, name, data.

struct LogEvent {
  std::int64_t number = 0;
  std::int64_t utime = 0;  ///< us; whose clock that is, is up to the writer
  std::string channel;
  std::vector<std::uint8_t> payload;
};

/// Reads a log from its beginning. Behind damage it goes on at the next event that makes sense; no
/// length in the file is believed before it was checked against the size of the file and
/// kMaxPayloadBytes. The work is linear in the size of the file, whatever it holds.
class EventLogReader {
 public:
  static constexpr std::int64_t kMaxPayloadBytes = 64 << 20;

  /// Throws InputError if the file cannot be read, is of another kind (told by its first bytes, so
  /// that a long video is not searched for events) or holds no event at all. Never waits for a
  /// pipe.
  explicit EventLogReader(const std::string& path);

  /// The next event, or nothing at the end of the file.
  std::optional<LogEvent> Next();

  /// Events lost to damage up to here, as far as the numbers of their neighbours tell.
  std::int64_t num_lost() const { return num_lost_; }
  std::int64_t num_bytes_skipped() const { return num_bytes_skipped_; }
  std::int64_t num_bytes() const { return num_bytes_; }
  std::int64_t position_bytes() const { return position_bytes_; }
  const std::string& path() const { return path_; }

 private:
  struct EventHeader {
    std::int64_t number = 0;
    std::int64_t utime = 0;
    std::int64_t channel_bytes = 0;
    std::int64_t payload_bytes = 0;
    std::int64_t end = 0;  // offset of the byte behind the event
  };
  struct CloseFile {
    void operator()(std::FILE* file) const { std::fclose(file); }
  };

  std::optional<LogEvent> ReadEvent();
  bool ReadAt(std::int64_t offset, void* bytes, std::size_t size) const;
  std::optional<EventHeader> HeaderAt(std::int64_t offset) const;
  bool IsBoundary(std::int64_t offset) const;
  // First event in [from, to) that makes sense; with `is_followed`, one that an event or the end of
  // the file follows.
  std::optional<std::int64_t> FindHeader(std::int64_t from, std::int64_t to,
                                         bool is_followed) const;
  // The first event behind bytes that belong to none, if it is the next by its number: then the
  // bytes are the rest of the event with this header.
  std::optional<std::int64_t> SuccessorBehind(const EventHeader& header) const;
  void CountLost(std::int64_t num_bytes, const EventHeader* next);

  std::string path_;
  std::unique_ptr<std::FILE, CloseFile> file_;
  std::int64_t num_bytes_ = 0;
  std::int64_t offset_ = 0;          // of the next header
  std::int64_t position_bytes_ = 0;  // behind the event that Next() gave last
  std::int64_t num_lost_ = 0;
  std::int64_t num_bytes_skipped_ = 0;
  std::int64_t last_number_ = -1;
  std::optional<LogEvent> first_;
};

/// A log could not be written to its end: disk full, for instance. What was written before is
/// intact.
class WriteError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// Writes a log. Each event goes to the system at once, so nothing that was written is lost when
/// the process is killed.
class EventLogWriter {
 public:
  /// Replaces the file if there is one. Throws InputError if it cannot be created, or another
  /// writer is at work on it.
  explicit EventLogWriter(const std::string& path);
  ~EventLogWriter();
  EventLogWriter(const EventLogWriter&) = delete;
  EventLogWriter& operator=(const EventLogWriter&) = delete;

  /// Whether a log can hold such an event: a name of 1..63 characters, none of them a
  /// control character, and at most EventLogReader::kMaxPayloadBytes.
  static bool Accepts(const std::string& channel, std::size_t size);
  /// The log must accept the event. Throws WriteError if it cannot be written as a whole; the log
  /// then ends with the event before it, and no further one is taken.
  void Write(std::int64_t number, std::int64_t utime, const std::string& channel, const void* data,
             std::size_t size);
  /// Numbers the events from 0 on.
  void Append(std::int64_t utime, const std::string& channel, const void* data, std::size_t size) {
    Write(num_events_, utime, channel, data, size);
  }
  /// Has the system put everything on the disk. Throws WriteError.
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
