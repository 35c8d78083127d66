#ifndef AIRDOS_COMMON_DATASET_FOLDER_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_FOLDER_SEQUENCE_H_

#include <string>
#include <utility>
#include <vector>

#include "common/dataset/image_names.h"
#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// A sequence with one file per image, in any layout: each layout fills in the contents.
class FolderSequence : public StereoSequence {
 public:
  /// Everything that depends on the layout.
  struct Contents {
    std::string folder;
    std::string left_folder;   ///< name inside `folder`
    std::string right_folder;  ///< name inside `folder`
    /// Subfolder of alphapose_0, alphapose_1 and rcnnseg_image_0 in `folder` that holds the people
    /// of this sequence; empty if they are not in a subfolder.
    std::string people_subfolder;
    StereoCamera camera;
    ImageNames left;
    ImageNames right;                  ///< with the same keys
    std::vector<std::int64_t> utimes;  ///< us, one per image
    std::vector<std::optional<Se3>> ground_truth;
    TrajectoryAxes axes = TrajectoryAxes::kUnknown;
    std::vector<std::string> notes;
  };

  /// Looks up the people's files. Throws InputError if their keypoints have different layouts.
  explicit FolderSequence(Contents contents);

  const StereoCamera& camera() const override { return contents_.camera; }
  std::size_t num_frames() const override { return contents_.left.files.size(); }
  TrajectoryAxes ground_truth_axes() const override { return contents_.axes; }
  bool has_people() const override { return has_people_; }
  SequenceFrame Load(std::size_t index) const override;
  std::int64_t utime(std::size_t index) const override { return contents_.utimes[index]; }
  std::optional<Se3> ground_truth(std::size_t index) const override {
    return contents_.ground_truth[index];
  }
  FrameFiles files(std::size_t index) const override;
  std::vector<std::string> notes() const override { return contents_.notes; }

 private:
  std::vector<std::string> PeopleFiles(const std::string& name, const std::string& ending) const;

  Contents contents_;
  std::vector<FrameFiles> files_;
  bool has_people_ = false;
  KeypointLayout keypoint_layout_ = KeypointLayout::kCoco18;
};

/// Fills in names and times. The images of both folders must have the same numbers. times.txt has
/// one time per image or per number (RowsOfImages()). Without it, times are taken from the names,
/// or else assumed to be 0.1 s per number, with a note.
void FillImagesAndTimes(FolderSequence::Contents* contents);

/// Fills in the ground truth from a file with one pose per image (or number).
void FillPosesByRow(const std::string& path, const std::string& what, const std::vector<Se3>& poses,
                    FolderSequence::Contents* contents);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FOLDER_SEQUENCE_H_
