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

/// Where the camera may be, and which corners of the left image are which landmarks if it is there.
struct PoseHypothesis {
  Se3 T_W_C;
  std::vector<LandmarkMatch> matches;  ///< that agree with it
  int num_inliers = 0;
};

/// A hypothesis measured to a fraction of a pixel.
struct MeasuredPose {
  PoseHypothesis hypothesis;
  SightedLandmarks seen;  ///< looked_for is empty where nothing supports the hypothesis
  PoseEstimate estimate;  ///< from seen.sightings, in their order
  double score = 0;       ///< see ScorePose()
};

/// Searches the pose of one frame against the local map. There are two hypotheses: the predicted
/// pose, corrected by the landmarks found around their projections; and one from descriptors
/// matched anywhere in the image (AP3P in RANSAC), which needs no prediction. Where they differ
/// both are measured, and the one is kept that more trusted landmarks agree with. All poses are
/// T_W_C, W as the map has it. Nothing is changed. What it is given must outlive it.
class PoseSearch {
 public:
  PoseSearch(const VisualOdometryOptions& options, const StereoFrame& frame, const LocalMap& map,
             const LandmarkJudge& judge)
      : options_(options), frame_(frame), map_(map), judge_(judge) {}

  /// The better of the two. Where rich_observations agree with the first the second is spared;
  /// where nothing is found its pose is the prior's.
  MeasuredPose FindBest(const PosePrior& prior) const;

  /// The pose that the sightings and the prior say together, each landmark weighted by its trust.
  PoseEstimate Estimate(const std::vector<LandmarkSighting>& sightings, const Se3& start,
                        const PosePrior& prior) const;

 private:
  /// Matches around the projections from `start`, estimates, and again in narrower circles.
  PoseHypothesis TrackFrom(const Se3& start, const ProjectionSearch& first,
                           const std::optional<PosePrior>& prior) const;
  /// From descriptors alone, against the landmarks of the last frames that saw any.
  std::optional<Se3> Relocate() const;
  /// Finds the landmarks of the hypothesis to a fraction of a pixel; the pose from them.
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
