#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_CAPTURE_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_CAPTURE_H_

#include <atomic>
#include <condition_variable>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "processes/stereo_camera/frame_grabber.h"

namespace airdos {

/// How pairs are captured.
struct CameraCaptureOptions {
  int max_waiting = 2;     ///< pairs that wait for Take(); the oldest is dropped for a new one
  double retry_s = 1;      ///< how often a lost source is looked for
  double max_skew_ms = 5;  ///< a right image that is later or earlier by more is warned of
  double complain_s = 10;  ///< how often drops are said at most
};

/// What became of the pairs so far.
struct CaptureCounters {
  std::int64_t num_captured = 0;  ///< complete pairs that the source delivered
  std::int64_t num_dropped = 0;   ///< of these, for newer ones, because nobody took them in time
  std::int64_t num_unusable = 0;  ///< damaged, of another size, or not later than the one before
  std::int64_t num_losses = 0;    ///< of the source
  std::string last_unusable;      ///< why
};

/// Takes pairs from a grabber as they come, in a thread of its own, and keeps the newest ones.
///
/// Times are converted from the grabber's clock to that of `offset_us` once and for all, so setting
/// the wall clock changes nothing, and rise from pair to pair: one that is not later than the one
/// before is left out. A source that is lost is said once, looked for, and gone on with.
class CameraCapture {
 public:
  using Pause = std::function<void(std::int64_t us)>;

  /// `offset_us` is added to the grabber's times. `pause` lets time pass; by default it sleeps.
  CameraCapture(std::unique_ptr<FrameGrabber> grabber, const CameraCaptureOptions& options,
                std::int64_t offset_us, CaptureClock clock, Pause pause = {});
  ~CameraCapture();
  CameraCapture(const CameraCapture&) = delete;
  CameraCapture& operator=(const CameraCapture&) = delete;

  /// Begins to capture; Stop() returns after the step that is being made.
  void Start();
  void Stop();
  /// What the thread repeats: looks once for a pair, or for the lost source. False after the last
  /// one. For tests, which have no thread.
  bool Step();

  /// The oldest pair that waits, after at most that long.
  std::optional<CapturedPair> Take(double timeout_s);
  /// Nothing waits, and nothing will come.
  bool has_ended() const;
  bool is_lost() const;
  /// Why capturing ended in an error; empty if it did not.
  std::string error() const;
  CaptureCounters counters() const;
  /// For the user, one line each ("warning: …"); each returned once.
  std::vector<std::string> TakeNotes();

 private:
  void Run();
  void LookForSource();
  void OnPair(CapturedPair pair);
  void OnUnusable(const std::string& why);
  void OnLost(const std::string& why);
  void WatchSkew(std::int64_t skew_us);
  void SayDrops(std::int64_t now);
  void Note(const std::string& line);

  std::unique_ptr<FrameGrabber> grabber_;
  CameraCaptureOptions options_;
  std::int64_t offset_us_;
  CaptureClock clock_;
  Pause pause_;

  // Of the capturing thread.
  std::optional<std::int64_t> newest_utime_;
  std::int64_t retry_utime_ = 0;
  std::int64_t lost_utime_ = 0;
  std::string why_not_found_;
  int num_skewed_in_row_ = 0;
  bool is_skew_said_ = false;
  std::int64_t num_drops_said_ = 0;
  std::int64_t say_drops_utime_ = 0;

  // Of both threads.
  mutable std::mutex mutex_;
  std::condition_variable has_news_;
  std::deque<CapturedPair> waiting_;
  CaptureCounters counters_;
  bool is_lost_ = false;
  bool is_over_ = false;
  std::string error_;
  std::vector<std::string> notes_;

  std::atomic<bool> must_stop_{false};
  std::thread thread_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_CAPTURE_H_
