#include "processes/node/live/log_recorder.h"

#include <unistd.h>

#include <cstring>
#include <iomanip>
#include <optional>
#include <sstream>
#include <vector>

#include "airdos/process_status_t.hpp"
#include "common/util/error.h"
#include "common/util/free_disk.h"
#include "common/util/output_files.h"
#include "common/util/version.h"
#include "processes/node/frame_joiner.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/types_fingerprint.h"

namespace airdos {
namespace {

constexpr char kProcessName[] = "airdos-record";
constexpr int kPollTimeout_ms = 50;
constexpr double kStatusPeriod_s = 1.0;
// For our own last message to come back; it may be lost.
constexpr double kMaxWaitForOwnEcho_s = 5.0;

// The writer replaces an existing file.
const std::string& CheckedPath(const LogRecorderOptions& options) {
  if (!options.replaces_file && StampOf(options.path)) {
    throw InputError(options.path + ": already exists; --force replaces it");
  }
  CheckOutputFile(options.path, {{}, options.replaces_file});
  return options.path;
}

std::regex ToRegex(const std::string& text) {
  try {
    return std::regex(text);
  } catch (const std::regex_error&) {
    throw InputError("--channels '" + text + "': is not a regular expression");
  }
}

bool CarriesEveryImage(const std::string& channel) {
  return IsOutputChannel(channel) || channel == channel::kCameraLeft ||
         channel == channel::kCameraRight;
}

// Returns the bytes that were sent.
std::vector<std::uint8_t> PublishStatus(const LogRecorder& recorder, LcmTransport* transport,
                                        std::int8_t state, const std::string& error) {
  process_status_t status = {};
  status.process = kProcessName;
  status.version = kVersion;
  status.types_fingerprint = TypesFingerprint();
  status.pid = getpid();
  status.state = state;
  status.memory_mb = ResidentMemory_mb();
  status.last_error = error.substr(0, 500);
  for (const auto& [name, counters] : recorder.channels()) {
    channel_status_t channel = {};
    channel.channel = name;
    channel.num_received = counters.num_received;
    channel.num_missing = counters.num_missing;
    status.channels.push_back(channel);
  }
  status.num_channels = static_cast<std::int32_t>(status.channels.size());
  std::vector<std::uint8_t> bytes = Encode(status);
  transport->Publish(channel::kStatus, bytes.data(), bytes.size());
  return bytes;
}

}  // namespace

LogRecorder::LogRecorder(const LogRecorderOptions& options)
    : options_(options), pattern_(ToRegex(options.channels)), writer_(CheckedPath(options)) {}

void LogRecorder::Take(const std::string& channel, const void* data, std::size_t size,
                       std::int64_t receive_utime) {
  if (channel == "LCM_SELF_TEST" || !std::regex_match(channel, pattern_)) return;
  if (options_.inputs_only && !IsInputChannel(channel)) return;
  if (!EventLogWriter::Accepts(channel, size)) {
    ++num_rejected_;
    return;
  }
  CheckDisk(size);
  writer_.Append(receive_utime, channel, data, size);
  ++CountersOf(channel).num_received;
  CountGap(channel, data, size);
}

ChannelCounters& LogRecorder::CountersOf(const std::string& channel) {
  const auto known = channels_.find(channel);
  if (known != channels_.end()) return known->second;
  // Channels that are counted for gaps always get their own entry, whatever came first.
  return channels_[channels_.size() < kMaxChannels || CarriesEveryImage(channel) ? channel
                                                                                 : kOtherChannels];
}

void LogRecorder::CheckDisk(std::size_t num_bytes) {
  constexpr std::size_t kCheckEveryBytes = 8u << 20;
  num_bytes_unchecked_ += num_bytes;
  if (num_bytes_unchecked_ < kCheckEveryBytes) return;
  num_bytes_unchecked_ = 0;
  const std::string why = WhyDiskIsFull(options_.path);
  if (!why.empty()) {
    throw WriteError(options_.path + ": " + why + ": recording ends; the " +
                     std::to_string(writer_.num_events()) + " events before are kept");
  }
}

void LogRecorder::CountGap(const std::string& channel, const void* data, std::size_t size) {
  const std::optional<Header> header = PeekHeader(data, size);
  if (!CarriesEveryImage(channel) || !header) return;
  const auto [entry, is_first] = newest_.emplace(channel, *header);
  Header& newest = entry->second;
  if (!is_first && newest.session == header->session) {
    if (header->seq <= newest.seq) return;
    // Unsigned, because the difference of hostile numbers may overflow.
    const std::uint64_t num_missing =
        static_cast<std::uint64_t>(header->seq) - static_cast<std::uint64_t>(newest.seq) - 1;
    if (num_missing > static_cast<std::uint64_t>(FrameJoiner::kMaxAhead))
      return;  // the processes reject it as well
    channels_[channel].num_missing += static_cast<std::int64_t>(num_missing);
  }
  newest = *header;
}

std::string LogRecorder::Summary() const {
  std::ostringstream text;
  for (const auto& [name, counters] : channels_) {
    text << std::left << std::setw(24) << name << std::right << std::setw(8)
         << counters.num_received << " messages";
    if (counters.num_missing > 0) text << ", " << counters.num_missing << " missing";
    text << "\n";
  }
  if (num_rejected_ > 0) text << num_rejected_ << " messages that no log can hold were left out\n";
  text << options_.path << ": " << writer_.num_events() << " events, " << writer_.num_bytes()
       << " bytes\n";
  return text.str();
}

int RunLogRecorder(LcmTransport* transport, const LogRecorderOptions& options, std::ostream* out,
                   const ProcessLog& log, ServiceNotifier* service) {
  LogRecorder recorder(options);
  std::vector<std::uint8_t> farewell;
  bool farewell_is_back = false;
  transport->SubscribeAll([&](const std::string& channel, const void* data, std::size_t size,
                              std::int64_t receive_utime) {
    recorder.Take(channel, data, size, receive_utime);
    if (!farewell.empty() && size == farewell.size() &&
        std::memcmp(data, farewell.data(), size) == 0) {
      farewell_is_back = true;
    }
  });
  *out << kProcessName << " READY version " << kVersion << " url " << transport->url() << " file "
       << options.path << std::endl;
  std::string error;
  double next_status_s = 0;
  double next_sync_s = SteadyClock_s() + options.flush_s;
  try {
    while (!StopRequested()) {
      const double now_s = SteadyClock_s();
      if (now_s >= next_status_s) {
        PublishStatus(recorder, transport, process_status_t::STATE_READY, "");
        service->Tell("recording to " + options.path);
        next_status_s = now_s + kStatusPeriod_s;
      }
      if (now_s >= next_sync_s) {
        recorder.Sync();
        next_sync_s = now_s + options.flush_s;
      }
      transport->Poll(kPollTimeout_ms);
    }
    // What was sent before the signal is still recorded, also where it waits in the kernel because
    // this process had no turn: datagrams keep their order, so all of it comes before our own.
    farewell = PublishStatus(recorder, transport, process_status_t::STATE_STOPPING, "");
    const double deadline_s = SteadyClock_s() + kMaxWaitForOwnEcho_s;
    while (!farewell_is_back && SteadyClock_s() < deadline_s) transport->Poll(kPollTimeout_ms);
    if (!farewell_is_back) {
      log.Warning("this program's own last message did not come back: others may be missing too");
    }
    recorder.Sync();
  } catch (const WriteError& failure) {
    error = failure.what();
    log.Error(error);
  }
  PublishStatus(recorder, transport, process_status_t::STATE_STOPPING, error);
  service->TellStopping(error.empty() ? "recorded to " + options.path : error);
  *out << recorder.Summary() << std::flush;
  return error.empty() ? 0 : 1;
}

}  // namespace airdos
