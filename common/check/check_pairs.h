#ifndef AIRDOS_COMMON_CHECK_PAIRS_H_
#define AIRDOS_COMMON_CHECK_PAIRS_H_

#include <string>
#include <vector>

#include "common/check/check_input.h"

namespace airdos {

/// Whether keypoints of the left and the right image are those of one stereo pair: both there,
/// different, not exchanged (disparities of people are positive), of one resolution and on the same
/// rows. People come in no order, so they are paired by shape and row, each with the other's best
/// and clearly better than the second best; mismatches are few enough for medians.
class PeoplePairCheck {
 public:
  explicit PeoplePairCheck(const StereoCamera& camera) : camera_(camera) {}

  void Add(const StereoPeople& people);
  void Report(const std::string& where, FindingList* findings) const;

 private:
  bool ReportMissing(const std::string& where, FindingList* findings) const;
  bool ReportResolution(const std::string& where, FindingList* findings) const;

  StereoCamera camera_;
  int num_left_ = 0;  // people
  int num_right_ = 0;
  int num_frames_ = 0;     // with people in both
  int num_identical_ = 0;  // of those
  std::string first_left_;
  std::string first_right_;
  std::vector<double> sizes_left_px_;  // of everybody's body
  std::vector<double> sizes_right_px_;
  std::vector<double> disparities_px_;  // of pairs of people, u_left - u_right
  std::vector<double> row_steps_px_;    // v_right - v_left
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_PAIRS_H_
