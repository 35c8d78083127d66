#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_OPTIONS_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_OPTIONS_H_

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/config/option_table.h"
#include "common/dataset/recording/video_recording.h"
#include "processes/node/live/calibration_cli.h"
#include "processes/node/live/process_cli.h"
#include "processes/stereo_camera/camera_capture.h"
#include "processes/stereo_camera/camera_messages.h"
#include "processes/stereo_camera/frame_grabber.h"

namespace airdos {

/// What the camera process is asked to do.
struct CameraOptions {
  std::vector<std::string> devices;  ///< one or two; else `videos` are
  std::vector<std::string> videos;
  VideoLayout layout = VideoLayout::kTwoVideos;
  std::optional<std::pair<int, int>> capture_size;  ///< of a device's whole image, px
  std::optional<double> rate_hz;
  std::string pixel_format;  ///< of a device, four letters; empty: any
  double stall_s = 2;        ///< a device that delivers nothing for that long counts as lost
  std::optional<std::int64_t> session;  ///< without: the wall clock, us
  CameraCaptureOptions capture;
  CameraMessageOptions messages;
};

/// launch_scripts/config/stereo_camera.yaml: those that are not only on the command line.
OptionTable TableOf(CameraOptions* options);

/// The command line, and where it says nothing the configuration file.
class CameraArguments {
 public:
  explicit CameraArguments(CommandLine* app);
  /// After parsing. Throws InputError.
  CameraOptions Resolve() const;
  const CommonArguments& common() const { return common_; }
  const CalibrationArguments& calibration() const { return calibration_; }

 private:
  void RequireSource() const;
  VideoLayout Layout() const;

  CommonArguments common_;
  CalibrationArguments calibration_;
  CameraOptions options_;
  bool is_side_by_side_ = false;
  bool is_over_under_ = false;
  std::string capture_size_;
  std::string encoding_ = "jpeg";
};

/// Opens the devices or the videos. Throws InputError.
std::unique_ptr<FrameGrabber> OpenGrabber(const CameraOptions& options, const CaptureClock& clock);

/// Throws InputError where the images have another size than those that were calibrated.
void RequireSize(const FrameGrabber& grabber, const StereoRectifier& rectifier);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_CAMERA_OPTIONS_H_
