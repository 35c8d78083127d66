#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_PLOT_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_PLOT_H_

#include <opencv2/core/mat.hpp>
#include <string>

#include "common/evaluation/trajectory_report.h"

namespace airdos {

/// A picture of one evaluation, 8-bit BGR: on the left both trajectories from above (SE(3) aligned,
/// the same scale on both axes), on the right position error (m) and rotation error per frame (deg)
/// over time (s; over the row for KITTI rows).
///
/// Above is told from the ground truth: the axis of its world that the camera's y axis (down)
/// points along on average.
cv::Mat DrawEvaluation(const TrajectoryReport& report, const std::string& title);

/// Writes a PNG file, whatever the ending of its name. Throws InputError where it cannot.
void WritePng(const cv::Mat& picture, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_PLOT_H_
