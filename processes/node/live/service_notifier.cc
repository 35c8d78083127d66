#include "processes/node/live/service_notifier.h"

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstdlib>
#include <cstring>

namespace airdos {
namespace {

std::string InOneLine(std::string text) {
  std::replace(text.begin(), text.end(), '\n', ' ');
  return text;
}

}  // namespace

std::string NotifySocketOfEnvironment() {
  const char* socket = std::getenv("NOTIFY_SOCKET");
  return socket == nullptr ? "" : socket;
}

ServiceNotifier::ServiceNotifier(const std::string& socket, const ProcessLog* log)
    : socket_(socket), log_(log) {
  if (socket_.empty()) return;
  const std::string why_not = Connect();
  if (!why_not.empty()) GiveUp(why_not);
}

std::string ServiceNotifier::Connect() {
  sockaddr_un address = {};
  const bool is_known = socket_[0] == '/' || socket_[0] == '@';
  if (!is_known || socket_.size() >= sizeof(address.sun_path)) {
    return "is neither a path nor @NAME, or too long";
  }
  address.sun_family = AF_UNIX;
  std::copy(socket_.begin(), socket_.end(), address.sun_path);
  if (socket_[0] == '@') address.sun_path[0] = '\0';
  const auto size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + socket_.size());
  descriptor_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC, 0);
  const bool is_connected =
      descriptor_ >= 0 &&
      connect(descriptor_, reinterpret_cast<const sockaddr*>(&address), size) == 0;
  return is_connected ? "" : std::strerror(errno);
}

ServiceNotifier::~ServiceNotifier() {
  if (descriptor_ >= 0) close(descriptor_);
}

void ServiceNotifier::Tell(const std::string& status) {
  const std::string ready = is_ready_ ? "" : "READY=1\n";
  is_ready_ = true;
  Send(ready + "STATUS=" + InOneLine(status) + "\nWATCHDOG=1");
}

void ServiceNotifier::TellWhenDue(double now_s, const std::string& status) {
  if (is_ready_ && now_s < next_s_) return;
  next_s_ = now_s + kPeriod_s;
  Tell(status);
}

void ServiceNotifier::TellStopping(const std::string& status) {
  Send("STOPPING=1\nSTATUS=" + InOneLine(status));
}

void ServiceNotifier::Send(const std::string& lines) {
  if (descriptor_ < 0) return;
  // It waits where the manager's queue is full, as sd_notify does: a READY must not get lost.
  if (send(descriptor_, lines.data(), lines.size(), MSG_NOSIGNAL) < 0 && errno != EINTR) {
    GiveUp(std::strerror(errno));
  }
}

void ServiceNotifier::GiveUp(const std::string& why) {
  if (descriptor_ >= 0) close(descriptor_);
  descriptor_ = -1;
  log_->Warning("the service manager cannot be told how this process is: NOTIFY_SOCKET '" +
                socket_ + "': " + why);
}

}  // namespace airdos
