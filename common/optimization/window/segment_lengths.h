#ifndef AIRDOS_COMMON_OPTIMIZATION_WINDOW_SEGMENT_LENGTHS_H_
#define AIRDOS_COMMON_OPTIMIZATION_WINDOW_SEGMENT_LENGTHS_H_

#include <Eigen/Core>
#include <array>
#include <map>
#include <optional>

#include "common/human/skeleton.h"

namespace airdos {

/// A joint as measured in one stereo frame, in the left camera.
struct MeasuredJoint {
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero();
  Eigen::Matrix3d covariance_C = Eigen::Matrix3d::Identity();  ///< m^2
};

/// What is known about the segment lengths of one person, from all frames that showed the person.
///
/// The mean of the measured lengths is not a good estimate: the noise of a triangulated depth is
/// often larger than the segment, always lengthens it, and grows with the square of the distance.
/// What the image does measure well is the length of a segment as seen across the ray. Each segment
/// therefore has a distribution over its length s, on a grid of ratios to the typical length, which
/// every frame multiplies by the likelihood of its measurement (a along the ray, l across it):
///
///   p(a, l | s) = integral over theta = 0..pi of q(theta) N(a; s cos theta, sigma_a^2)
///                 N(l; s sin theta, sigma_l^2)
///
/// where q is the density of the angle between segment and ray, sin^n(theta): n = 1 for a uniformly
/// distributed direction, larger for a segment that is mostly upright. How much a person's segment
/// swings determines how much longer it must be than it looks, so n is estimated together with s. A
/// share of outliers keeps one false joint from deciding the result, and the exponent kIndependence
/// accounts for errors that persist over frames. The prior is log-normal around the typical length,
/// wide enough for anybody. Left and right limbs are assumed to be equally long.
class SegmentLengths {
 public:
  /// Adds one frame's joints, keyed by joint number.
  void Add(const std::map<int, MeasuredJoint>& joints);

  /// A length and its standard deviation.
  struct Length {
    double mean_m = 0;
    double sigma_m = 0;
  };
  /// Nothing if no frame has shown both ends (of this segment or of its mirror image).
  std::optional<Length> Find(std::size_t segment) const;

  static constexpr std::size_t kGridSize = 36;
  static constexpr std::size_t kNumSpreads = 3;
  /// Length at a grid point, as a ratio to the typical length: 0.45 to 1.7, evenly spaced in the
  /// logarithm.
  static double Ratio(std::size_t place);

 private:
  /// Log likelihoods over the grid.
  struct Belief {
    int num_frames = 0;
    std::array<std::array<double, kGridSize>, kNumSpreads> log_likelihood{};
  };
  void AddSegment(std::size_t segment, const MeasuredJoint& a, const MeasuredJoint& b,
                  double inverse_depth);

  std::array<Belief, kNumSegments> beliefs_;  // for two mirrored segments only the first is used
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_WINDOW_SEGMENT_LENGTHS_H_
