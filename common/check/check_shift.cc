#include "common/check/check_shift.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/check/stereo_matches.h"
#include "common/util/quantile.h"

namespace airdos {
namespace {

constexpr int kMaxCorners = 800;
constexpr int kMaxShift = 2;  // frames
constexpr std::size_t kNumShifts = 2 * kMaxShift + 1;
constexpr double kMinMotionPx = 0.7;  // less motion between two images is not informative
constexpr std::size_t kMinMatches = 25;

/// How well left image k matches right image k + shift.
struct Fit {
  std::size_t num_matches = 0;
  double row_error_px = 0;  // median
};

struct Place {
  std::string where_left;
  std::array<std::string, kNumShifts> where_right;
  std::array<Fit, kNumShifts> fits;
  std::size_t best = kMaxShift;  // index of the shift that fits clearly better, or of no shift
};

double MedianAbsolute(std::vector<double> values) {
  for (double& value : values) value = std::abs(value);
  return Quantile(std::move(values), 0.5);
}

double MotionPx(const cv::Mat& before, const cv::Mat& after) {
  const StereoMatches matches = MatchStereo(before, after, kMaxCorners);
  std::vector<double> steps_px;
  for (std::size_t i = 0; i < matches.left.size(); ++i)
    steps_px.push_back(cv::norm(matches.left[i] - matches.right[i]));
  return Quantile(steps_px, 0.5);
}

/// At most half the row error, and more matches.
bool IsClearlyBetter(const Fit& fit, const Fit& unshifted) {
  constexpr double kMinGainPx = 0.3;
  return fit.num_matches >= kMinMatches && fit.num_matches > unshifted.num_matches &&
         fit.row_error_px < 0.5 * unshifted.row_error_px &&
         fit.row_error_px < unshifted.row_error_px - kMinGainPx;
}

/// Nothing if pictures are missing or the camera stands still.
std::optional<Place> LookAt(const std::vector<CheckedPictures>& window) {
  const cv::Mat& left = window[kMaxShift].left;
  for (const CheckedPictures& pictures : window) {
    if (pictures.right.empty() || pictures.right.size() != left.size()) return std::nullopt;
  }
  const cv::Mat& next = window[kMaxShift + 1].left;
  if (next.size() != left.size() || MotionPx(left, next) < kMinMotionPx) return std::nullopt;
  Place place;
  place.where_left = window[kMaxShift].where_left;
  for (std::size_t i = 0; i < kNumShifts; ++i) {
    const StereoMatches matches = MatchStereo(left, window[i].right, kMaxCorners);
    place.where_right[i] = window[i].where_right;
    place.fits[i] = {matches.left.size(), MedianAbsolute(matches.RowDifferences())};
  }
  for (std::size_t i = 0; i < kNumShifts; ++i) {
    if (!IsClearlyBetter(place.fits[i], place.fits[kMaxShift])) continue;
    if (place.best == kMaxShift || place.fits[i].row_error_px < place.fits[place.best].row_error_px)
      place.best = i;
  }
  return place;
}

std::string FitText(const Place& place, std::size_t index) {
  return place.where_right[index] + " (rows differ by " + Brief(place.fits[index].row_error_px) +
         " px, " + std::to_string(place.fits[index].num_matches) + " matches)";
}

}  // namespace

bool CheckShift(const CheckedInput& input, std::size_t num_places, FindingList* findings) {
  const std::size_t num_frames = input.utimes().size();
  if (num_frames < kNumShifts) return false;
  FindingList ignored;  // the check of the pictures has reported them
  std::vector<Place> places;
  for (const std::size_t start : SampleEvenly(num_frames - kNumShifts + 1, num_places)) {
    std::vector<std::size_t> frames;
    for (std::size_t i = 0; i < kNumShifts; ++i) frames.push_back(start + i);
    const std::optional<Place> place = LookAt(input.Load(frames, &ignored));
    if (place) places.push_back(*place);
  }
  std::array<std::size_t, kNumShifts> votes = {};
  for (const Place& place : places) ++votes[place.best];
  const auto best = static_cast<std::size_t>(
      std::distance(votes.begin(), std::max_element(votes.begin(), votes.end())));
  if (best == kMaxShift || 2 * votes[best] <= places.size()) return false;
  const auto example = std::find_if(places.begin(), places.end(),
                                    [&](const Place& place) { return place.best == best; });
  const int shift = static_cast<int>(best) - kMaxShift;
  findings->Fail(
      "images.shifted", input.name(),
      std::string("the right images are ") + (std::abs(shift) == 1 ? "one frame" : "two frames") +
          (shift > 0 ? " late" : " early") + ": " + example->where_left + " fits " +
          FitText(*example, best) + " better than " + FitText(*example, kMaxShift) + "; in " +
          std::to_string(votes[best]) + " of " + std::to_string(places.size()) +
          " places where the camera moves; were the recorders started separately?");
  return true;
}

}  // namespace airdos
