#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_LOOP_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_LOOP_H_

#include <cstddef>
#include <cstdint>
#include <deque>
#include <set>
#include <string>

#include "processes/node/live/lag_watch.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/process_usage.h"
#include "processes/node/live/service_notifier.h"
#include "processes/stereo_camera/camera_capture.h"
#include "processes/stereo_camera/camera_messages.h"

namespace airdos {

/// Publishes what a CameraCapture takes, rectified, until its source ends or StopRequested(); says
/// STATUS once a second, in which frames done are those published, skipped those dropped for newer
/// ones, and the rejected ones of "camera" those that could not be used.
class CameraLoop {
 public:
  static constexpr char kProcessName[] = "airdos-stereo-camera";

  /// None of the pointers is owned. `offset_us`: see CameraCapture; `notify_socket`: see
  /// ServiceNotifier.
  CameraLoop(CameraCapture* capture, CameraMessages* messages, std::int64_t offset_us,
             LcmTransport* transport, const ProcessLog* log, const std::string& notify_socket);

  /// Returns the exit code: 1 if capturing ended in an error.
  int Run();

 private:
  void Publish(const CapturedPair& pair);
  void Listen();
  void HearStatus(const void* data, std::size_t size);
  void PublishStatus(std::int8_t state);
  void PublishStatusWhenDue();
  void SayNotes();
  void Say(const std::string& note);
  std::string Tally() const;

  CameraCapture* capture_;
  CameraMessages* messages_;
  std::int64_t offset_us_;
  LcmTransport* transport_;
  const ProcessLog* log_;
  ServiceNotifier service_;
  LagWatch lag_;
  RecentValues latency_ms_{100};  // from capture to the last message of the pair
  double next_status_s_ = 0;
  double cpu_at_start_ms_ = 0;
  std::int64_t num_misfits_ = 0;        // pairs that no message holds
  std::int64_t num_not_published_ = 0;  // messages that the network did not accept
  std::set<std::int64_t> namesakes_;    // process ids
  std::string last_error_;
  std::deque<std::string> warnings_;  // the newest, for STATUS
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_LOOP_H_
