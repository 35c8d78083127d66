#ifndef AIRDOS_COMMON_CHECK_ROW_WATCH_H_
#define AIRDOS_COMMON_CHECK_ROW_WATCH_H_

#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/check/stereo_matches.h"

namespace airdos {

/// Watches while pairs of images come whether they are rectified: whether corners lie on the same
/// row in both, to the left in the right one. Looks at every second of the first ten pairs, at
/// every tenth until three measurements are there, then at every hundredth, for a camera that is
/// moved. A measurement has at least 20 matches, of several pairs if need be. Each problem is
/// reported once, and also that after 30 pairs, or at the end, there were too few matches to know.
class RowWatch {
 public:
  /// `mend`: what to do about images that are not rectified; ends with the command.
  explicit RowWatch(std::string mend);

  /// Counts a pair; whether it is to be measured: Add() it then. That takes about half as long as
  /// tracking a frame.
  bool IsDue();
  /// Both images CV_8UC1 and of equal size.
  void Add(const cv::Mat& left, const cv::Mat& right);

  /// Call this where no more pairs will come, if that is ever known.
  void Finish();

  /// Median row error of matches, px: the middle one of the last three measurements.
  std::optional<double> error_px() const;
  /// Warnings since the last call.
  std::vector<std::string> TakeWarnings();

 private:
  void Judge(const RowError& error);
  void JudgeSilence(int patience);

  std::string mend_;
  int num_pairs_ = 0;
  StereoMatches pool_;                  // of pairs with few matches, until they are enough
  std::vector<RowError> measurements_;  // the last three
  bool is_bad_said_ = false;
  bool is_unrectified_said_ = false;
  bool is_exchange_said_ = false;
  bool is_silence_said_ = false;
  std::vector<std::string> warnings_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_CHECK_ROW_WATCH_H_
