#include "processes/stereo_camera/v4l2_device.h"

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <cerrno>
#include <cmath>
#include <cstring>
#include <opencv2/videoio.hpp>
#include <vector>

#include "common/util/format.h"

namespace airdos {

struct V4l2Device::Capture {
  cv::VideoCapture video;
};

V4l2Device::V4l2Device(const V4l2DeviceOptions& options)
    : options_(options), capture_(std::make_unique<Capture>()) {}

V4l2Device::~V4l2Device() = default;

/// OpenCV only says that it failed.
std::string V4l2Device::WhyNotOpen() const {
  struct stat status = {};
  if (stat(options_.path.c_str(), &status) != 0) return std::strerror(errno);
  if (!S_ISCHR(status.st_mode)) return "is no device (a recording is played with --video)";
  const int device = open(options_.path.c_str(), O_RDWR | O_NONBLOCK | O_CLOEXEC);
  if (device < 0) return std::strerror(errno);
  close(device);
  return "is no camera, another program uses it, or its pixel format is unknown";
}

std::string V4l2Device::Open() {
  cv::VideoCapture& video = capture_->video;
  video.release();
  try {
    video.open(options_.path, cv::CAP_V4L2);
    if (!video.isOpened()) return options_.path + ": " + WhyNotOpen();
    return Configure();
  } catch (const cv::Exception& error) {
    video.release();
    return options_.path + ": " + error.err;
  }
}

/// The pixel format first: sizes and rates depend on it.
std::string V4l2Device::Configure() {
  cv::VideoCapture& video = capture_->video;
  const std::string& format = options_.pixel_format;
  if (!format.empty()) {
    const int code = cv::VideoWriter::fourcc(format[0], format[1], format[2], format[3]);
    video.set(cv::CAP_PROP_FOURCC, code);
    if (static_cast<int>(video.get(cv::CAP_PROP_FOURCC)) != code) {
      return options_.path + ": does not have the pixel format " + format;
    }
  }
  if (options_.size) {
    video.set(cv::CAP_PROP_FRAME_WIDTH, options_.size->first);
    video.set(cv::CAP_PROP_FRAME_HEIGHT, options_.size->second);
    const cv::Size size = image_size();
    if (size != cv::Size(options_.size->first, options_.size->second)) {
      return Format("%s: gives images of %dx%d px, not %dx%d", options_.path.c_str(), size.width,
                    size.height, options_.size->first, options_.size->second);
    }
  }
  if (options_.rate_hz) {
    video.set(cv::CAP_PROP_FPS, *options_.rate_hz);
    const double rate_hz = this->rate_hz();
    if (rate_hz > 0 && std::abs(rate_hz - *options_.rate_hz) > 0.5 + 0.05 * *options_.rate_hz) {
      return Format("%s: gives %.4g images a second, not %.4g", options_.path.c_str(), rate_hz,
                    *options_.rate_hz);
    }
  }
  return "";
}

ImageDevice::State V4l2Device::Take(int timeout_ms) {
  cv::VideoCapture& video = capture_->video;
  if (!video.isOpened()) return State::kLost;
  try {
    // Without this, grab() waits for up to ten seconds.
    std::vector<int> ready;
    const std::int64_t timeout_ns = static_cast<std::int64_t>(timeout_ms) * 1000000;
    if (!cv::VideoCapture::waitAny({video}, ready, timeout_ns) || ready.empty()) {
      // The node of a camera that is unplugged is gone at once, its stream may just be silent.
      return access(options_.path.c_str(), F_OK) == 0 ? State::kNothingYet : State::kLost;
    }
    return video.grab() ? State::kImage : State::kLost;
  } catch (const cv::Exception&) {
    return State::kLost;
  }
}

std::int64_t V4l2Device::utime() const {
  // That of the driver's buffer: when its first byte, or its last one, was received.
  return std::llround(1e3 * capture_->video.get(cv::CAP_PROP_POS_MSEC));
}

cv::Mat V4l2Device::Retrieve() {
  try {
    cv::Mat image;
    if (!capture_->video.retrieve(image)) return {};
    return image.clone();  // the capture's own memory is used again
  } catch (const cv::Exception&) {
    return {};
  }
}

double V4l2Device::rate_hz() const {
  const double rate_hz = capture_->video.get(cv::CAP_PROP_FPS);
  return std::isfinite(rate_hz) && rate_hz > 0 ? rate_hz : 0;
}

cv::Size V4l2Device::image_size() const {
  const cv::VideoCapture& video = capture_->video;
  return {static_cast<int>(video.get(cv::CAP_PROP_FRAME_WIDTH)),
          static_cast<int>(video.get(cv::CAP_PROP_FRAME_HEIGHT))};
}

}  // namespace airdos
