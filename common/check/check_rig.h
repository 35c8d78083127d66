#ifndef AIRDOS_COMMON_CHECK_CHECK_RIG_H_
#define AIRDOS_COMMON_CHECK_CHECK_RIG_H_

#include <array>
#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/calibration/stereo_rectifier.h"
#include "common/check/check_findings.h"

namespace airdos {

/// A pair of images as it was recorded, CV_8UC1.
struct RawPair {
  cv::Mat left;
  cv::Mat right;
};

/// How far the rows of matches lie apart, and on which side they are.
struct RowStatistics {
  int num_matches = 0;
  double median_px = 0;         ///< of |v_right - v_left|
  std::vector<double> pair_px;  ///< the same of each pair with matches enough
  /// Of the matches with a disparity: those with u_left < u_right; 1 where images are exchanged.
  double share_negative = 0;
  /// Median of |v_right - v_left| in thirds of the left image, row by row from the top left; below
  /// 0 where there are too few matches.
  std::array<double, 9> region_px = {-1, -1, -1, -1, -1, -1, -1, -1, -1};
};

/// What a calibration does to a user's images.
struct RigCheck {
  RowStatistics before;  ///< as recorded
  RowStatistics after;   ///< rectified
};

/// Matches corners of all pairs (MatchStereo()) before and after rectification.
RigCheck MeasureRig(const StereoRectifier& rectifier, const std::vector<RawPair>& pairs);

/// Whether the calibration fits the images: rows agree to 0.5 px (above 1 px is an error),
/// disparities are positive. Where it does not, which other reading of the file would: images
/// rectified already, left and right exchanged, calibrated at another resolution, a fisheye lens;
/// or, where rows agree in some of the pairs only, that left and right were not taken at one time.
/// Every pair must have the rig's size.
void JudgeRigCheck(const StereoRig& rig, const std::vector<RawPair>& pairs, const RigCheck& check,
                   const std::string& where, FindingList* findings);

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_CHECK_RIG_H_
