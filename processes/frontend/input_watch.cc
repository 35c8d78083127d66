#include "processes/frontend/input_watch.h"

#include <algorithm>
#include <utility>

#include "common/check/check_findings.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

// Whoever publishes the images has to rectify them; ours can.
constexpr char kHowToRectify[] =
    "give the calibration to what plays or captures them: airdos-stereo-player --images LEFT RIGHT "
    "--calibration FILE";

constexpr double kMaxCoverage = 0.9;
constexpr int kMinJoints = 50;
constexpr double kMinMarked = 0.1;  // share of joints inside masks
constexpr double kMinJointConfidence = 0.2;

// Periods that cameras can have, and those that most of them have.
constexpr double kMinPeriod_s = 0.002;
constexpr double kMaxPeriod_s = 2;
constexpr double kMinUsualPeriod_s = 0.005;
constexpr double kMaxUsualPeriod_s = 1;

}  // namespace

InputWatch::InputWatch() : rows_(kHowToRectify) {}

std::vector<std::string> InputWatch::TakeWarnings() {
  std::vector<std::string> warnings = std::exchange(warnings_, {});
  for (std::string& warning : rows_.TakeWarnings()) warnings.push_back(std::move(warning));
  return warnings;
}

void InputWatch::AddTime(std::int64_t utime) {
  if (are_times_judged_) return;
  if (last_utime_) {
    steps_us_.push_back(static_cast<double>(utime) - static_cast<double>(*last_utime_));
  }
  last_utime_ = utime;
  if (time_schedule_.IsDue()) JudgeTimes();
}

void InputWatch::JudgeTimes() {
  are_times_judged_ = true;
  const double period_s = 1e-6 * Quantile(std::exchange(steps_us_, {}), 0.5);
  const std::string must = "; utime must be the capture time in us";
  if (period_s == 0) {
    warnings_.push_back("the left images' utime stands still" + must);
    return;
  }
  if (period_s >= kMinPeriod_s && period_s <= kMaxPeriod_s) return;
  std::string unit;
  for (const auto& [name, factor] : {std::pair{"ns", 1e-3}, {"ms", 1e3}, {"s", 1e6}}) {
    const double meant_s = factor * period_s;
    if (meant_s >= kMinUsualPeriod_s && meant_s <= kMaxUsualPeriod_s) {
      unit = std::string(": it is in ") + name;
      break;
    }
  }
  warnings_.push_back("according to utime, the left images are " + Brief(period_s) +
                      " s apart (median)" + unit + must);
}

void InputWatch::AddPair(const cv::Mat& left, const cv::Mat& right) {
  if (rows_.IsDue()) rows_.Add(left, right);
}

void InputWatch::AddMask(const cv::Mat& mask, const std::vector<BodyKeypoints>& people) {
  const bool is_due = mask_schedule_.IsDue();
  if (are_masks_said_) return;
  coverages_.push_back(cv::countNonZero(mask) / static_cast<double>(mask.total()));
  for (const BodyKeypoints& person : people) {
    for (const BodyKeypoint& joint : person) {
      const bool is_seen = joint.confidence >= kMinJointConfidence && joint.u_px >= 0 &&
                           joint.v_px >= 0 && joint.u_px < mask.cols && joint.v_px < mask.rows;
      if (!is_seen) continue;
      ++num_joints_;
      const cv::Point pixel(static_cast<int>(joint.u_px), static_cast<int>(joint.v_px));
      num_marked_ += mask.at<unsigned char>(pixel) != 0 ? 1 : 0;
    }
  }
  if (is_due) JudgeMasks();
}

void InputWatch::JudgeMasks() {
  const double coverage = Quantile(std::exchange(coverages_, {}), 0.5);
  const int num_joints = std::exchange(num_joints_, 0);
  const int num_marked = std::exchange(num_marked_, 0);
  const bool misses_people = num_joints >= kMinJoints && num_marked < kMinMarked * num_joints;
  std::string text;
  if (coverage > kMaxCoverage) {
    text = "the person masks cover " + Percent(coverage) +
           " of the image (median), which excludes static features there; are they inverted, or "
           "does each class have a number?";
  } else if (misses_people) {
    text = "the person masks do not mark people: " + std::to_string(num_marked) + " of " +
           std::to_string(num_joints) +
           " keypoints are on them; are they inverted, empty or from another camera?";
  }
  if (text.empty()) return;
  are_masks_said_ = true;
  warnings_.push_back(text);
}

}  // namespace airdos
