#ifndef AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_
#define AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_

#include <opencv2/core.hpp>
#include <vector>

namespace airdos {

/// Corners of two pictures that show the same, px.
struct CornerMatches {
  std::vector<cv::Point2f> left;
  std::vector<cv::Point2f> right;  ///< of the same corners

  std::vector<double> Disparities() const;     ///< u_left - u_right, px
  std::vector<double> RowDifferences() const;  ///< v_right - v_left, px
};

/// Matches corners by descriptor without regard to rows or signs, then aligns them to a fraction of
/// a pixel. Pictures are CV_8UC1 of one size. Mismatches are few enough for medians.
CornerMatches MatchCorners(const cv::Mat& left, const cv::Mat& right);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_
