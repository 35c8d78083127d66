#include "common/check/check_stereo.h"

#include <cmath>

#include "common/check/stereo_matches.h"
#include "common/dataset/image_file.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr int kMaxCorners = 800;
constexpr int kMinMatches = 40;        // fewer are not significant
constexpr double kMinClearSign = 0.7;  // share of the matches that must agree on a sign

}  // namespace

void StereoCheck::Add(const std::string& where_left, const cv::Mat& left,
                      const std::string& where_right, const cv::Mat& right, FindingList* findings) {
  bool fits = true;
  for (const auto& [where, image] : {std::make_pair(where_left, left), {where_right, right}}) {
    if (image.cols == camera_.width && image.rows == camera_.height) continue;
    fits = false;
    findings->Fail(
        "images.size", where,
        SizeMismatchText(image.cols, image.rows, "the camera", camera_.width, camera_.height));
  }
  if (!fits) return;
  ++num_pairs_;
  if (cv::norm(left, right, cv::NORM_INF) == 0) ++num_identical_;
  const StereoMatches matches = MatchStereo(left, right, kMaxCorners);
  for (const double value : matches.Disparities()) disparities_px_.push_back(value);
  for (const double value : matches.RowDifferences()) row_errors_px_.push_back(value);
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
  if (is_shift_known_) return;  // for wrong partners, signs, depths and rows mean nothing
  ReportOrder(where, findings);
  ReportRows(where, findings);
}

double StereoCheck::row_error_px() const {
  std::vector<double> absolute_px;
  for (const double error_px : row_errors_px_) absolute_px.push_back(std::abs(error_px));
  return Quantile(absolute_px, 0.5);
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
  const double median_px = row_error_px();
  const std::string rows = "rows of matches differ by " + Brief(median_px) + " px (median), " +
                           Brief(Quantile(absolute_px, 0.9)) + " px (90 %), overall by " +
                           Brief(Quantile(row_errors_px_, 0.5)) + " px";
  // The frontend searches for a corner within 1.5 px of its row.
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
