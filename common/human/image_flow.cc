#include "common/human/image_flow.h"

#include <cstddef>
#include <opencv2/imgproc.hpp>
#include <opencv2/video/tracking.hpp>
#include <utility>

#include "common/util/check.h"

namespace airdos {
namespace {

constexpr int kShiftReduction = 4;  // scale at which the whole image's shift is measured

cv::Point2f ToPoint(const Eigen::Vector2d& uv_px) {
  return {static_cast<float>(uv_px.x()), static_cast<float>(uv_px.y())};
}

}  // namespace

void ImageFlow::SetImage(const cv::Mat& gray) {
  last_pyramid_ = std::move(pyramid_);
  pyramid_.clear();
  shift_px_.setZero();
  if (gray.empty() || gray.size() != size_) {
    last_pyramid_.clear();
    small_.release();
  }
  size_ = gray.size();
  if (gray.empty()) return;
  cv::buildOpticalFlowPyramid(gray, pyramid_, {options_.window_px, options_.window_px},
                              options_.num_levels);
  MeasureShift(gray);
}

void ImageFlow::MeasureShift(const cv::Mat& gray) {
  cv::Mat reduced;
  cv::resize(gray, reduced, {gray.cols / kShiftReduction, gray.rows / kShiftReduction}, 0, 0,
             cv::INTER_AREA);
  // A separate header that owns these pixels: converting into small_ would overwrite them.
  const cv::Mat last = std::move(small_);
  small_ = cv::Mat();
  reduced.convertTo(small_, CV_32F);
  if (last.empty() || small_.cols < 8 || small_.rows < 8) return;
  if (hanning_.size() != small_.size()) cv::createHanningWindow(hanning_, small_.size(), CV_32F);
  double response = 0;
  const cv::Point2d shift = cv::phaseCorrelate(last, small_, hanning_, &response);
  if (response < options_.min_shift_response) return;
  shift_px_ = Eigen::Vector2d(shift.x, shift.y) * kShiftReduction;
}

std::vector<std::optional<Eigen::Vector2d>> ImageFlow::Follow(
    const std::vector<Eigen::Vector2d>& from_px,
    const std::vector<Eigen::Vector2d>& guess_px) const {
  AIRDOS_CHECK(from_px.size() == guess_px.size());
  std::vector<std::optional<Eigen::Vector2d>> to_px(from_px.size());
  if (from_px.empty() || last_pyramid_.empty() || pyramid_.empty()) return to_px;
  std::vector<cv::Point2f> from, to, back;
  for (std::size_t i = 0; i < from_px.size(); ++i) {
    from.push_back(ToPoint(from_px[i]));
    to.push_back(ToPoint(guess_px[i]));
  }
  back = from;
  std::vector<unsigned char> is_there, is_back;
  const cv::Size window(options_.window_px, options_.window_px);
  const cv::TermCriteria criteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.03);
  cv::calcOpticalFlowPyrLK(last_pyramid_, pyramid_, from, to, is_there, cv::noArray(), window,
                           options_.num_levels, criteria, cv::OPTFLOW_USE_INITIAL_FLOW);
  // The way back starts from the reverse of the guess, not from the answer, so that it is a real
  // test.
  for (std::size_t i = 0; i < from.size(); ++i) back[i] = to[i] + (from[i] - ToPoint(guess_px[i]));
  cv::calcOpticalFlowPyrLK(pyramid_, last_pyramid_, to, back, is_back, cv::noArray(), window,
                           options_.num_levels, criteria, cv::OPTFLOW_USE_INITIAL_FLOW);
  for (std::size_t i = 0; i < from.size(); ++i) {
    if (is_there[i] == 0 || is_back[i] == 0) continue;
    const Eigen::Vector2d end(to[i].x, to[i].y);
    const bool is_inside =
        end.x() >= 0 && end.y() >= 0 && end.x() < size_.width && end.y() < size_.height;
    const double return_error_px = cv::norm(back[i] - from[i]);
    if (is_inside && return_error_px <= options_.max_return_error_px) to_px[i] = end;
  }
  return to_px;
}

}  // namespace airdos
