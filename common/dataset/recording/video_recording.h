#ifndef AIRDOS_COMMON_DATASET_RECORDING_VIDEO_RECORDING_H_
#define AIRDOS_COMMON_DATASET_RECORDING_VIDEO_RECORDING_H_

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/recording/stereo_recording.h"

namespace airdos {

/// How the two images of a pair lie in videos.
enum class VideoLayout {
  kTwoVideos,
  kSideBySide,  ///< one video, left image on the left
  kOverUnder,   ///< one video, left image on top
};

struct VideoRecordingOptions {
  std::string left;   ///< or the only one
  std::string right;  ///< of kTwoVideos
  VideoLayout layout = VideoLayout::kTwoVideos;
  /// The images follow each other at that rate, whatever times the container has.
  std::optional<double> rate_hz = std::nullopt;
};

/// One or two videos, read by FFmpeg. Pixels are as stored: a phone's rotation is not applied. Two
/// videos are taken as started together; each left image is paired with the right one of its time
/// (with `rate_hz`, of its number). What one video has more is left out.
class VideoRecording : public StereoRecording {
 public:
  /// Throws InputError where a video cannot be read, their images have different sizes, or there
  /// are neither times nor a rate.
  explicit VideoRecording(const VideoRecordingOptions& options);
  ~VideoRecording() override;

  std::string name() const override { return options_.left; }
  /// By the videos' headers; counted where these do not say.
  std::size_t num_pairs() const override { return num_pairs_; }
  std::pair<int, int> image_size() const override { return size_; }
  /// Going back reads the video from its beginning.
  std::optional<RecordedPair> Load(std::size_t index) override;
  /// Decodes up to there. Throws InputError where the video ends before.
  std::int64_t utime(std::size_t index) override;
  PairNames names(std::size_t index) const override;
  std::vector<std::string> TakeNotes() override { return std::exchange(notes_, {}); }

 private:
  class Reader;
  void FindLength();
  void RequireTimes();
  bool IsTwo() const { return options_.layout == VideoLayout::kTwoVideos; }
  RecordedPair Halves(const cv::Mat& image) const;
  bool FindRight(std::int64_t utime);
  void NoteEnd(const Reader& reader, std::size_t index);

  VideoRecordingOptions options_;
  std::unique_ptr<Reader> left_;
  std::unique_ptr<Reader> right_;  // of kTwoVideos
  std::size_t num_pairs_ = 0;
  std::pair<int, int> size_;
  double tolerance_us_ = 0;  // between the times of a pair
  std::vector<std::string> notes_;
  bool is_end_said_ = false;
  bool is_gap_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_VIDEO_RECORDING_H_
