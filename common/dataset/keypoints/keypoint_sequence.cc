#include "common/dataset/keypoints/keypoint_sequence.h"

#include <cmath>
#include <filesystem>

#include "common/dataset/keypoints/keypoint_matching.h"
#include "common/dataset/recording/rectified_sequence.h"
#include "common/util/error.h"

namespace airdos {
namespace {

/// Names of the images of one camera; their numbers where they are not files (videos).
std::vector<std::string> ImageNamesOf(const StereoSequence& sequence, bool is_left) {
  std::vector<std::string> names;
  for (std::size_t i = 0; i < sequence.num_frames(); ++i) {
    const FrameFiles files = sequence.files(i);
    const std::string& path = is_left ? files.left_image : files.right_image;
    const bool is_file = std::filesystem::is_regular_file(path);
    names.push_back(is_file ? std::filesystem::path(path).filename().string() : std::to_string(i));
  }
  return names;
}

std::size_t CountWithPeople(const std::vector<std::vector<PersonKeypoints>>& people) {
  std::size_t count = 0;
  for (const auto& of_frame : people) count += of_frame.empty() ? 0 : 1;
  return count;
}

}  // namespace

KeypointSequence::KeypointSequence(std::unique_ptr<StereoSequence> sequence,
                                   const ForeignKeypoints& left, const ForeignKeypoints& right)
    : sequence_(std::move(sequence)), notes_(sequence_->notes()) {
  if (sequence_->has_people()) {
    notes_.push_back(left.path + ": takes the place of the keypoints that the data set has");
  }
  if (dynamic_cast<const RectifiedSequence*>(sequence_.get()) != nullptr) {
    notes_.push_back(left.path + ": taken as found in the images as recorded: rectified with them");
  }
  if (num_frames() > 0 && !std::filesystem::is_regular_file(sequence_->files(0).left_image)) {
    notes_.push_back(left.path + ": its images belong to those of the video by number, from 0");
  }
  left_ = MakeSide(left, true);
  right_ = MakeSide(right, false);
}

KeypointSequence::Side KeypointSequence::MakeSide(const ForeignKeypoints& keypoints, bool is_left) {
  Side side;
  side.path = keypoints.path;
  const KeypointMatching matching =
      MatchKeypoints(keypoints.path, keypoints.images, ImageNamesOf(*sequence_, is_left));
  for (const auto* lines : {&keypoints.notes, &matching.notes}) {
    notes_.insert(notes_.end(), lines->begin(), lines->end());
  }
  for (const std::optional<std::size_t>& image : matching.image_of) {
    side.people.push_back(image ? keypoints.images[*image].people : std::vector<PersonKeypoints>());
  }
  MoveJoints(is_left, &side);
  summaries_[is_left ? 0 : 1] = keypoints.program +
                                (keypoints.layout ? ", " + NameOf(*keypoints.layout) : "") + ", " +
                                std::to_string(CountWithPeople(side.people)) + " of " +
                                std::to_string(num_frames()) + " images have people";
  return side;
}

/// From where they were found to the sequence's images.
void KeypointSequence::MoveJoints(bool is_left, Side* side) {
  const auto* const rectified = dynamic_cast<const RectifiedSequence*>(sequence_.get());
  const auto [width, height] = rectified != nullptr
                                   ? rectified->recording()->image_size()
                                   : std::make_pair(camera().width, camera().height);
  std::size_t num_seen = 0;
  std::size_t num_outside = 0;
  const auto move = [&, w = width, h = height](Keypoint* joint) {
    if (!(joint->confidence > 0)) return;
    ++num_seen;
    const bool is_inside = joint->u_px >= -0.5F && joint->v_px >= -0.5F &&
                           joint->u_px <= static_cast<float>(w) - 0.5F &&
                           joint->v_px <= static_cast<float>(h) - 0.5F;
    num_outside += is_inside ? 0 : 1;
    if (!is_inside || rectified == nullptr) {
      if (!is_inside) *joint = {};
      return;
    }
    const Eigen::Vector2d from(joint->u_px, joint->v_px);
    const Eigen::Vector2d to = is_left ? rectified->rectifier().RectifyLeft(from)
                                       : rectified->rectifier().RectifyRight(from);
    // Beyond what a rectified image can hold, and what messages carry.
    constexpr double kFar_px = 1e5;
    const bool is_near = std::abs(to.x()) < kFar_px && std::abs(to.y()) < kFar_px;
    *joint = is_near ? Keypoint{static_cast<float>(to.x()), static_cast<float>(to.y()),
                                joint->confidence}
                     : Keypoint{};
  };
  for (std::vector<PersonKeypoints>& people : side->people) {
    for (PersonKeypoints& person : people) {
      for (Keypoint& joint : person) move(&joint);
    }
  }
  if (num_outside == 0) return;
  const std::string text = side->path + ": " + std::to_string(num_outside) + " of " +
                           std::to_string(num_seen) + " joints lie outside the images of " +
                           std::to_string(width) + " x " + std::to_string(height) + " px";
  if (2 * num_outside > num_seen) throw InputError(text + ": found in images of another size?");
  notes_.push_back(text + ": taken as not seen");
}

SequenceFrame KeypointSequence::WithPeople(SequenceFrame frame, std::size_t index) const {
  frame.keypoint_layout = KeypointLayout::kCoco18;
  frame.keypoints_left = left_.people[index];
  frame.keypoints_right = right_.people[index];
  return frame;
}

SequenceFrame KeypointSequence::Load(std::size_t index) const {
  return WithPeople(sequence_->Load(index), index);
}

std::optional<SequenceFrame> KeypointSequence::TryLoad(std::size_t index) const {
  std::optional<SequenceFrame> frame = sequence_->TryLoad(index);
  if (!frame) return std::nullopt;
  return WithPeople(std::move(*frame), index);
}

FrameFiles KeypointSequence::files(std::size_t index) const {
  FrameFiles files = sequence_->files(index);
  files.keypoints_left = left_.path;
  files.keypoints_right = right_.path;
  return files;
}

}  // namespace airdos
