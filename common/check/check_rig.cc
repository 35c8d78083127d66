#include "common/check/check_rig.h"

#include <algorithm>
#include <cmath>
#include <tuple>

#include "common/calibration/camera_causes.h"
#include "common/check/stereo_matches.h"
#include "common/util/error.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr int kMaxCorners = 1500;
constexpr int kMinMatches = 30;  // fewer tell nothing
constexpr int kMinRegionMatches = 8;
constexpr int kMinPairMatches = 15;
constexpr double kFairRowPx = 0.5;  // good calibrations come to 0.1 to 0.4
constexpr double kMaxRowPx = 1;
constexpr double kClearlyBetter = 0.5;   // of the row error
constexpr double kClearlyWorse = 3;      // than in other pairs
constexpr double kExchangedShare = 0.8;  // of the disparities are negative
constexpr double kNoSignPx = 0.3;

/// The matches of each pair after `map_left` and `map_right` changed its images.
template <class Left, class Right>
std::vector<StereoMatches> MatchAll(const std::vector<RawPair>& pairs, const Left& map_left,
                                    const Right& map_right) {
  std::vector<StereoMatches> all;
  for (const RawPair& pair : pairs)
    all.push_back(MatchStereo(map_left(pair.left), map_right(pair.right), kMaxCorners));
  return all;
}

std::vector<double> AbsoluteRows(const StereoMatches& matches) {
  std::vector<double> rows_px = matches.RowDifferences();
  for (double& row_px : rows_px) row_px = std::abs(row_px);
  return rows_px;
}

/// Which ninth of the image.
std::size_t RegionOf(const cv::Point2f& at, cv::Size size) {
  const auto third = [](float value, int length) {
    return std::clamp(static_cast<int>(3 * value / static_cast<float>(length)), 0, 2);
  };
  return static_cast<std::size_t>(3 * third(at.y, size.height) + third(at.x, size.width));
}

RowStatistics Measure(const std::vector<StereoMatches>& pairs, cv::Size size) {
  RowStatistics statistics;
  std::vector<double> all_px;
  std::array<std::vector<double>, 9> regions_px;
  int num_negative = 0;
  int num_signed = 0;
  for (const StereoMatches& matches : pairs) {
    const std::vector<double> rows_px = AbsoluteRows(matches);
    all_px.insert(all_px.end(), rows_px.begin(), rows_px.end());
    if (static_cast<int>(rows_px.size()) >= kMinPairMatches)
      statistics.pair_px.push_back(Quantile(rows_px, 0.5));
    for (std::size_t i = 0; i < rows_px.size(); ++i)
      regions_px[RegionOf(matches.left[i], size)].push_back(rows_px[i]);
    for (const double disparity_px : matches.Disparities()) {
      if (std::abs(disparity_px) > kNoSignPx) ++num_signed;
      if (disparity_px < -kNoSignPx) ++num_negative;
    }
  }
  statistics.num_matches = static_cast<int>(all_px.size());
  statistics.median_px = Quantile(all_px, 0.5);
  statistics.share_negative = num_signed > 0 ? static_cast<double>(num_negative) / num_signed : 0;
  for (std::size_t i = 0; i < regions_px.size(); ++i) {
    if (static_cast<int>(regions_px[i].size()) >= kMinRegionMatches)
      statistics.region_px[i] = Quantile(regions_px[i], 0.5);
  }
  return statistics;
}

cv::Mat Same(const cv::Mat& image) { return image; }

