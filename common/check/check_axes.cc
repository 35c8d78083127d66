#include "common/check/check_axes.h"

#include <algorithm>
#include <opencv2/imgproc.hpp>

#include "common/evaluation/ground_truth_axes.h"
#include "common/features/visual_odometry.h"

namespace airdos {
namespace {

constexpr std::size_t kMinFrames = 8;    // fewer poses do not determine the axes
constexpr double kMinPath_m = 0.3;       // a shorter path does not determine the scale
constexpr double kPlausibleScale = 1.3;  // either way; short odometry is accurate to a few %

std::string NameOf(TrajectoryAxes axes) {
  switch (axes) {
    case TrajectoryAxes::kOptical:
      return "optical";
    case TrajectoryAxes::kNed:
      return "NED";
    case TrajectoryAxes::kUnknown:
      break;
  }
  return "unknown";
}

/// First of the consecutive frames, all with ground truth, over which the camera travels farthest.
std::optional<std::size_t> FarthestWindow(const std::vector<std::optional<Se3>>& poses,
                                          std::size_t size) {
  if (size == 0) return std::nullopt;
  std::optional<std::size_t> best;
  double best_path_m = -1;
  for (std::size_t first = 0; first + size <= poses.size(); ++first) {
    double path_m = 0;
    bool is_whole = poses[first].has_value();
    for (std::size_t i = first + 1; i < first + size && is_whole; ++i) {
      is_whole = poses[i].has_value();
      if (is_whole) path_m += (poses[i]->translation - poses[i - 1]->translation).norm();
    }
    if (!is_whole || path_m <= best_path_m) continue;
    best_path_m = path_m;
    best = first;
  }
  return best;
}

TrajectoryPose ToTrajectoryPose(const Se3& pose, std::int64_t utime) {
  return {1e-6 * static_cast<double>(utime), pose.rotation.toRotationMatrix(), pose.translation};
}

/// Odometry and ground truth over the given frames; empty if the pictures do not allow it.
MatchedTrajectories RunOdometry(const CheckedInput& input, const std::vector<std::size_t>& frames) {
  FindingList ignored;  // the check of the pictures has reported them
  VisualOdometry odometry{VisualOdometryOptions()};
  const cv::Mat mask_margin = cv::Mat::ones(17, 17, CV_8UC1);  // px, as in the frontend
  MatchedTrajectories matched;
  const cv::Size size(input.camera().width, input.camera().height);
  std::size_t i = 0;
  for (const CheckedPictures& pictures : input.Load(frames, &ignored)) {
    const std::size_t frame = frames[i++];
    if (pictures.left.size() != size || pictures.right.size() != size) return {};
    StereoImagePair pair;
    pair.id = FrameId{static_cast<std::int64_t>(frame)};
    pair.time_s = 1e-6 * static_cast<double>(input.utimes()[frame]);
    pair.left = pictures.left;
    pair.right = pictures.right;
    if (pictures.mask.pixels.size() == size)
      cv::dilate(pictures.mask.pixels, pair.mask, mask_margin);
    const OdometryFrame result = odometry.Process(input.camera(), pair);
    if (result.state == TrackingState::kCoasting) continue;
    matched.estimate.push_back(ToTrajectoryPose(result.T_W_C, input.utimes()[frame]));
    matched.ground_truth.push_back(
        ToTrajectoryPose(*input.ground_truth()[frame], input.utimes()[frame]));
  }
  return matched;
}

void CompareAxes(const CheckedInput& input, const MatchedTrajectories& matched,
                 FindingList* findings) {
  const std::string where = input.where_ground_truth();
  const AxesDecision decision = DetectAxes(matched);
  const std::string said = NameOf(input.ground_truth_axes());
  if (!decision.is_known) {
    findings->Note(
        "ground_truth.axes", where,
        said + " by the layout; a short visual odometry does not tell: " + decision.Explain());
    return;
  }
  bool is_as_said = decision.axes.Name() == said;
  bool is_right_handed = decision.axes.is_right_handed();
  for (const GroundTruthAxes& other : decision.alternatives) {
    is_as_said = is_as_said || other.Name() == said;
    is_right_handed = is_right_handed || other.is_right_handed();
  }
  if (!is_right_handed) {
    findings->Fail("ground_truth.handedness", where,
                   "left-handed: visual odometry goes the mirrored way: " + decision.Explain());
  } else if (input.ground_truth_axes() == TrajectoryAxes::kUnknown) {
    findings->Warn("ground_truth.axes", where,
                   "not those of the layout; visual odometry says " + decision.Explain());
  } else if (!is_as_said) {
    findings->Warn("ground_truth.axes", where,
                   said + " by the layout, but visual odometry says " + decision.Explain());
  } else {
    findings->Note("ground_truth.axes", where, said + ", and visual odometry agrees");
  }
}

/// Length of the path in steps of ten frames, m; the noise of single steps would make it longer.
double Travel(const std::vector<TrajectoryPose>& poses) {
  constexpr std::size_t kStride = 10;
  const std::size_t stride = std::min(kStride, poses.size() - 1);
  double travel_m = 0;
  for (std::size_t i = stride; i < poses.size(); ++i) {
    travel_m += (poses[i].position_m - poses[i - stride].position_m).norm();
  }
  const auto num_strides = static_cast<double>(poses.size() - stride);
  return travel_m / num_strides * static_cast<double>(poses.size() - 1) /
         static_cast<double>(stride);
}

void CompareLengths(const CheckedInput& input, const MatchedTrajectories& matched,
                    FindingList* findings) {
  const double odometry_m = Travel(matched.estimate);
  const double truth_m = Travel(matched.ground_truth);
  if (odometry_m < kMinPath_m || truth_m <= 0) return;
  const double ratio = truth_m / odometry_m;
  const std::string paths = "a path of " + Brief(truth_m) + " m, of which visual odometry makes " +
                            Brief(odometry_m) + " m";
  if (ratio > 5 || ratio < 0.2) {
    findings->Fail("ground_truth.scale", input.where_ground_truth(),
                   paths + ": is the ground truth, or the baseline, in another unit than m?");
  } else if (ratio > kPlausibleScale || ratio < 1 / kPlausibleScale) {
    findings->Warn("ground_truth.scale", input.where_ground_truth(), paths);
  } else {
    findings->Note("ground_truth.scale", input.where_ground_truth(), paths);
  }
}

}  // namespace

void CheckGroundTruth(const CheckedInput& input, std::size_t num_frames, FindingList* findings) {
  const std::vector<std::optional<Se3>>& poses = input.ground_truth();
  const auto num_poses =
      std::count_if(poses.begin(), poses.end(), [](const auto& pose) { return pose.has_value(); });
  if (num_poses == 0) {
    findings->Note("ground_truth.count", input.name(), "no ground truth");
    return;
  }
  if (static_cast<std::size_t>(num_poses) != poses.size()) {
    findings->Warn(
        "ground_truth.count", input.where_ground_truth(),
        std::to_string(num_poses) + " of " + std::to_string(poses.size()) + " frames have a pose");
  }
  const std::size_t size = std::min(num_frames, poses.size());
  const std::optional<std::size_t> first = FarthestWindow(poses, size);
  MatchedTrajectories matched;
  if (size >= kMinFrames && first) {
    std::vector<std::size_t> frames;
    for (std::size_t i = 0; i < size; ++i) frames.push_back(*first + i);
    matched = RunOdometry(input, frames);
  }
  if (matched.estimate.size() < kMinFrames) {
    findings->Note(
        "ground_truth.axes", input.where_ground_truth(),
        NameOf(input.ground_truth_axes()) + " by the layout; not compared with visual odometry");
    return;
  }
  CompareAxes(input, matched, findings);
  CompareLengths(input, matched, findings);
}

}  // namespace airdos
