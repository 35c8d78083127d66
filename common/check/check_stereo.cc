#include "common/check/check_stereo.h"

#include <algorithm>
#include <cmath>
#include <opencv2/features2d.hpp>
#include <opencv2/video/tracking.hpp>

namespace airdos {
namespace {

constexpr int kMaxCorners = 800;
constexpr float kMaxRatio = 0.8F;      // of the best to the second-best distance (Lowe)
constexpr float kMaxHamming = 60;      // bits of 256
constexpr double kMaxAlignPx = 3;      // a corner of the pyramid is at most this far off
constexpr int kMinMatches = 40;        // fewer say nothing
constexpr double kMinClearSign = 0.7;  // share of the matches that must agree on a sign

/// Whether a row of `a` could be one of `b`: a pair that is not rectified at all is seldom further
/// off than this, and mismatches are all over the image.
double MaxRowErrorPx(const cv::Mat& image) { return std::max(20.0, 0.1 * image.rows); }

struct Matches {
  std::vector<cv::Point2f> left;
  std::vector<cv::Point2f> right;
};

Matches MatchByDescriptor(const cv::Mat& left, const cv::Mat& right) {
  const cv::Ptr<cv::ORB> orb =
      cv::ORB::create(kMaxCorners, 1.2F, 3, 31, 0, 2, cv::ORB::FAST_SCORE, 31, 10);
  std::vector<cv::KeyPoint> corners_left;
  std::vector<cv::KeyPoint> corners_right;
  cv::Mat descriptors_left;
  cv::Mat descriptors_right;
  orb->detectAndCompute(left, cv::noArray(), corners_left, descriptors_left);
  orb->detectAndCompute(right, cv::noArray(), corners_right, descriptors_right);
  Matches matches;
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

/// Corners of a pyramid are good to a pixel or two; aligned patches to a tenth.
Matches Align(const cv::Mat& left, const cv::Mat& right, const Matches& matches) {
  Matches aligned;
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

std::string SizeOf(const cv::Mat& image) {
  return std::to_string(image.cols) + " x " + std::to_string(image.rows);
}

}  // namespace

void StereoCheck::Add(const std::string& where_left, const cv::Mat& left,
                      const std::string& where_right, const cv::Mat& right, FindingList* findings) {
  bool fits = true;
  for (const auto& [where, image] : {std::make_pair(where_left, left), {where_right, right}}) {
    if (image.cols == camera_.width && image.rows == camera_.height) continue;
    fits = false;
    findings->Fail("images.size", where,
                   "has " + SizeOf(image) + " px, the camera " + std::to_string(camera_.width) +
                       " x " + std::to_string(camera_.height));
  }
  if (!fits) return;
  ++num_pairs_;
  if (cv::norm(left, right, cv::NORM_INF) == 0) ++num_identical_;
  const Matches matches = Align(left, right, MatchByDescriptor(left, right));
  for (std::size_t i = 0; i < matches.left.size(); ++i) {
    disparities_px_.push_back(matches.left[i].x - matches.right[i].x);
    row_errors_px_.push_back(matches.right[i].y - matches.left[i].y);
  }
}

void StereoCheck::Report(const std::string& where, FindingList* findings) const {
  if (num_pairs_ == 0) return;
  if (num_identical_ > 0) {
    findings->Fail("images.identical", where,
                   "left and right are the same picture in " + std::to_string(num_identical_) +
                       " of " + std::to_string(num_pairs_) + " pairs");
    return;
  }
  if (disparities_px_.size() < kMinMatches) {
    findings->Warn("images.features", where,
                   std::to_string(disparities_px_.size()) + " matches in " +
                       std::to_string(num_pairs_) +
                       " pairs: too few to judge order, rectification and depth");
    return;
  }
  ReportOrder(where, findings);
  ReportRows(where, findings);
}

void StereoCheck::ReportOrder(const std::string& where, FindingList* findings) const {
  constexpr double kNoSignPx = 0.3;
  double num_positive = 0;
  double num_negative = 0;
  for (const double disparity_px : disparities_px_) {
    num_positive += disparity_px > kNoSignPx ? 1 : 0;
    num_negative += disparity_px < -kNoSignPx ? 1 : 0;
  }
  const auto num = static_cast<double>(disparities_px_.size());
  const std::string signs =
      Percent(num_positive / num) + " of " + std::to_string(disparities_px_.size()) +
      " matches have a positive disparity, " + Percent(num_negative / num) + " a negative one";
  if (num_negative > kMinClearSign * num) {
    findings->Fail("images.swapped", where, "left and right are exchanged: " + signs);
  } else if (num_positive < kMinClearSign * num) {
    findings->Warn("images.order", where, "not clear which image is the left one: " + signs);
  } else {
    findings->Note("images.order", where, signs);
    ReportDepth(where, findings);
  }
}

void StereoCheck::ReportRows(const std::string& where, FindingList* findings) const {
  std::vector<double> absolute_px;
  for (const double error_px : row_errors_px_) absolute_px.push_back(std::abs(error_px));
  const double median_px = Quantile(absolute_px, 0.5);
  const std::string rows = "rows of matches differ by " + Brief(median_px) + " px (median), " +
                           Brief(Quantile(absolute_px, 0.9)) + " px (90 %), on the whole by " +
                           Brief(Quantile(row_errors_px_, 0.5)) + " px";
  // The front end searches a corner within 1.5 px of its row.
  if (median_px > 1.5) {
    findings->Fail("images.rectification", where, "the images are not rectified: " + rows);
  } else if (median_px > 0.6) {
    findings->Warn("images.rectification", where, "the images are badly rectified: " + rows);
  } else {
    findings->Note("images.rectification", where, rows);
  }
}

void StereoCheck::ReportDepth(const std::string& where, FindingList* findings) const {
  std::vector<double> depths_m;
  for (const double disparity_px : disparities_px_) {
    if (disparity_px > 0.3) depths_m.push_back(camera_.fx_px * camera_.baseline_m / disparity_px);
  }
  const double median_m = Quantile(depths_m, 0.5);
  const std::string depth = "the median depth of matches is " + Brief(median_m) + " m";
  if (median_m < 0.2 || median_m > 1000) {
    findings->Fail("camera.depth", where, depth + ": baseline or focal length are in other units");
  } else if (median_m < 0.5 || median_m > 150) {
    findings->Warn("camera.depth", where, depth + ": check baseline and focal length");
  } else {
    findings->Note("camera.depth", where, depth);
  }
}

}  // namespace airdos
