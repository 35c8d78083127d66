#include "processes/stereo_camera/camera_loop.h"

#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <thread>
#include <vector>

#include "airdos/process_status_t.hpp"
#include "common/util/version.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/types_fingerprint.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

constexpr double kStatusPeriod_s = 1;
constexpr double kTakeTimeout_s = 0.05;
constexpr std::size_t kMaxTextBytes = 500;  // STATUS takes no text that is much longer
constexpr int kMaxDrained = 1000;           // messages received in one go
/// Limit of the sending rate: a burst of several images overflows the receivers' socket buffers
/// (200 kB with a stock kernel) before their threads run.
constexpr double kMaxBytesPerSecond = 30e6;

}  // namespace

CameraLoop::CameraLoop(CameraCapture* capture, CameraMessages* messages, std::int64_t offset_us,
                       LcmTransport* transport, const ProcessLog* log,
                       const std::string& notify_socket)
    : capture_(capture),
      messages_(messages),
      offset_us_(offset_us),
      transport_(transport),
      log_(log),
      service_(notify_socket, log) {}

int CameraLoop::Run() {
  transport_->Subscribe(channel::kStatus, [this](const void* data, std::size_t size, std::int64_t) {
    HearStatus(data, size);
  });
  cpu_at_start_ms_ = CpuTime_ms();
  capture_->Start();
  while (!StopRequested() && !capture_->has_ended()) {
    PublishStatusWhenDue();
    if (const std::optional<CapturedPair> pair = capture_->Take(kTakeTimeout_s)) Publish(*pair);
    Listen();
    SayNotes();
  }
  capture_->Stop();
  SayNotes();
  last_error_ = capture_->error();
  if (!last_error_.empty()) log_->Error(last_error_);
  PublishStatus(process_status_t::STATE_STOPPING);
  log_->Info(Tally());
  service_.TellStopping(Tally());
  return last_error_.empty() ? 0 : 1;
}

void CameraLoop::Publish(const CapturedPair& pair) {
  const std::vector<Envelope> messages = messages_->Pack(pair);
  if (messages.empty()) {
    ++num_misfits_;
    return;
  }
  for (const Envelope& message : messages) {
    if (!transport_->Publish(message.channel, message.payload.data(), message.payload.size())) {
      if (num_not_published_++ == 0) {
        last_error_ = "cannot publish on " + message.channel;
        log_->Error(last_error_ + ": is the network gone?");
      }
    }
    std::this_thread::sleep_for(std::chrono::duration<double>(
        static_cast<double>(message.payload.size()) / kMaxBytesPerSecond));
  }
  const double now_us = 1e6 * SteadyClock_s();
  latency_ms_.Add(std::max(0.0, 1e-3 * (now_us - static_cast<double>(pair.utime - offset_us_))));
  lag_.OnPublished(*messages_->newest());
}

void CameraLoop::Listen() {
  // Bounded: a flood of STATUS must not keep the camera from its images.
  for (int i = 0; i < kMaxDrained && !StopRequested() && transport_->Poll(0); ++i) {
  }
}

void CameraLoop::HearStatus(const void* data, std::size_t size) {
  constexpr std::size_t kMaxNamesakes = 100;
  process_status_t status;
  if (!Decode(data, size, &status) || !Validate(status).empty()) return;
  if (status.process != kProcessName) return lag_.OnStatus(status);
  if (status.pid == getpid() || status.state == process_status_t::STATE_STOPPING ||
      namesakes_.size() >= kMaxNamesakes || !namesakes_.insert(status.pid).second) {
    return;
  }
  log_->Warning("another " + std::string(kProcessName) + " runs, process " +
                std::to_string(status.pid) +
                ": both publish the same channels, which cannot be told apart; end one of them");
}

void CameraLoop::PublishStatusWhenDue() {
  const double now_s = SteadyClock_s();
  if (now_s < next_status_s_) return;
  next_status_s_ = now_s + kStatusPeriod_s;
  PublishStatus(capture_->is_lost() ? process_status_t::STATE_STALLED
                                    : process_status_t::STATE_READY);
  service_.Tell(Tally());
}

void CameraLoop::PublishStatus(std::int8_t state) {
  const CaptureCounters counters = capture_->counters();
  auto status = MessageOf<process_status_t>(messages_->newest().value_or(Header()));
  status.process = kProcessName;
  status.version = kVersion;
  status.types_fingerprint = TypesFingerprint();
  status.pid = getpid();
  status.state = state;
  status.num_frames_done = messages_->num_packed();
  status.num_frames_skipped = counters.num_dropped;
  status.latency_p50_ms = latency_ms_.Percentile(0.50);
  status.latency_p99_ms = latency_ms_.Percentile(0.99);
  status.cpu_ms_per_frame = (CpuTime_ms() - cpu_at_start_ms_) /
                            static_cast<double>(std::max<std::int64_t>(1, status.num_frames_done));
  status.memory_mb = ResidentMemory_mb();
  if (capture_->is_lost()) status.waiting_for = "camera";
  status.last_error = last_error_.substr(0, kMaxTextBytes);
  status.warnings.assign(warnings_.begin(), warnings_.end());
  status.num_warnings = static_cast<std::int32_t>(status.warnings.size());
  channel_status_t camera = {};
  camera.channel = "camera";
  camera.num_received = counters.num_captured + counters.num_unusable;
  camera.num_rejected = counters.num_unusable + num_misfits_;
  camera.last_reject = counters.last_unusable.substr(0, kMaxTextBytes);
  status.channels.push_back(camera);
  status.num_channels = 1;
  const std::vector<std::uint8_t> bytes = Encode(status);
  transport_->Publish(channel::kStatus, bytes.data(), bytes.size());
}

void CameraLoop::SayNotes() {
  for (const std::string& note : capture_->TakeNotes()) Say(note);
  for (const std::string& note : messages_->TakeNotes()) Say(note);
  for (const std::string& note : lag_.TakeNotes()) Say(note);
}

void CameraLoop::Say(const std::string& note) {
  const std::string warning = "warning: ";
  log_->Relay(note);
  if (note.compare(0, warning.size(), warning) != 0) return;
  warnings_.push_back(note.substr(warning.size(), kMaxTextBytes));
  if (warnings_.size() > Node::kMaxWarnings) warnings_.pop_front();
}

std::string CameraLoop::Tally() const {
  const CaptureCounters counters = capture_->counters();
  return "pairs captured " + std::to_string(counters.num_captured) + ", dropped " +
         std::to_string(counters.num_dropped) + ", published " +
         std::to_string(messages_->num_packed()) + ", unusable " +
         std::to_string(counters.num_unusable + num_misfits_) +
         (num_not_published_ == 0
              ? ""
              : ", messages that the network rejected " + std::to_string(num_not_published_)) +
         (capture_->is_lost() ? "; the camera is lost" : "");
}

}  // namespace airdos
