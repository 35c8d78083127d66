#ifndef AIRDOS_COMMON_HUMAN_HUMAN_TRACK_H_
#define AIRDOS_COMMON_HUMAN_HUMAN_TRACK_H_

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "common/human/appearance.h"
#include "common/human/body_keypoints.h"
#include "common/util/ids.h"

namespace airdos {

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
  std::optional<double> disparity_px;  ///< median; nothing where only the left image has the person
  double height_px = 0;                ///< of the person standing; with disparity_px only
  std::optional<Appearance> appearance;
};

/// What is kept of one person from frame to frame. Positions are px in the left image: the pose of
/// the camera is not known here.
class HumanTrack {
 public:
  HumanTrack(const HumanTrackOptions& options, HumanId id, const PersonDetection& first);

  /// Moves the joints into the next image. `flow_px[joint]` is where optical flow found the joint;
  /// where it did not, the joint goes with the rest of the person, or, if flow lost the person,
  /// with the camera's shift and the person's own velocity.
  void Predict(const std::array<std::optional<Eigen::Vector2d>, kNumJoints>& flow_px,
               const Eigen::Vector2d& shift_px);
  /// Where Predict() would move a joint without flow.
  Eigen::Vector2d Guess(std::size_t joint, const Eigen::Vector2d& shift_px) const;

  /// How badly a detection fits the predicted person: squared errors in sigmas of motion, depth and
  /// appearance. Nothing where it cannot be the same person.
  std::optional<double> Cost(const PersonDetection& detection) const;

  /// The part of Cost() that does not depend on where the person is in the image: depth and
  /// appearance.
  double LooksCost(const PersonDetection& detection) const;
  /// Median over the joints of where the detection is less where the track is, px; nothing where
  /// they share too few joints.
  std::optional<Eigen::Vector2d> Displacement(const PersonDetection& detection) const;

  /// Whether the detection has sides exchanged in this way, judged by the predicted joints: whether
  /// exchanging them saves `min_gain` of the sum of squared errors in sigmas.
  bool HasSwap(const BodyKeypoints& left, SideSwap swap, double min_gain) const;

  /// Takes a detection whose sides are right.
  void Observe(const PersonDetection& detection, const Eigen::Vector2d& shift_px);
  void Miss() { ++num_missed_; }

  HumanId id() const { return id_; }
  int num_seen() const { return num_seen_; }
  const Eigen::Vector2d& velocity_px() const { return velocity_px_; }
  int num_missed() const { return num_missed_; }  ///< frames since the last detection
  double disparity_px() const { return disparity_px_; }
  double height_px() const { return height_px_; }  ///< of the person standing, in the image
  /// Joints in the left image, predicted or seen; confidence 0 = unknown.
  const BodyKeypoints& left() const { return left_; }
  /// Whether the last Predict() had optical flow for the joint.
  bool is_carried(std::size_t joint) const { return is_carried_[joint]; }

 private:
  std::optional<double> MedianDistance(const BodyKeypoints& other) const;

  HumanTrackOptions options_;
  HumanId id_;
  int num_seen_ = 1;
  int num_missed_ = 0;
  BodyKeypoints left_;
  BodyKeypoints previous_left_;  // in the image before
  std::array<bool, kNumJoints> is_carried_{};
  double disparity_px_;
  double height_px_;
  Eigen::Vector2d velocity_px_ = Eigen::Vector2d::Zero();  // a frame, without the camera's shift
  Appearance appearance_;
  bool has_appearance_ = false;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_HUMAN_TRACK_H_
