#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_SLIDING_WINDOW_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_SLIDING_WINDOW_H_

#include <deque>
#include <optional>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/optimization/bundle/bundle_adjuster.h"
#include "common/optimization/window/frame_input.h"
#include "common/optimization/window/human_tracks.h"
#include "common/optimization/window/track_noise.h"
#include "common/optimization/window/trust_rule.h"
#include "common/optimization/window/window_map.h"

namespace airdos {

/// How the camera's own motion enters the adjustment.
struct CameraMotionOptions {
  bool use_acceleration = true;  ///< factor between three consecutive frames
  /// Its sigma, relative to the one with which the frontend predicts the newest frame (a generous
  /// one). A frontend that sends none gets no factor.
  double sigma_factor = 0.6;
};

/// Settings of the SlidingWindowOptimizer and its parts.
struct SlidingWindowOptions {
  WindowMapOptions map;
  BundleOptions bundle;  ///< `use_people` is set by people.mode: on
  CameraMotionOptions camera_motion;
  HumanTracksOptions people;  ///< its window is limited to that of the map
  TrustOptions trust;
  bool learn_track_noise = true;  ///< how steadily each person moves, see track_noise.h
  double publish_moved_m = 1e-4;  ///< a landmark that moved less is not reported again
};

/// The optimizer's answer for the newest frame.
struct FrameEstimate {
  /// How the pose was obtained.
  enum class Status { kFirstFrame, kConverged, kNotConverged, kPredicted };
  FrameId id;
  Status status = Status::kPredicted;
  Se3 T_W_C;                               ///< the one below that is trusted
  Matrix6d covariance = Matrix6d::Zero();  ///< of its tangent, see common/geometry/se3.h
  bool trusts_people = false;
  Se3 T_W_C_without_people;
  Se3 T_W_C_with_people;  ///< the same as without if people are off or not in view
  int num_window_frames = 0;
  int num_static_landmarks = 0;     ///< in the adjustment
  int num_static_observations = 0;  ///< of the newest frame
  BundleSummary summary;
};

/// What one frame changed in the map, in W.
struct MapChanges {
  /// A camera pose in the window.
  struct FramePose {
    FrameId id;
    double time_s = 0;
    Se3 T_W_C;
  };
  /// A static landmark.
  struct Landmark {
    LandmarkId id;
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    double sigma_m = 0;  ///< along the worst direction, given the poses
    int num_observations = 0;
  };
  std::vector<FramePose> frames;    ///< the window, newest last
  std::vector<Landmark> landmarks;  ///< new or moved, sorted by id
  std::vector<LandmarkId> removed;  ///< bad ones, sorted
  /// Everyone in the newest frame. Reported once more, refined, when that frame is the oldest in
  /// the people's window.
  std::vector<HumanState> humans;
};

/// The answer for one frame and the changes to the map.
struct FrameResult {
  FrameEstimate estimate;
  MapChanges changes;
};

/// Bundle adjustment on every frame over a co-visibility window (paper, eq. 6). A plain library: no
/// messages, no clock; the same inputs give bit-identical results.
///
/// A frame with people in view is adjusted twice: over the static scene alone, and then, starting
/// from that result, together with people (over the people's shorter window, with older poses
/// fixed). The rule in trust_rule.h decides which camera pose is believed, and the window continues
/// from it. People's joints always come from the adjustment with people, relative to its camera.
///
/// The newest frame starts at the last optimized pose moved by the frontend's odometry; a frame
/// without odometry, or the first one after a restart of the frontend, starts from constant
/// velocity. A frame that sees no static landmark of the map keeps that start value as its answer
/// (kPredicted), unless people determine the pose.
class SlidingWindowOptimizer {
 public:
  SlidingWindowOptimizer(const SlidingWindowOptions& options, const StereoCamera& camera);

  /// Frames must come in increasing order of their ids.
  FrameResult Process(const FrameInput& input);

 private:
  /// A pose of the trajectory.
  struct TimedPose {
    FrameId id;
    double time_s;
    Se3 T_W_C;
  };

  /// Estimates how steadily each person in the problem moves, and where a track switched to another
  /// person, as seen from a camera whose newest pose has this covariance.
  void LearnTrackNoise(const Matrix6d& camera_covariance, BundleProblem* problem) const;
  /// Predicted pose of the newest frame relative to an older one.
  struct Prediction {
    FrameId base;
    Se3 T_Cbase_C;
  };

  Prediction Predict(const FrameInput& input) const;
  /// The optimized pose; the frame must be in trajectory_.
  const Se3& PoseOf(FrameId id) const;
  /// Adjusts without and with people, fills the estimate and takes the trusted result into the map.
  /// `prediction` is used if the newest frame sees nothing static. Returns the bad landmarks.
  std::vector<LandmarkId> Adjust(const Prediction& prediction, FrameEstimate* estimate);
  /// The adjustment with people, starting from the solved one without.
  BundleProblem ProblemWithPeople(const BundleProblem& without_people,
                                  const Matrix6d& camera_covariance, bool is_static_strong) const;
  void AddAccelerations(BundleProblem* problem) const;
  void LearnCarrier(const FrameInput& input);
  /// Copies the window's poses to the trajectory.
  void UpdateTrajectory();
  MapChanges CollectChanges(std::vector<LandmarkId> removed);
  MapChanges::Landmark DescribeLandmark(LandmarkId id) const;

  SlidingWindowOptions options_;
  StereoCamera camera_;
  WindowMap map_;
  HumanTracks people_;
  BundleProblem problem_;              // the last one with people
  std::vector<double> solver_memory_;  // only capacity for the next solve
  std::deque<TimedPose> trajectory_;   // the last frames as optimized, oldest first
  FrameId odometry_frame_;             // the last one with odometry
  FrameId odometry_start_;             // of its O
  std::optional<Se3> T_O_C_;
  std::optional<AccelerationSigma> carrier_;  // how the camera moves, according to the frontend
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_SLIDING_WINDOW_H_
