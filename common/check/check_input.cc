#include "common/check/check_input.h"

#include <algorithm>

#include "common/check/check_axes.h"
#include "common/check/check_camera.h"
#include "common/check/check_pairs.h"
#include "common/check/check_people.h"
#include "common/check/check_shift.h"
#include "common/check/check_stereo.h"
#include "common/check/check_times.h"

namespace airdos {

void CheckedInput::ReportTimes(FindingList* findings) const {
  CheckTimes(utimes(), where_times(), findings);
}

std::vector<std::size_t> SampleEvenly(std::size_t size, std::size_t count) {
  std::vector<std::size_t> sample;
  if (count >= size) {
    for (std::size_t i = 0; i < size; ++i) sample.push_back(i);
  } else if (count == 1) {
    sample.push_back(0);
  } else {
    for (std::size_t i = 0; i < count; ++i) sample.push_back(i * (size - 1) / (count - 1));
  }
  return sample;
}

std::vector<std::size_t> SampleOfPictures(std::size_t num_frames, const CheckOptions& options) {
  // A recording often stands still at its ends, which hides errors of the times.
  if (options.is_quick() && num_frames > 3) return {num_frames / 3, 2 * num_frames / 3};
  return SampleEvenly(num_frames, options.all ? num_frames : options.max_frames);
}

std::vector<std::size_t> SampleOfPeople(std::size_t num_frames, const CheckOptions& options) {
  constexpr std::size_t kQuickPeople = 20;
  constexpr std::size_t kManyPeople = 200;
  return SampleEvenly(num_frames, options.is_quick() ? kQuickPeople
                                  : options.all      ? num_frames
                                                     : kManyPeople);
}

namespace {

void CheckPictures(const CheckedInput& input, const CheckOptions& options, StereoCheck* stereo,
                   FindingList* findings) {
  MaskCheck masks(input.camera());
  const std::vector<std::size_t> sample = SampleOfPictures(input.utimes().size(), options);
  // In batches: a log is read once per batch, and pictures are large.
  constexpr std::size_t kPortion = 50;
  for (std::size_t first = 0; first < sample.size(); first += kPortion) {
    const std::size_t end = std::min(first + kPortion, sample.size());
    const std::vector<std::size_t> frames(sample.begin() + static_cast<std::ptrdiff_t>(first),
                                          sample.begin() + static_cast<std::ptrdiff_t>(end));
    for (const CheckedPictures& pictures : input.Load(frames, findings)) {
      if (!pictures.left.empty() && !pictures.right.empty()) {
        stereo->Add(pictures.where_left, pictures.left, pictures.where_right, pictures.right,
                    findings);
      }
      masks.Add(pictures, findings);
    }
  }
  masks.Report(input.name(), findings);
  if (!options.is_quick() && sample.size() < input.utimes().size()) {
    findings->Note("frames.looked_at", input.name(),
                   "pictures of " + std::to_string(sample.size()) + " of " +
                       std::to_string(input.utimes().size()) +
                       " frames were checked (--all checks all)");
  }
}

void CheckPairs(const CheckedInput& input, const CheckOptions& options, FindingList* findings) {
  PeoplePairCheck pairs(input.camera());
  for (const StereoPeople& people :
       input.LoadPeople(SampleOfPeople(input.utimes().size(), options))) {
    pairs.Add(people);
  }
  pairs.Report(input.name(), findings);
}

}  // namespace

void CheckFrames(const CheckedInput& input, const CheckOptions& options, FindingList* findings) {
  CheckCamera(input.camera(), input.where_camera(), findings);
  input.ReportTimes(findings);

  StereoCheck stereo(input.camera());
  CheckPictures(input, options, &stereo, findings);
  constexpr double kDoubtfulRowsPx = 0.4;
  constexpr std::size_t kPlaces = 5;
  const bool may_be_shifted = !options.is_quick() || stereo.row_error_px() > kDoubtfulRowsPx;
  if (may_be_shifted && CheckShift(input, kPlaces, findings)) stereo.SetShiftKnown();
  stereo.Report(input.name(), findings);
  CheckPairs(input, options, findings);
  if (!options.is_quick()) CheckGroundTruth(input, options.odometry_frames, findings);
}

}  // namespace airdos
