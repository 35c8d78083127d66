#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_DEVICE_GRABBER_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_DEVICE_GRABBER_H_

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/recording/video_recording.h"
#include "processes/stereo_camera/frame_grabber.h"
#include "processes/stereo_camera/image_device.h"

namespace airdos {

/// Pairs from one device that delivers both images in one, or from two devices.
///
/// The images of two devices are taken one right after the other. Where one of the two lags by more
/// than half the time between images (it began later, or lost one), its image is left out, so that
/// each is paired with the one nearest in time.
class DeviceGrabber : public FrameGrabber {
 public:
  /// Opens the devices: one, or left and right (VideoLayout::kTwoVideos). `stall_s`: a device that
  /// delivers nothing for that long counts as lost. Throws InputError.
  DeviceGrabber(std::vector<std::unique_ptr<ImageDevice>> devices, VideoLayout layout,
                double stall_s, CaptureClock clock);

  std::string name() const override;
  std::pair<int, int> image_size() const override { return {size_.width, size_.height}; }
  Grabbed Grab() override;
  std::string Reopen() override;

 private:
  struct Eye {
    std::unique_ptr<ImageDevice> device;
    bool has_image = false;
    std::int64_t utime = 0;        // of that image
    std::int64_t heard_utime = 0;  // when there was one last
  };

  std::string OpenAll();
  std::optional<Grabbed> TakeMissing();
  void TakeTime(Eye* eye) const;
  bool DropLagging();
  Grabbed Retrieve();

  std::vector<Eye> eyes_;
  VideoLayout layout_;
  std::int64_t stall_us_;
  CaptureClock clock_;
  cv::Size size_;  // of one eye
  int num_dropped_in_row_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_DEVICE_GRABBER_H_
