#include "common/check/check_input.h"

#include <algorithm>

#include "common/check/check_axes.h"
#include "common/check/check_camera.h"
#include "common/check/check_people.h"
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

void CheckFrames(const CheckedInput& input, const CheckOptions& options, FindingList* findings) {
  CheckCamera(input.camera(), input.where_camera(), findings);
  input.ReportTimes(findings);

  StereoCheck stereo(input.camera());
  MaskCheck masks(input.camera());
  const std::vector<std::size_t> sample = SampleEvenly(input.utimes().size(), options.max_frames);
  // In portions: a log is read once for each, and pictures are large.
  constexpr std::size_t kPortion = 50;
  for (std::size_t first = 0; first < sample.size(); first += kPortion) {
    const std::size_t end = std::min(first + kPortion, sample.size());
    const std::vector<std::size_t> frames(sample.begin() + static_cast<std::ptrdiff_t>(first),
                                          sample.begin() + static_cast<std::ptrdiff_t>(end));
    for (const CheckedPictures& pictures : input.Load(frames, findings)) {
      if (!pictures.left.empty() && !pictures.right.empty()) {
        stereo.Add(pictures.where_left, pictures.left, pictures.where_right, pictures.right,
                   findings);
      }
      masks.Add(pictures, findings);
    }
  }
  stereo.Report(input.name(), findings);
  masks.Report(input.name(), findings);
  CheckGroundTruth(input, options.odometry_frames, findings);
}

}  // namespace airdos
