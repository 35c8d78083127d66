#include "processes/node/live/lcm_runner.h"

#include <unistd.h>

#include <algorithm>
#include <exception>
#include <iomanip>
#include <sstream>

#include "airdos/frame_done_t.hpp"
#include "airdos/process_status_t.hpp"
#include "common/util/version.h"
#include "processes/node/log/log_source.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/figures.h"
#include "processes/node/message/header.h"
#include "processes/node/message/types_fingerprint.h"

namespace airdos {
namespace {

/// How many deadlines to wait for a channel. Who speaks on it may wait for its own inputs, so
/// whoever is further down the chain gives up later: else one silent camera would cost two
/// processes their frame.
double NumDeadlines(const std::string& channel) {
  const bool is_of_people = channel == channel::kPersonKeypointsLeft ||
                            channel == channel::kPersonKeypointsRight ||
                            channel == channel::kPersonMask;
  if (is_of_people) return 1.125;  // of the person detector, if there is one
  if (IsInputChannel(channel)) return 1;
  if (channel == channel::kHumanObservations) return 1.25;
  if (channel == channel::kStaticFeatures) return 1.5;
  return 1.75;
}

constexpr int kPollTimeout_ms = 50;
constexpr double kStatusPeriod_s = 1.0;

channel_status_t StatusOf(const std::string& channel, const ChannelCounters& counters) {
  channel_status_t status = {};
  status.channel = channel;
  status.num_received = counters.num_received;
  status.num_missing = counters.num_missing;
  status.num_duplicate = counters.num_duplicate;
  status.num_rejected = counters.num_rejected;
  status.last_reject = counters.last_reject;
  return status;
}

}  // namespace

LcmRunner::LcmRunner(Node* node, LcmTransport* transport, const LcmRunnerOptions& options,
                     const ProcessLog* log)
    : node_(node),
      transport_(transport),
      options_(options),
      log_(log),
      service_(options.notify_socket, log) {}

void LcmRunner::Start() {
  for (const std::string& channel : node_->input_channels()) {
    transport_->Subscribe(
        channel, [this, channel](const void* data, std::size_t size, std::int64_t receive_utime) {
          node_->Receive(channel, data, size);
          last_receive_utime_ = receive_utime;
          SayFirstRejects();
          SayWarnings();
        });
  }
  for (const std::string& channel : node_->output_channels()) {
    transport_->Subscribe(channel,
                          [this, channel](const void* data, std::size_t size, std::int64_t) {
                            HearOwnChannel(channel, data, size);
                          });
  }
  transport_->Subscribe(channel::kStatus, [this](const void* data, std::size_t size, std::int64_t) {
    HearStatus(data, size);
  });
}

bool LcmRunner::MustStop() const { return StopRequested() || has_refused(); }

void LcmRunner::HearOwnChannel(const std::string& channel, const void* data, std::size_t size) {
  if (!own_output_.IsForeign(channel, data, size)) return;
  ++num_foreign_;
  if (num_foreign_ == 1) {
    SayError("somebody else publishes " + channel +
             ": a log that also holds outputs is being played, or a second " + options_.process +
             " runs; play only the inputs (replay_log.sh does; airdos-record --inputs-only records "
             "nothing else), or end the other one");
  } else if (has_refused()) {
    SayError("refuses to go on: somebody else publishes " + channel);
  }
}

void LcmRunner::HearStatus(const void* data, std::size_t size) {
  constexpr std::size_t kMaxNamesakes = 100;
  process_status_t status = {};
  if (!Decode(data, size, &status) || !Validate(status).empty()) return;
  const bool is_alive = status.state == process_status_t::STATE_READY ||
                        status.state == process_status_t::STATE_STALLED;
  if (!is_alive || status.process != options_.process || status.pid == getpid()) return;
  if (namesakes_.size() >= kMaxNamesakes && namesakes_.count(status.pid) == 0) return;
  // The last word of one that was killed may still have been on its way.
  if (++namesakes_[status.pid] != 2) return;
  SayWarning("another " + options_.process + " runs, process " + std::to_string(status.pid) +
             ": both work on the same input; end one of them");
}

void LcmRunner::Run() {
  cpu_at_start_ms_ = CpuTime_ms();
  progress_s_ = SteadyClock_s();
  bool has_worked = false;
  while (!MustStop()) {
    PublishStatusWhenDue();
    Receive(has_worked ? 0 : kPollTimeout_ms);
    has_worked = WorkOnFrames();
    CompleteAfterDeadline();
  }
  PublishStatus(process_status_t::STATE_STOPPING);
  SayCounters();
}

void LcmRunner::Receive(int timeout_ms) {
  const bool is_realtime = options_.pace == LcmRunnerOptions::Pace::kRealtime;
  // In lock-step one message at a time, so that the time of the last one is that of the input which
  // made the frame complete.
  if (!Poll(timeout_ms) || !is_realtime) return;
  // Bounded: whoever floods a channel must not keep the process from its work.
  for (int i = 0; i < kMaxDrained && !MustStop() && transport_->Poll(0); ++i) {
  }
  node_->SkipToNewest();
}

bool LcmRunner::Poll(int timeout_ms) {
  const double begin_s = SteadyClock_s();
  const bool has_received = transport_->Poll(timeout_ms);
  // Where it took longer than it may, this process stood still, and so may have whoever it waits
  // for: what they say is on its way now.
  progress_s_ += std::max(0.0, SteadyClock_s() - begin_s - 1e-3 * timeout_ms);
  return has_received;
}

bool LcmRunner::WorkOnFrames() {
  // In realtime one at a time: there may be newer ones by now.
  if (options_.pace == LcmRunnerOptions::Pace::kRealtime) return WorkOnOne();
  bool has_worked = false;
  while (!MustStop() && WorkOnOne()) {
    has_worked = true;
    PublishStatusWhenDue();
  }
  return has_worked;
}

bool LcmRunner::WorkOnOne() {
  bool has_worked = true;
  try {
    has_worked = node_->Step();
  } catch (const std::exception& error) {
    // The frame is over for the node; the next one may be better.
    SayError(error.what());
  }
  if (has_worked) PublishOutput();
  if (has_worked || node_->num_pending() == 0) {
    progress_s_ = SteadyClock_s();
    is_stalled_ = false;
  }
  return has_worked;
}

void LcmRunner::NoteSilent(const std::string& channels) {
  std::istringstream words(channels);
  for (std::string channel; words >> channel;) {
    // Without calibration a frame is lost as a whole: each one waits for it.
    if (channel == channel::kCalibration) continue;
    silent_[channel] = node_->channels().at(channel).num_received;
  }
}

double LcmRunner::Patience_s() {
  for (auto it = silent_.begin(); it != silent_.end();) {
    const bool has_spoken = node_->channels().at(it->first).num_received > it->second;
    it = has_spoken ? silent_.erase(it) : std::next(it);
  }
  std::istringstream words(node_->waiting_for());
  bool are_silent = true;  // all of them, and some there are
  double deadlines = 0;
  for (std::string channel; words >> channel;) {
    are_silent = are_silent && silent_.count(channel) > 0;
    deadlines = std::max(deadlines, NumDeadlines(channel));
  }
  if (deadlines == 0) return options_.deadline_s;
  if (!are_silent) return deadlines * options_.deadline_s;
  return deadlines == 1 ? 0 : 0.1 * options_.deadline_s;
}

void LcmRunner::CompleteAfterDeadline() {
  if (node_->num_pending() == 0) return;
  const double waited_s = Patience_s();
  if (SteadyClock_s() - progress_s_ < waited_s) return;
  const std::string silent = node_->waiting_for();
  NoteSilent(silent);
  is_stalled_ = true;
  if (silent_said_.insert(silent).second) {
    std::ostringstream line;
    line << "nothing on " << silent << " for " << waited_s << " s: frames are completed without it";
    log_->Warning(line.str());
  } else {
    log_->Debug("a frame is completed without " + silent);
  }
  PublishStatus(process_status_t::STATE_STALLED);  // while waiting_for() still names the channels
  try {
    node_->CompleteOldest();
  } catch (const std::exception& error) {
    SayError(error.what());
  }
  PublishOutput();
  progress_s_ = SteadyClock_s();
}

void LcmRunner::PublishOutput() {
  SayFirstRejects();  // some messages are only rejected when their frame is worked on
  SayWarnings();
  for (const Envelope& message : node_->TakeOutput()) {
    own_output_.AddSaid(message.channel, message.payload.data(), message.payload.size());
    PublishBytes(message.channel, message.payload);
  }
  const double latency_ms =
      std::max(0.0, 1e-3 * static_cast<double>(WallClock_us() - last_receive_utime_));
  latency_ms_.Add(latency_ms);
  long_latency_ms_.Add(latency_ms);
  if (log_->Says(LogLevel::kDebug)) SayFrame(latency_ms);
  if (options_.publishes_frame_done) PublishFrameDone();
}

void LcmRunner::SayFrame(double latency_ms) {
  if (!node_->last_finished()) return;
  std::ostringstream line;
  line << "image " << node_->last_finished()->seq << " of session "
       << node_->last_finished()->session << " is done, " << std::fixed << std::setprecision(1)
       << latency_ms << " ms after its last input; " << node_->num_pending() << " wait";
  log_->Debug(line.str());
}

void LcmRunner::PublishFrameDone() {
  if (!node_->last_finished()) return;
  auto message = MessageOf<frame_done_t>(*node_->last_finished());
  message.process = options_.process;
  Publish(channel::kFrameDone, message);
}

void LcmRunner::PublishStatusWhenDue() {
  const double now_s = SteadyClock_s();
  if (now_s < next_status_s_) return;
  next_status_s_ = now_s + kStatusPeriod_s;
  PublishStatus(is_stalled_ ? process_status_t::STATE_STALLED : process_status_t::STATE_READY);
}

void LcmRunner::PublishStatus(std::int8_t state) {
  auto status = MessageOf<process_status_t>(node_->last_finished().value_or(Header()));
  status.process = options_.process;
  status.version = kVersion;
  status.types_fingerprint = TypesFingerprint();
  status.pid = getpid();
  status.state = state;
  status.num_frames_done = node_->frames().num_done;
  status.num_frames_incomplete = node_->frames().num_incomplete;
  status.num_frames_skipped = node_->frames().num_skipped;
  status.latency_p50_ms = latency_ms_.Percentile(0.50);
  status.latency_p99_ms = latency_ms_.Percentile(0.99);
  const auto num_done = static_cast<double>(std::max<std::int64_t>(1, node_->frames().num_done));
  status.cpu_ms_per_frame = (CpuTime_ms() - cpu_at_start_ms_) / num_done;
  status.memory_mb = ResidentMemory_mb();
  status.waiting_for = node_->waiting_for();
  status.last_error = last_error_;
  status.warnings.assign(node_->warnings().begin(), node_->warnings().end());
  status.warnings.insert(status.warnings.end(), own_warnings_.begin(), own_warnings_.end());
  status.num_warnings = static_cast<std::int32_t>(status.warnings.size());
  for (const auto& [channel, counters] : node_->channels()) {
    status.channels.push_back(StatusOf(channel, counters));
  }
  status.num_channels = static_cast<std::int32_t>(status.channels.size());
  Publish(channel::kStatus, status);
  TellService(state);
}

void LcmRunner::TellService(std::int8_t state) {
  std::ostringstream text;
  if (node_->last_finished()) {
    text << "image " << node_->last_finished()->seq << " of session "
         << node_->last_finished()->session << ", ";
  }
  const FrameCounters& frames = node_->frames();
  text << "frames done " << frames.num_done << ", incomplete " << frames.num_incomplete
       << ", skipped " << frames.num_skipped;
  if (state == process_status_t::STATE_STALLED) text << "; waits for " << node_->waiting_for();
  if (!last_error_.empty()) text << "; last error: " << last_error_;
  if (state == process_status_t::STATE_STOPPING) return service_.TellStopping(text.str());
  service_.Tell(text.str());
}

template <class Message>
void LcmRunner::Publish(const std::string& channel, const Message& message) {
  PublishBytes(channel, Encode(message));
}

void LcmRunner::PublishBytes(const std::string& channel, const std::vector<std::uint8_t>& bytes) {
  if (transport_->Publish(channel, bytes.data(), bytes.size())) return;
  last_error_ = "cannot publish on " + channel;
  if (!publish_failure_said_) log_->Error(last_error_ + ": is the network gone?");
  publish_failure_said_ = true;
}

void LcmRunner::SayError(const std::string& error) {
  constexpr std::size_t kMaxErrorsSaid = 100;  // stderr may go to a disk
  last_error_ = error.substr(0, 500);          // STATUS takes no text that is much longer
  if (errors_said_.size() < kMaxErrorsSaid && errors_said_.insert(error).second) {
    log_->Error(error + " (said once; STATUS has the last error)");
  }
}

void LcmRunner::SayWarning(const std::string& warning) {
  own_warnings_.push_back(warning);
  if (own_warnings_.size() > Node::kMaxWarnings) own_warnings_.pop_front();
  log_->Warning(warning);
}

void LcmRunner::SayWarnings() {
  constexpr int kMaxWarningsSaid = 100;  // stderr may go to a disk
  for (const std::string& warning : node_->TakeWarnings()) {
    if (++num_warnings_said_ <= kMaxWarningsSaid) log_->Warning(warning);
  }
}

void LcmRunner::SayFirstRejects() {
  for (const auto& [channel, counters] : node_->channels()) {
    if (counters.num_rejected == 0 || !rejects_said_.insert(channel).second) continue;
    log_->Warning("rejected a message on " + channel + ": " + counters.last_reject +
                  " (further ones are counted in STATUS)");
  }
}

void LcmRunner::SayCounters() {
  const FrameCounters& frames = node_->frames();
  log_->Info("stopped; frames done " + std::to_string(frames.num_done) + ", incomplete " +
             std::to_string(frames.num_incomplete) + ", skipped " +
             std::to_string(frames.num_skipped));
  if (!node_->summary().empty()) log_->Info(node_->summary());
  std::ostringstream latency;
  latency << std::fixed << std::setprecision(1) << "latency p50 "
          << long_latency_ms_.Percentile(0.5) << " ms, p99 " << long_latency_ms_.Percentile(0.99)
          << " ms";
  log_->Info(latency.str());
  for (const auto& [channel, counters] : node_->channels()) {
    if (channel == figure::kRowError_millipx) {
      log_->Info(channel + ": " + std::to_string(counters.num_received));
      continue;
    }
    log_->Info(channel + ": received " + std::to_string(counters.num_received) + ", missing " +
               std::to_string(counters.num_missing) + ", duplicate " +
               std::to_string(counters.num_duplicate) + ", rejected " +
               std::to_string(counters.num_rejected) +
               (counters.last_reject.empty() ? "" : " (" + counters.last_reject + ")"));
  }
}

}  // namespace airdos
