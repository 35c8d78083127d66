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

/// What was heard on the port within a short time.
struct BusTraffic {
  struct Channel {
    std::int64_t num_messages = 0;
    std::size_t max_bytes = 0;
  };
  double duration_s = 0;
  std::map<std::string, Channel> channels;
  /// The last STATUS of each process: name and pid.
  std::map<std::pair<std::string, std::int64_t>, process_status_t> processes;
  std::int64_t num_strange_status = 0;  ///< STATUS messages of another type
};

/// Listens, sends nothing (but LCM's own LCM_SELF_TEST). Throws InputError where LCM cannot be
/// used.
BusTraffic Listen(const std::string& url, double duration_s);

/// Whether the port is free for one run, and whether those who are there belong together: one
/// process of each name, of our version and of the same message types.
Diagnoses JudgeTraffic(const MulticastUrl& url, const BusTraffic& traffic,
                       const std::string& own_version, const std::string& own_fingerprint);

struct RoundTrip {
  int num_sent = 0;
  int num_received = 0;
  double latency_p50_ms = 0;  ///< from the call that sends to LCM's thread that receives
  double latency_p99_ms = 0;
};

/// Sends messages as one camera does (90 kB, 30 a second) on the channel AIRDOS_DOCTOR and receives
/// them. Throws as Listen().
RoundTrip MeasureRoundTrip(const std::string& url, double duration_s);
Diagnoses JudgeRoundTrip(const RoundTrip& trip);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_BUS_H_
