#ifndef AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_H_
#define AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_H_

#include <cstdint>
#include <deque>
#include <memory>
#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "common/features/camera_motion_filter.h"
#include "common/features/feature_extractor.h"
#include "common/features/feature_stereo_matcher.h"
#include "common/features/landmark_judge.h"
#include "common/features/landmark_matcher.h"
#include "common/features/local_map.h"
#include "common/features/people_pose.h"
#include "common/features/pose_estimator.h"
#include "common/geometry/stereo_camera.h"
#include "common/human/people_filter.h"

namespace airdos {

struct VisualOdometryOptions {
  FeatureExtractorOptions extractor;
  FeatureStereoMatcherOptions stereo;
  /// So many static landmarks are plenty (about half of max_observations). Where the last frame
  /// held them there is a choice, and only better stereo matches are taken: with doubtful ones
  /// paths came out half a percent too long (KITTI). Where they agree with one pose no other is
  /// tried.
  int rich_observations = 150;
  double rich_min_correlation = 0.95;
  LocalMapOptions map;
  double wide_radius_px = 30;     ///< first search around the constant-velocity prediction
  int wide_max_hamming = 64;      ///< bits
  int narrow_max_hamming = 90;    ///< bits
  int min_inliers_tracking = 20;  ///< fewer: STATE_WEAK
  int min_inliers_weak = 1;       ///< fewer: STATE_COASTING
  double min_correlation = 0.8;   ///< of a landmark's patch with the image
  double aligned_sigma_px = 0.2;  ///< of an aligned patch at level 0; grows with the level
  double corner_sigma_px = 0.7;   ///< of a corner whose patch did not align
  int max_observations = 300;     ///< of landmarks a frame
  int observation_cell_px = 16;   ///< at most two observed landmarks in each cell of this size
  CameraMotionFilterOptions motion;
  PeopleFilterOptions people;
  int max_static_for_people = 15;  ///< with so many static landmarks people have no say
};

enum class TrackingState { kInitializing, kTracking, kWeak, kCoasting };

/// One stereo frame; images are CV_8UC1 of the camera's size.
struct StereoImagePair {
  FrameId id;
  double time_s = 0;  ///< capture time
  cv::Mat left;
  cv::Mat right;
  cv::Mat mask;  ///< of the left image, not 0 = no static feature may come from here; or empty
  std::vector<PersonMeasurement> people;  ///< in view; empty where people are not to be used
};

struct LandmarkSighting {
  LandmarkId id;
  Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
  bool has_right = false;
  double sigma_px = 1;
};

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

/// Stereo odometry against a local map: the constant-velocity prediction and a descriptor search
/// over the whole image are two hypotheses for the pose; where they differ each is measured, every
/// landmark found again to a fraction of a pixel by its own patch, and the one is kept that more
/// trusted landmarks agree with. Where very many agree with the first the second is spared. What
/// moves is not trusted: see LandmarkJudge. It never resets: without support it coasts on the
/// prediction and goes on matching the whole map. W is the first left camera.
///
/// Where static landmarks are few, people help: each moves on with the velocity it had, and where
/// the camera sees them says where the camera is, as far as they can be relied on.
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
  struct View;  // what is computed once for a frame

  struct Hypothesis {
    Se3 T_W_C;
    std::vector<LandmarkMatch> matches;
    int num_inliers = 0;
  };

  /// A hypothesis, measured to a fraction of a pixel.
  struct Tracking {
    Hypothesis hypothesis;
    std::vector<LandmarkSighting> sightings;
    std::vector<LandmarkId> tried;
    PoseEstimate estimate;
    double score = 0;
  };

  /// What a match must fulfil in this frame: more where landmarks abound.
  FeatureStereoMatcherOptions StereoOptions() const;
  /// Seconds from the last frame; a step as before where the clock stands still or jumps.
  double StepTo(double time_s) const;
  PosePrior Predict(double step_s) const;
  /// People, as long as static landmarks were few in the last frame.
  std::vector<PersonConstraint> Constraints(const StereoImagePair& images,
                                            const PosePrior& prior) const;
  /// The better of two hypotheses.
  Tracking Track(const View& view, const PosePrior& prior) const;
  Hypothesis TrackFrom(const View& view, const Se3& start, const ProjectionSearch& first,
                       const std::optional<PosePrior>& prior) const;
  std::optional<Se3> Relocate(const View& view) const;
  PoseEstimate EstimateFromMatches(const View& view, const std::vector<LandmarkMatch>& matches,
                                   const Se3& start, const std::optional<PosePrior>& prior) const;
  PoseEstimate EstimateFromSightings(const StereoCamera& camera,
                                     const std::vector<LandmarkSighting>& sightings,
                                     const Se3& start, const PosePrior& prior) const;
  void DescribePrior(double step_s, OdometryFrame* frame) const;
  /// Finds the landmarks of the hypothesis to a fraction of a pixel; the pose from them.
  Tracking Measure(const View& view, Hypothesis hypothesis, const PosePrior& prior) const;
  /// `tried`: the landmarks that should be in view and were looked for.
  std::vector<LandmarkSighting> Sight(const View& view, const Hypothesis& hypothesis,
                                      std::vector<LandmarkId>* tried) const;
  std::optional<LandmarkSighting> SightOne(const View& view, const VisibleLandmark& visible,
                                           const Feature* feature) const;
  std::vector<LandmarkSighting> KeepSpread(std::vector<LandmarkSighting> sightings) const;
  /// Judges, moves on and makes landmarks once the frame's pose is known.
  void UpdateMap(const View& view, const std::vector<LandmarkId>& tried, OdometryFrame* frame);
  void UpdateLandmarks(const View& view, const Se3& T_W_C,
                       const std::vector<LandmarkSighting>& sightings);
  void CreateLandmarks(const View& view, const Se3& T_W_C, const TrustField& field,
                       std::vector<LandmarkSighting>* sightings);
  Eigen::Matrix3d CreatedCovariance(const StereoCamera& camera, const Se3& T_W_C,
                                    const Eigen::Vector3d& p_C, double sigma_px) const;
  /// Also gives the frame its T_O_C.
  void Remember(FrameId id, double time_s, OdometryFrame* frame);
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
  Se3 T_O_C_;                                      // of the last frame
  int num_static_ = 0;                             // inliers of the last frame
  bool is_started_ = false;                        // a landmark was created: W lies still
  std::deque<std::pair<FrameId, double>> recent_;  // frame and time, newest last
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_FEATURES_VISUAL_ODOMETRY_H_
