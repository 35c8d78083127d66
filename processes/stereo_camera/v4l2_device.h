#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_V4L2_DEVICE_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_V4L2_DEVICE_H_

#include <memory>
#include <optional>
#include <string>
#include <utility>

#include "processes/stereo_camera/image_device.h"

namespace airdos {

/// What is asked of a V4L2 device; it may give something else, which is then said.
struct V4l2DeviceOptions {
  std::string path;                         ///< such as /dev/video0
  std::optional<std::pair<int, int>> size;  ///< width and height of its whole image, px
  std::optional<double> rate_hz;
  std::string pixel_format;  ///< four letters, such as MJPG; empty: any
};

/// A camera of Linux (Video4Linux), through OpenCV's videoio. Opened by Open() only.
class V4l2Device : public ImageDevice {
 public:
  explicit V4l2Device(const V4l2DeviceOptions& options);
  ~V4l2Device() override;

  std::string name() const override { return options_.path; }
  /// Also fails where the device does not give what was asked of it.
  std::string Open() override;
  State Take(int timeout_ms) override;
  std::int64_t utime() const override;
  cv::Mat Retrieve() override;
  double rate_hz() const override;
  cv::Size image_size() const override;

 private:
  std::string WhyNotOpen() const;
  std::string Configure();
  struct Capture;  // of OpenCV, whose header takes long to compile

  V4l2DeviceOptions options_;
  std::unique_ptr<Capture> capture_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_V4L2_DEVICE_H_
