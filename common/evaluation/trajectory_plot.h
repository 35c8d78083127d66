#ifndef AIRDOS_COMMON_EVALUATION_TRAJECTORY_PLOT_H_
#define AIRDOS_COMMON_EVALUATION_TRAJECTORY_PLOT_H_

#include <opencv2/core/mat.hpp>
#include <string>

#include "common/evaluation/trajectory_report.h"

namespace airdos {

/// Draws an evaluation as an 8-bit BGR picture: on the left both trajectories from above (SE(3)
/// aligned, equal scale on both axes); on the right the position error (m) and the rotation error
/// per frame (deg) over time (s; over the row number for KITTI rows).
///
/// "Above" is determined from the ground truth: the axis of its world that the camera's y axis
/// (down) points along on average.
cv::Mat DrawEvaluation(const TrajectoryReport& report, const std::string& title);

/// Writes a PNG file, whatever the extension. Throws InputError on failure.
void WritePng(const cv::Mat& picture, const std::string& path);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_TRAJECTORY_PLOT_H_
