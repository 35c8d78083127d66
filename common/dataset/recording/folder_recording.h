#ifndef AIRDOS_COMMON_DATASET_RECORDING_FOLDER_RECORDING_H_
#define AIRDOS_COMMON_DATASET_RECORDING_FOLDER_RECORDING_H_

#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/dataset/image_file.h"
#include "common/dataset/recording/stereo_recording.h"

namespace airdos {

struct FolderRecordingOptions {
  std::string left;               ///< folder of the left images, or of all
  std::string right;              ///< empty: the left folder holds both cameras' images
  std::string times;              ///< ReadRecordingTimes(); empty: see below
  std::optional<double> rate_hz;  ///< the images follow each other at that rate
};

/// Images in folders, paired by PairImages(). Their times are those of the options; without, those
/// in the names, in EuRoC's data.csv, or in KITTI raw's timestamps.txt. PNG or JPEG as in data sets
/// (image_file.h). Files that are cut short or no images, and those of another size than most, are
/// left out with their partners; 16-bit images are scaled by one range.
class FolderRecording : public StereoRecording {
 public:
  /// Reads names and headers. Throws InputError where no pair is left, the two cameras' images have
  /// different sizes, or no times are known.
  explicit FolderRecording(const FolderRecordingOptions& options);

  std::string name() const override { return name_; }
  std::size_t num_pairs() const override { return pairs_.size(); }
  std::pair<int, int> image_size() const override { return size_; }
  std::optional<RecordedPair> Load(std::size_t index) override;
  std::int64_t utime(std::size_t index) override { return pairs_[index].utime; }
  PairNames names(std::size_t index) const override { return pairs_[index].paths; }
  std::vector<std::string> TakeNotes() override { return std::exchange(notes_, {}); }

 private:
  struct Pair {
    PairNames paths;
    std::int64_t utime = 0;
  };
  struct Surveyed;
  void Survey();
  void NoteFormats(const std::vector<Surveyed>& surveyed);
  cv::Mat Read(const std::string& path) const;

  std::string name_;
  std::vector<Pair> pairs_;
  std::pair<int, int> size_;
  SixteenBitRange range_;
  std::vector<std::string> notes_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_FOLDER_RECORDING_H_
