#include <cmath>
#include <iostream>
#include <memory>
#include <opencv2/core/utility.hpp>
#include <string>
#include <utility>

#include "common/util/version.h"
#include "processes/node/live/lcm_transport.h"
#include "processes/node/live/process_cli.h"
#include "processes/node/live/process_log.h"
#include "processes/node/live/process_usage.h"
#include "processes/stereo_camera/camera_loop.h"
#include "processes/stereo_camera/camera_options.h"

namespace {

std::int64_t SteadyClock_us() { return std::llround(1e6 * airdos::SteadyClock_s()); }

int Capture(airdos::CameraOptions options, const airdos::CalibrationArguments& calibration,
            const airdos::CommonArguments& common) {
  airdos::InstallStopSignals();
  cv::setNumThreads(1);
  const airdos::ProcessLog log(airdos::CameraLoop::kProcessName,
                               airdos::ParseLogLevel(common.log_level));
  std::unique_ptr<airdos::FrameGrabber> grabber = OpenGrabber(options, SteadyClock_us);
  const airdos::StereoRig rig = calibration.Read(grabber->image_size());
  const airdos::StereoRectifier rectifier(rig, calibration.rectifier_options());
  airdos::RequireSize(*grabber, rectifier);
  airdos::LcmTransport transport(common.lcm_url);
  const std::int64_t now_us = airdos::WallClock_us();
  const std::int64_t offset_us = now_us - SteadyClock_us();
  options.messages.session = options.session.value_or(now_us);
  airdos::CameraCapture capture(std::move(grabber), options.capture, offset_us, SteadyClock_us);
  airdos::CameraMessages messages(&rectifier, options.messages);
  airdos::CameraLoop loop(&capture, &messages, offset_us, &transport, &log,
                          airdos::NotifySocketOfEnvironment());
  for (const auto* notes : {&rig.notes, &rectifier.notes()}) {
    for (const std::string& note : *notes) log.Relay(calibration.paths()[0] + ": " + note);
  }
  std::cout << airdos::CameraLoop::kProcessName << " READY version " << airdos::kVersion << " url "
            << common.lcm_url << " config " << common.config_file << std::endl;
  return loop.Run();
}

}  // namespace

int main(int argc, char** argv) {
  airdos::CommandLine app("Publishes the images of a stereo camera, rectified, as they come",
                          "airdos-stereo-camera");
  const airdos::CameraArguments arguments(&app);
  return airdos::RunProgram(argc, argv, &app, [&] {
    return Capture(arguments.Resolve(), arguments.calibration(), arguments.common());
  });
}
