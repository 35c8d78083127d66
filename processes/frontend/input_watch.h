#ifndef AIRDOS_PROCESSES_FRONTEND_INPUT_WATCH_H_
#define AIRDOS_PROCESSES_FRONTEND_INPUT_WATCH_H_

#include <cstdint>
#include <opencv2/core.hpp>
#include <optional>
#include <string>
#include <vector>

#include "common/human/body_keypoints.h"
#include "processes/node/partner_watch.h"

namespace airdos {

/// Watches, while a session runs, what airdos-check looks at beforehand: whether images are stereo
/// pairs of rectified cameras, times are us, and masks mark people. It counts frames and knows no
/// clock; each thing is said once. Cheap: all but a few frames are only counted.
class InputWatch {
 public:
  /// A frame that has its left image, taken at `utime`.
  void AddTime(std::int64_t utime);
  /// Both images, CV_8UC1 of one size.
  void AddPair(const cv::Mat& left, const cv::Mat& right);
  /// Mask of the left image as it came (not 0 = a person), and the people in it where they are
  /// known.
  void AddMask(const cv::Mat& mask, const std::vector<BodyKeypoints>& people);

  /// What is to be said since the last call.
  std::vector<std::string> TakeWarnings();

 private:
  void JudgeTimes();
  void JudgePairs();
  void JudgeMasks();

  std::vector<std::string> warnings_;

  LookSchedule time_schedule_;
  std::optional<std::int64_t> last_utime_;
  std::vector<double> steps_us_;  // of the first images
  bool are_times_judged_ = false;

  int num_pairs_ = 0;
  int num_measured_ = 0;
  std::vector<double> row_errors_px_;    // of each pair that was measured
  std::vector<double> negative_shares_;  // of its disparities
  bool are_rows_said_ = false;
  bool is_exchange_said_ = false;

  LookSchedule mask_schedule_;
  std::vector<double> coverages_;  // since the last look
  int num_joints_ = 0;
  int num_marked_ = 0;
  bool are_masks_said_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_PROCESSES_FRONTEND_INPUT_WATCH_H_
