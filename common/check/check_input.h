#ifndef AIRDOS_COMMON_CHECK_INPUT_H_
#define AIRDOS_COMMON_CHECK_INPUT_H_

#include <cstddef>
#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/check/check_findings.h"
#include "common/dataset/mask_file.h"
#include "common/dataset/stereo_sequence.h"
#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/layouts.h"

namespace airdos {

/// The people of one image as they were given: as many keypoints a person as the layout says, the
/// confidences as they stand there.
struct CheckedPeople {
  std::string where;  ///< file, or log and image number
  KeypointLayout layout = KeypointLayout::kCoco18;
  std::vector<std::vector<BodyKeypoint>> people;
};

/// The decoded pictures of one frame. Empty where there is none or it does not decode (which is
/// then a finding already).
struct CheckedPictures {
  std::string where_left;  ///< file, or log and image number; likewise the next
  std::string where_right;
  std::string where_mask;
  cv::Mat left;   ///< CV_8UC1
  cv::Mat right;  ///< CV_8UC1
  PersonMask mask;
  CheckedPeople people_left;
};

/// The people of one frame.
struct StereoPeople {
  CheckedPeople left;
  CheckedPeople right;
};

/// What a folder and a log have in common for the checks.
class CheckedInput {
 public:
  virtual ~CheckedInput() = default;
  virtual std::string name() const = 0;
  virtual const StereoCamera& camera() const = 0;
  virtual std::string where_camera() const = 0;
  virtual const std::vector<std::int64_t>& utimes() const = 0;  ///< us, of each frame in order
  virtual std::string where_times() const = 0;
  /// Checks the times: those of a folder, in s.
  virtual void ReportTimes(FindingList* findings) const;
  virtual const std::vector<std::optional<Se3>>& ground_truth() const = 0;  ///< of each frame
  virtual TrajectoryAxes ground_truth_axes() const = 0;
  virtual std::string where_ground_truth() const = 0;
  /// Of the frames with these numbers (0 .. utimes().size() - 1, increasing). What cannot be read
  /// or decoded goes to `findings`.
  virtual std::vector<CheckedPictures> Load(const std::vector<std::size_t>& frames,
                                            FindingList* findings) const = 0;
  /// The people alone of such frames. What cannot be read counts as nobody.
  virtual std::vector<StereoPeople> LoadPeople(const std::vector<std::size_t>& frames) const = 0;
};

struct CheckOptions {
  enum class Depth { kQuick, kFull };
  Depth depth = Depth::kFull;
  std::size_t max_frames = 20;       ///< whose pictures are looked at, evenly spread
  std::size_t odometry_frames = 30;  ///< to compare with the ground truth; 0: none
  std::string calibration = {};      ///< of a folder: SequenceOptions::calibration
  bool all = false;                  ///< look at the pictures of all frames

  bool is_quick() const { return depth == Depth::kQuick; }
};

/// Numbers of the frames, of so many, whose pictures, or people, are looked at.
std::vector<std::size_t> SampleOfPictures(std::size_t num_frames, const CheckOptions& options);
std::vector<std::size_t> SampleOfPeople(std::size_t num_frames, const CheckOptions& options);

/// `count` numbers evenly spread over 0 .. size - 1, first and last included; all if they are
/// fewer.
std::vector<std::size_t> SampleEvenly(std::size_t size, std::size_t count);

/// Everything that can be asked of frames alike from a folder and from a log.
void CheckFrames(const CheckedInput& input, const CheckOptions& options, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_INPUT_H_
