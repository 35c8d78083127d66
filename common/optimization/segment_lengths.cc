#include "common/optimization/segment_lengths.h"

#include <algorithm>
#include <cmath>
#include <vector>

namespace airdos {
namespace {

constexpr double kPi = 3.14159265358979323846;
constexpr double kSmallestRatio = 0.45;
constexpr double kLargestRatio = 1.7;
constexpr double kPriorSigma = 0.25;    // of the logarithm of a grown person's length
constexpr double kIndependence = 0.3;   // what a frame tells beyond the one before
constexpr double kOutlierShare = 0.05;  // joints that are somewhere else
constexpr double kOutlierSizeM = 1.0;   // and how far they may be off
constexpr double kBodyDepthM = 0.2;     // standard deviation of joints' depths in a body
constexpr int kNumDirections = 24;

/// Mirror images share one belief: that of the right side.
constexpr std::array<std::size_t, kNumSegments> kMirror = {0, 0, 2, 2,  4, 5,  6,
                                                           5, 6, 9, 10, 9, 10, 13};

/// How upright segments are: exponent n of the density sin^n(theta) of the angle to the ray. 1: any
/// direction. Shoulders and hips lie level and turn with the person (0); limbs hang and swing, a
/// forearm more than a thigh (about 1 / sqrt(n) rad around the upright); the trunk leans little.
constexpr std::array<double, kNumSegments> kUprightness = {0, 0, 12, 12, 0, 4, 2,
                                                           4, 2, 4,  4,  4, 4, 2};

double Normal(double error, double sigma) {
  return std::exp(-0.5 * error * error / (sigma * sigma)) / (sigma * std::sqrt(2 * kPi));
}

double MiddleDepth(const std::map<int, MeasuredJoint>& joints) {
  std::vector<double> depths_m;
  for (const auto& [joint, measured] : joints) depths_m.push_back(measured.p_C.z());
  const auto middle = depths_m.begin() + static_cast<std::ptrdiff_t>(depths_m.size() / 2);
  std::nth_element(depths_m.begin(), middle, depths_m.end());
  return *middle;
}

/// The joint's depth, where it is badly measured, as the person's.
double DepthOf(const MeasuredJoint& joint, double person_depth_m) {
  const double variance = joint.covariance_C(2, 2);
  const double weight = kBodyDepthM * kBodyDepthM / (kBodyDepthM * kBodyDepthM + variance);
  return weight * joint.p_C.z() + (1 - weight) * person_depth_m;
}

/// Sum of the variances of the two directions across the joint's ray, m^2.
double VarianceAcross(const MeasuredJoint& joint) {
  const Eigen::Vector3d ray = joint.p_C.normalized();
  return joint.covariance_C.trace() - ray.dot(joint.covariance_C * ray);
}

/// What a frame says about a segment.
struct Measurement {
  double along_m = 0;  ///< the ray
  double sigma_along_m = 0;
  double across_m = 0;
  double sigma_across_m = 0;
};

using Weights = std::array<double, kNumDirections>;

double Angle(std::size_t i) { return kPi * (static_cast<double>(i) + 0.5) / kNumDirections; }

/// The density of the angle to the ray, at Angle(i), with sum 1.
Weights DirectionWeights(std::size_t segment) {
  Weights weights;
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = std::pow(std::sin(Angle(i)), kUprightness[segment]);
    sum += weights[i];
  }
  for (double& weight : weights) weight /= sum;
  return weights;
}

/// p(a, l | s) of the header.
double Likelihood(const Measurement& seen, const Weights& weights, double length_m) {
  double sum = 0;
  for (std::size_t i = 0; i < weights.size(); ++i) {
    sum += weights[i] * Normal(seen.across_m - length_m * std::sin(Angle(i)), seen.sigma_across_m) *
           Normal(seen.along_m - length_m * std::cos(Angle(i)), seen.sigma_along_m);
  }
  return sum;
}

}  // namespace

double SegmentLengths::Ratio(int place) {
  const double share = static_cast<double>(place) / (kGridSize - 1);
  return kSmallestRatio * std::pow(kLargestRatio / kSmallestRatio, share);
}

void SegmentLengths::Add(const std::map<int, MeasuredJoint>& joints) {
  if (joints.empty()) return;
  const double depth_m = MiddleDepth(joints);
  for (std::size_t segment = 0; segment < kNumSegments; ++segment) {
    const auto a = joints.find(kSegments[segment].joint_a);
    const auto b = joints.find(kSegments[segment].joint_b);
    if (a != joints.end() && b != joints.end()) AddSegment(segment, a->second, b->second, depth_m);
  }
}

void SegmentLengths::AddSegment(std::size_t segment, const MeasuredJoint& a, const MeasuredJoint& b,
                                double depth_m) {
  // Across the ray: both directions at one depth; along it: the measured difference.
  const double common_depth_m = 0.5 * (DepthOf(a, depth_m) + DepthOf(b, depth_m));
  const Eigen::Vector3d ray_a = a.p_C / a.p_C.z();
  const Eigen::Vector3d ray_b = b.p_C / b.p_C.z();
  const Eigen::Vector3d ray = (ray_a + ray_b).normalized();
  const Eigen::Vector3d offset = common_depth_m * (ray_a - ray_b);
  Measurement seen;
  const Eigen::Matrix3d covariance = a.covariance_C + b.covariance_C;
  seen.along_m = ray.dot(a.p_C - b.p_C);
  seen.sigma_along_m = std::sqrt(ray.dot(covariance * ray));
  seen.sigma_across_m = std::sqrt(0.5 * (VarianceAcross(a) + VarianceAcross(b)));
  // Noise square to the segment in the image makes it longer: E[l^2] has one variance more.
  const double across_m2 = (offset - ray * ray.dot(offset)).squaredNorm();
  seen.across_m = std::sqrt(std::max(across_m2 - seen.sigma_across_m * seen.sigma_across_m, 0.0));

  Belief& belief = beliefs_[kMirror[segment]];
  ++belief.num_frames;
  const double outlier = kOutlierShare / kOutlierSizeM *
                         Normal(seen.along_m, std::hypot(kOutlierSizeM, seen.sigma_along_m));
  const Weights weights = DirectionWeights(segment);
  for (int i = 0; i < kGridSize; ++i) {
    const double length_m = Ratio(i) * kSegments[segment].typical_length_m;
    const double fit = Likelihood(seen, weights, length_m);
    belief.log_likelihood[static_cast<std::size_t>(i)] +=
        kIndependence * std::log((1 - kOutlierShare) * fit + outlier);
  }
}

std::optional<SegmentLengths::Length> SegmentLengths::Find(std::size_t segment) const {
  const Belief& belief = beliefs_[kMirror[segment]];
  if (belief.num_frames == 0) return std::nullopt;
  const double most = *std::max_element(belief.log_likelihood.begin(), belief.log_likelihood.end());
  double sum = 0;
  double first = 0;
  double second = 0;
  for (int i = 0; i < kGridSize; ++i) {
    const double ratio = Ratio(i);
    const double logarithm = std::log(ratio) / kPriorSigma;
    const double weight = std::exp(belief.log_likelihood[static_cast<std::size_t>(i)] - most -
                                   0.5 * logarithm * logarithm);
    sum += weight;
    first += weight * ratio;
    second += weight * ratio * ratio;
  }
  const double mean = first / sum;
  const double typical_m = kSegments[segment].typical_length_m;
  return Length{typical_m * mean, typical_m * std::sqrt(std::max(second / sum - mean * mean, 0.0))};
}

}  // namespace airdos
