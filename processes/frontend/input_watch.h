#ifndef AIRDOS_PROCESSES_FRONTEND_INPUT_WATCH_H_
#define AIRDOS_PROCESSES_FRONTEND_INPUT_WATCH_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/check/row_watch.h"
#include "common/human/body_keypoints.h"
#include "processes/node/partner_watch.h"

namespace airdos {

/// Watches during a session what airdos-check examines beforehand: whether the images are rectified
/// stereo pairs, times are in us, and masks mark people. Counts frames and uses no clock; reports
/// each problem once. Cheap: apart from a few frames, it only counts.
class InputWatch {
 public:
  InputWatch();
  /// Adds a frame that has its left image, taken at `utime`.
  void AddTime(std::int64_t utime);
  /// Adds both images, CV_8UC1 and of equal size.
  void AddPair(const cv::Mat& left, const cv::Mat& right);
  /// Adds the mask of a left image as received (non-zero = person), and the people in it, if known.
  void AddMask(const cv::Mat& mask, const std::vector<BodyKeypoints>& people);

  /// See RowWatch.
  std::optional<double> row_error_px() const { return rows_.error_px(); }
  /// Warnings since the last call.
  std::vector<std::string> TakeWarnings();

 private:
  void JudgeTimes();
  void JudgeMasks();

  std::vector<std::string> warnings_;

  LookSchedule time_schedule_;
  std::optional<std::int64_t> last_utime_;
  std::vector<double> steps_us_;  // between the first images
  bool are_times_judged_ = false;

  RowWatch rows_;

  LookSchedule mask_schedule_;
  std::vector<double> coverages_;  // since the last judgement
  int num_joints_ = 0;
  int num_marked_ = 0;
  bool are_masks_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_INPUT_WATCH_H_
