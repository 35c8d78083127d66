#include "common/dataset/recording/rectified_sequence.h"

#include "common/util/check.h"
#include "common/util/error.h"

namespace airdos {
RectifiedSequence::RectifiedSequence(std::unique_ptr<StereoRecording> recording,
                                     const StereoRig& rig, const RectifierOptions& options)
    : recording_(std::move(recording)),
      rig_(rig),
      rectifier_(rig, options),
      notes_(recording_->TakeNotes()) {
  const std::pair<int, int> calibrated = {camera().width, camera().height};
  if (recording_->image_size() != calibrated) {
    throw InputError(recording_->name() + ": has images of " + SizeText(recording_->image_size()) +
                     ", the calibration is for " + SizeText(calibrated));
  }
  const std::string file = rig.files.empty() ? "calibration" : rig.files[0];
  for (const auto* lines : {&rig.notes, &rectifier_.notes()}) {
    for (const std::string& line : *lines) notes_.push_back(file + ": " + line);
  }
}

void RectifiedSequence::SetGroundTruth(std::vector<std::optional<Se3>> T_W_C) {
  AIRDOS_CHECK(T_W_C.size() == num_frames());
  T_W_C_ = std::move(T_W_C);
}

TrajectoryAxes RectifiedSequence::ground_truth_axes() const {
  return T_W_C_.empty() ? TrajectoryAxes::kUnknown : TrajectoryAxes::kOptical;
}

std::optional<Se3> RectifiedSequence::ground_truth(std::size_t index) const {
  return T_W_C_.empty() ? std::nullopt : T_W_C_[index];
}

FrameFiles RectifiedSequence::files(std::size_t index) const {
  const PairNames names = recording_->names(index);
  return {names.left, names.right, "", "", ""};
}

std::optional<SequenceFrame> RectifiedSequence::TryLoad(std::size_t index) const {
  const std::optional<RecordedPair> pair = recording_->Load(index);
  if (!pair) return std::nullopt;
  SequenceFrame frame;
  frame.utime = pair->utime;
  frame.left_pixels = rectifier_.Left(pair->left);
  frame.right_pixels = rectifier_.Right(pair->right);
  frame.ground_truth = ground_truth(index);
  return frame;
}

SequenceFrame RectifiedSequence::Load(std::size_t index) const {
  std::optional<SequenceFrame> frame = TryLoad(index);
  if (!frame) throw InputError(recording_->names(index).left + ": this pair cannot be used");
  return std::move(*frame);
}

}  // namespace airdos
