#include "processes/stereo_camera/device_grabber.h"

#include <algorithm>
#include <cmath>

#include "common/util/check.h"
#include "common/util/error.h"
#include "common/util/format.h"

namespace airdos {
namespace {

std::string SizeText(const cv::Size& size) {
  return std::to_string(size.width) + "x" + std::to_string(size.height);
}

}  // namespace

DeviceGrabber::DeviceGrabber(std::vector<std::unique_ptr<ImageDevice>> devices, VideoLayout layout,
                             double stall_s, CaptureClock clock)
    : layout_(layout), stall_us_(std::llround(1e6 * stall_s)), clock_(std::move(clock)) {
  AIRDOS_CHECK(devices.size() == (layout == VideoLayout::kTwoVideos ? 2u : 1u));
  for (std::unique_ptr<ImageDevice>& device : devices) {
    eyes_.push_back({std::move(device)});
  }
  const std::string why = OpenAll();
  if (!why.empty()) throw InputError(why);
  size_ = eyes_[0].device->image_size();
  if (eyes_.size() == 2) {
    const cv::Size right = eyes_[1].device->image_size();
    if (right != size_) {
      throw InputError(eyes_[1].device->name() + ": gives images of " + SizeText(right) + " px, " +
                       eyes_[0].device->name() + " of " + SizeText(size_));
    }
    return;
  }
  int& divided = layout == VideoLayout::kSideBySide ? size_.width : size_.height;
  if (divided < 2 || divided % 2 != 0) {
    throw InputError(name() + ": gives images of " + SizeText(size_) +
                     " px, which cannot be divided into two of one size");
  }
  divided /= 2;
}

std::string DeviceGrabber::name() const {
  return eyes_.size() == 1 ? eyes_[0].device->name()
                           : eyes_[0].device->name() + ", " + eyes_[1].device->name();
}

std::string DeviceGrabber::OpenAll() {
  for (Eye& eye : eyes_) {
    eye.has_image = false;
    const std::string why = eye.device->Open();
    if (!why.empty()) return why;
  }
  for (Eye& eye : eyes_) eye.heard_utime = clock_();
  return "";
}

std::string DeviceGrabber::Reopen() {
  const std::string why = OpenAll();
  if (!why.empty()) return why;
  cv::Size whole = size_;
  if (layout_ == VideoLayout::kSideBySide) whole.width *= 2;
  if (layout_ == VideoLayout::kOverUnder) whole.height *= 2;
  for (const Eye& eye : eyes_) {
    const cv::Size now = eye.device->image_size();
    if (now == whole) continue;
    return eye.device->name() + ": is back, but gives images of " + SizeText(now) + " px, not " +
           SizeText(whole);
  }
  return "";
}

/// The driver's time, unless it is from another clock: then that at which the image was here.
void DeviceGrabber::TakeTime(Eye* eye) const {
  constexpr std::int64_t kMaxAge_us = 1000000;
  const std::int64_t now = clock_();
  const std::int64_t stamp = eye->device->utime();
  eye->utime = stamp <= now && stamp > now - kMaxAge_us ? stamp : now;
  eye->heard_utime = now;
}

std::optional<Grabbed> DeviceGrabber::TakeMissing() {
  for (Eye& eye : eyes_) {
    if (eye.has_image) continue;
    const std::string& name = eye.device->name();
    switch (eye.device->Take(kMaxWait_ms / 2)) {
      case ImageDevice::State::kLost:
        return Grabbed{Grabbed::State::kLost, {}, name + " is lost"};
      case ImageDevice::State::kNothingYet:
        if (clock_() - eye.heard_utime > stall_us_) {
          return Grabbed{Grabbed::State::kLost,
                         {},
                         Format("%s delivers nothing for %.3g s", name.c_str(),
                                1e-6 * static_cast<double>(stall_us_))};
        }
        return Grabbed{};
      case ImageDevice::State::kImage:
        eye.has_image = true;
        TakeTime(&eye);
    }
  }
  return std::nullopt;
}

/// Leaves out the earlier image of two that belong to different pairs. Bounded, because the times
/// of a device may be wrong.
bool DeviceGrabber::DropLagging() {
  constexpr int kMaxInRow = 4;
  if (eyes_.size() == 1) return false;
  const double rate_hz = std::min(eyes_[0].device->rate_hz(), eyes_[1].device->rate_hz());
  const auto difference_us = static_cast<double>(eyes_[1].utime - eyes_[0].utime);
  if (rate_hz <= 0 || std::abs(difference_us) <= 0.5e6 / rate_hz ||
      num_dropped_in_row_ >= kMaxInRow) {
    num_dropped_in_row_ = 0;
    return false;
  }
  ++num_dropped_in_row_;
  eyes_[difference_us > 0 ? 0 : 1].has_image = false;
  return true;
}

Grabbed DeviceGrabber::Grab() {
  if (std::optional<Grabbed> nothing = TakeMissing()) return *nothing;
  if (DropLagging()) return {};
  return Retrieve();
}

Grabbed DeviceGrabber::Retrieve() {
  std::vector<cv::Mat> images;
  for (Eye& eye : eyes_) {
    images.push_back(eye.device->Retrieve());
    eye.has_image = false;
  }
  cv::Size whole = size_;
  if (layout_ == VideoLayout::kSideBySide) whole.width *= 2;
  if (layout_ == VideoLayout::kOverUnder) whole.height *= 2;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (images[i].size() == whole && images[i].depth() == CV_8U) continue;
    const std::string what = images[i].empty() ? "cannot be decoded"
                             : images[i].depth() != CV_8U
                                 ? "has more than 8 bits"
                                 : "has " + SizeText(images[i].size()) + " px";
    return {Grabbed::State::kUnusable, {}, eyes_[i].device->name() + ": an image " + what};
  }
  Grabbed grabbed{Grabbed::State::kPair, {}, ""};
  grabbed.pair.utime = eyes_[0].utime;
  if (images.size() == 2) {
    grabbed.pair.skew_us = eyes_[1].utime - eyes_[0].utime;
    grabbed.pair.left = images[0];
    grabbed.pair.right = images[1];
  } else {
    const bool is_beside = layout_ == VideoLayout::kSideBySide;
    const cv::Point second(is_beside ? size_.width : 0, is_beside ? 0 : size_.height);
    grabbed.pair.left = images[0](cv::Rect({0, 0}, size_));
    grabbed.pair.right = images[0](cv::Rect(second, size_));
  }
  return grabbed;
}

}  // namespace airdos
