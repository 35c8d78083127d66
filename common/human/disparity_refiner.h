#ifndef AIRDOS_COMMON_HUMAN_DISPARITY_REFINER_H_
#define AIRDOS_COMMON_HUMAN_DISPARITY_REFINER_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace airdos {

struct DisparityRefinerOptions {
  double patch_per_height = 0.03;  ///< half the side of the patch, of the person's height in px
  int min_half_patch_px = 3;
  int max_half_patch_px = 9;
  double min_correlation = 0.75;
  double max_return_error_px = 0.7;  ///< allowed between the way to the right image and back
  double min_contrast = 3;           ///< standard deviation of the patch in grey levels
};

/// Finds where the patch around a pixel of the left image lies on the same row of the right image:
/// disparity in px to a fraction of a pixel, by normalised correlation and a parabola through its
/// peak. Only disparities within `search_px` of `expected_px` are looked at. Nothing where the
/// patch leaves an image, has no contrast, has its best correlation at the border of the search or
/// below the bound, or is not found again on the way back. Images are CV_8UC1 of one size.
std::optional<double> RefineDisparity(const DisparityRefinerOptions& options,
                                      const cv::Mat& left_gray, const cv::Mat& right_gray,
                                      const Eigen::Vector2d& uv_left_px, double expected_px,
                                      double search_px, double height_px);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_DISPARITY_REFINER_H_
