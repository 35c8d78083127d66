#ifndef AIRDOS_COMMON_FEATURES_POSE_SEARCH_H_
#define AIRDOS_COMMON_FEATURES_POSE_SEARCH_H_

#include <optional>
#include <vector>

#include "common/features/landmark_judge.h"
#include "common/features/landmark_matcher.h"
#include "common/features/landmark_sighting.h"
#include "common/features/local_map.h"
#include "common/features/pose_estimator.h"
#include "common/features/stereo_frame.h"
#include "common/features/visual_odometry_options.h"
#include "common/geometry/se3.h"

namespace airdos {

/// A possible camera pose, and the matches of landmarks with corners of the left image under it.
struct PoseHypothesis {
  Se3 T_W_C;
  std::vector<LandmarkMatch> matches;  ///< inliers only
  int num_inliers = 0;
};

/// A hypothesis refined by measuring its landmarks to a fraction of a pixel.
struct MeasuredPose {
  PoseHypothesis hypothesis;
  SightedLandmarks seen;  ///< looked_for is empty if nothing supports the hypothesis
  PoseEstimate estimate;  ///< from seen.sightings, in their order
  double score = 0;       ///< see ScorePose()
};

/// Searches for the pose of one frame against the local map. There are two hypotheses: the
/// predicted pose, corrected by landmarks found near their projections; and one from descriptors
/// matched anywhere in the image (AP3P in RANSAC), which needs no prediction. If they differ, both
/// are measured, and the one supported by more trusted landmarks wins. All poses are T_W_C, with W
/// as the map has it. Frame, map and judge are only read, and must outlive the search.
class PoseSearch {
 public:
  PoseSearch(const VisualOdometryOptions& options, const StereoFrame& frame, const LocalMap& map,
             const LandmarkJudge& judge)
      : options_(options), frame_(frame), map_(map), judge_(judge) {}

  /// The better of the two hypotheses. If at least rich_observations support the first, the second
  /// is not tried. If nothing is found, the pose is that of the prior.
  MeasuredPose FindBest(const PosePrior& prior) const;

  /// The pose from sightings and prior, each landmark weighted by its trust.
  PoseEstimate Estimate(const std::vector<LandmarkSighting>& sightings, const Se3& start,
                        const PosePrior& prior) const;

 private:
  /// Matches near the projections from `start` and estimates the pose, in ever narrower circles.
  PoseHypothesis TrackFrom(const Se3& start, const ProjectionSearch& first,
                           const std::optional<PosePrior>& prior) const;
  /// From descriptors alone, against the landmarks last seen in the newest frames that saw any.
  std::optional<Se3> Relocate() const;
  /// Measures the landmarks of the hypothesis, and estimates the pose from them.
  MeasuredPose Measure(PoseHypothesis hypothesis, const PosePrior& prior) const;
  PoseEstimate EstimateFromMatches(const std::vector<LandmarkMatch>& matches, const Se3& start,
                                   const std::optional<PosePrior>& prior) const;

  const VisualOdometryOptions& options_;
  const StereoFrame& frame_;
  const LocalMap& map_;
  const LandmarkJudge& judge_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_POSE_SEARCH_H_
