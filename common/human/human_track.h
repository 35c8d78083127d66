#ifndef AIRDOS_COMMON_HUMAN_HUMAN_TRACK_H_
#define AIRDOS_COMMON_HUMAN_HUMAN_TRACK_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/human/appearance.h"
#include "common/human/body_keypoints.h"
#include "common/util/ids.h"

namespace airdos {

/// How a person may move and change between frames.
struct HumanTrackOptions {
  double motion_sigma_per_height = 0.15;         ///< of the predicted joints
  double motion_sigma_growth_per_height = 0.03;  ///< added for each frame without a detection
  double max_motion_per_height = 0.6;            ///< beyond it, it is somebody else
  double max_motion_growth_per_height = 0.05;    ///< added for each frame without a detection
  double disparity_sigma_px = 0.8;               ///< of a person's median disparity
  double depth_sigma = 0.1;                      ///< relative change of depth from frame to frame
  double depth_sigma_growth = 0.04;
  double appearance_sigma = 0.3;  ///< of AppearanceDistance()
  double unknown_appearance_cost = 1;
  double appearance_rate = 0.2;
  double velocity_rate = 0.5;
  double min_confidence = 0.1;
  KeypointNoise noise;
};

/// A person seen in the left image, or in both.
struct PersonDetection {
  BodyKeypoints left;
  std::optional<double> disparity_px;  ///< median; nothing if only the left image shows the person
  double height_px = 0;                ///< of the person standing; set only with disparity_px
  std::optional<Appearance> appearance;
};

/// What is remembered of one person from frame to frame. Positions are px in the left image: the
/// camera's pose is not known here.
class HumanTrack {
 public:
  HumanTrack(const HumanTrackOptions& options, HumanId id, const PersonDetection& first);

  /// Moves the joints into the next image. `flow_px[joint]` is where optical flow found the joint.
  /// A joint that it did not find moves with the rest of the person or, if flow lost the whole
  /// person, with the camera's shift and the person's own velocity.
  void Predict(const std::array<std::optional<Eigen::Vector2d>, kNumJoints>& flow_px,
               const Eigen::Vector2d& shift_px);
  /// Where Predict() would move a joint without optical flow.
  Eigen::Vector2d Guess(std::size_t joint, const Eigen::Vector2d& shift_px) const;

  /// How badly a detection fits the predicted person: the sum of squared errors of motion, depth
  /// and appearance, in sigmas. Nothing if it cannot be the same person.
  std::optional<double> Cost(const PersonDetection& detection) const;

  /// The terms of Cost() that do not depend on the position in the image: depth and appearance.
  double LooksCost(const PersonDetection& detection) const;
  /// Median over the joints of the detection's position minus the track's, px; nothing if they
  /// share too few joints.
  std::optional<Eigen::Vector2d> Displacement(const PersonDetection& detection) const;

  /// Whether the detection has its sides exchanged in this way, compared with the predicted joints:
  /// whether exchanging them lowers the sum of squared errors, in sigmas, by at least `min_gain`.
  bool HasSwap(const BodyKeypoints& left, SideSwap swap, double min_gain) const;

  /// Takes in a detection whose sides are correct.
  void Observe(const PersonDetection& detection, const Eigen::Vector2d& shift_px);
  void Miss() { ++num_missed_; }

  HumanId id() const { return id_; }
  int num_seen() const { return num_seen_; }
  const Eigen::Vector2d& velocity_px() const { return velocity_px_; }
  int num_missed() const { return num_missed_; }  ///< frames since the last detection
  double disparity_px() const { return disparity_px_; }
  double height_px() const { return height_px_; }  ///< of the person standing, in the image
  /// Joints in the left image, predicted or seen; confidence 0 means unknown.
  const BodyKeypoints& left() const { return left_; }
  /// Whether the last Predict() had optical flow for this joint.
  bool is_carried(std::size_t joint) const { return is_carried_[joint]; }

 private:
  std::optional<double> MedianDistance(const BodyKeypoints& other) const;

  HumanTrackOptions options_;
  HumanId id_;
  int num_seen_ = 1;
  int num_missed_ = 0;
  BodyKeypoints left_;
  BodyKeypoints previous_left_;  // in the previous image
  std::array<bool, kNumJoints> is_carried_{};
  double disparity_px_;
  double height_px_;
  Eigen::Vector2d velocity_px_ = Eigen::Vector2d::Zero();  // per frame, without the camera's shift
  Appearance appearance_;
  bool has_appearance_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_HUMAN_TRACK_H_
