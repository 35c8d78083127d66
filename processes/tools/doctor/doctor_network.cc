#include "processes/tools/doctor/doctor_network.h"

#include <arpa/inet.h>
#include <linux/rtnetlink.h>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <regex>

#include "common/util/error.h"

namespace airdos {
namespace {

constexpr std::int64_t kLosslessBytes = 4194304;  // what LcmTransport requests
constexpr std::int64_t kUsualBytes =
    212992;  // Linux' default: no messages of 90 kB lost, 1 in 150 of 128 kB
constexpr std::int64_t kMessageBytes = 131072;  // our largest message

class Socket {
 public:
  Socket(int family, int type, int protocol)
      : handle_(socket(family, type | SOCK_CLOEXEC, protocol)) {}
  ~Socket() {
    if (handle_ >= 0) close(handle_);
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  int handle() const { return handle_; }

 private:
  int handle_;
};

int ToInt(const std::string& url, const std::string& digits, std::int64_t max) {
  const std::int64_t value = digits.size() > 9 ? max + 1 : std::stoll(digits);
  if (value > max) throw InputError("LCM URL '" + url + "': " + digits + " is too large");
  return static_cast<int>(value);
}

/// The interface through which the kernel sends to an address; nothing if it has no route.
std::optional<int> InterfaceTo(const in_addr& address) {
  struct {
    nlmsghdr header;
    rtmsg message;
    rtattr attribute;
    in_addr address;
  } request = {};
  request.header.nlmsg_len = sizeof(request);
  request.header.nlmsg_type = RTM_GETROUTE;
  request.header.nlmsg_flags = NLM_F_REQUEST;
  request.message.rtm_family = AF_INET;
  request.message.rtm_dst_len = 32;
  request.attribute.rta_type = RTA_DST;
  request.attribute.rta_len = sizeof(request.attribute) + sizeof(request.address);
  request.address = address;
  const Socket socket(AF_NETLINK, SOCK_RAW, NETLINK_ROUTE);
  if (send(socket.handle(), &request, sizeof(request), 0) < 0) return std::nullopt;
  alignas(nlmsghdr) std::array<char, 4096> answer = {};
  const ssize_t size = recv(socket.handle(), answer.data(), answer.size(), 0);
  if (size < static_cast<ssize_t>(NLMSG_LENGTH(sizeof(rtmsg)))) return std::nullopt;
  const auto* header = reinterpret_cast<const nlmsghdr*>(answer.data());
  if (header->nlmsg_type != RTM_NEWROUTE) return std::nullopt;
  auto num_bytes = static_cast<int>(size - static_cast<ssize_t>(NLMSG_LENGTH(sizeof(rtmsg))));
  const auto* attribute =
      reinterpret_cast<const rtattr*>(answer.data() + NLMSG_LENGTH(sizeof(rtmsg)));
  for (; RTA_OK(attribute, num_bytes); attribute = RTA_NEXT(attribute, num_bytes)) {
    if (attribute->rta_type != RTA_OIF) continue;
    int interface = 0;
    std::memcpy(&interface, RTA_DATA(attribute), sizeof(interface));
    return interface;
  }
  return std::nullopt;
}

}  // namespace

MulticastUrl ParseMulticastUrl(const std::string& url) {
  static const std::regex pattern(R"(udpm://([0-9.]*)(:([0-9]+))?(\?(.*))?)");
  std::smatch match;
  if (!std::regex_match(url, match, pattern)) {
    throw InputError("LCM URL '" + url +
                     "': only multicast can be tested, like udpm://239.255.76.67:7667?ttl=0");
  }
  MulticastUrl result;
  if (match[1].length() > 0) result.address = match[1];
  in_addr address = {};
  if (inet_pton(AF_INET, result.address.c_str(), &address) != 1 ||
      !IN_MULTICAST(ntohl(address.s_addr))) {
    throw InputError("LCM URL '" + url + "': '" + result.address + "' is not a multicast address");
  }
  if (match[3].length() > 0) result.port = ToInt(url, match[3], 65535);
  const std::string options = match[5];
  static const std::regex option(R"((ttl|recv_buf_size|transmit_only)=([0-9]+|true|false))");
  for (std::size_t from = 0; from < options.size();) {
    const std::size_t end = std::min(options.find('&', from), options.size());
    const std::string text = options.substr(from, end - from);
    if (!std::regex_match(text, match, option)) {
      throw InputError("LCM URL '" + url + "': '" + text + "' cannot be parsed");
    }
    if (match[1] == "ttl") result.ttl = ToInt(url, match[2], 255);
    if (match[1] == "recv_buf_size") result.recv_buf_size = ToInt(url, match[2], 1 << 30);
    from = end + 1;
  }
  return result;
}

std::string WithPort(const MulticastUrl& url, int port) {
  return "udpm://" + url.address + ":" + std::to_string(port) + "?ttl=" + std::to_string(url.ttl);
}

MulticastRoute FindRoute(const MulticastUrl& url) {
  MulticastRoute route;
  in_addr address = {};
  inet_pton(AF_INET, url.address.c_str(), &address);
  const std::optional<int> index = InterfaceTo(address);
  ifreq interface = {};
  if (!index || if_indextoname(static_cast<unsigned>(*index), interface.ifr_name) == nullptr) {
    return route;
  }
  route.has_route = true;
  route.interface = interface.ifr_name;
  const Socket socket(AF_INET, SOCK_DGRAM, 0);
  if (ioctl(socket.handle(), SIOCGIFFLAGS, &interface) == 0) {
    route.is_up = (interface.ifr_flags & IFF_UP) != 0;
    route.is_multicast = (interface.ifr_flags & IFF_MULTICAST) != 0;
    route.is_loopback = (interface.ifr_flags & IFF_LOOPBACK) != 0;
  }
  return route;
}

std::int64_t GrantedReceiveBuffer(std::int64_t asked) {
  const Socket socket(AF_INET, SOCK_DGRAM, 0);
  const int size = static_cast<int>(asked);
  if (asked > 0) setsockopt(socket.handle(), SOL_SOCKET, SO_RCVBUF, &size, sizeof(size));
  int granted = 0;
  socklen_t length = sizeof(granted);
  if (getsockopt(socket.handle(), SOL_SOCKET, SO_RCVBUF, &granted, &length) != 0) return 0;
  return asked > 0 ? granted / 2 : granted;  // the kernel doubles what was requested
}

Diagnoses JudgeRoute(const MulticastUrl& url, const MulticastRoute& route) {
  if (!route.has_route) {
    return {{Health::kFail, "network.route", "no route for " + url.address + ": LCM cannot send",
             "sudo ip link set lo up; sudo ip route add 224.0.0.0/4 dev lo"}};
  }
  Diagnoses result;
  const std::string& name = route.interface;
  result.push_back({Health::kOk, "network.route", url.address + " is routed over " + name, ""});
  if (!route.is_up) {
    result.push_back({Health::kFail, "network.interface", name + " is down",
                      "sudo ip link set " + name + " up"});
  } else if (!route.is_multicast) {
    result.push_back({Health::kFail, "network.interface", name + " has no MULTICAST flag",
                      "sudo ip link set " + name + " multicast on"});
  } else {
    result.push_back({Health::kOk, "network.interface", name + " is up and has MULTICAST", ""});
  }
  const std::string ttl = "ttl=" + std::to_string(url.ttl) + ": ";
  if (url.ttl == 0) {
    result.push_back({Health::kOk, "network.ttl", ttl + "messages stay on this host", ""});
  } else if (route.is_loopback) {
    result.push_back({Health::kWarn, "network.ttl",
                      ttl + "messages should leave this host, but " + name + " does not lead there",
                      "sudo ip route replace 224.0.0.0/4 dev NETWORK_INTERFACE"});
  } else {
    result.push_back(
        {Health::kWarn, "network.ttl",
         ttl + "messages leave this host over " + name +
             ", and LCM has no authentication: anybody there can send to the processes",
         "use ttl=0 in --lcm-url, unless you use several hosts"});
  }
  return result;
}

Diagnoses JudgeBuffer(const MulticastUrl& url, std::int64_t granted, std::int64_t by_default) {
  Diagnoses result;
  const bool is_bound_by_url = url.recv_buf_size && *url.recv_buf_size <= granted;
  const std::string mend =
      is_bound_by_url ? "a larger recv_buf_size in --lcm-url, or none"
                      : "sudo sysctl -w net.core.rmem_max=" + std::to_string(kLosslessBytes);
  const std::string buffer = "a socket gets " + std::to_string(granted) + " bytes";
  if (granted >= kLosslessBytes) {
    result.push_back({Health::kOk, "network.buffer", buffer + ": lossless images fit", ""});
  } else if (granted >= kUsualBytes) {
    result.push_back({Health::kWarn, "network.buffer",
                      buffer +
                          ": enough for messages of up to 128 kB (JPEG), lossless images need " +
                          std::to_string(kLosslessBytes),
                      mend});
  } else if (granted >= kMessageBytes) {
    result.push_back({Health::kWarn, "network.buffer",
                      buffer + ": large messages will be lost now and then", mend});
  } else {
    result.push_back({Health::kFail, "network.buffer",
                      buffer + ": messages of up to 128 kB do not fit and are lost", mend});
  }
  if (by_default < kUsualBytes) {
    result.push_back({Health::kWarn, "network.default_buffer",
                      "programs that do not request a size, such as lcm-spy, get " +
                          std::to_string(by_default) + " bytes: they miss images",
                      "sudo sysctl -w net.core.rmem_default=" + std::to_string(kUsualBytes)});
  }
  return result;
}

}  // namespace airdos
