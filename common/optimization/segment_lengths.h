#ifndef AIRDOS_COMMON_OPTIMIZATION_SEGMENT_LENGTHS_H_
#define AIRDOS_COMMON_OPTIMIZATION_SEGMENT_LENGTHS_H_

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
///   p(a, l | s) = 1/2 integral over theta = 0..pi of N(a; s cos theta, sigma_a^2)
///                 N(l; s sin theta, sigma_l^2) sin theta
///
/// that is, a segment may point anywhere. A share of outliers keeps a false joint from deciding,
/// and the power kIndependence stands for errors that last over frames. The start is a log-normal
/// around the typical length, wide enough for anybody. Left and right are as long as each other.
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

  static constexpr int kGridSize = 48;
  /// Length at a place of the grid, as a ratio to the typical one: 0.45 to 1.7, evenly in
  /// logarithm.
  static double Ratio(int place);

 private:
  struct Belief {
    int num_frames = 0;
    std::array<double, kGridSize> log_likelihood{};
  };
  void AddSegment(std::size_t segment, const MeasuredJoint& a, const MeasuredJoint& b,
                  double depth_m);

  std::array<Belief, kNumSegments> beliefs_;  // of the mirror images' first ones
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_SEGMENT_LENGTHS_H_
