#ifndef AIRDOS_COMMON_DATASET_FOLDER_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_FOLDER_SEQUENCE_H_

#include <string>
#include <utility>
#include <vector>

#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// A sequence with one file an image, whatever its layout: a layout fills in the contents.
class FolderSequence : public StereoSequence {
 public:
  struct Contents {
    std::string folder;
    std::string left_folder;   ///< name inside `folder`
    std::string right_folder;  ///< name inside `folder`
    /// Of alphapose_0, alphapose_1 and rcnnseg_image_0 in `folder`, where the people of this
    /// sequence are; empty: directly there.
    std::string people_subfolder;
    StereoCamera camera;
    std::vector<std::string> left_names;
    std::vector<std::string> right_names;  ///< of the same images
    std::vector<std::int64_t> utimes;      ///< us, of the same images
    std::vector<std::optional<Se3>> ground_truth;
    TrajectoryAxes axes = TrajectoryAxes::kUnknown;
    std::vector<std::string> notes;
  };

  explicit FolderSequence(Contents contents);

  const StereoCamera& camera() const override { return contents_.camera; }
  std::size_t num_frames() const override { return contents_.left_names.size(); }
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
  std::string PeopleFolder(const std::string& name) const;

  Contents contents_;
  bool has_people_;
};

/// Fills in names and times: the images of both folders must have the same names but for the
/// ending. times.txt must have a time for each image; further ones are noted. Without it: 10 Hz.
void FillImagesAndTimes(FolderSequence::Contents* contents);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_FOLDER_SEQUENCE_H_
