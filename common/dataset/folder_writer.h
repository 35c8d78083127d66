#ifndef AIRDOS_COMMON_DATASET_FOLDER_WRITER_H_
#define AIRDOS_COMMON_DATASET_FOLDER_WRITER_H_

#include <cstddef>
#include <string>
#include <vector>

#include "common/dataset/stereo_sequence.h"
#include "common/util/output_files.h"
#include "common/util/output_folder.h"

namespace airdos {

/// Writes frames as a folder that OpenStereoSequence() reads: the layout of shibuya_sequence.h,
/// with images numbered from 000000. Images and masks are the same files (PNG where there is none,
/// but pixels), times exact to 1 us,
/// calibration, keypoints and poses have all digits. Poses become NED, as the layout wants it;
/// those of unknown axes are written as they are.
///
/// calib.json is written last, by Finish(): without it the folder cannot be opened, so that what is
/// left by a run that was interrupted is not taken for the whole.
class FolderWriter {
 public:
  /// Throws InputError if the folder is not empty, unless forced: then what an earlier run wrote
  /// there is removed. Refuses, even if forced, inputs and folders where images, people or a
  /// calibration are that airdos did not write.
  FolderWriter(const std::string& path, const OutputRules& rules);

  /// Throws InputError if a file cannot be written.
  void Add(const SequenceFrame& frame, TrajectoryAxes axes);
  void Finish(const StereoCamera& camera);

  std::size_t num_frames() const { return num_frames_; }

 private:
  void AddPeople(const std::string& folder, const std::string& number,
                 const std::vector<PersonKeypoints>& people);
  void Write(const std::string& name, const void* data, std::size_t size);
  void Write(const std::string& name, const std::string& text);

  OutputFolder folder_;
  std::size_t num_frames_ = 0;
  std::string times_;
  std::string poses_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FOLDER_WRITER_H_
