#ifndef AIRDOS_PROCESSES_TOOLS_EVALUATE_KEYPOINT_LOG_H_
#define AIRDOS_PROCESSES_TOOLS_EVALUATE_KEYPOINT_LOG_H_

#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <utility>

#include "common/evaluation/detection_report.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// The people on PERSON_KEYPOINTS_LEFT and PERSON_KEYPOINTS_RIGHT of a log.
struct KeypointLog {
  /// A pair of images of which at least one has a message.
  struct Frame {
    std::int64_t utime = 0;
    PeopleOfPair people;
  };
  std::map<std::pair<std::int64_t, std::int64_t>, Frame> frames;  ///< by session and image number
  std::optional<StereoCamera> camera;                             ///< of the first CALIBRATION
  std::size_t num_invalid = 0;                                    ///< messages that cannot be used
  std::size_t num_again = 0;  ///< messages of an image that has one already; not used
  std::int64_t num_lost = 0;  ///< events of the file that are damaged
};

/// Keypoints of any layout, as the human tracker takes them. Throws InputError if the file is not a
/// log, or has no such message of the left images that can be used.
KeypointLog ReadKeypointLog(const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_EVALUATE_KEYPOINT_LOG_H_
