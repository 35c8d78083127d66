#include "processes/stereo_camera/recording_grabber.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace airdos {

RecordingGrabber::RecordingGrabber(std::unique_ptr<StereoRecording> recording, CaptureClock clock,
                                   Pause pause)
    : recording_(std::move(recording)), clock_(std::move(clock)), pause_(std::move(pause)) {
  if (!pause_) {
    pause_ = [](std::int64_t us) { std::this_thread::sleep_for(std::chrono::microseconds(us)); };
  }
}

Grabbed RecordingGrabber::Next() {
  if (next_ >= recording_->num_pairs()) return {Grabbed::State::kEnded, {}, ""};
  const std::optional<RecordedPair> pair = recording_->Load(next_++);
  if (!pair) {
    return {Grabbed::State::kUnusable,
            {},
            recording_->names(next_ - 1).left + ": this pair cannot be used"};
  }
  if (!offset_us_) offset_us_ = clock_() - pair->utime;
  waiting_ = CapturedPair{pair->utime + *offset_us_, 0, pair->left, pair->right};
  return {};
}

Grabbed RecordingGrabber::Grab() {
  if (!waiting_) {
    Grabbed next = Next();
    if (next.state != Grabbed::State::kNothingYet) return next;
  }
  const std::int64_t left_us = waiting_->utime - clock_();
  if (left_us > 0) {
    pause_(std::min<std::int64_t>(left_us, 1000 * kMaxWait_ms));
    if (waiting_->utime > clock_()) return {};
  }
  Grabbed grabbed{Grabbed::State::kPair, std::move(*waiting_), ""};
  waiting_.reset();
  return grabbed;
}

}  // namespace airdos
