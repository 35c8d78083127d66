#ifndef AIRDOS_COMMON_DATASET_RECORDING_RECTIFIED_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_RECORDING_RECTIFIED_SEQUENCE_H_

#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/calibration/stereo_rectifier.h"
#include "common/dataset/recording/stereo_recording.h"
#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// A recording whose images are rectified as they are loaded. They are PNG files, which lose
/// nothing. There are no people.
class RectifiedSequence : public StereoSequence {
 public:
  /// Throws InputError if the rig is of images of another size, or leaves no image.
  RectifiedSequence(std::unique_ptr<StereoRecording> recording, const StereoRig& rig,
                    const RectifierOptions& options = {});

  /// Of the left camera in its world, optical axes, one element a pair.
  void SetGroundTruth(std::vector<std::optional<Se3>> T_W_C);
  void AddNote(const std::string& note) { notes_.push_back(note); }

  const StereoCamera& camera() const override { return rectifier_.camera(); }
  std::size_t num_frames() const override { return recording_->num_pairs(); }
  TrajectoryAxes ground_truth_axes() const override;
  bool has_people() const override { return false; }
  /// Throws InputError where TryLoad() returns nothing.
  SequenceFrame Load(std::size_t index) const override;
  std::optional<SequenceFrame> TryLoad(std::size_t index) const override;
  std::int64_t utime(std::size_t index) const override { return recording_->utime(index); }
  std::optional<Se3> ground_truth(std::size_t index) const override;
  FrameFiles files(std::size_t index) const override;
  bool has_camera_files() const override { return false; }
  std::vector<std::string> notes() const override { return notes_; }
  std::vector<std::string> TakeLateNotes() const override { return recording_->TakeNotes(); }

  const StereoRig& rig() const { return rig_; }
  StereoRecording* recording() const { return recording_.get(); }
  const StereoRectifier& rectifier() const { return rectifier_; }

 private:
  std::unique_ptr<StereoRecording> recording_;
  StereoRig rig_;
  StereoRectifier rectifier_;
  std::vector<std::string> notes_;
  std::vector<std::optional<Se3>> T_W_C_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_RECORDING_RECTIFIED_SEQUENCE_H_
