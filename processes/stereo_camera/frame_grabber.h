#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_FRAME_GRABBER_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_FRAME_GRABBER_H_

#include <cstdint>
#include <functional>
#include <opencv2/core.hpp>
#include <string>
#include <utility>
#include <vector>

namespace airdos {

/// CLOCK_MONOTONIC, us: the clock of V4L2's time stamps, which nobody sets.
using CaptureClock = std::function<std::int64_t()>;

/// Two images that were taken together, before rectification: CV_8UC1, or CV_8UC3 (BGR).
struct CapturedPair {
  std::int64_t utime = 0;    ///< us, capture time of the left image
  std::int64_t skew_us = 0;  ///< by how much the right image was taken later
  cv::Mat left;
  cv::Mat right;
};

/// What a grabber has at the moment.
struct Grabbed {
  enum class State {
    kPair,
    kNothingYet,  ///< ask again
    kUnusable,    ///< a pair that is damaged; `why`
    kLost,        ///< the source is gone until Reopen() succeeds; `why`
    kEnded,       ///< no more will come
  };
  State state = State::kNothingYet;
  CapturedPair pair;  ///< its times are by the CaptureClock
  std::string why;
};

/// Where a camera process has its images from: devices, or a recording that plays at its own rate.
/// Used by one thread at a time.
class FrameGrabber {
 public:
  /// Grab() and Reopen() return within about that time, so that a process can end.
  static constexpr int kMaxWait_ms = 200;

  virtual ~FrameGrabber() = default;
  virtual std::string name() const = 0;                ///< for messages
  virtual std::pair<int, int> image_size() const = 0;  ///< of one eye; width and height, px
  virtual Grabbed Grab() = 0;
  /// After kLost: tries once to find the source again. Returns an empty text, or why it failed.
  virtual std::string Reopen() = 0;
  /// What users should know about the source, one line each; each returned once.
  virtual std::vector<std::string> TakeNotes() { return {}; }
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_FRAME_GRABBER_H_
