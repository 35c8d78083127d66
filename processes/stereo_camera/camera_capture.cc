#include "processes/stereo_camera/camera_capture.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <utility>

#include "common/util/format.h"

namespace airdos {
namespace {

/// Notes of a source that fails for ever must not fill the disk.
constexpr std::size_t kMaxNotesWaiting = 100;

}  // namespace

CameraCapture::CameraCapture(std::unique_ptr<FrameGrabber> grabber,
                             const CameraCaptureOptions& options, std::int64_t offset_us,
                             CaptureClock clock, Pause pause)
    : grabber_(std::move(grabber)),
      options_(options),
      offset_us_(offset_us),
      clock_(std::move(clock)),
      pause_(std::move(pause)) {
  if (!pause_) {
    pause_ = [](std::int64_t us) { std::this_thread::sleep_for(std::chrono::microseconds(us)); };
  }
}

CameraCapture::~CameraCapture() { Stop(); }

void CameraCapture::Start() { thread_ = std::thread(&CameraCapture::Run, this); }

void CameraCapture::Stop() {
  must_stop_ = true;
  if (thread_.joinable()) thread_.join();
}

void CameraCapture::Run() {
  std::string error;
  try {
    while (!must_stop_ && Step()) {
    }
  } catch (const std::exception& failure) {
    error = failure.what();
  }
  const std::lock_guard<std::mutex> lock(mutex_);
  error_ = error;
  is_over_ = true;
  has_news_.notify_all();
}

bool CameraCapture::Step() {
  if (is_lost()) {
    LookForSource();
    return true;
  }
  Grabbed grabbed = grabber_->Grab();
  for (const std::string& note : grabber_->TakeNotes()) Note(note);
  switch (grabbed.state) {
    case Grabbed::State::kNothingYet:
      break;
    case Grabbed::State::kPair:
      OnPair(std::move(grabbed.pair));
      break;
    case Grabbed::State::kUnusable:
      OnUnusable(grabbed.why);
      break;
    case Grabbed::State::kLost:
      OnLost(grabbed.why);
      break;
    case Grabbed::State::kEnded: {
      Note(grabber_->name() + ": has ended");
      const std::lock_guard<std::mutex> lock(mutex_);
      is_over_ = true;
      has_news_.notify_all();
      return false;
    }
  }
  SayDrops(clock_());
  return true;
}

void CameraCapture::OnPair(CapturedPair pair) {
  const std::pair<int, int> size = grabber_->image_size();
  const cv::Size expected(size.first, size.second);
  if (pair.left.size() != expected || pair.right.size() != expected) {
    return OnUnusable(grabber_->name() + ": an image of another size");
  }
  if (newest_utime_ && pair.utime <= *newest_utime_) {
    return OnUnusable(Format("%s: an image that is %.3f s earlier than the one before",
                             grabber_->name().c_str(),
                             1e-6 * static_cast<double>(*newest_utime_ - pair.utime)));
  }
  newest_utime_ = pair.utime;
  WatchSkew(pair.skew_us);
  pair.utime += offset_us_;
  const std::lock_guard<std::mutex> lock(mutex_);
  ++counters_.num_captured;
  waiting_.push_back(std::move(pair));
  while (waiting_.size() > static_cast<std::size_t>(std::max(1, options_.max_waiting))) {
    waiting_.pop_front();
    ++counters_.num_dropped;
  }
  has_news_.notify_all();
}

void CameraCapture::OnUnusable(const std::string& why) {
  bool is_first = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_first = counters_.num_unusable++ == 0;
    counters_.last_unusable = why;
  }
  if (is_first) Note("warning: " + why + ": left out, as are others like it (STATUS counts them)");
}

void CameraCapture::OnLost(const std::string& why) {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_lost_ = true;
    ++counters_.num_losses;
  }
  lost_utime_ = clock_();
  retry_utime_ = lost_utime_ + std::llround(1e6 * options_.retry_s);
  why_not_found_.clear();
  Note("warning: " + why + ": waiting for it");
}

void CameraCapture::LookForSource() {
  const std::int64_t now = clock_();
  if (now < retry_utime_) {
    return pause_(std::min<std::int64_t>(retry_utime_ - now, 1000 * FrameGrabber::kMaxWait_ms));
  }
  retry_utime_ = now + std::llround(1e6 * options_.retry_s);
  const std::string why = grabber_->Reopen();
  if (!why.empty()) {
    // Each reason once: it changes where another camera was plugged in.
    if (why != why_not_found_) Note("warning: " + why);
    why_not_found_ = why;
    return;
  }
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    is_lost_ = false;
  }
  Note(Format("warning: %s is back after %.1f s: going on in the same session",
              grabber_->name().c_str(), 1e-6 * static_cast<double>(now - lost_utime_)));
}

void CameraCapture::WatchSkew(std::int64_t skew_us) {
  constexpr int kMostInRow = 10;  // a single one may be a hiccup of the bus
  const double skew_ms = 1e-3 * static_cast<double>(skew_us);
  num_skewed_in_row_ = std::abs(skew_ms) > options_.max_skew_ms ? num_skewed_in_row_ + 1 : 0;
  if (num_skewed_in_row_ < kMostInRow || is_skew_said_) return;
  is_skew_said_ = true;
  Note(
      Format("warning: %s: right images are taken %.1f ms %s than left ones; what moves is "
             "mismeasured, cameras with a common trigger are needed",
             grabber_->name().c_str(), std::abs(skew_ms), skew_ms > 0 ? "later" : "earlier"));
}

void CameraCapture::SayDrops(std::int64_t now) {
  const CaptureCounters counters = this->counters();
  if (counters.num_dropped == num_drops_said_ || now < say_drops_utime_) return;
  say_drops_utime_ = now + std::llround(1e6 * options_.complain_s);
  Note("warning: " + std::to_string(counters.num_dropped - num_drops_said_) +
       " pairs dropped, of " + std::to_string(counters.num_captured) +
       " so far: rectifying and sending them takes longer than the camera's period");
  num_drops_said_ = counters.num_dropped;
}

void CameraCapture::Note(const std::string& line) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (notes_.size() < kMaxNotesWaiting) notes_.push_back(line);
}

std::optional<CapturedPair> CameraCapture::Take(double timeout_s) {
  std::unique_lock<std::mutex> lock(mutex_);
  has_news_.wait_for(lock, std::chrono::duration<double>(timeout_s),
                     [this] { return !waiting_.empty() || is_over_; });
  if (waiting_.empty()) return std::nullopt;
  CapturedPair pair = std::move(waiting_.front());
  waiting_.pop_front();
  return pair;
}

bool CameraCapture::has_ended() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return is_over_ && waiting_.empty();
}

bool CameraCapture::is_lost() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return is_lost_;
}

std::string CameraCapture::error() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return error_;
}

CaptureCounters CameraCapture::counters() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return counters_;
}

std::vector<std::string> CameraCapture::TakeNotes() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(notes_, {});
}

}  // namespace airdos
