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

struct CameraMotionOptions {
  bool use_acceleration = true;  ///< factor between three consecutive frames of the window
  /// Its sigma, of the one that the front end predicts the newest frame with (which is generous). A
  /// front end that gives none gets no factor.
  double sigma_factor = 0.6;
};

struct SlidingWindowOptions {
  WindowMapOptions map;
  BundleOptions bundle;  ///< `use_people` is the switch people: on
  CameraMotionOptions camera_motion;
  HumanTracksOptions people;  ///< its window is cut to that of the map
  TrustOptions trust;
  bool learn_track_noise = true;  ///< how steadily each person moves, see track_noise.h
  double publish_moved_m = 1e-4;  ///< a landmark that moved less is not reported again
};

/// The optimizer's answer about the newest frame.
struct FrameEstimate {
  enum class Status { kFirstFrame, kConverged, kNotConverged, kPredicted };
  FrameId id;
  Status status = Status::kPredicted;
  Se3 T_W_C;                               ///< the trusted one of the two below
  Matrix6d covariance = Matrix6d::Zero();  ///< of its tangent, see common/geometry/se3.h
  bool trusts_people = false;
  Se3 T_W_C_without_people;
  Se3 T_W_C_with_people;  ///< equals the one without where people are off or not in view
  int num_window_frames = 0;
  int num_static_landmarks = 0;     ///< in the adjustment
  int num_static_observations = 0;  ///< of the newest frame
  BundleSummary summary;
};

/// What one frame changed in the map, in W.
struct MapChanges {
  struct FramePose {
    FrameId id;
    double time_s = 0;
    Se3 T_W_C;
  };
  struct Landmark {
    LandmarkId id;
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    double sigma_m = 0;  ///< standard deviation along the worst direction, poses taken as known
    int num_observations = 0;
  };
  std::vector<FramePose> frames;    ///< the window, newest last
  std::vector<Landmark> landmarks;  ///< new or moved, sorted by id
  std::vector<LandmarkId> removed;  ///< bad and gone, sorted
  /// Everyone in the newest frame, and once more, refined, when that frame is the oldest of the
  /// people's window.
  std::vector<HumanState> humans;
};

struct FrameResult {
  FrameEstimate estimate;
  MapChanges changes;
};

/// Bundle adjustment on every frame over a co-visibility window (paper, eq. 6). A plain library: no
/// messages, no clock; the same inputs give the same answers bit by bit.
///
/// Each frame is adjusted twice where people are in view: over the static scene alone, and from
/// that result again together with people (over the people's shorter window; older poses held). The
/// rule of trust_rule.h says which camera is believed; the window goes on from it. People's joints
/// always come from the adjustment with people, relative to its camera.
///
/// The newest frame starts at the last optimized pose moved by the front end's odometry; a frame
/// without odometry, or the first one of a front end that was started again, at constant velocity.
/// A frame that sees no static landmark of the map keeps that start as its answer (kPredicted)
/// unless people carry it.
class SlidingWindowOptimizer {
 public:
  SlidingWindowOptimizer(const SlidingWindowOptions& options, const StereoCamera& camera);

  /// Frames must come in order of their ids.
  FrameResult Process(const FrameInput& input);

 private:
  struct TimedPose {
    FrameId id;
    double time_s;
    Se3 T_W_C;
  };

  /// How steadily each person of the problem moves, and where a track became somebody else's, as
  /// seen from a camera whose newest pose is known that well.
  void LearnTrackNoise(const Matrix6d& camera_covariance, BundleProblem* problem) const;
  /// Where the newest frame should be, seen from an older one.
  struct Prediction {
    FrameId base;
    Se3 T_Cbase_C;
  };

  Prediction Predict(const FrameInput& input) const;
  /// As optimized; the frame must be one of those in trajectory_.
  const Se3& PoseOf(FrameId id) const;
  /// Adjusts without and with people; fills the estimate and takes the trusted result into the map.
  /// `prediction` stands in where the newest frame sees nothing static. Returns the bad landmarks.
  std::vector<LandmarkId> Adjust(const Prediction& prediction, FrameEstimate* estimate);
  /// The adjustment together with people, from the solved one without.
  BundleProblem ProblemWithPeople(const BundleProblem& without_people,
                                  const Matrix6d& camera_covariance, bool is_static_strong) const;
  void AddAccelerations(BundleProblem* problem) const;
  void LearnCarrier(const FrameInput& input);
  /// The poses of the window into the trajectory.
  void UpdateTrajectory();
  MapChanges CollectChanges(std::vector<LandmarkId> removed);
  MapChanges::Landmark DescribeLandmark(LandmarkId id) const;

  SlidingWindowOptions options_;
  StereoCamera camera_;
  WindowMap map_;
  HumanTracks people_;
  BundleProblem problem_;              // the last one with people
  std::vector<double> solver_memory_;  // no values: capacity for the next solve
  std::deque<TimedPose> trajectory_;   // the last frames, oldest first, as optimized
  FrameId odometry_frame_;             // the last one with odometry
  FrameId odometry_start_;             // of its O
  std::optional<Se3> T_O_C_;
  std::optional<AccelerationSigma> carrier_;  // how the front end says that the camera moves
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_SLIDING_WINDOW_H_
