#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_WINDOW_MAP_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_WINDOW_MAP_H_

#include <map>
#include <optional>
#include <set>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/optimization/bundle/bundle_problem.h"
#include "common/optimization/window/frame_input.h"

namespace airdos {

/// Size of the window and limits of the WindowMap.
struct WindowMapOptions {
  int window_frames = 12;             ///< newest frames, whose poses are free
  int max_fixed_key_frames = 8;       ///< older frames that hold the window in place
  int min_shared_landmarks = 15;      ///< a key frame needs this many in common with the window
  double key_frame_max_shared = 0.6;  ///< a frame that shares less with the last key frame is kept
  int key_frame_interval = 5;         ///< frames; at the latest then one is kept
  int max_key_frames = 60;            ///< in memory
  int forget_after_frames = 200;      ///< applies to a landmark that no kept frame sees
  double min_disparity_px = 0.5;      ///< below it an observation cannot start a landmark
  /// An observation rejected in this many adjustments in a row is dropped for good.
  int max_rejections = 2;
};

/// The optimizer's memory of the static scene: recent frames, key frames and static landmarks, in
/// W. Selects those of the next bundle adjustment and takes back its result. Its size is bounded by
/// the options.
class WindowMap {
 public:
  /// A landmark seen in a frame.
  struct Observation {
    Eigen::Vector3d uvu_px = Eigen::Vector3d::Zero();
    bool has_right = true;
    double sigma_px = 1;
    int num_rejections = 0;  ///< consecutive adjustments that rejected it
  };
  /// A frame in memory.
  struct Frame {
    double time_s = 0;
    Se3 T_W_C;
    bool is_first = false;  ///< defines W
    std::map<LandmarkId, Observation> observations;
  };
  /// A static landmark in memory.
  struct Landmark {
    std::optional<Eigen::Vector3d> p_W;  ///< nothing before the first stereo observation
    std::set<FrameId> frames;            ///< kept frames that see it
    FrameId last_seen;
    std::optional<Eigen::Vector3d> published_p_W;
    int num_dropped = 0;  ///< observations dropped for good
  };

  explicit WindowMap(const WindowMapOptions& options) : options_(options) {}

  /// Adds the newest frame at T_W_C, the best pose known so far. The oldest frame leaves the window
  /// and becomes a key frame or is forgotten. Ids must increase. A landmark seen twice in the frame
  /// counts once; observations of recently removed landmarks are ignored.
  void AddFrame(const StereoCamera& camera, const FrameInput& input, const Se3& T_W_C);

  /// The adjustment over the window: its frames are free, and the key frames that see most of the
  /// same landmarks are fixed. It has the landmarks seen by at least two of these frames, one of
  /// them in the window. The first frame stays fixed as long as it is in the window; if no frame
  /// would be fixed, the window's oldest is.
  BundleProblem BuildProblem(const StereoCamera& camera) const;

  /// Takes back poses, landmarks and rejected observations. Returns the landmarks that turned out
  /// to be bad and were removed, sorted.
  std::vector<LandmarkId> Absorb(const BundleProblem& problem);

  /// Ids of the window's frames, oldest first.
  const std::vector<FrameId>& window() const { return window_; }
  const std::map<FrameId, Frame>& frames() const { return frames_; }
  const std::map<LandmarkId, Landmark>& landmarks() const { return landmarks_; }
  void SetPose(FrameId id, const Se3& T_W_C) { frames_.at(id).T_W_C = T_W_C; }
  /// Records that the landmark's current position has been published.
  void MarkPublished(LandmarkId id) { landmarks_.at(id).published_p_W = landmarks_.at(id).p_W; }

 private:
  void AddObservation(const StereoCamera& camera, FrameId id, const StaticObservation& feature);
  void RetireOldest();
  void ForgetFrame(FrameId id);
  void ForgetLandmarks(FrameId newest);
  int NumShared(const Frame& a, const Frame& b) const;
  std::vector<FrameId> ChooseFixedFrames() const;
  bool IsBad(const Landmark& landmark) const;

  WindowMapOptions options_;
  std::vector<FrameId> window_;      // oldest first
  std::vector<FrameId> key_frames_;  // older than the window, oldest first
  std::map<FrameId, Frame> frames_;  // window and key frames
  std::map<LandmarkId, Landmark> landmarks_;
  std::map<LandmarkId, FrameId> removed_;  // bad landmarks, and when they were removed
  int frames_since_key_frame_ = 0;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_WINDOW_MAP_H_
