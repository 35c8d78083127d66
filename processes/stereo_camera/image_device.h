#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_IMAGE_DEVICE_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_IMAGE_DEVICE_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <string>

namespace airdos {

/// One device that delivers images at a rate of its own.
class ImageDevice {
 public:
  enum class State { kImage, kNothingYet, kLost };

  virtual ~ImageDevice() = default;
  virtual std::string name() const = 0;
  /// Opens it, or opens it again. Returns an empty text, or why it failed.
  virtual std::string Open() = 0;
  /// Takes the next image from the device, waiting at most that long.
  virtual State Take(int timeout_ms) = 0;
  /// When the image taken last was captured, by the CaptureClock (us); 0: the device does not say.
  virtual std::int64_t utime() const = 0;
  /// The pixels of the image taken last, the caller's own; empty if they cannot be decoded.
  virtual cv::Mat Retrieve() = 0;
  virtual double rate_hz() const = 0;       ///< 0: unknown
  virtual cv::Size image_size() const = 0;  ///< px, once it has been opened
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_IMAGE_DEVICE_H_
