#ifndef AIRDOS_TESTS_SUPPORT_NOTIFY_SOCKET_H_
#define AIRDOS_TESTS_SUPPORT_NOTIFY_SOCKET_H_

#include <sys/socket.h>
#include <sys/time.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <stdexcept>
#include <string>

namespace airdos {

/// The service manager's end of sd_notify(3), of one test.
class NotifySocket {
 public:
  /// `name` as in NOTIFY_SOCKET: a path, or @NAME.
  explicit NotifySocket(const std::string& name)
      : descriptor_(socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    sockaddr_un address = {};
    address.sun_family = AF_UNIX;
    if (name.size() >= sizeof(address.sun_path)) throw std::runtime_error("too long: " + name);
    std::copy(name.begin(), name.end(), address.sun_path);
    if (name[0] == '@') address.sun_path[0] = '\0';
    const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + name.size());
    if (bind(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) != 0) {
      throw std::runtime_error("cannot bind " + name);
    }
  }
  ~NotifySocket() { close(descriptor_); }
  NotifySocket(const NotifySocket&) = delete;
  NotifySocket& operator=(const NotifySocket&) = delete;

  /// The next datagram; empty where none comes in time.
  std::string Next(int deadline_s) const {
    const timeval timeout = {deadline_s, 0};
    setsockopt(descriptor_, SOL_SOCKET, SO_RCVTIMEO, &timeout, sizeof(timeout));
    std::array<char, 4096> data = {};
    const ssize_t size = recv(descriptor_, data.data(), data.size(), 0);
    return size <= 0 ? "" : std::string(data.data(), static_cast<std::size_t>(size));
  }
  /// What has come already.
  std::string NextNow() const {
    std::array<char, 4096> data = {};
    const ssize_t size = recv(descriptor_, data.data(), data.size(), MSG_DONTWAIT);
    return size <= 0 ? "" : std::string(data.data(), static_cast<std::size_t>(size));
  }

 private:
  int descriptor_;
};

}  // namespace airdos

#endif  // AIRDOS_TESTS_SUPPORT_NOTIFY_SOCKET_H_
