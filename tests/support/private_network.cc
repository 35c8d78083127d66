#include "tests/support/private_network.h"

#include <arpa/inet.h>
#include <net/if.h>
#include <net/route.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <fstream>

namespace airdos {
namespace {

std::string Failure(const std::string& what) { return what + ": " + std::strerror(errno); }

sockaddr Address(const char* text) {
  sockaddr_in address = {};
  address.sin_family = AF_INET;
  inet_pton(AF_INET, text, &address.sin_addr);
  sockaddr generic = {};
  std::memcpy(&generic, &address, sizeof(generic));
  return generic;
}

std::string SetUpLoopback(int socket, bool with_multicast) {
  ifreq request = {};
  std::strcpy(request.ifr_name, "lo");
  if (ioctl(socket, SIOCGIFFLAGS, &request) != 0) return Failure("reading the flags of lo");
  request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_UP | IFF_RUNNING);
  if (with_multicast) request.ifr_flags = static_cast<short>(request.ifr_flags | IFF_MULTICAST);
  if (ioctl(socket, SIOCSIFFLAGS, &request) != 0) return Failure("setting the flags of lo");
  if (!with_multicast) return "";
  rtentry route = {};
  route.rt_dst = Address("224.0.0.0");
  route.rt_genmask = Address("240.0.0.0");
  route.rt_flags = RTF_UP;
  char device[] = "lo";
  route.rt_dev = device;
  return ioctl(socket, SIOCADDRT, &route) == 0 ? "" : Failure("adding the multicast route");
}

}  // namespace

std::string EnterPrivateNetwork(bool with_multicast) {
  const uid_t user = geteuid();
  if (unshare(user == 0 ? CLONE_NEWNET : CLONE_NEWUSER | CLONE_NEWNET) != 0) {
    return Failure("a network namespace needs root or user namespaces; unshare");
  }
  if (user != 0) std::ofstream("/proc/self/uid_map") << "0 " << user << " 1\n";
  const int socket_handle = socket(AF_INET, SOCK_DGRAM, 0);
  if (socket_handle < 0) return Failure("socket");
  const std::string failure = SetUpLoopback(socket_handle, with_multicast);
  close(socket_handle);
  return failure;
}

}  // namespace airdos
