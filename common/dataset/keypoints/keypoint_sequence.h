#ifndef AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_SEQUENCE_H_

#include <array>
#include <memory>
#include <string>
#include <vector>

#include "common/dataset/keypoints/foreign_keypoints.h"
#include "common/dataset/stereo_sequence.h"

namespace airdos {

/// A sequence whose people are those that another program found; its own, if it has some, are not
/// used. They are COCO-18, in px of the sequence's images.
class KeypointSequence : public StereoSequence {
 public:
  /// Of a sequence that rectifies its images (RectifiedSequence), the people are those of the
  /// images as recorded, and are rectified with them. Joints outside the images that were searched
  /// are not seen. Throws InputError where images do not match (MatchKeypoints()), or where more
  /// than half of the joints lie outside, as those of larger images do.
  KeypointSequence(std::unique_ptr<StereoSequence> sequence, const ForeignKeypoints& left,
                   const ForeignKeypoints& right);

  const StereoCamera& camera() const override { return sequence_->camera(); }
  std::size_t num_frames() const override { return sequence_->num_frames(); }
  TrajectoryAxes ground_truth_axes() const override { return sequence_->ground_truth_axes(); }
  bool has_people() const override { return true; }
  SequenceFrame Load(std::size_t index) const override;
  std::optional<SequenceFrame> TryLoad(std::size_t index) const override;
  std::int64_t utime(std::size_t index) const override { return sequence_->utime(index); }
  std::optional<Se3> ground_truth(std::size_t index) const override {
    return sequence_->ground_truth(index);
  }
  FrameFiles files(std::size_t index) const override;
  bool has_camera_files() const override { return sequence_->has_camera_files(); }
  std::vector<std::string> notes() const override { return notes_; }
  std::vector<std::string> TakeLateNotes() const override { return sequence_->TakeLateNotes(); }

  /// "AlphaPose, COCO-17, 100 of 100 images have people", left and right.
  const std::array<std::string, 2>& summaries() const { return summaries_; }

 private:
  using People = std::vector<std::vector<PersonKeypoints>>;  // of each frame
  struct Side {
    People people;
    std::string path;
  };
  Side MakeSide(const ForeignKeypoints& keypoints, bool is_left);
  void MoveJoints(bool is_left, Side* side);
  SequenceFrame WithPeople(SequenceFrame frame, std::size_t index) const;

  std::unique_ptr<StereoSequence> sequence_;
  std::vector<std::string> notes_;
  std::array<std::string, 2> summaries_;
  Side left_;
  Side right_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_KEYPOINTS_KEYPOINT_SEQUENCE_H_
