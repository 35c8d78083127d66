#ifndef AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_H_
#define AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_H_

#include <deque>
#include <vector>

#include "common/features/camera_motion_filter.h"
#include "common/features/feature_extractor.h"
#include "common/features/landmark_judge.h"
#include "common/features/landmark_sighting.h"
#include "common/features/local_map.h"
#include "common/features/people_pose.h"
#include "common/features/pose_estimator.h"
#include "common/features/pose_search.h"
#include "common/features/stereo_frame.h"
#include "common/features/visual_odometry_options.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/people_filter.h"

namespace airdos {

/// What the pose of a frame stands on.
enum class TrackingState {
  kInitializing,  ///< nothing yet: the pose is that of W
  kTracking,      ///< enough landmarks
  kWeak,          ///< few landmarks, with the prediction and people beside them
  kCoasting,      ///< the prediction alone, or people
};

/// The result of one frame.
struct OdometryFrame {
  TrackingState state = TrackingState::kInitializing;
  Se3 T_W_C;  ///< W as the corrections so far have it
  Se3 T_O_C;  ///< the motions from frame to frame, one after the other: no correction moves it
  double prior_sigma_position_m = 0;  ///< of constant velocity: by how much it may change a frame
  double prior_sigma_orientation_rad = 0;
  int num_people = 0;  ///< who had a say in the pose
  int num_detected = 0;
  int num_masked = 0;
  int num_matched = 0;
  std::vector<LandmarkSighting> sightings;  ///< ordered by id
};

/// Stereo odometry against a local map. The pose is searched for around a constant-velocity
/// prediction (pose_search.h); what moves is not trusted (landmark_judge.h). It never resets:
/// without support it coasts on the prediction and keeps matching the whole map. W is the first
/// left camera.
///
/// Where static landmarks are few, people help: each is predicted to keep its velocity, and where
/// the camera sees them constrains its pose, as far as they can be relied on.
class VisualOdometry {
 public:
  /// Landmarks are numbered from `first_id` on.
  explicit VisualOdometry(const VisualOdometryOptions& options, LandmarkId first_id = {1})
      : options_(options),
        extractor_(options.extractor),
        map_(options.map, first_id),
        motion_(options.motion),
        people_(options.people) {}

  OdometryFrame Process(const StereoCamera& camera, const StereoImagePair& images);
  /// A frame without usable images: coasts.
  OdometryFrame Coast(FrameId id, double time_s);
  void Apply(const MapCorrection& correction);

  const LocalMap& map() const { return map_; }

 private:
  struct FrameTime {
    FrameId id;
    double time_s;
  };
  /// Where the camera should be, by its motion so far.
  struct Prediction {
    double step_s;  ///< from the last frame
    PosePrior prior;
  };

  // The steps of Process(), in order; each fills in its part of the result.

  /// The criteria of a stereo match in this frame: stricter where landmarks abound.
  FeatureStereoMatcherOptions StereoOptions() const;
  /// Camera and people keep their velocities.
  Prediction PredictMotion(double time_s, OdometryFrame* result);
  /// The prior, corrected by people if static landmarks were few in the last frame.
  PeoplePose CorrectByPeople(const std::vector<HumanMeasurement>& people,
                             const PosePrior& prior) const;
  /// The measured pose. If static landmarks turn out to be many, it is estimated again without
  /// people, and their information is dropped.
  PoseEstimate EstimateFinalPose(const PoseSearch& search, const MeasuredPose& measured,
                                 const PosePrior& prior, PeoplePose* people) const;
  /// Accepts the pose and the sightings that agree with it. If too few do, or the prior contradicts
  /// it, coasts: the prior's pose and no sightings.
  void AcceptOrCoast(const std::vector<LandmarkSighting>& sightings, const PosePrior& prior,
                     PoseEstimate* estimate, OdometryFrame* result);
  /// `information` is that of the frame's own measurements, without the prior.
  void UpdateMotion(const Prediction& predicted, const Matrix6d& information,
                    const OdometryFrame& result);
  /// Adds the motion since the last frame to T_O_C.
  void Remember(FrameId id, double time_s, OdometryFrame* result);
  /// Judges which landmarks are static, thins out the sightings, updates the landmarks seen,
  /// creates new ones where there is room, and culls.
  void UpdateMap(const StereoFrame& frame, const std::vector<LandmarkId>& looked_for,
                 OdometryFrame* result);

  /// Seconds from the last frame; a step as before where the clock stands still or jumps.
  double StepTo(double time_s) const;
  const Se3& LastPose() const { return map_.poses_W_C().at(recent_.back().id); }
  /// Few landmarks that agree by chance can put the camera anywhere: such a pose must be one that
  /// the prior allows.
  bool IsBelievable(const PoseEstimate& estimate, const PosePrior& prior) const;
  TrackingState StateOf(int num_inliers) const;

  const VisualOdometryOptions options_;
  FeatureExtractor extractor_;
  LocalMap map_;
  CameraMotionFilter motion_;
  PeopleFilter people_;
  LandmarkJudge judge_;
  Se3 T_O_C_;                     // of the last frame
  int num_static_ = 0;            // inliers of the last frame
  bool is_started_ = false;       // a landmark was created: W lies still
  std::deque<FrameTime> recent_;  // the last two frames, newest last
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_H_
