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

/// $LCM_DEFAULT_URL, else multicast that does not leave this machine.
std::string DefaultLcmUrl();

/// From here on SIGINT and SIGTERM, and SIGHUP unless it is ignored, only set what StopRequested()
/// tells, and interrupt Poll().
void InstallStopSignals();
bool StopRequested();

/// Bytes on channels over LCM, nothing else: long queues (what is dropped behind the socket would
/// have been minutes late), one thread, exceptions kept away from LCM's C code.
class LcmTransport {
 public:
  /// Messages that wait for Poll(), of one channel or of all; beyond it the newest are dropped.
  static constexpr int kMaxQueuedOfChannel = 1000;
  static constexpr int kMaxQueuedOfAll = 5000;
  /// `receive_utime` (us, wall clock): when the kernel got the last datagram of the message.
  using Handler =
      std::function<void(const void* data, std::size_t size, std::int64_t receive_utime)>;

  /// Throws InputError, in one line that says what to do, if the URL is bad or the machine has no
  /// route for multicast. Asks for a receive buffer that takes a burst of large messages, unless
  /// the URL says a recv_buf_size; the kernel grants up to net.core.rmem_max.
  explicit LcmTransport(const std::string& url);
  ~LcmTransport();
  LcmTransport(const LcmTransport&) = delete;
  LcmTransport& operator=(const LcmTransport&) = delete;

  /// `channel` is the exact name. When this returns, what is said on it is heard: LCM's first
  /// subscription waits for a message of its own (LCM_SELF_TEST). Throws InputError as the
  /// constructor does.
  void Subscribe(const std::string& channel, Handler handler);
  /// Every channel; `handler` gets its name first. For recorders and the like.
  void SubscribeAll(std::function<void(const std::string& channel, const void* data,
                                       std::size_t size, std::int64_t receive_utime)>
                        handler);
  /// Hands one message to its handler; waits for it at most `timeout_ms`. False if none came or a
  /// signal did. Throws what the handler threw, and std::runtime_error if LCM is broken.
  bool Poll(int timeout_ms);
  /// False if the network does not take it.
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
