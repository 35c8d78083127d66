#ifndef AIRDOS_COMMON_CHECK_PAIRS_H_
#define AIRDOS_COMMON_CHECK_PAIRS_H_

#include <string>
#include <vector>

#include "common/check/check_input.h"

namespace airdos {

/// Checks whether the keypoints of the left and right images form stereo pairs: present in both,
/// different, not exchanged (people's disparities are positive), at the same resolution and on the
/// same rows. People come in no particular order, so they are paired by shape and row; a pair must
/// be mutually best and clearly better than the second best. Mismatches are then rare enough for
/// medians.
class PeoplePairCheck {
 public:
  explicit PeoplePairCheck(const StereoCamera& camera) : camera_(camera) {}

  void Add(const StereoPeople& people);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  bool ReportMissing(const std::string& where, FindingList* findings) const;
  bool ReportResolution(const std::string& where, FindingList* findings) const;

  StereoCamera camera_;
  int num_left_ = 0;  // number of people
  int num_right_ = 0;
  int num_frames_ = 0;     // frames with people in both images
  int num_identical_ = 0;  // of these
  std::string first_left_;
  std::string first_right_;
  std::vector<double> sizes_left_px_;  // one per person
  std::vector<double> sizes_right_px_;
  std::vector<double> disparities_px_;  // u_left - u_right, one per pair of people
  std::vector<double> row_steps_px_;    // v_right - v_left
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_PAIRS_H_
