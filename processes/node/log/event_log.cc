#include "processes/node/log/event_log.h"

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>
#include <utility>

#include "common/util/check.h"
#include "common/util/error.h"
#include "processes/node/log/foreign_file.h"

namespace airdos {
namespace {

constexpr std::array<std::uint8_t, 4> kSyncWord{0xED, 0xA1, 0xDA, 0x01};
constexpr std::int64_t kHeaderBytes = 28;
constexpr std::size_t kMaxWrittenChannelBytes = 63;  // LCM_MAX_CHANNEL_NAME_LENGTH
// LCM's own reader accepts this much; other programs may write names above LCM's limit.
constexpr std::int64_t kMaxChannelBytes = 999;

std::uint64_t ReadBigEndian(const std::uint8_t* bytes, int size) {
  std::uint64_t value = 0;
  for (int i = 0; i < size; ++i) value = value << 8 | bytes[i];
  return value;
}

// LCM accepts any byte in a name; blanks and special characters of regular expressions do occur.
// Control characters do not, so refusing them helps to distinguish names from damaged bytes.
bool IsOfName(std::uint8_t character) { return character >= 0x20 && character != 0x7f; }

void WriteBigEndian(std::uint64_t value, int size, std::uint8_t* bytes) {
  for (int i = 0; i < size; ++i)
    bytes[i] = static_cast<std::uint8_t>(value >> (8 * (size - 1 - i)));
}

}  // namespace

EventLogReader::EventLogReader(const std::string& path) : path_(path) {
  struct stat status = {};
  const auto fail = [&path] {
    throw InputError(path + ": cannot be read: " + std::strerror(errno));
  };
  // Checked before opening: opening a pipe would wait for its writer.
  if (stat(path.c_str(), &status) != 0) fail();
  if (S_ISDIR(status.st_mode)) throw InputError(path + ": is a folder, not an LCM log");
  if (!S_ISREG(status.st_mode))
    throw InputError(path + ": is a pipe or a device, not a file: an LCM log is expected");
  file_.reset(std::fopen(path.c_str(), "rb"));
  if (file_ == nullptr || fstat(fileno(file_.get()), &status) != 0) fail();
  num_bytes_ = status.st_size;
  if (num_bytes_ == 0) throw InputError(path + ": holds no LCM event (0 bytes): the file is empty");
  std::vector<std::uint8_t> bytes(
      static_cast<std::size_t>(std::min<std::int64_t>(num_bytes_, kForeignFileBytes)));
  if (!ReadAt(0, bytes.data(), bytes.size())) fail();
  const std::string description = DescribeForeignFile(bytes);
  if (!description.empty()) throw InputError(path + ": " + description);
  first_ = ReadEvent();
  if (first_) return;
  if (LooksLikeText(bytes)) throw InputError(path + ": is a text file, not an LCM log");
  throw InputError(path + ": holds no LCM event (" + std::to_string(num_bytes_) +
                   " bytes): it is not an LCM log, or damaged from end to end");
}

std::optional<LogEvent> EventLogReader::Next() {
  std::optional<LogEvent> event = first_ ? std::exchange(first_, std::nullopt) : ReadEvent();
  position_bytes_ = offset_;
  return event;
}

bool EventLogReader::ReadAt(std::int64_t offset, void* bytes, std::size_t size) const {
  if (std::ftell(file_.get()) != offset && fseeko(file_.get(), offset, SEEK_SET) != 0) return false;
  return std::fread(bytes, 1, size, file_.get()) == size;
}

std::optional<EventLogReader::EventHeader> EventLogReader::HeaderAt(std::int64_t offset) const {
  std::array<std::uint8_t, kHeaderBytes + kMaxChannelBytes> bytes;
  if (num_bytes_ - offset < kHeaderBytes) return std::nullopt;
  if (!ReadAt(offset, bytes.data(), kHeaderBytes)) return std::nullopt;
  if (!std::equal(kSyncWord.begin(), kSyncWord.end(), bytes.begin())) return std::nullopt;
  EventHeader header;
  header.number = static_cast<std::int64_t>(ReadBigEndian(&bytes[4], 8));
  header.utime = static_cast<std::int64_t>(ReadBigEndian(&bytes[12], 8));
  header.channel_bytes = static_cast<std::int64_t>(ReadBigEndian(&bytes[20], 4));
  header.payload_bytes = static_cast<std::int64_t>(ReadBigEndian(&bytes[24], 4));
  header.end = offset + kHeaderBytes + header.channel_bytes + header.payload_bytes;
  const bool makes_sense = header.channel_bytes >= 1 && header.channel_bytes <= kMaxChannelBytes &&
                           header.payload_bytes <= kMaxPayloadBytes && header.end <= num_bytes_;
  if (!makes_sense) return std::nullopt;
  if (!ReadAt(offset + kHeaderBytes, bytes.data(), static_cast<std::size_t>(header.channel_bytes)))
    return std::nullopt;
  const auto name_end = bytes.begin() + header.channel_bytes;
  if (!std::all_of(bytes.begin(), name_end, IsOfName)) return std::nullopt;
  return header;
}

bool EventLogReader::IsBoundary(std::int64_t offset) const {
  if (offset == num_bytes_) return true;
  std::array<std::uint8_t, 4> bytes;
  return num_bytes_ - offset >= 4 && ReadAt(offset, bytes.data(), 4) && bytes == kSyncWord;
}

std::optional<std::int64_t> EventLogReader::FindHeader(std::int64_t from, std::int64_t to,
                                                       bool is_followed) const {
  constexpr std::int64_t kChunkBytes = 64 << 10;
  std::vector<std::uint8_t> chunk;
  // Chunks overlap by three bytes so that no sync word is split between two.
  for (std::int64_t start = from; start < to; start += kChunkBytes) {
    const std::int64_t size = std::min(kChunkBytes + 3, num_bytes_ - start);
    chunk.resize(static_cast<std::size_t>(size));
    if (!ReadAt(start, chunk.data(), chunk.size())) return std::nullopt;
    auto it = chunk.begin();
    while ((it = std::search(it, chunk.end(), kSyncWord.begin(), kSyncWord.end())) != chunk.end()) {
      const std::int64_t offset = start + (it - chunk.begin());
      if (offset >= to) return std::nullopt;
      const std::optional<EventHeader> header = HeaderAt(offset);
      if (header && (!is_followed || IsBoundary(header->end))) return offset;
      ++it;
    }
  }
  return std::nullopt;
}

std::optional<std::int64_t> EventLogReader::SuccessorBehind(const EventHeader& header) const {
  const std::optional<std::int64_t> next = FindHeader(header.end, num_bytes_, false);
  // Unsigned, since a damaged number may be the largest possible one.
  const std::uint64_t expected = static_cast<std::uint64_t>(header.number) + 1;
  if (!next || static_cast<std::uint64_t>(HeaderAt(*next)->number) != expected) return std::nullopt;
  return next;
}

void EventLogReader::CountLost(std::int64_t num_bytes, const EventHeader* next) {
  num_bytes_skipped_ += num_bytes;
  // Loggers number their events; trust this only as far as the skipped bytes could have held them.
  std::int64_t num_events = 1;
  if (next != nullptr && next->number > last_number_) {
    const std::int64_t most = std::max<std::int64_t>(1, num_bytes / kHeaderBytes);
    const std::uint64_t gap =
        static_cast<std::uint64_t>(next->number) - static_cast<std::uint64_t>(last_number_) - 1;
    if (gap >= 1 && gap <= static_cast<std::uint64_t>(most))
      num_events = static_cast<std::int64_t>(gap);
  }
  num_lost_ += num_events;
}

std::optional<LogEvent> EventLogReader::ReadEvent() {
  const std::int64_t start = offset_;
  std::optional<EventHeader> header;
  while (offset_ < num_bytes_) {
    header = HeaderAt(offset_);
    std::optional<std::int64_t> next;
    if (!header) {
      next = FindHeader(offset_ + 1, num_bytes_, false);
    } else {
      if (IsBoundary(header->end)) break;
      // Either this event's length is damaged (it then includes other intact events, or there are
      // leftover bytes before the event with the next number), or the following event is.
      next = FindHeader(offset_ + 4, header->end, true);
      if (!next) next = SuccessorBehind(*header);
      if (!next) break;
    }
    header.reset();
    offset_ = next.value_or(num_bytes_);
  }
  if (offset_ > start) CountLost(offset_ - start, header ? &*header : nullptr);
  if (!header) return std::nullopt;

  LogEvent event;
  event.number = header->number;
  event.utime = header->utime;
  event.channel.resize(static_cast<std::size_t>(header->channel_bytes));
  event.payload.resize(static_cast<std::size_t>(header->payload_bytes));
  const bool is_read = ReadAt(offset_ + kHeaderBytes, event.channel.data(), event.channel.size()) &&
                       ReadAt(offset_ + kHeaderBytes + header->channel_bytes, event.payload.data(),
                              event.payload.size());
  if (!is_read) throw InputError(path_ + ": cannot be read at byte " + std::to_string(offset_));
  last_number_ = header->number;
  offset_ = header->end;
  return event;
}

EventLogWriter::EventLogWriter(const std::string& path)
    : path_(path), file_(open(path.c_str(), O_WRONLY | O_CREAT | O_CLOEXEC, 0644)) {
  if (file_ < 0) throw InputError(path + ": cannot be created: " + std::strerror(errno));
  // Truncated only once no other writer is active: two writers would leave a mixture.
  struct stat status = {};
  const bool is_file = fstat(file_, &status) == 0 && S_ISREG(status.st_mode);
  const bool is_taken = is_file && flock(file_, LOCK_EX | LOCK_NB) != 0 && errno == EWOULDBLOCK;
  if (!is_taken && (!is_file || ftruncate(file_, 0) == 0)) return;
  const std::string why = is_taken ? "another program is writing it" : std::strerror(errno);
  close(file_);
  throw InputError(path + ": cannot be written: " + why);
}

EventLogWriter::~EventLogWriter() { close(file_); }

void EventLogWriter::Fail(const std::string& what) {
  has_failed_ = true;
  throw WriteError(path_ + ": " + what + "; the " + std::to_string(num_events_) +
                   " events before are kept");
}

bool EventLogWriter::Accepts(const std::string& channel, std::size_t size) {
  return !channel.empty() && channel.size() <= kMaxWrittenChannelBytes &&
         std::all_of(channel.begin(), channel.end(),
                     [](char c) { return IsOfName(static_cast<std::uint8_t>(c)); }) &&
         size <= static_cast<std::size_t>(EventLogReader::kMaxPayloadBytes);
}

void EventLogWriter::Write(std::int64_t number, std::int64_t utime, const std::string& channel,
                           const void* data, std::size_t size) {
  if (has_failed_) Fail("is closed after a failed write");
  AIRDOS_CHECK(Accepts(channel, size));
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kHeaderBytes) + channel.size() + size);
  std::copy(kSyncWord.begin(), kSyncWord.end(), bytes.begin());
  WriteBigEndian(static_cast<std::uint64_t>(number), 8, &bytes[4]);
  WriteBigEndian(static_cast<std::uint64_t>(utime), 8, &bytes[12]);
  WriteBigEndian(channel.size(), 4, &bytes[20]);
  WriteBigEndian(size, 4, &bytes[24]);
  std::copy(channel.begin(), channel.end(), bytes.begin() + kHeaderBytes);
  if (size > 0) std::memcpy(&bytes[bytes.size() - size], data, size);

  std::size_t num_written = 0;
  while (num_written < bytes.size()) {
    const ssize_t step = write(file_, &bytes[num_written], bytes.size() - num_written);
    if (step < 0 && errno == EINTR) continue;
    if (step <= 0) {
      const std::string reason = step < 0 ? std::strerror(errno) : "nothing was taken";
      // Half an event at the end would count as damage; if it cannot be cut off, the reader skips
      // it.
      if (num_written > 0 && ftruncate(file_, num_bytes_) != 0)
        Fail("cannot be written or cut: " + reason);
      Fail("cannot be written: " + reason);
    }
    num_written += static_cast<std::size_t>(step);
  }
  num_bytes_ += static_cast<std::int64_t>(bytes.size());
  ++num_events_;
}

void EventLogWriter::Sync() {
  // EINVAL: a pipe or a device such as /dev/null, for which there is nothing to wait.
  if (fdatasync(file_) != 0 && errno != EINVAL && errno != EROFS) {
    Fail(std::string("cannot be flushed to disk: ") + std::strerror(errno));
  }
}

}  // namespace airdos
