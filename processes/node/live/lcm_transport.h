#ifndef AIRDOS_PROCESSES_NODE_LIVE_LCM_TRANSPORT_H_
#define AIRDOS_PROCESSES_NODE_LIVE_LCM_TRANSPORT_H_

#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <map>
#include <memory>
#include <string>

namespace lcm {
class LCM;
struct ReceiveBuffer;
}  // namespace lcm

namespace airdos {

/// $LCM_DEFAULT_URL, or else multicast that does not leave this machine.
std::string DefaultLcmUrl();

/// From now on SIGINT and SIGTERM, and SIGHUP unless it is ignored, only set the flag read by
/// StopRequested() and interrupt Poll().
void InstallStopSignals();
bool StopRequested();

/// Sends and receives bytes on channels over LCM and nothing else, with long queues (what is
/// dropped at the socket would have been minutes late), a single thread, and exceptions kept away
/// from LCM's C code.
class LcmTransport {
 public:
  /// Messages that may wait for Poll(), per channel or in total; beyond that the newest are
  /// dropped.
  static constexpr int kMaxQueuedOfChannel = 1000;
  static constexpr int kMaxQueuedOfAll = 5000;
  /// `receive_utime` (us, wall clock): when the kernel received the message's last datagram.
  using Handler =
      std::function<void(const void* data, std::size_t size, std::int64_t receive_utime)>;

  /// Throws InputError, in one line that says what to do, if the URL is wrong or the machine has no
  /// route for multicast. Requests a receive buffer large enough for a burst of large messages,
  /// unless the URL specifies recv_buf_size; the kernel grants up to net.core.rmem_max.
  explicit LcmTransport(const std::string& url);
  ~LcmTransport();
  LcmTransport(const LcmTransport&) = delete;
  LcmTransport& operator=(const LcmTransport&) = delete;

  /// `channel` is the exact name. Once this returns, whatever is published on it is received: LCM's
  /// first subscription waits for a message of its own (LCM_SELF_TEST). Throws InputError like the
  /// constructor.
  void Subscribe(const std::string& channel, Handler handler);
  /// Subscribes to every channel, for recorders and the like; `handler` gets the channel's name
  /// first.
  void SubscribeAll(std::function<void(const std::string& channel, const void* data,
                                       std::size_t size, std::int64_t receive_utime)>
                        handler);
  /// Passes one message to its handler, waiting at most `timeout_ms`. Returns false if none came or
  /// a signal arrived. Throws what the handler throws, and std::runtime_error if LCM fails.
  bool Poll(int timeout_ms);
  /// Returns false if the network does not accept the message.
  bool Publish(const std::string& channel, const void* data, std::size_t size);

  const std::string& url() const { return url_; }

 private:
  void OnMessage(const lcm::ReceiveBuffer* buffer, const std::string& channel);
  void SubscribeTo(const std::string& regex, int max_queued);

  std::string url_;
  std::unique_ptr<lcm::LCM> lcm_;
  std::map<std::string, Handler> handlers_;
  std::function<void(const std::string&, const void*, std::size_t, std::int64_t)> all_handler_;
  std::exception_ptr exception_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_LCM_TRANSPORT_H_
