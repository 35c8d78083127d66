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

struct HumanTrackerOptions {
  double gate = 12;            ///< sum of squared errors, in sigmas, up to which it is one person
  double left_only_gate = 6;   ///< the same where there is no disparity to compare
  int max_missed_frames = 10;  ///< after as many frames without a detection a track ends
  int min_seen_to_report = 1;  ///< detections of a person before it is reported
  int min_joints = 4;          ///< with fewer joints a person is not reported
  bool use_left_only = true;   ///< report people whom only the left detections have
  int max_carried_frames = 1;  ///< report people by optical flow for as many missed frames
  double carried_sigma_factor = 1.5;
  double min_swap_gain = 20;  ///< squared errors, in sigmas, that exchanging sides must save
  double min_swap_gain_doubtful = 3;  ///< the same where left and right detection disagree on sides
  bool use_shift_vote = true;         ///< let the people tell how far the camera turned
  PersonPairingOptions matcher;
  JointTriangulatorOptions triangulator;
  ImageFlowOptions flow;
  HumanTrackOptions track;
};

/// One stereo frame. Images may be empty: then the keypoints must do alone.
struct PeopleFrame {
  cv::Mat left_gray;   ///< CV_8UC1
  cv::Mat left_color;  ///< CV_8UC3, for appearance
  cv::Mat right_gray;
  std::vector<BodyKeypoints> left;  ///< in no particular order
  std::vector<BodyKeypoints> right;
};

struct TrackedHuman {
  HumanId id;
  JointObservations joints;
};

struct TrackedFrame {
  std::vector<TrackedHuman> humans;  ///< sorted by id
  int num_rejected = 0;  ///< detections, left and right, that matched nobody or had no usable shape
};

/// Who is where in each stereo frame: pairs the people of the two images, finds again whom it knows
/// (optical flow, motion, depth, appearance) and triangulates their joints in the left camera C. It
/// knows nothing of the camera's pose. The same frames always give the same result.
class HumanTracker {
 public:
  /// People are numbered from `first_id` on.
  explicit HumanTracker(const HumanTrackerOptions& options, HumanId first_id = {1});

  TrackedFrame Process(const StereoCamera& camera, const PeopleFrame& frame);

 private:
  struct Observation;

  void PredictTracks();
  std::vector<Observation> Observe(const StereoCamera& camera, const PeopleFrame& frame,
                                   const PersonPairing& pairing) const;
  // For each observation the track it belongs to.
  std::vector<std::optional<int>> FindTracks(const std::vector<Observation>& observations) const;
  void Associate(const std::vector<Observation>& observations, bool is_stereo, double gate,
                 std::vector<bool>* is_track_taken, std::vector<std::optional<int>>* tracks) const;
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
  Eigen::Vector2d shift_px_ = Eigen::Vector2d::Zero();  // of the image since the last frame
  HumanId next_id_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_HUMAN_TRACKER_H_
