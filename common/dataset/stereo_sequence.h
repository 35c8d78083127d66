#ifndef AIRDOS_COMMON_DATASET_STEREO_SEQUENCE_H_
#define AIRDOS_COMMON_DATASET_STEREO_SEQUENCE_H_

#include <cstddef>
#include <cstdint>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se3.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/layouts.h"

namespace airdos {

/// One 2-D keypoint; confidence 0 means not seen.
struct Keypoint {
  float u_px = 0;
  float v_px = 0;
  float confidence = 0;
};
/// One detected person: the keypoints of the layout, in its order.
using PersonKeypoints = std::vector<Keypoint>;

/// Axes of a ground-truth trajectory, for body and world.
enum class TrajectoryAxes { kOptical, kNed, kUnknown };

/// Everything a data set contains for one frame. Files are passed on as bytes and decoded by
/// whoever needs the pixels; images that are made, by rectification, are passed on as pixels, and
/// their files are empty.
struct SequenceFrame {
  std::int64_t utime = 0;                     ///< us, capture time
  std::vector<std::uint8_t> left_image_file;  ///< a whole JPEG or PNG file
  std::vector<std::uint8_t> right_image_file;
  cv::Mat left_pixels;  ///< CV_8UC1 or CV_8UC3 (BGR) if there is no file
  cv::Mat right_pixels;
  /// An 8-bit PNG file for the left image, 0 = background; empty if there is none.
  std::vector<std::uint8_t> person_mask_file;
  KeypointLayout keypoint_layout = KeypointLayout::kCoco18;  ///< the same in every frame
  std::vector<PersonKeypoints> keypoints_left;  ///< in no particular order; empty if nobody is seen
  std::vector<PersonKeypoints> keypoints_right;
  std::optional<Se3> ground_truth;  ///< camera in its world, in ground_truth_axes()
};

/// The files of one frame, for findings that name them. Empty if unknown.
struct FrameFiles {
  std::string left_image;
  std::string right_image;
  std::string person_mask;  ///< this and the next two need not exist
  std::string keypoints_left;
  std::string keypoints_right;
};

/// A recorded stereo sequence on disk. Every function throws InputError naming the file (and line)
/// that cannot be used.
class StereoSequence {
 public:
  virtual ~StereoSequence() = default;
  virtual const StereoCamera& camera() const = 0;
  virtual std::size_t num_frames() const = 0;
  virtual TrajectoryAxes ground_truth_axes() const = 0;
  virtual bool has_people() const = 0;  ///< whether the layout includes keypoints at all
  virtual SequenceFrame Load(std::size_t index) const = 0;
  /// The same; nothing where a recording turns out to lack the frame (a damaged image, a video that
  /// ends early), which TakeLateNotes() tells.
  virtual std::optional<SequenceFrame> TryLoad(std::size_t index) const { return Load(index); }
  virtual std::int64_t utime(std::size_t index) const { return Load(index).utime; }  ///< us
  virtual std::optional<Se3> ground_truth(std::size_t index) const {
    return Load(index).ground_truth;
  }
  virtual FrameFiles files(std::size_t /*index*/) const { return {}; }
  /// Whether the images are files as they are; if not, they are made from those of files().
  virtual bool has_camera_files() const { return true; }
  /// What had to be assumed about the folder (calibration, frame rate, axes), one sentence each,
  /// for the user to read.
  virtual std::vector<std::string> notes() const { return {}; }
  /// What has turned out since, while frames were loaded; each line is returned once.
  virtual std::vector<std::string> TakeLateNotes() const { return {}; }
};

/// What the user states about a folder that is not recorded in it.
struct SequenceOptions {
  /// kPublicCalibration: the camera of the public TartanAir-Shibuya data set, whose folders have no
  /// calib.json. Empty: the folder's own.
  std::string calibration;
};
inline constexpr char kPublicCalibration[] = "tartanair-shibuya";

/// Opens a folder after determining its layout: KITTI tracking if the folder is image_02/NNNN
/// (kitti_tracking_sequence.h), KITTI odometry if there is a calib.txt (kitti_sequence.h),
/// TartanAir-Shibuya if there are image_0 and image_1 (shibuya_sequence.h), or EuRoC if there are
/// cam0/data and cam1/data, or mav0 with these (recording/euroc_sequence.h). Throws InputError if
/// it is none of these, naming nearby folders that are, or what else the folder looks like.
std::unique_ptr<StereoSequence> OpenStereoSequence(const std::string& folder,
                                                   const SequenceOptions& options = {});

/// Whether OpenStereoSequence() recognises the layout of a folder, even if its contents are faulty.
bool HasSequenceLayout(const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_COMMON_DATASET_STEREO_SEQUENCE_H_
