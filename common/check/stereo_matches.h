#ifndef AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_
#define AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace airdos {

/// Corners that are seen in both images of a pair, px.
struct StereoMatches {
  std::vector<cv::Point2f> left;
  std::vector<cv::Point2f> right;  ///< of the same corners

  std::vector<double> Disparities() const;     ///< u_left - u_right, px
  std::vector<double> RowDifferences() const;  ///< v_right - v_left, px
};

/// Matches by descriptor without regard to rows or signs, aligned to a fraction of a pixel, so that
/// they can tell whether a pair is what it is said to be; mismatches are few enough for medians.
/// Both are CV_8UC1 and of one size; of each at most `max_corners` are looked at.
StereoMatches MatchStereo(const cv::Mat& left, const cv::Mat& right, int max_corners);

/// How a pair's matches lie to one another.
struct RowError {
  int num_matches = 0;
  double median_px = 0;  ///< of |v_right - v_left|; near 0 where the images are rectified
  double share_negative =
      0;  ///< of matches with a disparity below 0: 1 where the images are exchanged
};

/// Nothing where matches are too few to tell.
std::optional<RowError> MeasureRowError(const cv::Mat& left, const cv::Mat& right, int max_corners);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_