RowStatistics MeasureWith(const StereoRectifier& rectifier, const std::vector<RawPair>& pairs) {
  return Measure(MatchAll(
                     pairs, [&](const cv::Mat& image) { return rectifier.Left(image); },
                     [&](const cv::Mat& image) { return rectifier.Right(image); }),
                 pairs.front().left.size());
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
  if (rig.are_images_rectified) return guesses;
  if (rig.is_lens_assumed) {
    Guess guess{rig, false, "the coefficients seem to be of cv::fisheye: --lens fisheye"};
    guess.rig.left.lens = guess.rig.right.lens = LensModel::kFisheye;
    guesses.push_back(guess);
  }
  for (const double factor : {0.5, 2.0, 2.0 / 3, 1.5, 0.75, 4.0 / 3}) {
    // Taken for images of another size, then fitted to these.
    const auto [width, height] = std::make_pair(rig.left.width, rig.left.height);
    const std::pair<int, int> calibrated = {static_cast<int>(std::lround(width * factor)),
                                            static_cast<int>(std::lround(height * factor))};
    Guess guess{rig, false,
                "the calibration seems to be one for images " + TimesAsLarge(factor) + " (" +
                    std::to_string(calibrated.first) + "x" + std::to_string(calibrated.second) +
                    " px): --size and --scale-calibration"};
    for (CameraIntrinsics* camera : {&guess.rig.left, &guess.rig.right}) {
      std::tie(camera->width, camera->height) = calibrated;
      *camera = Resized(*camera, {width, height});
    }
    guesses.push_back(guess);
  }
  return guesses;
}

/// What another reading of the file would be better than the one that was taken, or empty.
std::string BetterReading(const StereoRig& rig, const std::vector<RawPair>& pairs,
                          const RigCheck& check) {
  if (!rig.are_images_rectified && check.before.median_px < kMaxRowPx &&
      check.before.median_px < kClearlyBetter * check.after.median_px) {
    return "as they are, rows agree to " + Brief(check.before.median_px) +
           " px: the images are rectified already: --rectified";
  }
  std::string best;
  double best_px = std::min(kMaxRowPx, kClearlyBetter * check.after.median_px);
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

/// "0.2 px in some pairs, 4 px in others" where the rows agree in some pairs only, which no
/// calibration does; otherwise empty.
std::string SomePairsOnly(const RowStatistics& statistics) {
  constexpr std::size_t kMinPairs = 4;
  if (statistics.pair_px.size() < kMinPairs) return "";
  const double good_px = Quantile(statistics.pair_px, 0.1);
  const double bad_px = Quantile(statistics.pair_px, 0.9);
  if (good_px > kMaxRowPx || bad_px < std::max(kMaxRowPx, kClearlyWorse * good_px)) return "";
  return Brief(good_px) + " px in some pairs, " + Brief(bad_px) + " px in others";
}

constexpr char kNotAtOneTime[] =
    "left and right images were not all taken at one time, or a camera has moved";

/// What else is wrong where no other reading of the file helps.
std::string OtherCause(const StereoRig& rig, const RowStatistics& after) {
  const std::string some_pairs = SomePairsOnly(after);
  if (!some_pairs.empty()) return std::string(kNotAtOneTime) + " (" + some_pairs + ")";
  if (rig.are_images_rectified) {
    return "the file is for rectified images, these are not, or not by the same calibration";
  }
  return "the calibration is of another camera or lens, or left and right were not taken at one "
         "time";
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
  if (after.median_px <= kFairRowPx) {
    findings->Note("rig.fits", where,
                   "the calibration fits: rows differ by " + Brief(after.median_px) +
                       " px (median), " + Brief(check.before.median_px) + " px before");
    const std::string some_pairs = SomePairsOnly(after);
    if (!some_pairs.empty()) {
      findings->Warn("rig.times", where,
                     "rows differ by " + some_pairs + ": " + std::string(kNotAtOneTime));
    }
    return;
  }
  const std::string reading = BetterReading(rig, pairs, check);
  findings->Add(after.median_px > kMaxRowPx ? Severity::kError : Severity::kWarning, "rig.rows",
                where,
                "after rectification the rows still differ by " + Brief(after.median_px) +
                    " px (median), most at the " + WorstRegion(after) + "; " +
                    (reading.empty() ? OtherCause(rig, after) : reading));
}

}  // namespace airdos
