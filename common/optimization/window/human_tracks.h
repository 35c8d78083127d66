#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_HUMAN_TRACKS_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_HUMAN_TRACKS_H_

#include <array>
#include <map>
#include <optional>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/human/skeleton.h"
#include "common/optimization/bundle/bundle_problem.h"
#include "common/optimization/window/frame_input.h"
#include "common/optimization/window/segment_lengths.h"

namespace airdos {

/// Limits of the optimizer's memory of people.
struct HumanTracksOptions {
  int window_frames = 8;          ///< newest frames whose people are adjusted
  int forget_after_frames = 100;  ///< then the lengths of an unseen person are forgotten
  double min_disparity_px = 0.5;  ///< a joint with less has no depth and is left out
  double max_depth_m = 60;
};

/// One person in one frame, as optimized.
struct HumanState {
  /// A joint's position in W.
  struct JointPosition {
    int joint = 0;  ///< COCO-18
    Eigen::Vector3d p_W = Eigen::Vector3d::Zero();
    Eigen::Vector3d p_W_measured = Eigen::Vector3d::Zero();  ///< as triangulated, same camera
  };
  /// A segment's length.
  struct SegmentLength {
    int segment = 0;  ///< index into kSegments
    double length_m = 0;
  };
  HumanId id;
  FrameId frame;
  double time_s = 0;
  std::vector<JointPosition> joints;
  std::vector<SegmentLength> segments;
  std::vector<BundleProblem::PartMotion> motions;
};

/// The optimizer's memory of people: what the last frames showed of each, and what all frames have
/// measured of their segment lengths (see SegmentLengths). Joints are kept in camera coordinates,
/// so that they follow when poses are corrected.
class HumanTracks {
 public:
  explicit HumanTracks(const HumanTracksOptions& options) : options_(options) {}

  /// Adds the newest frame. Joints without depth are left out.
  void AddFrame(const StereoCamera& camera, const FrameInput& input);

  /// Fills `problem->humans` from the newest frames, which `problem->frames` must hold.
  void AddTo(BundleProblem* problem) const;
  /// Takes joints back from a solved problem, relative to its cameras. Joints that ended up behind
  /// the camera or impossibly far away are not taken, and neither are lengths: those come from the
  /// measurements of all frames.
  void Absorb(const BundleProblem& problem);

  /// Everyone seen in `frame` (one of frames()), with `T_W_C` as its camera and the motions of
  /// `problem`. Joints whose reprojection was rejected are left out.
  std::vector<HumanState> Describe(FrameId frame, const Se3& T_W_C,
                                   const BundleProblem& problem) const;
  /// The frames in memory, oldest first.
  const std::vector<FrameId>& frames() const { return frames_; }
  /// Whether the next frame pushes out the oldest one.
  bool is_full() const { return static_cast<int>(frames_.size()) == options_.window_frames; }

 private:
  /// A joint in one frame.
  struct Joint {
    Eigen::Vector3d uvu_px;
    Eigen::Matrix3d covariance_px2;
    Eigen::Vector3d p_C;           ///< as triangulated, then as optimized
    Eigen::Vector3d p_C_measured;  ///< as triangulated
    bool is_rejected = false;      ///< by the last adjustment
  };
  /// One track.
  struct Person {
    std::map<FrameId, std::map<int, Joint>> sightings;  // of the frames in memory
    SegmentLengths lengths;                             // from all frames
    SegmentLengths lengths_before_window;               // from frames that have left memory
    FrameId last_seen;
  };

  static std::map<int, MeasuredJoint> MeasuredJoints(const StereoCamera& camera,
                                                     const std::map<int, Joint>& joints);

  HumanTracksOptions options_;
  std::vector<FrameId> frames_;
  std::map<FrameId, double> times_s_;
  std::map<HumanId, Person> people_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_HUMAN_TRACKS_H_
