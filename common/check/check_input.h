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

/// The people in one image as given: the layout's number of keypoints per person, with the
/// confidences as they are in the file.
struct CheckedPeople {
  std::string where;  ///< file, or log and image number
  KeypointLayout layout = KeypointLayout::kCoco18;
  std::vector<std::vector<BodyKeypoint>> people;
};

/// The decoded pictures of one frame. Empty if there is none or it cannot be decoded (which has
/// then been reported as a finding).
struct CheckedPictures {
  std::string where_left;  ///< file, or log and image number; the same for the next
  std::string where_right;
  std::string where_mask;
  cv::Mat left;   ///< CV_8UC1
  cv::Mat right;  ///< CV_8UC1
  PersonMask mask;
  CheckedPeople people_left;
};

/// The people in both images of one frame.
struct StereoPeople {
  CheckedPeople left;
  CheckedPeople right;
};

/// The interface through which the checks see both folders and logs.
class CheckedInput {
 public:
  virtual ~CheckedInput() = default;
  virtual std::string name() const = 0;
  virtual const StereoCamera& camera() const = 0;
  virtual std::string where_camera() const = 0;
  virtual const std::vector<std::int64_t>& utimes() const = 0;  ///< us, one per frame, in order
  virtual std::string where_times() const = 0;
  /// Checks the times; this default is for those of a folder, in s.
  virtual void ReportTimes(FindingList* findings) const;
  virtual const std::vector<std::optional<Se3>>& ground_truth() const = 0;  ///< one per frame
  virtual TrajectoryAxes ground_truth_axes() const = 0;
  virtual std::string where_ground_truth() const = 0;
  /// Loads the frames with these indices (0 .. utimes().size() - 1, increasing). What cannot be
  /// read or decoded goes to `findings`.
  virtual std::vector<CheckedPictures> Load(const std::vector<std::size_t>& frames,
                                            FindingList* findings) const = 0;
  /// Loads only the people of these frames. What cannot be read counts as nobody.
  virtual std::vector<StereoPeople> LoadPeople(const std::vector<std::size_t>& frames) const = 0;
};

/// What a check examines, and how thoroughly.
struct CheckOptions {
  /// kQuick: only what is checked before a run.
  enum class Depth { kQuick, kFull };
  Depth depth = Depth::kFull;
  std::size_t max_frames = 20;       ///< whose pictures are examined, evenly spread
  std::size_t odometry_frames = 30;  ///< to compare with the ground truth; 0 for none
  std::string calibration = {};      ///< of a folder: SequenceOptions::calibration
  bool all = false;                  ///< examine the pictures of all frames

  bool is_quick() const { return depth == Depth::kQuick; }
};

/// Indices of the frames, out of `num_frames`, whose pictures or people are examined.
std::vector<std::size_t> SampleOfPictures(std::size_t num_frames, const CheckOptions& options);
std::vector<std::size_t> SampleOfPeople(std::size_t num_frames, const CheckOptions& options);

/// `count` indices evenly spread over 0 .. size - 1, including the first and the last; all if there
/// are not more.
std::vector<std::size_t> SampleEvenly(std::size_t size, std::size_t count);

/// Runs every check that works in the same way on the frames of a folder and of a log.
void CheckFrames(const CheckedInput& input, const CheckOptions& options, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_INPUT_H_
