#include "common/check/row_watch.h"

#include <cstddef>
#include <utility>

#include "common/check/check_findings.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr int kMaxCorners = 300;
constexpr int kFirstPairs = 10;
constexpr int kFirstStep = 2;
constexpr int kSearchStep = 10;
constexpr int kLaterStep = 100;
constexpr int kPatience = 30;  // pairs

constexpr std::size_t kMeasurements = 3;
// Of a pair: images that show nothing have a mismatch now and then, which must not add up.
constexpr std::size_t kMinPooled = 5;

constexpr double kNotRectified_px = 1.5;  // the frontend's search range for a corner around its row
constexpr double kBadlyRectified_px = 0.6;
constexpr double kMinExchanged = 0.7;  // share of negative disparities

void Append(const StereoMatches& matches, StereoMatches* pool) {
  pool->left.insert(pool->left.end(), matches.left.begin(), matches.left.end());
  pool->right.insert(pool->right.end(), matches.right.begin(), matches.right.end());
}

/// Two of the last three must agree: a single one may show nothing but water, or date from before
/// the camera moved.
double Middle(const std::vector<RowError>& measurements, double RowError::*figure) {
  std::vector<double> values;
  for (const RowError& measurement : measurements) values.push_back(measurement.*figure);
  return Quantile(values, 0.5);
}

}  // namespace

RowWatch::RowWatch(std::string mend) : mend_(std::move(mend)) {}

bool RowWatch::IsDue() {
  ++num_pairs_;
  if (measurements_.size() == kMeasurements) return num_pairs_ % kLaterStep == 0;
  if (num_pairs_ <= kFirstPairs) return num_pairs_ % kFirstStep == 1;
  return num_pairs_ % kSearchStep == 0;
}

void RowWatch::Add(const cv::Mat& left, const cv::Mat& right) {
  const StereoMatches matches = MatchStereo(left, right, kMaxCorners);
  if (matches.left.size() >= kMinPooled) Append(matches, &pool_);
  if (const std::optional<RowError> error = RowErrorOf(pool_)) {
    pool_ = {};
    Judge(*error);
  }
  JudgeSilence(kPatience);
}

// Of fewer pairs than the first ones hardly a trajectory comes.
void RowWatch::Finish() { JudgeSilence(kFirstPairs); }

void RowWatch::Judge(const RowError& error) {
  measurements_.push_back(error);
  if (measurements_.size() < kMeasurements) return;
  if (measurements_.size() > kMeasurements) measurements_.erase(measurements_.begin());
  const double share_negative = Middle(measurements_, &RowError::share_negative);
  if (!is_exchange_said_ && share_negative > kMinExchanged) {
    is_exchange_said_ = true;
    warnings_.push_back("left and right images are exchanged: " + Percent(share_negative) +
                        " of the matches have a negative disparity; no static feature will be "
                        "found until they are swapped");
  }
  const double error_px = *this->error_px();
  const bool is_unrectified = error_px > kNotRectified_px;
  if (is_unrectified_said_ || error_px <= kBadlyRectified_px) return;
  if (is_bad_said_ && !is_unrectified) return;
  (is_unrectified ? is_unrectified_said_ : is_bad_said_) = true;
  const std::string how = is_unrectified ? "are not rectified" : "are badly rectified";
  warnings_.push_back("the images " + how + ": rows of matches differ by " + Brief(error_px) +
                      " px (median); " + mend_);
}

void RowWatch::JudgeSilence(int patience) {
  if (is_silence_said_ || num_pairs_ < patience || measurements_.size() == kMeasurements) return;
  is_silence_said_ = true;
  warnings_.push_back(
      "hardly anything in the left images is found in the right ones, so whether "
      "they are rectified is not known; if they are not, " +
      mend_);
}

std::optional<double> RowWatch::error_px() const {
  if (measurements_.size() < kMeasurements) return std::nullopt;
  return Middle(measurements_, &RowError::median_px);
}

std::vector<std::string> RowWatch::TakeWarnings() { return std::exchange(warnings_, {}); }

}  // namespace airdos
