#ifndef AIRDOS_PROCESSES_NODE_LIVE_SERVICE_NOTIFIER_H_
#define AIRDOS_PROCESSES_NODE_LIVE_SERVICE_NOTIFIER_H_

#include <string>

#include "processes/node/live/process_log.h"

namespace airdos {

/// $NOTIFY_SOCKET, which systemd sets for a service of Type=notify; else empty.
std::string NotifySocketOfEnvironment();

/// Tells the service manager how this process is, in the datagrams of sd_notify(3): lines such as
/// READY=1, to a Unix socket. Written here because that is all of the protocol, which systemd
/// promises to keep, and libsystemd would bring its compression libraries into every process and
/// one more package into every build.
///
/// Where there is no such socket nothing happens; where it takes nothing, this is said once and the
/// process goes on: only whoever waits for it suffers.
class ServiceNotifier {
 public:
  static constexpr double kPeriod_s = 1;  ///< of what TellWhenDue() says

  /// `socket`: a path, or @NAME in the abstract namespace; empty: nobody is told. The log is not
  /// owned.
  ServiceNotifier(const std::string& socket, const ProcessLog* log);
  ~ServiceNotifier();
  ServiceNotifier(const ServiceNotifier&) = delete;
  ServiceNotifier& operator=(const ServiceNotifier&) = delete;

  /// The process is at work: READY=1 with the first of these, STATUS=`status` (one line) and
  /// WATCHDOG=1 with each.
  void Tell(const std::string& status);
  /// The same, if the last one was kPeriod_s ago by the caller's clock.
  void TellWhenDue(double now_s, const std::string& status);
  /// The process is about to end: STOPPING=1.
  void TellStopping(const std::string& status);

 private:
  /// Empty, or why it could not.
  std::string Connect();
  void Send(const std::string& lines);
  void GiveUp(const std::string& why);

  std::string socket_;
  const ProcessLog* log_;
  int descriptor_ = -1;  // none: nobody is told
  bool is_ready_ = false;
  double next_s_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_NODE_LIVE_SERVICE_NOTIFIER_H_
