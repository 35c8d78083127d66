#ifndef AIRDOS_PROCESSES_TOOLS_CALIBRATION_IMAGE_FOLDERS_H_
#define AIRDOS_PROCESSES_TOOLS_CALIBRATION_IMAGE_FOLDERS_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/calibration/stereo_rectifier.h"
#include "common/check/check_input.h"
#include "common/check/check_rig.h"
#include "common/dataset/recording/folder_recording.h"

namespace airdos {

/// The left and the right images of a user, a folder each, as they were recorded; grey.
class ImageFolders {
 public:
  /// Throws InputError as FolderRecording does.
  ImageFolders(const std::string& left, const std::string& right);

  std::size_t size() const { return recording_->num_pairs(); }
  std::string left_folder() const { return recording_->name(); }
  std::string LeftPath(std::size_t index) const { return recording_->names(index).left; }
  std::string RightPath(std::size_t index) const { return recording_->names(index).right; }
  /// Nothing where an image cannot be decoded; a note says so.
  std::optional<RawPair> Read(std::size_t index) const;
  /// Up to `count` pairs, evenly spread. Throws InputError where none can be used.
  std::vector<RawPair> Sample(std::size_t count) const;
  std::vector<std::string> TakeNotes() const { return recording_->TakeNotes(); }

 private:
  std::unique_ptr<FolderRecording> recording_;
};

/// The same images rectified, as the checks of data sets see them; they have neither times nor
/// people nor ground truth. Both references must outlive it.
class RectifiedFolders : public CheckedInput {
 public:
  RectifiedFolders(const ImageFolders& folders, const StereoRectifier& rectifier);

  std::string name() const override { return folders_.left_folder(); }
  const StereoCamera& camera() const override { return rectifier_.camera(); }
  std::string where_camera() const override { return ""; }
  /// Numbers instead of times.
  const std::vector<std::int64_t>& utimes() const override { return utimes_; }
  std::string where_times() const override { return ""; }
  const std::vector<std::optional<Se3>>& ground_truth() const override { return ground_truth_; }
  TrajectoryAxes ground_truth_axes() const override { return TrajectoryAxes::kOptical; }
  std::string where_ground_truth() const override { return ""; }
  std::vector<CheckedPictures> Load(const std::vector<std::size_t>& frames,
                                    FindingList* findings) const override;
  std::vector<StereoPeople> LoadPeople(const std::vector<std::size_t>& frames) const override;

 private:
  const ImageFolders& folders_;
  const StereoRectifier& rectifier_;
  std::vector<std::int64_t> utimes_;
  std::vector<std::optional<Se3>> ground_truth_;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_CALIBRATION_IMAGE_FOLDERS_H_
