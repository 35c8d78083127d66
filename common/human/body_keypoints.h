#ifndef AIRDOS_COMMON_HUMAN_BODY_KEYPOINTS_H_
#define AIRDOS_COMMON_HUMAN_BODY_KEYPOINTS_H_

#include <Eigen/Core>
#include <array>
#include <optional>
#include <vector>

#include "common/human/skeleton.h"

namespace airdos {

/// One joint of the body model as detected in one image; confidence 0 means not seen.
struct BodyKeypoint {
  double u_px = 0;
  double v_px = 0;
  double confidence = 0;

  Eigen::Vector2d uv_px() const { return {u_px, v_px}; }
};
/// One person in one image, indexed by Joint.
using BodyKeypoints = std::array<BodyKeypoint, kNumJoints>;

/// How a detector mixes up the sides of a body. kLowerLegs: knees and ankles; kLowerArms: elbows
/// and wrists; kAll: every pair of joints.
enum class SideSwap { kNone, kAll, kLowerLegs, kLowerArms };
inline constexpr std::array<SideSwap, 4> kSideSwaps = {SideSwap::kNone, SideSwap::kAll,
                                                       SideSwap::kLowerLegs, SideSwap::kLowerArms};

/// The joint that `joint` is mistaken for; `joint` itself if the swap does not affect it.
int SwappedJoint(int joint, SideSwap swap);
/// The person with the sides exchanged. Applying the same swap twice gives the input.
BodyKeypoints SwapSides(const BodyKeypoints& person, SideSwap swap);

/// Standard deviation of a keypoint: a floor, growing with the person's size in the image and with
/// decreasing confidence. sigma = max(min_px, per_height * height) * factor, where factor = 1 +
/// per_confidence * (full_confidence - confidence), limited to 1..max_factor.
struct KeypointNoise {
  double min_px = 0.9;
  double per_height = 0.009;      ///< relative to the person's standing height in px
  double full_confidence = 0.85;  ///< from here on a joint counts as clearly visible
  double per_confidence = 3.6;    ///< 1.9 times at confidence 0.6, 3 times at 0.3
  double max_factor = 4;

  /// Standard deviation of u and of v, px.
  double Sigma(double confidence, double height_px) const;
};

/// Height of a standing adult; used only to scale noise and gates.
inline constexpr double kPersonHeightM = 1.7;

/// Median of the values, the lower of the two middle ones if their number is even. Nothing if there
/// are none.
std::optional<double> Median(std::vector<double> values);

}  // namespace airdos

#endif  // AIRDOS_COMMON_HUMAN_BODY_KEYPOINTS_H_
