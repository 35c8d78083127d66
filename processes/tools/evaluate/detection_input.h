#ifndef AIRDOS_PROCESSES_TOOLS_EVALUATE_DETECTION_INPUT_H_
#define AIRDOS_PROCESSES_TOOLS_EVALUATE_DETECTION_INPUT_H_

#include <string>
#include <vector>

#include "common/evaluation/detection_report.h"
#include "common/evaluation/trajectory.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// The people that a log has on PERSON_KEYPOINTS_LEFT and PERSON_KEYPOINTS_RIGHT, and what a data
/// set knows of the same frames.
struct DetectionInput {
  StereoCamera camera;
  std::vector<DetectionFrame> frames;  ///< those of the log that the data set has, too
  Remarks remarks;                     ///< what does not fit together, or is missing
};

/// Reads a log, and of the folder of a data set: its calibration and times; its keypoints, if it
/// has any; joints_gt.json.gz (or joints_gt.json) with gt_tum_optical.txt, if it has them. Messages
/// are joined with each other by session and image number, and with the folder's images, true
/// joints and true poses by time (1 ms). Throws InputError if the log has no people, the folder
/// knows nothing to compare them with, they have no time in common, or are of different cameras.
DetectionInput ReadDetections(const std::string& log, const std::string& folder);

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_TOOLS_EVALUATE_DETECTION_INPUT_H_
