#ifndef AIRDOS_COMMON_HUMAN_HUMAN_TRACKER_H_
#define AIRDOS_COMMON_HUMAN_HUMAN_TRACKER_H_

#include <opencv2/core.hpp>
#include <optional>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/human/human_track.h"
#include "common/human/image_flow.h"
#include "common/human/joint_triangulator.h"
#include "common/human/person_pairing.h"
#include "common/util/ids.h"

namespace airdos {

/// Settings of the HumanTracker.
struct HumanTrackerOptions {
  /// Sum of squared errors up to which it is one person; the same where there is no disparity to
  /// compare.
  double max_squared_sigmas = 12;
  double left_only_max_squared_sigmas = 6;
  int max_missed_frames = 10;  ///< a track ends after this many without a detection
  int min_seen_to_report = 1;  ///< detections of a person before it is reported
  int min_joints = 4;          ///< with fewer joints a person is not reported
  bool use_left_only = true;   ///< report people whom only the left detections have
  int max_carried_frames = 1;  ///< missed frames in which optical flow stands in
  double carried_sigma_factor = 1.5;
  /// Squared errors that exchanging sides must save; the same where left and right detection
  /// disagree on sides.
  double min_swap_gain_squared_sigmas = 20;
  double min_doubtful_swap_gain_squared_sigmas = 3;
  bool use_shift_vote = true;  ///< let the people tell how far the camera turned
  PersonPairingOptions matcher;
  JointTriangulatorOptions triangulator;
  ImageFlowOptions flow;
  HumanTrackOptions track;
};

/// One stereo frame. Images may be empty: then only the keypoints are used.
struct PeopleFrame {
  cv::Mat left_gray;   ///< CV_8UC1
  cv::Mat left_color;  ///< CV_8UC3, for appearance
  cv::Mat right_gray;
  std::vector<BodyKeypoints> left;  ///< in no particular order
  std::vector<BodyKeypoints> right;
};

/// A person in the current frame, with triangulated joints.
struct TrackedHuman {
  HumanId id;
  JointObservations joints;
};

/// The people of one frame.
struct TrackedFrame {
  std::vector<TrackedHuman> humans;  ///< sorted by id
  int num_rejected = 0;  ///< detections, left and right, without a match or usable shape
};

/// Tracks people over stereo frames: pairs the detections of the two images, recognises people seen
/// before (optical flow, motion, depth, appearance) and triangulates their joints in the left
/// camera C. It does not use the camera's pose. The same frames always give the same result.
class HumanTracker {
 public:
  /// People are numbered from `first_id` upwards.
  explicit HumanTracker(const HumanTrackerOptions& options, HumanId first_id = {1});

  TrackedFrame Process(const StereoCamera& camera, const PeopleFrame& frame);

 private:
  struct Observation;

  void PredictTracks();
  std::vector<Observation> Observe(const StereoCamera& camera, const PeopleFrame& frame,
                                   const PersonPairing& pairing) const;
  // For each observation, the track that it belongs to.
  std::vector<std::optional<int>> FindTracks(const std::vector<Observation>& observations) const;
  void Associate(const std::vector<Observation>& observations, bool is_stereo,
                 double max_squared_sigmas, std::vector<bool>* is_track_taken,
                 std::vector<std::optional<int>>* tracks) const;
  SideSwap FindSwap(const Observation& observation, const HumanTrack& track) const;
  std::optional<TrackedHuman> Update(const StereoCamera& camera, const StereoImages& images,
                                     Observation observation, HumanTrack* track) const;
  std::optional<TrackedHuman> Start(const StereoCamera& camera, const StereoImages& images,
                                    const Observation& observation);
  std::optional<TrackedHuman> Carry(const StereoCamera& camera, const StereoImages& images,
                                    const HumanTrack& track) const;
  JointObservations Triangulate(const StereoCamera& camera, const StereoImages& images,
                                const Observation& observation, double disparity_px) const;
  bool IsReported(const JointObservations& joints, int num_seen) const;

  HumanTrackerOptions options_;
  ImageFlow flow_;
  std::vector<HumanTrack> tracks_;                      // sorted by id
  Eigen::Vector2d shift_px_ = Eigen::Vector2d::Zero();  // shift of the image since the last frame
  HumanId next_id_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_HUMAN_TRACKER_H_
