#ifndef AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_
#define AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

namespace airdos {

/// Corners visible in both images of a pair, px.
struct StereoMatches {
  std::vector<cv::Point2f> left;
  std::vector<cv::Point2f> right;  ///< the same corners

  std::vector<double> Disparities() const;     ///< u_left - u_right, px
  std::vector<double> RowDifferences() const;  ///< v_right - v_left, px
};

/// Matches corners by descriptor, regardless of rows and signs, and aligns them to a fraction of a
/// pixel, so the matches can reveal whether the pair is what it should be; mismatches are rare
/// enough for medians. Both images are CV_8UC1 and of equal size; at most `max_corners` of each are
/// used.
StereoMatches MatchStereo(const cv::Mat& left, const cv::Mat& right, int max_corners);

/// Summary of the rows and disparities of matches.
struct RowError {
  int num_matches = 0;
  double median_px = 0;       ///< of |v_right - v_left|; near 0 if the images are rectified
  double share_negative = 0;  ///< share of negative disparities; 1 if the images are exchanged
};

/// Nothing if there are fewer than 20 matches, which are not significant.
std::optional<RowError> RowErrorOf(const StereoMatches& matches);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_STEREO_MATCHES_H_
