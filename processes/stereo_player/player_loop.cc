#include "processes/stereo_player/player_loop.h"

#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>

#include "common/util/error.h"
#include "processes/node/channels.h"
#include "processes/node/event_log.h"
#include "processes/node/process_usage.h"

namespace airdos {
namespace {

constexpr int kPollTimeout_ms = 50;
/// Messages go out no faster than this: a burst of several frames overflows the receivers' socket
/// buffers (200 kB on a stock kernel) before their threads run.
constexpr double kMaxBytesPerSecond = 30e6;

template <class Message, class Handle>
LcmTransport::Handler HandlerOf(Handle handle) {
  return [handle](const void* data, std::size_t size, std::int64_t) {
    Message message;
    if (Decode(data, size, &message) && Validate(message).empty()) handle(message);
  };
}

}  // namespace

FrameRange RangeOf(const PlayerOptions& options, const StereoSequence& sequence) {
  const auto num_frames = static_cast<std::int64_t>(sequence.num_frames());
  const std::int64_t last = options.last.value_or(num_frames - 1);
  if (last >= num_frames || options.first > last) {
    throw InputError(options.data_folder + ": has " + std::to_string(num_frames) +
                     " frames, so --first " + std::to_string(options.first) + " --last " +
                     std::to_string(last) + " cannot be played");
  }
  return {static_cast<std::size_t>(options.first), static_cast<std::size_t>(last)};
}

void WriteLog(const PlayerOptions& options, const StereoSequence& sequence, std::int64_t session,
              std::ostream* log) {
  const FrameRange range = RangeOf(options, sequence);
  StereoPlayer player(&sequence, session, options.image);
  EventLogWriter writer(options.write_log);
  for (std::size_t index = range.first; index <= range.last && !StopRequested(); ++index) {
    const StereoPlayer::Frame frame = player.Load(index);
    for (const Envelope& message : frame.messages) {
      writer.Append(frame.header.utime, message.channel, message.payload.data(),
                    message.payload.size());
    }
  }
  for (const std::string& note : player.TakeNotes()) {
    *log << "airdos-stereo-player: " << note << std::endl;
  }
  writer.Sync();
  *log << "airdos-stereo-player: " << options.write_log << ": " << writer.num_events()
       << " messages, " << writer.num_bytes() << " bytes" << std::endl;
}

PlayerLoop::PlayerLoop(const PlayerOptions& options, const StereoSequence* sequence,
                       std::int64_t session, LcmTransport* transport, std::ostream* log)
    : options_(options),
      sequence_(sequence),
      session_(session),
      transport_(transport),
      log_(log),
      gate_(options.gate, SteadyClock_s()) {}

void PlayerLoop::Run() {
  RangeOf(options_, *sequence_);
  transport_->Subscribe(channel::kStatus,
                        HandlerOf<process_status_t>([this](const process_status_t& status) {
                          gate_.OnStatus(status, SteadyClock_s());
                        }));
  transport_->Subscribe(channel::kFrameDone,
                        HandlerOf<frame_done_t>([this](const frame_done_t& done) {
                          gate_.OnFrameDone(done, SteadyClock_s());
                        }));
  const double start_s = SteadyClock_s();
  for (int loop = 0; loop < options_.num_loops || options_.num_loops == 0; ++loop) {
    if (StopRequested()) break;
    PlayOnce(session_ + loop);
  }
  if (options_.pace == PlayerPace::kLockstep) WaitUntilAllDone();
  std::ostringstream line;
  line.precision(3);
  line << "published " << num_published_ << " frames in " << SteadyClock_s() - start_s << " s";
  if (num_not_published_ > 0) line << ", the network refused " << num_not_published_ << " messages";
  Say(line.str());
}

void PlayerLoop::PlayOnce(std::int64_t session) {
  const FrameRange range = RangeOf(options_, *sequence_);
  StereoPlayer player(sequence_, session, options_.image);
  double start_s = 0;
  std::int64_t first_utime = 0;
  for (std::size_t index = range.first; index <= range.last; ++index) {
    const StereoPlayer::Frame frame = player.Load(index);
    SayNotes(&player);
    if (index == range.first || options_.pace == PlayerPace::kLockstep) WaitUntilMayPublish();
    if (index == range.first) {
      start_s = SteadyClock_s();
      first_utime = frame.header.utime;
    }
    if (options_.pace == PlayerPace::kRealtime) {
      WaitForTime(start_s +
                  1e-6 * static_cast<double>(frame.header.utime - first_utime) / options_.rate);
    }
    if (StopRequested()) return;
    const bool has_calibration = frame.messages.front().channel == channel::kCalibration;
    if (gate_.TakeNewcomer() && !has_calibration) Publish(player.Calibration(frame.header));
    PublishFrame(frame);
  }
}

void PlayerLoop::WaitUntilMayPublish() {
  Listen(0);
  while (!StopRequested() && !gate_.MayPublish(SteadyClock_s())) Listen(kPollTimeout_ms);
  SayNotes(nullptr);
}

void PlayerLoop::WaitForTime(double due_s) {
  for (double left_s = due_s - SteadyClock_s(); left_s > 0 && !StopRequested();
       left_s = due_s - SteadyClock_s()) {
    Listen(std::min(kPollTimeout_ms, static_cast<int>(1e3 * left_s) + 1));
  }
}

void PlayerLoop::WaitUntilAllDone() {
  while (!StopRequested() && !gate_.IsAllDone(SteadyClock_s())) Listen(kPollTimeout_ms);
  SayNotes(nullptr);
}

void PlayerLoop::Listen(int timeout_ms) {
  if (transport_->Poll(timeout_ms)) {
    while (!StopRequested() && transport_->Poll(0)) {
    }
  }
  SayNotes(nullptr);
}

void PlayerLoop::PublishFrame(const StereoPlayer::Frame& frame) {
  for (const Envelope& message : frame.messages) Publish(message);
  gate_.OnPublished(frame.header.session, frame.header.seq, SteadyClock_s());
  ++num_published_;
}

void PlayerLoop::Publish(const Envelope& message) {
  if (!transport_->Publish(message.channel, message.payload.data(), message.payload.size())) {
    if (num_not_published_++ == 0) Say("cannot publish on " + message.channel);
  }
  std::this_thread::sleep_for(std::chrono::duration<double>(
      static_cast<double>(message.payload.size()) / kMaxBytesPerSecond));
}

void PlayerLoop::SayNotes(StereoPlayer* player) {
  for (const std::string& note : gate_.TakeNotes()) Say(note);
  if (player == nullptr) return;
  for (const std::string& note : player->TakeNotes()) Say(note);
}

void PlayerLoop::Say(const std::string& line) {
  *log_ << "airdos-stereo-player: " << line << std::endl;
}

}  // namespace airdos
