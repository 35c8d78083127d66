#ifndef AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_NETWORK_H_
#define AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_NETWORK_H_

#include <cstdint>
#include <optional>
#include <string>

#include "processes/tools/doctor/doctor_report.h"

namespace airdos {

/// The parts of LCM's multicast URL, with LCM's defaults.
struct MulticastUrl {
  std::string address = "239.255.76.67";
  int port = 7667;
  int ttl = 0;                                ///< 0 = does not leave this host
  std::optional<std::int64_t> recv_buf_size;  ///< bytes
};

/// Throws InputError for a URL that does not match udpm://ADDRESS:PORT?ttl=N&recv_buf_size=N.
MulticastUrl ParseMulticastUrl(const std::string& url);
/// The same URL with a different port.
std::string WithPort(const MulticastUrl& url, int port);

/// The interface through which this machine sends to the address.
struct MulticastRoute {
  bool has_route = false;
  std::string interface;
  bool is_up = false;
  bool is_multicast = false;
  bool is_loopback = false;
};
MulticastRoute FindRoute(const MulticastUrl& url);

/// Receive buffer (bytes) granted by the kernel to a socket that requests `asked`; 0 means no
/// request.
std::int64_t GrantedReceiveBuffer(std::int64_t asked);

/// Whether route, interface or TTL prevent messages from arriving.
Diagnoses JudgeRoute(const MulticastUrl& url, const MulticastRoute& route);
/// `granted` bytes are granted to us, `by_default` to programs that do not request a size, such as
/// lcm-spy. Messages of 128 kB need 212,992 bytes, lossless images 4 MiB.
Diagnoses JudgeBuffer(const MulticastUrl& url, std::int64_t granted, std::int64_t by_default);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_DOCTOR_DOCTOR_NETWORK_H_
