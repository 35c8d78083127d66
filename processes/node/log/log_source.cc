#include "processes/node/log/log_source.h"

#include <algorithm>
#include <cstring>
#include <utility>

#include "common/util/error.h"
#include "processes/node/message/channels.h"

namespace airdos {
namespace {

constexpr std::size_t kSessionsRemembered = 8;  // one's last message may be in the next one

// A frame of another session is newer, whatever its number.
bool IsNewer(const Header& a, const Header& b) { return a.session != b.session || a.seq > b.seq; }

constexpr std::size_t kFingerprintBytes = 8;

}  // namespace

std::optional<Header> PeekHeader(const void* data, std::size_t size) {
  if (size < kFingerprintBytes + 24) return std::nullopt;
  const auto* bytes = static_cast<const std::uint8_t*>(data) + kFingerprintBytes;
  const auto read = [bytes](std::size_t offset) {
    std::uint64_t value = 0;
    for (std::size_t i = 0; i < 8; ++i) value = value << 8 | bytes[offset + i];
    return static_cast<std::int64_t>(value);
  };
  return Header{read(0), read(8), read(16)};
}

void WriteHeader(const Header& header, void* data, std::size_t size) {
  if (!PeekHeader(data, size)) return;
  auto* bytes = static_cast<std::uint8_t*>(data) + kFingerprintBytes;
  for (const std::int64_t value : {header.utime, header.seq, header.session}) {
    for (int i = 7; i >= 0; --i) {
      *bytes++ = static_cast<std::uint8_t>(static_cast<std::uint64_t>(value) >> (8 * i));
    }
  }
}

LogSource::LogSource(const std::string& path, std::int64_t first_seq, std::int64_t last_seq,
                     LogInputs inputs)
    : reader_(path), first_seq_(first_seq), last_seq_(last_seq), inputs_(inputs) {
  const bool wants_features = inputs == LogInputs::kFeatures;
  const std::string missing =
      ExplainIfMissing(path, wants_features ? channel::kStaticFeatures : channel::kCameraLeft);
  if (!missing.empty())
    throw InputError(path + ": contains no message for the processes: " + missing);
}

std::optional<LogSource::Input> LogSource::ReadInput() {
  while (std::optional<LogEvent> event = reader_.Next()) {
    const bool is_feature =
        event->channel == channel::kStaticFeatures || event->channel == channel::kHumanObservations;
    const bool is_input =
        IsInputChannel(event->channel) || (is_feature && inputs_ == LogInputs::kFeatures);
    if (!is_input) continue;
    const std::optional<Header> header = PeekHeader(event->payload.data(), event->payload.size());
    if (header) return Input{*header, std::move(*event)};
    ++num_without_header_;
  }
  return std::nullopt;
}

bool LogSource::IsCredible(const Header& header) const {
  if (header.seq < 0) return false;  // receivers would reject it
  for (const Header& newest : newest_) {
    if (newest.session == header.session && header.seq - 1 <= newest.seq) return true;
  }
  if (ahead_.empty()) return true;
  return std::any_of(ahead_.begin(), ahead_.end(), [&header](const Input& later) {
    // Neither is negative, so the difference does not overflow.
    return later.header.session == header.session && later.header.seq >= header.seq &&
           later.header.seq - header.seq <= FrameJoiner::kMaxAhead;
  });
}

void LogSource::Remember(const Header& header) {
  for (Header& newest : newest_) {
    if (newest.session != header.session) continue;
    newest.seq = std::max(newest.seq, header.seq);
    return;
  }
  newest_.push_back(header);
  if (newest_.size() > kSessionsRemembered) newest_.pop_front();
}

std::optional<LogSource::Input> LogSource::NextInput() {
  while (true) {
    while (ahead_.size() < kLookahead + 1) {
      std::optional<Input> input = ReadInput();
      if (!input) break;
      ahead_.push_back(std::move(*input));
    }
    if (ahead_.empty()) break;
    Input input = std::move(ahead_.front());
    ahead_.pop_front();
    if (!IsCredible(input.header)) {
      ++num_incredible_;
      continue;
    }
    Remember(input.header);
    const bool is_before =
        input.header.seq < first_seq_ && input.event.channel != channel::kCalibration;
    if (is_before || input.header.seq > last_seq_) continue;
    pairing_.Add(input.event.channel, input.header);
    return input;
  }
  NoteDamage();
  NotePairing();
  return std::nullopt;
}

std::vector<Envelope> LogSource::NextFrame() {
  std::vector<Envelope> frame;
  if (is_at_end_) return frame;
  const bool is_first = !next_;
  if (is_first) next_ = NextInput();
  if (is_first && !next_) {
    throw InputError(reader_.path() + ": contains no message for the processes: none of " +
                     (inputs_ == LogInputs::kFeatures ? "STATIC_FEATURES" : "CAMERA_LEFT") +
                     " and the like in the range of image numbers");
  }
  frame_ = next_->header;
  while (next_ && !IsNewer(next_->header, frame_) && frame.size() < kMaxFrameMessages) {
    frame.push_back(ToEnvelope(std::move(*next_)));
    next_ = NextInput();
  }
  is_at_end_ = !next_;
  return frame;
}

Envelope LogSource::ToEnvelope(Input input) {
  Envelope message{std::move(input.event.channel), std::move(input.event.payload)};
  if (first_session_) {
    Header header = input.header;
    const auto next = *first_session_ + static_cast<std::int64_t>(session_of_.size());
    header.session = session_of_.emplace(header.session, next).first->second;
    WriteHeader(header, message.payload.data(), message.payload.size());
  }
  return message;
}

double LogSource::fraction_done() const {
  return static_cast<double>(reader_.position_bytes()) / static_cast<double>(reader_.num_bytes());
}

void LogSource::NoteDamage() {
  if (reader_.num_lost() > 0) {
    notes_.push_back(reader_.path() + ": " + std::to_string(reader_.num_lost()) +
                     " events lost to damage (" + std::to_string(reader_.num_bytes_skipped()) +
                     " bytes skipped)");
  }
  if (num_without_header_ > 0) {
    notes_.push_back(reader_.path() + ": " + std::to_string(num_without_header_) +
                     " messages skipped: too short for a header");
  }
  if (num_incredible_ > 0) {
    notes_.push_back(
        reader_.path() + ": " + std::to_string(num_incredible_) +
        " messages skipped: their session or image number does not fit their neighbours");
  }
}

void LogSource::NotePairing() {
  if (inputs_ == LogInputs::kFeatures) return;
  if (!pairing_.Has(channel::kCameraRight))
    notes_.push_back(reader_.path() + ": no message on CAMERA_RIGHT: nothing can be measured");
  for (const LogPairing::Remark& remark : pairing_.Remarks()) {
    notes_.push_back(reader_.path() + ": " + remark.channel +
                     (remark.seq ? " " + std::to_string(*remark.seq) : std::string()) + ": " +
                     remark.text);
  }
}

}  // namespace airdos
