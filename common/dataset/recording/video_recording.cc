#include "common/dataset/recording/video_recording.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <opencv2/videoio.hpp>

#include "common/dataset/recording/recording_times.h"
#include "common/util/check.h"
#include "common/util/error.h"
#include "common/util/format.h"
#include "common/util/image_header.h"
#include "common/util/input_file.h"

namespace airdos {
namespace {

/// What FFmpeg would print of a damaged video, our notes say in a line. OpenCV asks the environment
/// when it opens the first one; whoever has set the variable sees all.
void SilenceFfmpeg() {
  constexpr char kQuiet[] = "-8";  // AV_LOG_QUIET
  constexpr int kKeepsOther = 0;
  static const int result = setenv("OPENCV_FFMPEG_LOGLEVEL", kQuiet, kKeepsOther);
  (void)result;
}

}  // namespace

/// One video, read from its beginning on.
class VideoRecording::Reader {
 public:
  Reader(const std::string& path, std::optional<double> rate_hz) : path_(path), rate_hz_(rate_hz) {
    RequireRegularFile(path);
    SilenceFfmpeg();
    Rewind();
    size_ = {static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_WIDTH)),
             static_cast<int>(capture_.get(cv::CAP_PROP_FRAME_HEIGHT))};
    const auto num_pixels = static_cast<std::int64_t>(size_.first) * size_.second;
    if (size_.first <= 0 || size_.second <= 0 || num_pixels > kMaxImagePixels) {
      throw InputError(path + ": has images of " + SizeText(size_) + ", which cannot be used");
    }
    count_ = CountOfHeader();
    if (count_ > 0) return;
    std::size_t num_images = 0;
    while (Advance()) ++num_images;
    count_ = num_images;
    Rewind();
    if (count_ == 0) throw InputError(path + ": holds no image that can be decoded");
  }

  const std::string& path() const { return path_; }
  std::size_t count() const { return count_; }
  std::pair<int, int> size() const { return size_; }
  /// As the header says; 0 = it does not.
  double header_rate_hz() const {
    const double rate_hz = capture_.get(cv::CAP_PROP_FPS);
    return std::isfinite(rate_hz) && rate_hz > 0.01 && rate_hz < 10000 ? rate_hz : 0;
  }
  bool is_turned() const { return std::lround(capture_.get(cv::CAP_PROP_ORIENTATION_META)) != 0; }

  void Rewind() {
    try {
      capture_.open(path_, cv::CAP_FFMPEG);
      capture_.set(cv::CAP_PROP_ORIENTATION_AUTO, 0);
    } catch (const cv::Exception&) {
      capture_.release();
    }
    if (!capture_.isOpened()) {
      throw InputError(path_ + ": cannot be read as a video (cut short, damaged, or no video?)");
    }
    num_read_ = num_grabbed_ = 0;
    next_ = {};
    first_ms_.reset();
  }

  /// Goes on to the next image; false at the end. What cannot be decoded is passed over by FFmpeg.
  /// The last image of a video that is cut short is not handed out: its missing part would be grey.
  bool Advance() {
    if (num_read_ == 0) next_ = Grab();
    if (next_.pixels.empty()) return false;
    current_ = next_;
    next_ = Grab();
    constexpr std::size_t kRoundingOfCounts = 1;  // of those made from duration and rate
    if (next_.pixels.empty() && num_read_ + 1 + kRoundingOfCounts < count_) return false;
    ++num_read_;
    return true;
  }
  std::size_t num_read() const { return num_read_; }
  /// Of the newest image, us since the first one.
  std::int64_t utime() const { return current_.utime; }
  const cv::Mat& image() const { return current_.pixels; }

 private:
  struct Image {
    cv::Mat pixels;  // empty: the video has ended
    std::int64_t utime = 0;
  };

  Image Grab() {
    Image image;
    cv::Mat pixels;
    if (!capture_.grab() || !capture_.retrieve(pixels)) return image;
    image.pixels = pixels.clone();  // the capture's own memory is used again
    const double time_ms = capture_.get(cv::CAP_PROP_POS_MSEC);
    if (!first_ms_) first_ms_ = time_ms;
    image.utime = rate_hz_ ? TimeAtRate(num_grabbed_, *rate_hz_)
                           : static_cast<std::int64_t>(std::llround(1e3 * (time_ms - *first_ms_)));
    ++num_grabbed_;
    return image;
  }

  std::size_t CountOfHeader() const {
    const double count = capture_.get(cv::CAP_PROP_FRAME_COUNT);
    constexpr double kMaxCount = 1e9;
    return count >= 1 && count < kMaxCount ? static_cast<std::size_t>(count) : 0;
  }

  std::string path_;
  std::optional<double> rate_hz_;
  cv::VideoCapture capture_;
  std::size_t count_ = 0;
  std::pair<int, int> size_;
  std::size_t num_read_ = 0;
  std::optional<double> first_ms_;
  std::size_t num_grabbed_ = 0;
  Image current_;
  Image next_;
};

