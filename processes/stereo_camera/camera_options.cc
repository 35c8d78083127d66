#include "processes/stereo_camera/camera_options.h"

#include <cstdio>

#include "common/calibration/camera_matrix.h"
#include "common/config/option_pages.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "processes/stereo_camera/device_grabber.h"
#include "processes/stereo_camera/recording_grabber.h"
#include "processes/stereo_camera/v4l2_device.h"

namespace airdos {
namespace {

std::pair<int, int> SizeOf(const std::string& text) {
  int width = 0;
  int height = 0;
  char rest = '\0';
  if (std::sscanf(text.c_str(), "%6dx%6d%c", &width, &height, &rest) != 2) {
    throw InputError("--capture-size: '" + text + "' must be WIDTHxHEIGHT");
  }
  return ToImageSize(width, height, "--capture-size");
}

}  // namespace

OptionTable TableOf(CameraOptions* options) {
  OptionTable table(
      "stereo_camera",
      "Defaults of airdos-stereo-camera; a command-line option wins over the value here.");
  table.AddSection("capture");
  table.Add("capture.max_waiting", &options->capture.max_waiting, {1, 100}, "pairs",
            "at most this many wait to be rectified and published; the oldest is dropped for a new "
            "one, so more means fewer drops and older images");
  table.Add("capture.stall_s", &options->stall_s, {0.1, 3600}, "s",
            "a device that delivers nothing for that long is taken for lost, and opened again");
  table.Add("capture.retry_s", &options->capture.retry_s, {0.1, 3600}, "s",
            "how often a lost device is looked for");
  table.Add("capture.max_skew_ms", &options->capture.max_skew_ms, {0.01, 10000}, "ms",
            "warn where the images of two devices are further apart in time");
  table.Add("capture.complain_s", &options->capture.complain_s, {1, 86400}, "s",
            "dropped pairs are said at most that often");
  table.AddSection("image");
  table.Add("image.max_image_bytes", &options->messages.max_image_bytes, {1000, 100000000}, "bytes",
            "largest image file in a message; above about 128 kB receivers with the system's "
            "default buffers lose messages");
  table.Add("image.jpeg_qualities", &options->messages.jpeg_qualities, {1, 100}, "1..100",
            "JPEG qualities, tried in this order until an image fits");
  return table;
}

CameraArguments::CameraArguments(CommandLine* app) {
  AddCommonOptions(PagesOf<CameraOptions>(), app, &common_);
  app->Add("--camera", &options_.devices,
           "Devices of the left and the right camera, or one that gives both images in one")
      .ShownAs("LEFT [RIGHT]")
      .Words(1, 2);
  app->Add("--video", &options_.videos,
           "In place of --camera: videos that play at their own rate, as from a camera")
      .ShownAs("LEFT [RIGHT]")
      .Words(1, 2)
      .Excludes("--camera");
  app->AddFlag("--side-by-side", &is_side_by_side_,
               "One device or video: left image on the left, right one on the right");
  app->AddFlag("--over-under", &is_over_under_,
               "One device or video: left image on top, right one below");
  app->Add("--capture-size", &capture_size_,
           "Size of a device's whole image; default: what the driver gives")
      .ShownAs("WIDTHxHEIGHT");
  app->Add("--rate", &options_.rate_hz,
           "Images a second that a device shall give, or that a video without times has")
      .ShownAs("HZ")
      .Within(0.01, 10000.0);
  app->Add("--pixel-format", &options_.pixel_format,
           "Pixel format of a device, such as MJPG or YUYV; default: what the driver gives")
      .ShownAs("CODE");
  calibration_.AddTo("--calibration", app);
  app->AddFlag("--nobody", &options_.messages.publishes_nobody,
               "Publish empty messages of people: there is no detector");
  app->Add("--session", &options_.session, "Session number; default: the wall clock in us");
  app->Add("--image-encoding", &encoding_, "jpeg: small enough for all; png: lossless")
      .ShowDefault()
      .OneOf({"jpeg", "png"});
}

void CameraArguments::RequireSource() const {
  if (options_.devices.empty() && options_.videos.empty()) {
    throw InputError(
        "--camera is missing: the device, or the left and the right one (--video "
        "plays a recording in its place)");
  }
  const bool is_device = !options_.devices.empty();
  if (!calibration_.is_given()) {
    throw InputError(std::string(is_device ? "--camera" : "--video") +
                     ": the calibration is missing: --calibration FILE (airdos-calibration show "
                     "FILE tells what it says)");
  }
  if (is_device) {
    const std::string& format = options_.pixel_format;
    if (!format.empty() && format.size() != 4) {
      throw InputError("--pixel-format: '" + format + "' must be four letters, such as MJPG");
    }
  } else if (!capture_size_.empty() || !options_.pixel_format.empty()) {
    throw InputError(std::string(capture_size_.empty() ? "--pixel-format" : "--capture-size") +
                     " is for --camera; a video has its own");
  }
}

VideoLayout CameraArguments::Layout() const {
  const std::vector<std::string>& all =
      options_.devices.empty() ? options_.videos : options_.devices;
  if (is_side_by_side_ && is_over_under_) {
    throw InputError("--side-by-side and --over-under exclude each other");
  }
  const bool is_one_image = is_side_by_side_ || is_over_under_;
  if (all.size() == 2 && is_one_image) {
    throw InputError("--side-by-side and --over-under are for one source, there are two: '" +
                     all[0] + "' and '" + all[1] + "'");
  }
  if (all.size() == 2 && all[0] == all[1]) {
    throw InputError("'" + all[0] + "' cannot be the left and the right one");
  }
  if (all.size() == 1 && !is_one_image) {
    throw InputError(
        all[0] + ": one source: where are the two images in it, --side-by-side or --over-under?");
  }
  return is_side_by_side_ ? VideoLayout::kSideBySide
         : is_over_under_ ? VideoLayout::kOverUnder
                          : VideoLayout::kTwoVideos;
}

CameraOptions CameraArguments::Resolve() const {
  RequireSource();
  CameraOptions options = options_;
  options.layout = Layout();
  if (!capture_size_.empty()) options.capture_size = SizeOf(capture_size_);
  options.messages.is_lossless = encoding_ == "png";
  ConfigReader config = ReadConfig(common_);
  TableOf(&options).Read(&config);
  FinishConfig(config, common_);
  return options;
}

std::unique_ptr<FrameGrabber> OpenGrabber(const CameraOptions& options, const CaptureClock& clock) {
  if (options.devices.empty()) {
    const std::vector<std::string>& videos = options.videos;
    return std::make_unique<RecordingGrabber>(
        std::make_unique<VideoRecording>(VideoRecordingOptions{
            videos[0], videos.size() == 2 ? videos[1] : "", options.layout, options.rate_hz}),
        clock);
  }
  std::vector<std::unique_ptr<ImageDevice>> devices;
  for (const std::string& path : options.devices) {
    devices.push_back(std::make_unique<V4l2Device>(
        V4l2DeviceOptions{path, options.capture_size, options.rate_hz, options.pixel_format}));
  }
  return std::make_unique<DeviceGrabber>(std::move(devices), options.layout, options.stall_s,
                                         clock);
}

void RequireSize(const FrameGrabber& grabber, const StereoRectifier& rectifier) {
  const auto [width, height] = grabber.image_size();
  const StereoCamera& camera = rectifier.camera();
  if (width == camera.width && height == camera.height) return;
  throw InputError(Format("%s: gives images of %dx%d px, the calibration is for %dx%d px",
                          grabber.name().c_str(), width, height, camera.width, camera.height));
}

}  // namespace airdos
