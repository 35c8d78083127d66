#include "common/optimization/window/segment_lengths.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <vector>

namespace airdos {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSmallestRatio = 0.45;
constexpr double kLargestRatio = 1.7;
constexpr double kPriorSigma = 0.25;    // of the logarithm of an adult's length
constexpr double kIndependence = 0.3;   // the share of a frame's information that is new
constexpr double kOutlierShare = 0.05;  // share of joints that are misplaced
constexpr double kOutlierSizeM = 1.0;   // how far those may be off
constexpr double kNothing = 1e-12;      // lower bound of a density: avoids log(0)
constexpr double kBodyDepthM = 0.2;     // standard deviation of joint depths within a body
constexpr double kLeastAlongM = 0.03;   // no finer than the grid of directions resolves
constexpr double kLeastAcrossM = 0.01;  // a keypoint is not an anatomical joint
constexpr int kNumDirections = 20;

/// Mirrored segments share one belief, stored under the first of the two.
constexpr std::array<std::size_t, kNumSegments> kMirror = {0, 0, 2, 2,  4, 5,  6,
                                                           5, 6, 9, 10, 9, 10, 13};

/// Candidate exponents of the direction's density, among which the frames choose. Shoulders and
/// hips are level and turn with the person.
constexpr std::array<double, SegmentLengths::kNumSpreads> kUpright = {1, 5, 25};
constexpr std::array<double, SegmentLengths::kNumSpreads> kLevel = {0, 0, 0};

const std::array<double, SegmentLengths::kNumSpreads>& ExponentsOf(std::size_t segment) {
  const bool is_level = segment == 0 || segment == 1 || segment == 4;
  return is_level ? kLevel : kUpright;
}

double Normal(double error, double sigma) {
  return std::exp(-0.5 * error * error / (sigma * sigma)) / (sigma * std::sqrt(2 * kPi));
}

/// Median of the joints' inverse depths, 1/m. Disparity noise affects inverse depths symmetrically,
/// whereas depths come out too large more often than too small.
double MiddleInverseDepth(const std::map<int, MeasuredJoint>& joints) {
  std::vector<double> inverse_depths;
  for (const auto& [joint, measured] : joints) inverse_depths.push_back(1 / measured.p_C.z());
  std::sort(inverse_depths.begin(), inverse_depths.end());
  const std::size_t n = inverse_depths.size();
  return 0.5 * (inverse_depths[(n - 1) / 2] + inverse_depths[n / 2]);
}

/// The joint's inverse depth, or the person's where the joint's is poorly measured.
double InverseDepthOf(const MeasuredJoint& joint, double of_person) {
  const double variance = joint.covariance_C(2, 2);
  const double weight = kBodyDepthM * kBodyDepthM / (kBodyDepthM * kBodyDepthM + variance);
  return weight / joint.p_C.z() + (1 - weight) * of_person;
}

/// Sum of the variances in the two directions across the joint's ray, m^2.
double VarianceAcross(const MeasuredJoint& joint) {
  const Eigen::Vector3d ray = joint.p_C.normalized();
  return joint.covariance_C.trace() - ray.dot(joint.covariance_C * ray);
}

/// One frame's measurement of a segment.
struct Measurement {
  double along_m = 0;  ///< component along the ray
  double sigma_along_m = 0;
  double across_m = 0;
  double sigma_across_m = 0;
};

using Weights = std::array<double, kNumDirections>;

double Angle(std::size_t i) { return kPi * (static_cast<double>(i) + 0.5) / kNumDirections; }

/// The density of the angle to the ray, sampled at Angle(i) and normalised to sum 1.
Weights DirectionWeights(double exponent) {
  Weights weights;
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = std::pow(std::sin(Angle(i)), exponent);
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// The integrand in the header without q, at Angle(i).
Weights FitOfDirections(const Measurement& seen, double length_m) {
  Weights fit;
  const double scale = 1 / (2 * kPi * seen.sigma_across_m * seen.sigma_along_m);
  for (std::size_t i = 0; i < fit.size(); ++i) {
    const double across = (seen.across_m - length_m * std::sin(Angle(i))) / seen.sigma_across_m;
    const double along = (seen.along_m - length_m * std::cos(Angle(i))) / seen.sigma_along_m;
    fit[i] = scale * std::exp(-0.5 * (across * across + along * along));
  }
  return fit;
}

}  // namespace

double SegmentLengths::Ratio(std::size_t place) {
  const double share = static_cast<double>(place) / (kGridSize - 1);
  return kSmallestRatio * std::pow(kLargestRatio / kSmallestRatio, share);
}

void SegmentLengths::Add(const std::map<int, MeasuredJoint>& joints) {
  if (joints.empty()) return;
  const double inverse_depth = MiddleInverseDepth(joints);
  for (std::size_t segment = 0; segment < kNumSegments; ++segment) {
    const auto a = joints.find(kSegments[segment].joint_a);
    const auto b = joints.find(kSegments[segment].joint_b);
    if (a != joints.end() && b != joints.end())
      AddSegment(segment, a->second, b->second, inverse_depth);
  }
}

void SegmentLengths::AddSegment(std::size_t segment, const MeasuredJoint& a, const MeasuredJoint& b,
                                double inverse_depth) {
  // Across the ray: both joints at a common depth. Along the ray: the measured difference.
  const double common_depth_m =
      2 / (InverseDepthOf(a, inverse_depth) + InverseDepthOf(b, inverse_depth));
  const Eigen::Vector3d ray_a = a.p_C / a.p_C.z();
  const Eigen::Vector3d ray_b = b.p_C / b.p_C.z();
  const Eigen::Vector3d ray = (ray_a + ray_b).normalized();
  const Eigen::Vector3d offset = common_depth_m * (ray_a - ray_b);
  Measurement seen;
  const Eigen::Matrix3d covariance = a.covariance_C + b.covariance_C;
  seen.along_m = ray.dot(a.p_C - b.p_C);
  seen.sigma_along_m = std::sqrt(ray.dot(covariance * ray));
  seen.sigma_across_m = std::sqrt(0.5 * (VarianceAcross(a) + VarianceAcross(b)));
  // Image noise perpendicular to the segment lengthens it: E[l^2] is larger by one variance.
  const double across_m2 = (offset - ray * ray.dot(offset)).squaredNorm();
  seen.across_m = std::sqrt(std::max(across_m2 - seen.sigma_across_m * seen.sigma_across_m, 0.0));
  seen.sigma_along_m = std::hypot(seen.sigma_along_m, kLeastAlongM);
  seen.sigma_across_m = std::hypot(seen.sigma_across_m, kLeastAcrossM);

  Belief& belief = beliefs_[kMirror[segment]];
  ++belief.num_frames;
  const double outlier = kOutlierShare / kOutlierSizeM *
                         Normal(seen.along_m, std::hypot(kOutlierSizeM, seen.sigma_along_m));
  std::array<Weights, kNumSpreads> weights;
  for (std::size_t spread = 0; spread < kNumSpreads; ++spread) {
    weights[spread] = DirectionWeights(ExponentsOf(segment)[spread]);
  }
  for (std::size_t place = 0; place < kGridSize; ++place) {
    const Weights fit = FitOfDirections(seen, Ratio(place) * kSegments[segment].typical_length_m);
    for (std::size_t spread = 0; spread < kNumSpreads; ++spread) {
      const double density =
          std::inner_product(fit.begin(), fit.end(), weights[spread].begin(), 0.0);
      belief.log_likelihood[spread][place] +=
          kIndependence * std::log((1 - kOutlierShare) * density + outlier + kNothing);
    }
  }
}

std::optional<SegmentLengths::Length> SegmentLengths::Find(std::size_t segment) const {
  const Belief& belief = beliefs_[kMirror[segment]];
  if (belief.num_frames == 0) return std::nullopt;
  double most = belief.log_likelihood[0][0];
  for (const auto& of_spread : belief.log_likelihood) {
    most = std::max(most, *std::max_element(of_spread.begin(), of_spread.end()));
  }
  double sum = 0;
  double first = 0;
  double second = 0;
  for (std::size_t place = 0; place < kGridSize; ++place) {
    const double ratio = Ratio(place);
    const double logarithm = std::log(ratio) / kPriorSigma;
    double weight = 0;
    for (const auto& of_spread : belief.log_likelihood) weight += std::exp(of_spread[place] - most);
    weight *= std::exp(-0.5 * logarithm * logarithm);
    sum += weight;
    first += weight * ratio;
    second += weight * ratio * ratio;
  }
  const double mean = first / sum;
  const double typical_m = kSegments[segment].typical_length_m;
  return Length{typical_m * mean, typical_m * std::sqrt(std::max(second / sum - mean * mean, 0.0))};
}

}  // namespace airdos
