#ifndef AIRDOS_COMMON_DATASET_RECORDING_STEREO_RECORDING_H_
#define AIRDOS_COMMON_DATASET_RECORDING_STEREO_RECORDING_H_

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace airdos {

/// Two images that were taken together, before rectification: CV_8UC1, or CV_8UC3 (BGR), both
/// alike.
struct RecordedPair {
  std::int64_t utime = 0;  ///< us
  cv::Mat left;
  cv::Mat right;
};

/// Where the images of a pair come from, for messages.
struct PairNames {
  std::string left;
  std::string right;
};

/// "640x360 px", for messages.
inline std::string SizeText(const std::pair<int, int>& size) {
  return std::to_string(size.first) + "x" + std::to_string(size.second) + " px";
}

/// The images of a stereo camera as people have them: in folders, in videos. What is known of them
/// to be useless when the recording is opened is left out of it; what turns out to be when an image
/// is decoded is skipped. Both are said in notes.
class StereoRecording {
 public:
  virtual ~StereoRecording() = default;
  virtual std::string name() const = 0;  ///< for messages
  /// As far as is known without decoding: a video may end earlier than its header says.
  virtual std::size_t num_pairs() const = 0;
  virtual std::pair<int, int> image_size() const = 0;  ///< width and height, px
  /// Nothing where one of the images cannot be used; a note says so. Consecutive indices are cheap.
  virtual std::optional<RecordedPair> Load(std::size_t index) = 0;
  virtual std::int64_t utime(std::size_t index) = 0;  ///< us
  virtual PairNames names(std::size_t index) const = 0;
  /// What was assumed and left out, one line each; each returned once.
  virtual std::vector<std::string> TakeNotes() = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_STEREO_RECORDING_H_
