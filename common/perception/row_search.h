#ifndef AIRDOS_COMMON_PERCEPTION_ROW_SEARCH_H_
#define AIRDOS_COMMON_PERCEPTION_ROW_SEARCH_H_

#include <opencv2/core.hpp>
#include <optional>

#include "common/human/disparity_refiner.h"
#include "common/perception/person_pose.h"

namespace airdos {

struct RowSearchOptions {
  DisparityRefinerOptions refiner;
  double min_score = 0.1;  ///< of joints that are looked for
  int min_joints = 4;      ///< that must be found
  /// A person's disparity is at most this, relative to his height: of somebody of 1.7 m seen
  /// whole, a baseline of 1.2 m; more for those who are seen in part.
  double max_disparity_per_height = 0.7;
  /// How far joints may be before or behind the person's middle, as disparity relative to it; at
  /// least 2 px.
  double body_extent = 0.15;
};

/// A person of the left image in the right one, by looking for the patch around each joint along
/// its row: first in all disparities that the person's size allows, of which the median is the
/// person's; then again near it. Joints that are not found, or elsewhere, get the person's
/// disparity and half their score. Nothing if too few are found. Images are CV_8UC1, rectified and
/// of one size.
std::optional<PersonPose> FindInRightImage(const RowSearchOptions& options, const cv::Mat& left,
                                           const cv::Mat& right, const PersonPose& person);

}  // namespace airdos

#endif  // AIRDOS_COMMON_PERCEPTION_ROW_SEARCH_H_
