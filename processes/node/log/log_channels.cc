#include "processes/node/log/log_channels.h"

#include <algorithm>
#include <cctype>

#include "common/util/words.h"
#include "processes/node/log/event_log.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/types_fingerprint.h"

namespace airdos {
namespace {

bool Contains(const std::vector<std::string>& channels, const std::string& channel) {
  return std::find(channels.begin(), channels.end(), channel) != channels.end();
}

const std::vector<std::string>& OutputChannels() {
  static const std::vector<std::string> channels{channel::kStaticFeatures,
                                                 channel::kHumanObservations,
                                                 channel::kStateEstimate, channel::kMapUpdate};
  return channels;
}

/// Letters and digits only, in upper case.
std::string Bare(const std::string& name) {
  std::string bare;
  for (const char c : name) {
    const auto code = static_cast<unsigned char>(c);
    if (std::isalnum(code) != 0) bare += static_cast<char>(std::toupper(code));
  }
  return bare;
}

}  // namespace

const std::vector<std::string>& InputChannels() {
  static const std::vector<std::string> channels{
      channel::kCameraLeft,          channel::kCameraRight,          channel::kCalibration,
      channel::kPersonKeypointsLeft, channel::kPersonKeypointsRight, channel::kPersonMask,
      channel::kGroundTruth};
  return channels;
}

bool IsInputChannel(const std::string& channel) { return Contains(InputChannels(), channel); }
bool IsOutputChannel(const std::string& channel) { return Contains(OutputChannels(), channel); }

std::optional<std::int64_t> PeekFingerprint(const void* data, std::size_t size) {
  if (size < 8) return std::nullopt;
  const auto* bytes = static_cast<const std::uint8_t*>(data);
  std::uint64_t value = 0;
  for (int i = 0; i < 8; ++i) value = value << 8 | bytes[i];
  return static_cast<std::int64_t>(value);
}

std::string TypeOfFingerprint(std::int64_t fingerprint) {
  for (const auto& [name, of_type] : MessageTypes()) {
    if (of_type == fingerprint) return name;
  }
  return "";
}

void LogChannels::Add(const std::string& channel, const void* data, std::size_t size) {
  auto it = entries_.find(channel);
  if (it == entries_.end() && (entries_.size() < kMaxNames || IsInputChannel(channel))) {
    it = entries_.emplace(channel, Entry()).first;
    const std::optional<std::int64_t> fingerprint = PeekFingerprint(data, size);
    if (fingerprint) it->second.type = TypeOfFingerprint(*fingerprint);
  }
  Entry& entry = it == entries_.end() ? others_ : it->second;
  ++entry.num_messages;
  entry.num_bytes += static_cast<std::int64_t>(size);
}

std::int64_t LogChannels::num_messages(const std::string& channel) const {
  const auto it = entries_.find(channel);
  return it == entries_.end() ? 0 : it->second.num_messages;
}

std::string LogChannels::List() const {
  std::string text;
  std::size_t num_listed = 0;
  for (const auto& [name, entry] : entries_) {
    if (num_listed++ == kMaxListed) {
      text += " and " + std::to_string(entries_.size() - kMaxListed) + " more";
      break;
    }
    text += (text.empty() ? "" : ", ") + name + " (" + std::to_string(entry.num_messages) +
            (entry.num_messages == 1 ? " message" : " messages") +
            (entry.type.empty() ? "" : " of " + entry.type) + ", " +
            std::to_string((entry.num_bytes + 1023) / 1024) + " kB)";
  }
  if (others_.num_messages > 0)
    text += ", " + std::to_string(others_.num_messages) + " messages on further channels";
  return text;
}

std::optional<std::string> LogChannels::LookAlike(const std::string& wanted) const {
  std::optional<std::string> best;
  for (const auto& [name, entry] : entries_) {
    const bool is_like =
        !IsInputChannel(name) && Bare(name).find(Bare(wanted)) != std::string::npos;
    if (is_like && (!best || name.size() < best->size())) best = name;
  }
  return best;
}

std::vector<std::string> LogChannels::Outputs() const {
  std::vector<std::string> outputs;
  for (const auto& [name, entry] : entries_) {
    if (IsOutputChannel(name)) outputs.push_back(name);
  }
  return outputs;
}

std::string LogChannels::ExplainMissing(const std::string& wanted) const {
  std::string text = "no message on " + wanted + "; the channels read are " +
                     JoinWords(InputChannels(), ", ") + "; the log contains " + List();
  const std::optional<std::string> like = LookAlike(wanted);
  if (like) {
    text += "; " + *like + " looks like " + wanted + ": publish it under exactly that name, and " +
            "the others likewise";
  }
  return text;
}

std::string ExplainIfMissing(const std::string& path, const std::string& wanted) {
  EventLogReader reader(path);
  LogChannels channels;
  while (const std::optional<LogEvent> event = reader.Next()) {
    if (event->channel == wanted) return "";
    channels.Add(event->channel, event->payload.data(), event->payload.size());
  }
  return channels.ExplainMissing(wanted);
}

}  // namespace airdos
