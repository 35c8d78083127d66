#ifndef AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_BUS_H_
#define AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_BUS_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <string>
#include <utility>

#include "airdos/process_status_t.hpp"
#include "processes/tools/doctor/doctor_network.h"
#include "processes/tools/doctor/doctor_report.h"

namespace airdos {

/// What was received on the port within a short time.
struct BusTraffic {
  /// The messages on one channel.
  struct Channel {
    std::int64_t num_messages = 0;
    std::size_t max_bytes = 0;
  };
  double duration_s = 0;
  std::map<std::string, Channel> channels;
  /// The last STATUS of each process, by name and pid.
  std::map<std::pair<std::string, std::int64_t>, process_status_t> processes;
  std::int64_t num_strange_status = 0;  ///< STATUS messages of a different type
};

/// Listens without sending anything (except LCM's own LCM_SELF_TEST). Throws InputError if LCM
/// cannot be used.
BusTraffic Listen(const std::string& url, double duration_s);

/// Whether the port is free for a single run, and whether the processes on it belong together: one
/// per name, of our version and with the same message types.
Diagnoses JudgeTraffic(const MulticastUrl& url, const BusTraffic& traffic,
                       const std::string& own_version, const std::string& own_fingerprint);

/// Result of MeasureRoundTrip().
struct RoundTrip {
  int num_sent = 0;
  int num_received = 0;
  double latency_p50_ms = 0;  ///< from the sending call to LCM's receiving thread
  double latency_p99_ms = 0;
};

/// Sends and receives messages like a camera's (90 kB, 30 per second) on the channel AIRDOS_DOCTOR.
/// Throws like Listen().
RoundTrip MeasureRoundTrip(const std::string& url, double duration_s);
Diagnoses JudgeRoundTrip(const RoundTrip& trip);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_BUS_H_
