#ifndef AIRDOS_PROCESSES_STEREO_CAMERA_RECORDING_GRABBER_H_
#define AIRDOS_PROCESSES_STEREO_CAMERA_RECORDING_GRABBER_H_

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/recording/stereo_recording.h"
#include "processes/stereo_camera/frame_grabber.h"

namespace airdos {

/// A recording that plays at its own rate, like a camera: a pair is there once its time has passed
/// since the first one, whether anybody asks or not. Nothing is lost within; whoever asks too
/// seldom gets late pairs.
class RecordingGrabber : public FrameGrabber {
 public:
  using Pause = std::function<void(std::int64_t us)>;

  /// The first pair is there with the first Grab(). `pause` lets time pass; by default it sleeps.
  RecordingGrabber(std::unique_ptr<StereoRecording> recording, CaptureClock clock,
                   Pause pause = {});

  std::string name() const override { return recording_->name(); }
  std::pair<int, int> image_size() const override { return recording_->image_size(); }
  Grabbed Grab() override;
  std::string Reopen() override { return ""; }  // it is never lost
  std::vector<std::string> TakeNotes() override { return recording_->TakeNotes(); }

 private:
  Grabbed Next();

  std::unique_ptr<StereoRecording> recording_;
  CaptureClock clock_;
  Pause pause_;
  std::size_t next_ = 0;
  std::optional<std::int64_t> offset_us_;  // of the clock from the recording's times
  std::optional<CapturedPair> waiting_;    // decoded, not yet due
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_STEREO_CAMERA_RECORDING_GRABBER_H_
