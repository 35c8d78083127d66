#ifndef AIRDOS_COMMON_HUMAN_DISPARITY_REFINER_H_
#define AIRDOS_COMMON_HUMAN_DISPARITY_REFINER_H_

#include <Eigen/Core>
#include <opencv2/core.hpp>
#include <optional>

namespace airdos {

/// Settings of RefineDisparity().
struct DisparityRefinerOptions {
  double patch_per_height = 0.03;  ///< half the patch size, relative to the person's height in px
  int min_half_patch_px = 3;
  int max_half_patch_px = 9;
  double min_correlation = 0.75;
  double max_return_error_px = 0.7;  ///< allowed error after matching forth and back
  double min_contrast = 3;           ///< standard deviation of the patch in grey levels
};

/// Finds the patch around a pixel of the left image on the same row of the right image. Returns the
/// disparity in px, to a fraction of a pixel, from normalised correlation and a parabola through
/// its peak. Only disparities within `search_px` of `expected_px` are considered. Nothing if the
/// patch leaves an image or has no contrast, or if its best correlation is below the bound, lies at
/// the border of the search range, or is not confirmed by the search in the opposite direction.
/// Images are CV_8UC1 and of equal size.
std::optional<double> RefineDisparity(const DisparityRefinerOptions& options,
                                      const cv::Mat& left_gray, const cv::Mat& right_gray,
                                      const Eigen::Vector2d& uv_left_px, double expected_px,
                                      double search_px, double height_px);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_DISPARITY_REFINER_H_
