#include "common/check/stereo_matches.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/video/tracking.hpp>

#include "common/check/check_findings.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr float kMaxRatio = 0.8F;   // best to second-best distance (Lowe)
constexpr float kMaxHamming = 60;   // bits of 256
constexpr double kMaxAlignPx = 3;   // maximum error of a corner found in the pyramid
constexpr int kMinRowMatches = 20;  // fewer are not significant
constexpr double kNoSignPx = 0.3;   // the sign of a smaller disparity is not significant

/// Tolerance for matching a row of `a` with a row of `b`: even an unrectified pair is rarely off by
/// more than this, whereas mismatches are spread over the whole image.
double MaxRowErrorPx(const cv::Mat& image) { return std::max(20.0, 0.1 * image.rows); }

StereoMatches MatchByDescriptor(const cv::Mat& left, const cv::Mat& right, int max_corners) {
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(max_corners, 1.2F, 3, 31, 0, 2, cv::ORB::FAST_SCORE, 31, 10);
  std::vector<cv::KeyPoint> corners_left;
  std::vector<cv::KeyPoint> corners_right;
  cv::Mat descriptors_left;
  cv::Mat descriptors_right;
  orb->detectAndCompute(left, cv::noArray(), corners_left, descriptors_left);
  orb->detectAndCompute(right, cv::noArray(), corners_right, descriptors_right);
  StereoMatches matches;
  if (corners_left.size() < 2 || corners_right.size() < 2) return matches;
  std::vector<std::vector<cv::DMatch>> nearest;
  cv::BFMatcher(cv::NORM_HAMMING).knnMatch(descriptors_left, descriptors_right, nearest, 2);
  for (const std::vector<cv::DMatch>& pair : nearest) {
    if (pair.size() < 2 || pair[0].distance > kMaxHamming ||
        pair[0].distance > kMaxRatio * pair[1].distance) {
      continue;
    }
    const cv::Point2f a = corners_left[static_cast<std::size_t>(pair[0].queryIdx)].pt;
    const cv::Point2f b = corners_right[static_cast<std::size_t>(pair[0].trainIdx)].pt;
    if (std::abs(a.y - b.y) > MaxRowErrorPx(left) || std::abs(a.x - b.x) > 0.5 * left.cols) {
      continue;
    }
    matches.left.push_back(a);
    matches.right.push_back(b);
  }
  return matches;
}

/// Corners found in the pyramid are accurate to a pixel or two, aligned patches to a tenth.
StereoMatches Align(const cv::Mat& left, const cv::Mat& right, const StereoMatches& matches) {
  StereoMatches aligned;
  if (matches.left.empty()) return aligned;
  std::vector<cv::Point2f> found = matches.right;
  std::vector<unsigned char> status;
  cv::calcOpticalFlowPyrLK(
      left, right, matches.left, found, status, cv::noArray(), cv::Size(15, 15), 0,
      cv::TermCriteria(cv::TermCriteria::COUNT + cv::TermCriteria::EPS, 20, 0.02),
      cv::OPTFLOW_USE_INITIAL_FLOW);
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (status[i] == 0 || cv::norm(found[i] - matches.right[i]) > kMaxAlignPx) continue;
    aligned.left.push_back(matches.left[i]);
    aligned.right.push_back(found[i]);
  }
  return aligned;
}

}  // namespace

std::vector<double> StereoMatches::Disparities() const {
  std::vector<double> disparities_px;
  for (std::size_t i = 0; i < left.size(); ++i) disparities_px.push_back(left[i].x - right[i].x);
  return disparities_px;
}

std::vector<double> StereoMatches::RowDifferences() const {
  std::vector<double> differences_px;
  for (std::size_t i = 0; i < left.size(); ++i) differences_px.push_back(right[i].y - left[i].y);
  return differences_px;
}

StereoMatches MatchStereo(const cv::Mat& left, const cv::Mat& right, int max_corners) {
  return Align(left, right, MatchByDescriptor(left, right, max_corners));
}

std::optional<RowError> RowErrorOf(const StereoMatches& matches) {
  const std::size_t num_matches = matches.left.size();
  if (num_matches < kMinRowMatches) return std::nullopt;
  std::vector<double> rows_px = matches.RowDifferences();
  for (double& row_px : rows_px) row_px = std::abs(row_px);
  double num_negative = 0;
  for (const double disparity_px : matches.Disparities()) {
    num_negative += disparity_px < -kNoSignPx ? 1 : 0;
  }
  return RowError{static_cast<int>(num_matches), Quantile(rows_px, 0.5),
                  num_negative / static_cast<double>(num_matches)};
}

}  // namespace airdos
