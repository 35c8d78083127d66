#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_SEGMENT_LENGTHS_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_SEGMENT_LENGTHS_H_

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>

#include "common/human/skeleton.h"

namespace airdos {

/// A joint as one stereo frame measured it, in the left camera.
struct MeasuredJoint {
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_C = Eigen::Matrix3d::Identity();  ///< m^2
};

/// What is known of the lengths of one person's segments, from all frames that showed the person.
///
/// The mean of measured lengths is no estimate of a length: the noise of a triangulated depth is
/// often longer than the segment, always makes it longer, and grows with the square of the
/// distance. What the image tells well is how long a segment looks across the ray. So each segment
/// has a distribution over its length s, on a grid of ratios to the typical length, that every
/// frame multiplies with the likelihood of what it measured (a = along the ray, l = across it):
///
///   p(a, l | s) = integral over theta = 0..pi of q(theta) N(a; s cos theta, sigma_a^2)
///                 N(l; s sin theta, sigma_l^2)
///
/// where q is the density of the angle between segment and ray, sin^n(theta): n = 1 for any
/// direction, more for what is mostly upright. How much one person's segment swings decides how
/// much longer than it looks it must be, so n is found out along with s. A share of outliers keeps
/// a false joint from deciding, and the power kIndependence stands for errors that last over
/// frames. The start is a log-normal around the typical length, wide enough for anybody. Left and
/// right are as long as each other.
class SegmentLengths {
 public:
  /// Adds one frame's joints, by Joint.
  void Add(const std::map<int, MeasuredJoint>& joints);

  struct Length {
    double mean_m = 0;
    double sigma_m = 0;
  };
  /// Nothing where no frame has shown both ends (of this segment or its mirror image).
  std::optional<Length> Find(std::size_t segment) const;

  static constexpr std::size_t kGridSize = 36;
  static constexpr std::size_t kNumSpreads = 3;
  /// Length at a place of the grid, as a ratio to the typical one: 0.45 to 1.7, evenly in
  /// logarithm.
  static double Ratio(std::size_t place);

 private:
  struct Belief {
    int num_frames = 0;
    std::array<std::array<double, kGridSize>, kNumSpreads> log_likelihood{};
  };
  void AddSegment(std::size_t segment, const MeasuredJoint& a, const MeasuredJoint& b,
                  double inverse_depth);

  std::array<Belief, kNumSegments> beliefs_;  // of the mirror images' first ones
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_SEGMENT_LENGTHS_H_
