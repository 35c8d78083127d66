#ifndef AIRDOS_COMMON_CHECK_STEREO_H_
#define AIRDOS_COMMON_CHECK_STEREO_H_

#include <opencv2/core.hpp>
#include <string>
#include <vector>

#include "common/check/check_findings.h"
#include "common/geometry/stereo_camera.h"

namespace airdos {

/// Checks whether image pairs are what they should be: of equal size, left and right not exchanged
/// (disparities are positive), different, rectified (matches are on the same row), and with
/// plausible depths (MatchStereo() in stereo_matches.h).
class StereoCheck {
 public:
  explicit StereoCheck(const StereoCamera& camera) : camera_(camera) {}

  /// Pictures are CV_8UC1. A size that differs from the camera's is reported at once.
  void Add(const std::string& where_left, const cv::Mat& left, const std::string& where_right,
           const cv::Mat& right, FindingList* findings);
  void Report(const std::string& where, FindingList* findings) const;

  /// Median absolute row difference so far, px.
  double row_error_px() const;
  /// The reason why the rows differ has been found and reported (check_shift.h).
  void SetShiftKnown() { is_shift_known_ = true; }

 private:
  void ReportOrder(const std::string& where, FindingList* findings) const;
  void ReportRows(const std::string& where, FindingList* findings) const;
  void ReportDepth(const std::string& where, FindingList* findings) const;

  StereoCamera camera_;
  int num_pairs_ = 0;
  int num_identical_ = 0;
  bool is_shift_known_ = false;
  std::vector<double> disparities_px_;  // u_left - u_right
  std::vector<double> row_errors_px_;   // v_right - v_left
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_STEREO_H_
