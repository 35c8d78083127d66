#include "processes/stereo_player/player_loop.h"

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <limits>
#include <sstream>
#include <thread>
#include <utility>

#include "common/util/error.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/log/event_log.h"
#include "processes/node/log/looped_source.h"
#include "processes/node/log/partial_source.h"
#include "processes/node/message/channels.h"
#include "processes/stereo_player/dataset_source.h"

namespace airdos {
namespace {

constexpr int kPollTimeout_ms = 50;
constexpr int kMaxJumpsSaid = 10;
constexpr int kMaxDrained = 1000;  // messages received in one go
/// Limit of the sending rate: a burst of several frames overflows the receivers' socket buffers
/// (200 kB with a stock kernel) before their threads run.
constexpr double kMaxBytesPerSecond = 30e6;

// The frame that the messages belong to: that of the newest one. Sources return no messages without
// a header.
Header HeaderOfFrame(const std::vector<Envelope>& messages) {
  Header newest;
  bool is_first = true;
  for (const Envelope& message : messages) {
    const auto header = PeekHeader(message.payload.data(), message.payload.size());
    if (!header || (!is_first && header->seq <= newest.seq)) continue;
    newest = *header;
    is_first = false;
  }
  return newest;
}

template <class Message, class Handle>
LcmTransport::Handler HandlerOf(Handle handle) {
  return [handle](const void* data, std::size_t size, std::int64_t) {
    Message message;
    if (Decode(data, size, &message) && Validate(message).empty()) handle(message);
  };
}

}  // namespace

std::unique_ptr<FrameSource> OpenPlayerSource(const PlayerOptions& options, std::int64_t session) {
  if (!options.without.empty()) {
    PlayerOptions whole = options;
    whole.without.clear();
    return std::make_unique<PartialSource>(OpenPlayerSource(whole, session),
                                           ChannelsOfPeople("--without", options.without));
  }
  if (options.is_one_session) {
    PlayerOptions once = options;
    once.is_one_session = false;
    once.num_loops = 1;
    return std::make_unique<LoopedSource>([=] { return OpenPlayerSource(once, session); },
                                          options.num_loops);
  }
  const std::int64_t last = options.last.value_or(std::numeric_limits<std::int64_t>::max());
  if (options.recording.is_given()) {
    return std::make_unique<DatasetSource>(options.recording.Open(), options.recording.name(),
                                           options.first, last, session, options.image);
  }
  if (std::filesystem::is_directory(options.data)) {
    return std::make_unique<DatasetSource>(options.data, options.first, last, session,
                                           options.image, options.check.calibration);
  }
  auto log = std::make_unique<LogSource>(options.data, options.first, last);
  // Unless requested otherwise, a log is played unchanged: its sessions also occur in recorded
  // outputs.
  if (options.session || options.num_loops != 1) log->RenumberSessions(session);
  return log;
}

void WriteLog(const std::string& path, FrameSource* source, const ProcessLog& log) {
  EventLogWriter writer(path);
  while (!StopRequested()) {
    const std::vector<Envelope> frame = source->NextFrame();
    for (const std::string& note : source->TakeNotes()) log.Relay(note);
    if (frame.empty()) break;
    const std::int64_t utime = HeaderOfFrame(frame).utime;
    for (const Envelope& message : frame)
      writer.Append(utime, message.channel, message.payload.data(), message.payload.size());
  }
  writer.Sync();
  log.Info(path + ": " + std::to_string(writer.num_events()) + " messages, " +
           std::to_string(writer.num_bytes()) + " bytes");
}

PlayerLoop::PlayerLoop(const PlayerOptions& options, OpenSource open_source,
                       LcmTransport* transport, const ProcessLog* log,
                       const std::string& notify_socket)
    : options_(options),
      open_source_(std::move(open_source)),
      transport_(transport),
      log_(log),
      service_(notify_socket, log),
      gate_(options.gate, SteadyClock_s()) {}

void PlayerLoop::Run() {
  transport_->Subscribe(channel::kStatus,
                        HandlerOf<process_status_t>([this](const process_status_t& status) {
                          gate_.OnStatus(status, SteadyClock_s());
                          if (options_.pace == PlayerPace::kRealtime) lag_.OnStatus(status);
                        }));
  transport_->Subscribe(channel::kFrameDone,
                        HandlerOf<frame_done_t>([this](const frame_done_t& done) {
                          gate_.OnFrameDone(done, SteadyClock_s());
                        }));
  TellService();
  const double start_s = SteadyClock_s();
  const int num_loops = options_.is_one_session ? 1 : options_.num_loops;
  for (int loop = 0; loop < num_loops || num_loops == 0; ++loop) {
    if (StopRequested()) break;
    PlayOnce(open_source_(std::max(loop, num_sessions_)).get());
  }
  if (options_.pace == PlayerPace::kLockstep) WaitUntilAllDone();
  std::ostringstream line;
  line.precision(3);
  line << "published " << num_published_ << " frames in " << SteadyClock_s() - start_s << " s";
  if (num_not_published_ > 0)
    line << ", the network rejected " << num_not_published_ << " messages";
  log_->Info(line.str());
  service_.TellStopping(line.str());
}

void PlayerLoop::PlayOnce(FrameSource* source) {
  pace_.reset();
  for (bool is_first = true;; is_first = false) {
    const std::vector<Envelope> messages = source->NextFrame();
    SayNotes(source);
    if (messages.empty()) return;
    const Header header = HeaderOfFrame(messages);
    if (newest_session_ != header.session) ++num_sessions_;
    newest_session_ = header.session;
    if (is_first || options_.pace == PlayerPace::kLockstep) WaitUntilMayPublish();
    if (options_.pace == PlayerPace::kRealtime) WaitForTime(header);
    if (StopRequested()) return;
    PublishFrame(messages, header);
  }
}

void PlayerLoop::WaitUntilMayPublish() {
  Listen(0);
  while (!StopRequested() && !gate_.MayPublish(SteadyClock_s())) Listen(kPollTimeout_ms);
  SayNotes(nullptr);
}

void PlayerLoop::WaitForTime(const Header& header) {
  if (!pace_) pace_ = {SteadyClock_s(), header.utime};
  // In floating point: the difference of two damaged times may not fit into an integer.
  double gap_s = 1e-6 * (static_cast<double>(header.utime) - static_cast<double>(pace_->second));
  if (gap_s < 0 || gap_s > kMaxGap_s) {
    if (++num_jumps_ <= kMaxJumpsSaid) {
      std::ostringstream line;
      line.precision(3);
      line << "capture time jumps by " << gap_s << " s at image " << header.seq
           << ": continuing without waiting";
      if (num_jumps_ == kMaxJumpsSaid) line << " (further jumps are not reported)";
      log_->Warning(line.str());
    }
    gap_s = 0;
  }
  pace_ = {pace_->first + gap_s / options_.speed, header.utime};
  Listen(0);  // also where it is late
  for (double left_s = pace_->first - SteadyClock_s(); left_s > 0 && !StopRequested();
       left_s = pace_->first - SteadyClock_s()) {
    Listen(std::min(kPollTimeout_ms, static_cast<int>(1e3 * std::min(left_s, 1.0)) + 1));
  }
}

void PlayerLoop::WaitUntilAllDone() {
  while (!StopRequested() && !gate_.IsAllDone(SteadyClock_s())) Listen(kPollTimeout_ms);
  SayNotes(nullptr);
}

void PlayerLoop::Listen(int timeout_ms) {
  TellService();
  if (transport_->Poll(timeout_ms)) {
    // Bounded: a flood of STATUS must not keep the player from playing.
    for (int i = 0; i < kMaxDrained && !StopRequested() && transport_->Poll(0); ++i) {
    }
  }
  SayNotes(nullptr);
}

void PlayerLoop::PublishFrame(const std::vector<Envelope>& messages, const Header& header) {
  if (gate_.TakeNewcomer() && calibration_) Publish(*calibration_);
  for (const Envelope& message : messages) {
    if (message.channel == channel::kCalibration) calibration_ = message;
    Publish(message);
  }
  TellService();
  gate_.OnPublished(header.session, header.seq, SteadyClock_s());
  lag_.OnPublished(header);
  ++num_published_;
  if (options_.say_every > 0 && num_published_ % options_.say_every == 0)
    log_->Info(std::to_string(num_published_) + " frames published");
}

void PlayerLoop::Publish(const Envelope& message) {
  if (!transport_->Publish(message.channel, message.payload.data(), message.payload.size())) {
    if (num_not_published_++ == 0) log_->Error("cannot publish on " + message.channel);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(
      static_cast<double>(message.payload.size()) / kMaxBytesPerSecond));
}

void PlayerLoop::TellService() {
  service_.TellWhenDue(SteadyClock_s(), std::to_string(num_published_) + " frames published");
}

void PlayerLoop::SayNotes(FrameSource* source) {
  for (const std::string& note : gate_.TakeNotes()) log_->Relay(note);
  for (const std::string& note : lag_.TakeNotes()) log_->Relay(note);
  if (source == nullptr) return;
  for (const std::string& note : source->TakeNotes()) log_->Relay(note);
}

}  // namespace airdos
