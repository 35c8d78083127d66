#ifndef AIRDOS_COMMON_HUMAN_PERSON_PAIRING_H_
#define AIRDOS_COMMON_HUMAN_PERSON_PAIRING_H_

#include <optional>
#include <vector>

#include "common/geometry/stereo_camera.h"
#include "common/human/body_keypoints.h"

namespace airdos {

/// What two detections, one in each image, must fulfil to be one person.
struct PersonPairingOptions {
  double min_confidence = 0.1;  ///< keypoints below it are ignored
  int min_joints = 4;           ///< that both images must see of a person
  double min_depth_m = 0.5;
  double max_depth_m = 40;
  double body_extent_m = 0.2;  ///< standard deviation of the depth of a person's joints
  /// A joint that fits worse counts as an outlier and no more.
  double max_joint_squared_sigmas = 8;
  /// Of a pair, per measurement; above it two detections are not one person.
  double max_mean_squared_sigmas = 3.5;
  KeypointNoise noise;
};

/// The same person in both images: indices into the lists given to PairPeople().
struct PersonPair {
  int left = 0;
  int right = 0;
  SideSwap right_swap = SideSwap::kNone;  ///< to apply to the right one so that sides agree
  double disparity_px = 0;                ///< median over the joints
  double cost = 0;
};

/// Who is who in the two images of a frame.
struct PersonPairing {
  std::vector<PersonPair> pairs;  ///< sorted by left
  std::vector<int> unpaired_left;
  std::vector<int> unpaired_right;
};

/// How badly two detections fit as one person; nothing where they cannot be. For each joint j that
/// both see, with d_j = u_left - u_right, the median disparity d and the joint's variance s_j^2 of
/// both images together:
///   e_j = (v_left - v_right)^2 / s_j^2 + (d_j - d)^2 / (s_j^2 + extent(d)^2),
///   cost = mean(min(e_j, max_joint_squared_sigmas)) / 2 + size term + a little for exchanged
///   sides,
/// and the size term compares the limbs' lengths in the image with what kSegments lets expect at
/// that depth. All exchanges of sides are tried; the best is returned.
std::optional<PersonPair> FitPersonPair(const PersonPairingOptions& options,
                                        const StereoCamera& camera, const BodyKeypoints& left,
                                        const BodyKeypoints& right);

/// Pairs the people of a rectified pair of images, who come in no order and partly in one image
/// only, so that the sum of costs is least; pairs above max_mean_squared_sigmas are not made.
PersonPairing PairPeople(const PersonPairingOptions& options, const StereoCamera& camera,
                         const std::vector<BodyKeypoints>& left,
                         const std::vector<BodyKeypoints>& right);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_PERSON_PAIRING_H_
