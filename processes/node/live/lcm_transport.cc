#include "processes/node/live/lcm_transport.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <lcm/lcm-cpp.hpp>
#include <stdexcept>
#include <utility>

#include "common/util/error.h"

namespace airdos {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

void RequestStop(int) { stop_requested = 1; }

/// LCM reports errors in a dozen lines on stderr; we report them in one.
class StderrSilencer {
 public:
  StderrSilencer() : saved_(dup(STDERR_FILENO)) {
    const int nowhere = open("/dev/null", O_WRONLY | O_CLOEXEC);
    if (nowhere < 0) return;
    dup2(nowhere, STDERR_FILENO);
    close(nowhere);
  }
  ~StderrSilencer() {
    if (saved_ < 0) return;
    dup2(saved_, STDERR_FILENO);
    close(saved_);
  }
  StderrSilencer(const StderrSilencer&) = delete;
  StderrSilencer& operator=(const StderrSilencer&) = delete;

 private:
  int saved_;
};

/// Requests a large receive buffer, as far as the system allows, unless the URL specifies one: the
/// kernel's default of 212,992 B loses bursts of messages that span more than one datagram.
std::string WithReceiveBuffer(const std::string& url) {
  if (url.rfind("udpm://", 0) != 0 || url.find("recv_buf_size") != std::string::npos) return url;
  return url + (url.find('?') == std::string::npos ? "?" : "&") + "recv_buf_size=4194304";
}

[[noreturn]] void FailToOpen(const std::string& url) {
  if (url.rfind("udpm://", 0) == 0) {
    throw InputError("LCM URL '" + url +
                     "' cannot be used: either it is misspelt, or this machine has no multicast "
                     "route; launch_scripts/network_setup.sh checks and sets it");
  }
  throw InputError("LCM URL '" + url +
                   "' cannot be used: expected something like udpm://239.255.76.67:7667?ttl=0");
}

}  // namespace

std::string DefaultLcmUrl() {
  const char* url = std::getenv("LCM_DEFAULT_URL");
  return url != nullptr && *url != '\0' ? url : "udpm://239.255.76.67:7667?ttl=0";
}

void InstallStopSignals() {
  struct sigaction action = {};
  action.sa_handler = RequestStop;  // without SA_RESTART, so that a waiting Poll() returns
  sigemptyset(&action.sa_mask);
  sigaction(SIGINT, &action, nullptr);
  sigaction(SIGTERM, &action, nullptr);
  // Closing the terminal should stop us as well, unless nohup has asked to ignore it.
  struct sigaction before = {};
  sigaction(SIGHUP, nullptr, &before);
  if (before.sa_handler != SIG_IGN) sigaction(SIGHUP, &action, nullptr);
}

bool StopRequested() { return stop_requested != 0; }

LcmTransport::LcmTransport(const std::string& url) : url_(url) {
  const StderrSilencer silencer;
  lcm_ = std::make_unique<lcm::LCM>(WithReceiveBuffer(url));
  if (!lcm_->good()) FailToOpen(url);
}

LcmTransport::~LcmTransport() = default;

void LcmTransport::SubscribeTo(const std::string& regex, int max_queued) {
  const StderrSilencer silencer;
  lcm::Subscription* subscription = lcm_->subscribe(regex, &LcmTransport::OnMessage, this);
  if (subscription == nullptr) FailToOpen(url_);
  // Far above LCM's 30, but bounded: beyond it LCM drops the newest message, which the image
  // numbers reveal. Without a bound, a sender that is faster than us would use up all memory.
  subscription->setQueueCapacity(max_queued);
}

void LcmTransport::Subscribe(const std::string& channel, Handler handler) {
  SubscribeTo(channel, kMaxQueuedOfChannel);
  handlers_[channel] = std::move(handler);
}

void LcmTransport::SubscribeAll(
    std::function<void(const std::string&, const void*, std::size_t, std::int64_t)> handler) {
  SubscribeTo(".*", kMaxQueuedOfAll);
  all_handler_ = std::move(handler);
}

bool LcmTransport::Poll(int timeout_ms) {
  errno = 0;
  const int result = lcm_->handleTimeout(timeout_ms);
  if (exception_ != nullptr) std::rethrow_exception(std::exchange(exception_, nullptr));
  if (result < 0 && errno != EINTR) {
    throw std::runtime_error(std::string("LCM cannot receive any more: ") + std::strerror(errno));
  }
  return result > 0;
}

bool LcmTransport::Publish(const std::string& channel, const void* data, std::size_t size) {
  return lcm_->publish(channel, data, static_cast<unsigned int>(size)) == 0;
}

void LcmTransport::OnMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel) {
  // An exception that unwinds through LCM's C code makes the next call abort.
  try {
    if (all_handler_) all_handler_(channel, buffer->data, buffer->data_size, buffer->recv_utime);
    const auto handler = handlers_.find(channel);
    if (handler == handlers_.end()) return;
    handler->second(buffer->data, buffer->data_size, buffer->recv_utime);
  } catch (...) {
    exception_ = std::current_exception();
  }
}

}  // namespace airdos