VideoRecording::VideoRecording(const VideoRecordingOptions& options) : options_(options) {
  if (options.rate_hz) TimesAtRate(0, *options.rate_hz);  // refuses what is no rate
  left_ = std::make_unique<Reader>(options.left, options.rate_hz);
  if (IsTwo()) right_ = std::make_unique<Reader>(options.right, options.rate_hz);
  size_ = left_->size();
  if (IsTwo() && right_->size() != size_) {
    throw InputError(options.right + ": has images of " + SizeText(right_->size()) + ", " +
                     options.left + " of " + SizeText(size_));
  }
  int& divided = options.layout == VideoLayout::kSideBySide ? size_.first : size_.second;
  if (!IsTwo() && divided % 2 != 0) {
    throw InputError(options.left + ": has images of " + SizeText(size_) +
                     ", which cannot be divided into two of one size");
  }
  if (!IsTwo()) divided /= 2;
  for (const Reader* reader : {left_.get(), right_.get()}) {
    if (reader != nullptr && reader->is_turned()) {
      notes_.push_back(reader->path() +
                       ": asks to be shown turned, which is not done: pixels are as stored");
    }
  }
  RequireTimes();
  FindLength();
}

VideoRecording::~VideoRecording() = default;

/// Looks at the first two times.
void VideoRecording::RequireTimes() {
  for (Reader* reader : {left_.get(), right_.get()}) {
    if (reader == nullptr || options_.rate_hz) continue;
    const bool has_two = reader->Advance() && reader->Advance();
    if (has_two && reader->utime() <= 0) {
      throw InputError(reader->path() +
                       ": the video has no times: say how many images there are in a second with "
                       "--rate HZ");
    }
    reader->Rewind();
  }
}

void VideoRecording::FindLength() {
  num_pairs_ = left_->count();
  if (!IsTwo()) return;
  const double left_hz = options_.rate_hz.value_or(left_->header_rate_hz());
  const double right_hz = options_.rate_hz.value_or(right_->header_rate_hz());
  const double faster_hz = std::max(left_hz, right_hz);
  constexpr double kUsual_hz = 30;
  tolerance_us_ = 0.25e6 / (faster_hz > 0 ? faster_hz : kUsual_hz);
  const double right_per_left = left_hz > 0 && right_hz > 0 ? right_hz / left_hz : 1;
  const auto in_right = static_cast<std::size_t>(
      std::ceil(static_cast<double>(right_->count()) / right_per_left - 1e-3));
  num_pairs_ = std::min(num_pairs_, in_right);
  notes_.push_back(options_.left + ", " + options_.right +
                   ": taken as started together, their first images are a pair");
  if (std::abs(right_per_left - 1) > 0.01) {
    notes_.push_back(Format("%s: has %.4g images a second, %s %.4g: paired by time",
                            options_.left.c_str(), left_hz, options_.right.c_str(), right_hz));
  }
  if (left_->count() != in_right) {
    notes_.push_back(options_.left + ": has " + std::to_string(left_->count()) + " images, " +
                     options_.right + " " + std::to_string(right_->count()) + ": the first " +
                     std::to_string(num_pairs_) + " pairs are used");
  }
}

PairNames VideoRecording::names(std::size_t index) const {
  const std::string image = ", image " + std::to_string(index);
  return {options_.left + image, (IsTwo() ? options_.right : options_.left) + image};
}

void VideoRecording::NoteEnd(const Reader& reader, std::size_t index) {
  if (is_end_said_) return;
  is_end_said_ = true;
  notes_.push_back(reader.path() + ": ends after " + std::to_string(reader.num_read()) + " of " +
                   std::to_string(reader.count()) + " images (cut short or damaged?): pairs from " +
                   std::to_string(index) + " on are missing");
}

/// Advances the right video to the image of that time; false if there is none.
bool VideoRecording::FindRight(std::int64_t utime) {
  const auto difference_us = [&] { return static_cast<double>(right_->utime() - utime); };
  while (right_->num_read() == 0 || difference_us() < -tolerance_us_) {
    if (!right_->Advance()) return false;
  }
  return true;
}

RecordedPair VideoRecording::Halves(const cv::Mat& image) const {
  const cv::Size size(size_.first, size_.second);
  const bool is_beside = options_.layout == VideoLayout::kSideBySide;
  const cv::Point second(is_beside ? size.width : 0, is_beside ? 0 : size.height);
  RecordedPair pair;
  pair.left = image(cv::Rect({0, 0}, size)).clone();
  pair.right = image(cv::Rect(second, size)).clone();
  return pair;
}

std::optional<RecordedPair> VideoRecording::Load(std::size_t index) {
  AIRDOS_CHECK(index < num_pairs_);
  if (left_->num_read() > index) {
    left_->Rewind();
    if (IsTwo()) right_->Rewind();
  }
  while (left_->num_read() <= index) {
    if (left_->Advance()) continue;
    NoteEnd(*left_, left_->num_read());
    return std::nullopt;
  }
  const std::int64_t utime = left_->utime();
  if (IsTwo() && !FindRight(utime)) {
    NoteEnd(*right_, index);
    return std::nullopt;
  }
  if (IsTwo() && static_cast<double>(right_->utime() - utime) > tolerance_us_) {
    if (!is_gap_said_) {
      notes_.push_back(
          Format("%s: has no image at %.3f s, as %s has: skipped, as are others like it",
                 options_.right.c_str(), 1e-6 * static_cast<double>(utime), options_.left.c_str()));
    }
    is_gap_said_ = true;
    return std::nullopt;
  }
  RecordedPair pair =
      IsTwo() ? RecordedPair{0, left_->image(), right_->image()} : Halves(left_->image());
  pair.utime = utime;
  return pair;
}

std::int64_t VideoRecording::utime(std::size_t index) {
  const std::optional<RecordedPair> pair = Load(index);
  if (!pair) throw InputError(names(index).left + ": is not there");
  return pair->utime;
}

}  // namespace airdos
