#include "common/check/check_rig.h"

#include <algorithm>
#include <cmath>

#include "common/check/stereo_matches.h"
#include "common/util/error.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr int kMaxCorners = 1500;
constexpr int kMinMatches = 30;  // fewer tell nothing
constexpr int kMinRegionMatches = 8;
constexpr double kGoodRowPx = 1;         // good calibrations come to 0.1 to 0.4
constexpr double kClearlyBetter = 0.5;   // of the row error
constexpr double kExchangedShare = 0.8;  // of the disparities are negative
constexpr double kNoSignPx = 0.3;

/// All matches of the pairs after `map_left` and `map_right` changed the images.
template <class Left, class Right>
StereoMatches MatchAll(const std::vector<RawPair>& pairs, const Left& map_left,
                       const Right& map_right) {
  StereoMatches all;
  for (const RawPair& pair : pairs) {
    const StereoMatches matches =
        MatchStereo(map_left(pair.left), map_right(pair.right), kMaxCorners);
    all.left.insert(all.left.end(), matches.left.begin(), matches.left.end());
    all.right.insert(all.right.end(), matches.right.begin(), matches.right.end());
  }
  return all;
}

RowStatistics Measure(const StereoMatches& matches, cv::Size size) {
  RowStatistics statistics;
  statistics.num_matches = static_cast<int>(matches.left.size());
  std::vector<double> rows_px;
  std::array<std::vector<double>, 9> regions_px;
  int num_negative = 0;
  int num_signed = 0;
  for (std::size_t i = 0; i < matches.left.size(); ++i) {
    const cv::Point2f& left = matches.left[i];
    const double row_px = std::abs(static_cast<double>(matches.right[i].y) - left.y);
    const double disparity_px = static_cast<double>(left.x) - matches.right[i].x;
    rows_px.push_back(row_px);
    const auto third = [](float value, int length) {
      return std::clamp(static_cast<int>(3 * value / static_cast<float>(length)), 0, 2);
    };
    regions_px[static_cast<std::size_t>(3 * third(left.y, size.height) + third(left.x, size.width))]
        .push_back(row_px);
    if (std::abs(disparity_px) > kNoSignPx) ++num_signed;
    if (disparity_px < -kNoSignPx) ++num_negative;
  }
  statistics.median_px = Quantile(rows_px, 0.5);
  statistics.share_negative = num_signed > 0 ? static_cast<double>(num_negative) / num_signed : 0;
  for (std::size_t i = 0; i < regions_px.size(); ++i) {
    if (static_cast<int>(regions_px[i].size()) >= kMinRegionMatches)
      statistics.region_px[i] = Quantile(regions_px[i], 0.5);
  }
  return statistics;
}

cv::Mat Same(const cv::Mat& image) { return image; }

RowStatistics MeasureWith(const StereoRectifier& rectifier, const std::vector<RawPair>& pairs) {
  const StereoMatches matches = MatchAll(
      pairs, [&](const cv::Mat& image) { return rectifier.Left(image); },
      [&](const cv::Mat& image) { return rectifier.Right(image); });
  return Measure(matches, pairs.front().left.size());
}

/// Another reading of the same file.
struct Guess {
  StereoRig rig;
  bool exchanges_images = false;
  std::string what;  ///< it would be, and what to do
};

std::vector<Guess> Guesses(const StereoRig& rig) {
  std::vector<Guess> guesses;
  guesses.push_back(
      {rig, true, "left and right images are exchanged: give them the other way round"});
  for (const double factor : {0.5, 2.0, 2.0 / 3, 1.5, 0.75, 4.0 / 3}) {
    Guess guess{rig, false,
                "the calibration seems to be one for images " + Brief(factor) +
                    " times as large: --scale-calibration"};
    const auto [width, height] = std::make_pair(rig.left.width, rig.left.height);
    guess.rig.left = Scaled(rig.left, 1 / factor);
    guess.rig.right = Scaled(rig.right, 1 / factor);
    guess.rig.left.width = guess.rig.right.width = width;
    guess.rig.left.height = guess.rig.right.height = height;
    guesses.push_back(guess);
  }
  return guesses;
}

/// What another reading of the file would be better than the one that was taken, or empty.
std::string BetterReading(const StereoRig& rig, const std::vector<RawPair>& pairs,
                          const RigCheck& check) {
  if (check.before.median_px < kGoodRowPx &&
      check.before.median_px < kClearlyBetter * check.after.median_px) {
    return "as they are, rows agree to " + Brief(check.before.median_px) +
           " px: the images are rectified already: --rectified";
  }
  std::string best;
  double best_px = std::min(kGoodRowPx, kClearlyBetter * check.after.median_px);
  for (const Guess& guess : Guesses(rig)) {
    std::vector<RawPair> images = pairs;
    if (guess.exchanges_images) {
      for (RawPair& pair : images) std::swap(pair.left, pair.right);
    }
    try {
      const RowStatistics statistics = MeasureWith(StereoRectifier(guess.rig), images);
      if (statistics.num_matches >= kMinMatches && statistics.median_px < best_px &&
          statistics.share_negative < 1 - kExchangedShare) {
        best_px = statistics.median_px;
        best = guess.what + " (rows would agree to " + Brief(best_px) + " px)";
      }
    } catch (const InputError&) {
      continue;  // no rectified image that way
    }
  }
  return best;
}

std::string WorstRegion(const RowStatistics& statistics) {
  static const char* const kNames[] = {"top left",    "top middle",    "top right",
                                       "left",        "middle",        "right",
                                       "bottom left", "bottom middle", "bottom right"};
  const auto worst = std::max_element(statistics.region_px.begin(), statistics.region_px.end());
  return std::string(kNames[worst - statistics.region_px.begin()]) + " (" + Brief(*worst) + " px)";
}

}  // namespace

RigCheck MeasureRig(const StereoRectifier& rectifier, const std::vector<RawPair>& pairs) {
  RigCheck check;
  if (pairs.empty()) return check;
  check.before = Measure(MatchAll(pairs, Same, Same), pairs.front().left.size());
  check.after = MeasureWith(rectifier, pairs);
  return check;
}

void JudgeRigCheck(const StereoRig& rig, const std::vector<RawPair>& pairs, const RigCheck& check,
                   const std::string& where, FindingList* findings) {
  const RowStatistics& after = check.after;
  if (after.num_matches < kMinMatches) {
    findings->Warn(
        "rig.few_matches", where,
        "only " + std::to_string(after.num_matches) +
            " matches between left and right: whether the calibration fits is not known");
    return;
  }
  if (after.share_negative > kExchangedShare) {
    findings->Fail("rig.swapped", where,
                   Percent(after.share_negative) +
                       " of the disparities are negative: left and right images are exchanged");
    return;
  }
  if (after.median_px <= kGoodRowPx) {
    findings->Note("rig.fits", where,
                   "the calibration fits: rows differ by " + Brief(after.median_px) +
                       " px (median), " + Brief(check.before.median_px) + " px before");
    return;
  }
  const std::string reading = BetterReading(rig, pairs, check);
  findings->Fail("rig.rows", where,
                 "after rectification the rows still differ by " + Brief(after.median_px) +
                     " px (median), most at the " + WorstRegion(after) +
                     (reading.empty() ? "; the calibration is of another camera or lens, or left "
                                        "and right were not taken at one time"
                                      : "; " + reading));
}

}  // namespace airdos
