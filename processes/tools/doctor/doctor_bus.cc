#include "processes/tools/doctor/doctor_bus.h"

#include <algorithm>
#include <cstring>
#include <vector>

#include "common/util/format.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/message/channels.h"
#include "processes/node/message/codec.h"
#include "processes/node/message/figures.h"
#include "processes/node/message/validate.h"

namespace airdos {
namespace {

constexpr char kChannel[] = "AIRDOS_DOCTOR";
constexpr std::size_t kCameraBytes = 90000;  // a JPEG image of 1226 x 370 px
constexpr double kCameraPeriod_s = 1.0 / 30;
constexpr double kLastArrival_s = 0.5;  // waits for messages still in transit at the end
constexpr std::size_t kMaxBytes = 131072;
constexpr double kNotRectified_px = 1.5;  // as RowWatch has it

/// The start of a test message.
struct Stamp {
  std::int64_t number = 0;
  std::int64_t utime = 0;
};

std::string Fixed(double value) { return Format("%.1f", value); }

std::string NameOf(const process_status_t& status) {
  return status.process + " (" + std::to_string(status.pid) + ")";
}

/// Lists rates, such as "CAMERA_LEFT 30/s, STATUS 4/s".
std::string Describe(const BusTraffic& traffic) {
  std::string text;
  for (const auto& [name, channel] : traffic.channels) {
    const double rate_hz = static_cast<double>(channel.num_messages) / traffic.duration_s;
    text += (text.empty() ? "" : ", ") + name + " " + Fixed(rate_hz) + "/s";
  }
  return text;
}

Diagnosis JudgePort(const MulticastUrl& url, const BusTraffic& traffic) {
  const std::string port = "port " + std::to_string(url.port);
  if (traffic.channels.empty()) {
    return {Health::kOk, "bus.port", "nobody sends on " + port, ""};
  }
  const std::string other = "--lcm-url '" + WithPort(url, url.port + 1) + "' for another run";
  std::string twins;
  for (auto it = traffic.processes.begin(); it != traffic.processes.end(); ++it) {
    const auto next = std::next(it);
    if (next == traffic.processes.end() || next->first.first != it->first.first) continue;
    twins += (twins.empty() ? "" : ", ") + NameOf(it->second) + " and " + NameOf(next->second);
  }
  if (!twins.empty()) {
    return {Health::kFail, "bus.port", "two runs share " + port + ": " + twins,
            "end one of them, or " + other};
  }
  return {Health::kWarn, "bus.port", port + " is in use: " + Describe(traffic), other};
}

void JudgeProcess(const process_status_t& status, const std::string& own_version,
                  const std::string& own_fingerprint, Diagnoses* result) {
  if (status.types_fingerprint != own_fingerprint) {
    result->push_back({Health::kFail, "bus.types",
                       NameOf(status) + " was built with other message types (" +
                           status.types_fingerprint + ", here " + own_fingerprint + ")",
                       "build and install all programs from the same source"});
  } else if (status.version != own_version) {
    result->push_back(
        {Health::kWarn, "bus.version",
         NameOf(status) + " has version " + status.version + ", this program " + own_version,
         "build and install all programs from the same source"});
  }
  if (status.state == process_status_t::STATE_STALLED) {
    result->push_back(
        {Health::kWarn, "bus.stalled", NameOf(status) + " waits for " + status.waiting_for, ""});
  }
  if (!status.last_error.empty()) {
    result->push_back(
        {Health::kWarn, "bus.error", NameOf(status) + " says: " + status.last_error, ""});
  }
  for (const std::string& warning : status.warnings) {
    result->push_back({Health::kWarn, "bus.warning", NameOf(status) + " says: " + warning, ""});
  }
  for (const channel_status_t& channel : status.channels) {
    if (channel.channel == figure::kRowError_millipx) {
      const double error_px = 1e-3 * static_cast<double>(channel.num_received);
      // What to do about it is in the process's own warning.
      result->push_back({error_px > kNotRectified_px ? Health::kWarn : Health::kOk, "bus.rows",
                         NameOf(status) + ": rows of left and right images differ by " +
                             Format("%.2f", error_px) + " px (median)",
                         ""});
    }
    if (channel.num_rejected == 0) continue;
    result->push_back({Health::kWarn, "bus.rejected",
                       NameOf(status) + " rejected " + std::to_string(channel.num_rejected) +
                           " messages on " + channel.channel + ": " + channel.last_reject,
                       ""});
  }
}

}  // namespace

BusTraffic Listen(const std::string& url, double duration_s) {
  BusTraffic traffic;
  LcmTransport transport(url);
  transport.SubscribeAll(
      [&](const std::string& channel, const void* data, std::size_t size, std::int64_t) {
        if (channel == "LCM_SELF_TEST" || channel == kChannel) return;
        ++traffic.channels[channel].num_messages;
        std::size_t& max_bytes = traffic.channels[channel].max_bytes;
        max_bytes = std::max(max_bytes, size);
        if (channel != channel::kStatus) return;
        process_status_t status;
        if (Decode(data, size, &status) && Validate(status).empty()) {
          traffic.processes[{status.process, status.pid}] = status;
        } else {
          ++traffic.num_strange_status;
        }
      });
  const double start_s = SteadyClock_s();
  while (!StopRequested() && traffic.duration_s < duration_s) {
    transport.Poll(50);
    traffic.duration_s = SteadyClock_s() - start_s;
  }
  return traffic;
}

Diagnoses JudgeTraffic(const MulticastUrl& url, const BusTraffic& traffic,
                       const std::string& own_version, const std::string& own_fingerprint) {
  Diagnoses result = {JudgePort(url, traffic)};
  for (const auto& [name, channel] : traffic.channels) {
    if (channel.max_bytes <= kMaxBytes) continue;
    result.push_back({Health::kWarn, "bus.size",
                      name + " carries messages of " + std::to_string(channel.max_bytes) +
                          " bytes: receivers with default buffers lose them",
                      "smaller or JPEG images, below 128 kB"});
  }
  if (traffic.num_strange_status > 0) {
    result.push_back(
        {Health::kFail, "bus.types",
         std::to_string(traffic.num_strange_status) +
             " STATUS messages cannot be decoded: some program was built with other types",
         "build and install all programs from the same source"});
  }
  if (traffic.processes.empty()) {
    result.push_back(
        {Health::kOk, "bus.processes",
         "no process publishes STATUS; here version " + own_version + ", types " + own_fingerprint,
         ""});
    return result;
  }
  std::string names;
  for (const auto& [key, status] : traffic.processes) {
    names += (names.empty() ? "" : ", ") + NameOf(status) + " " + status.version;
    JudgeProcess(status, own_version, own_fingerprint, &result);
  }
  result.push_back({Health::kOk, "bus.processes", names, ""});
  return result;
}

RoundTrip MeasureRoundTrip(const std::string& url, double duration_s) {
  LcmTransport sender(url);
  LcmTransport receiver(url);
  std::vector<double> latencies_ms;
  receiver.Subscribe(kChannel, [&](const void* data, std::size_t size, std::int64_t receive_utime) {
    if (size != kCameraBytes) return;  // another doctor of a different version
    Stamp stamp;
    std::memcpy(&stamp, data, sizeof(stamp));
    latencies_ms.push_back(1e-3 * static_cast<double>(receive_utime - stamp.utime));
  });
  RoundTrip trip;
  std::vector<std::uint8_t> message(kCameraBytes, 0x5a);
  const double start_s = SteadyClock_s();
  double next_s = start_s;
  double end_s = start_s + duration_s;
  while (!StopRequested() && SteadyClock_s() < end_s) {
    const double now_s = SteadyClock_s();
    if (now_s >= next_s && next_s < start_s + duration_s) {
      const Stamp stamp{trip.num_sent, WallClock_us()};
      std::memcpy(message.data(), &stamp, sizeof(stamp));
      sender.Publish(kChannel, message.data(), message.size());
      ++trip.num_sent;
      next_s += kCameraPeriod_s;
      end_s = std::max(next_s, start_s + duration_s) + kLastArrival_s;
    }
    receiver.Poll(std::max(1, static_cast<int>(1e3 * (next_s - SteadyClock_s()))));
    if (static_cast<int>(latencies_ms.size()) == trip.num_sent && next_s >= start_s + duration_s) {
      break;
    }
  }
  trip.num_received = static_cast<int>(latencies_ms.size());
  RecentValues values(std::max<std::size_t>(latencies_ms.size(), 1));
  for (const double latency_ms : latencies_ms) values.Add(std::max(0.0, latency_ms));
  trip.latency_p50_ms = values.Percentile(0.5);
  trip.latency_p99_ms = values.Percentile(0.99);
  return trip;
}

Diagnoses JudgeRoundTrip(const RoundTrip& trip) {
  const int num_lost = trip.num_sent - trip.num_received;
  const std::string what = std::to_string(num_lost) + " of " + std::to_string(trip.num_sent) +
                           " messages of 90 kB at 30 Hz lost, latency p50 " +
                           Fixed(trip.latency_p50_ms) + " ms, p99 " + Fixed(trip.latency_p99_ms) +
                           " ms";
  if (trip.num_received == 0) {
    return {{Health::kFail, "bus.round_trip", what + ": nothing arrives (a firewall?)",
             "sudo iptables -I INPUT -d 224.0.0.0/4 -j ACCEPT"}};
  }
  if (num_lost > 0) {
    const bool is_bad = 100 * num_lost > trip.num_sent;
    return {{is_bad ? Health::kFail : Health::kWarn, "bus.round_trip", what,
             "sudo sysctl -w net.core.rmem_max=4194304 and reduce the load"}};
  }
  if (trip.latency_p99_ms > 1e3 * kCameraPeriod_s) {
    return {
        {Health::kWarn, "bus.round_trip", what + ": the machine is busy", "end other programs"}};
  }
  return {{Health::kOk, "bus.round_trip", what, ""}};
}

}  // namespace airdos
