#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <vector>

#include "common/optimization/window/segment_lengths.h"

// The posterior of segment_lengths.h once more, over fine grids, for a few frames.

namespace airdos {
namespace {

constexpr std::size_t kHips = 4;
constexpr std::size_t kRightThigh = 9;
constexpr std::size_t kLeftThigh = 11;

/// A segment in a frame: along the ray and across it, with standard deviations.
struct Look {
  double along_m, sigma_along_m, across_m, sigma_across_m;
};

double Normal(double error, double sigma) {
  return std::exp(-0.5 * error * error / (sigma * sigma)) / (sigma * std::sqrt(2 * M_PI));
}

/// p(along, across | length), the angle to the ray having the density sin^n.
double Density(const Look& look, double length_m, double n) {
  constexpr int kSteps = 200;
  double sum = 0, weights = 0;
  for (int i = 0; i < kSteps; ++i) {
    const double theta = M_PI * (i + 0.5) / kSteps;
    const double weight = std::pow(std::sin(theta), n);
    sum += weight * Normal(look.along_m - length_m * std::cos(theta), look.sigma_along_m) *
           Normal(look.across_m - length_m * std::sin(theta), look.sigma_across_m);
    weights += weight;
  }
  return sum / weights;
}

SegmentLengths::Length Posterior(const std::vector<Look>& looks, double typical_m, bool is_level) {
  constexpr int kSteps = 200;
  const std::array<double, 3> exponents =
      is_level ? std::array<double, 3>{0, 0, 0} : std::array<double, 3>{1, 5, 25};
  double sum = 0, first = 0, second = 0;
  for (int i = 0; i <= kSteps; ++i) {
    const double ratio = 0.45 * std::pow(1.7 / 0.45, static_cast<double>(i) / kSteps);
    double weight = 0;
    for (const double n : exponents) {
      double likelihood = 1;
      for (const Look& look : looks) {
        const double outlier = 0.05 * Normal(look.along_m, std::hypot(1, look.sigma_along_m));
        likelihood *= std::pow(0.95 * Density(look, ratio * typical_m, n) + outlier, 0.3);
      }
      weight += likelihood;
    }
    weight *= std::exp(-0.5 * std::pow(std::log(ratio) / 0.25, 2));
    sum += weight;
    first += weight * ratio;
    second += weight * ratio * ratio;
  }
  const double mean = first / sum;
  return {typical_m * mean, typical_m * std::sqrt(second / sum - mean * mean)};
}

/// Standard deviations along the ray and in each direction across it.
MeasuredJoint Joint(const Eigen::Vector3d& p_C, double along_m, double across_m) {
  const Eigen::Vector3d ray = p_C.normalized();
  const Eigen::Matrix3d along = ray * ray.transpose();
  return {p_C,
          along_m * along_m * along + across_m * across_m * (Eigen::Matrix3d::Identity() - along)};
}

/// The middle of `joints` is at 1 / z = `inverse_depth`.
Look LookAt(const MeasuredJoint& a, const MeasuredJoint& b, double inverse_depth,
            double sigma_along_m, double sigma_across_m) {
  const auto own = [inverse_depth](const MeasuredJoint& joint) {
    const double share = 0.04 / (0.04 + joint.covariance_C(2, 2));
    return share / joint.p_C.z() + (1 - share) * inverse_depth;
  };
  const double depth_m = 2 / (own(a) + own(b));
  const Eigen::Vector3d at_a = a.p_C / a.p_C.z(), at_b = b.p_C / b.p_C.z();
  const Eigen::Vector3d ray = (at_a + at_b).normalized();
  Look look{};
  look.along_m = ray.dot(a.p_C - b.p_C);
  look.sigma_along_m = std::hypot(sigma_along_m, 0.03);
  const double across_m = depth_m * (at_a - at_b).cross(ray).norm();
  look.across_m = std::sqrt(std::max(across_m * across_m - sigma_across_m * sigma_across_m, 0.0));
  look.sigma_across_m = std::hypot(sigma_across_m, 0.01);
  return look;
}

void ExpectLength(const SegmentLengths& lengths, std::size_t segment,
                  const SegmentLengths::Length& expected) {
  ASSERT_TRUE(lengths.Find(segment));
  // 36 places of 3.8 percent and 20 directions.
  EXPECT_NEAR(lengths.Find(segment)->mean_m / expected.mean_m, 1, 0.01) << segment;
  EXPECT_NEAR(lengths.Find(segment)->sigma_m / expected.sigma_m, 1, 0.05) << segment;
}

TEST(SegmentPosterior, AThighInOneFrame) {
  const MeasuredJoint hip = Joint({0.1, 0.2, 4}, 0.08, 0.03);
  const MeasuredJoint knee = Joint({0.25, 0.48, 4.15}, 0.1, 0.05);
  SegmentLengths lengths;
  lengths.Add({{kRightHip, hip}, {kRightKnee, knee}});
  const Look look =
      LookAt(hip, knee, 0.5 * (1 / 4. + 1 / 4.15), std::hypot(0.08, 0.1), std::hypot(0.03, 0.05));
  EXPECT_GT(look.across_m, 0.2);
  EXPECT_LT(look.along_m, -0.15);
  ExpectLength(lengths, kRightThigh, Posterior({look}, 0.43, false));
  ExpectLength(lengths, kLeftThigh, Posterior({look}, 0.43, false));
  EXPECT_FALSE(lengths.Find(kHips));
}

TEST(SegmentPosterior, WhatAllFramesSay) {
  SegmentLengths lengths;
  std::vector<Look> looks;
  for (int i = 0; i < 4; ++i) {
    const MeasuredJoint hip = Joint({0.1 * i, 0.2, 4}, 0.05, 0.02);
    const MeasuredJoint knee =
        Joint({0.1 * i + 0.02, 0.52 + 0.02 * i, 4.02 + 0.02 * i}, 0.06, 0.02);
    // The left thigh speaks of both.
    const bool is_left = i % 2 == 1;
    lengths.Add({{is_left ? kLeftHip : kRightHip, hip}, {is_left ? kLeftKnee : kRightKnee, knee}});
    looks.push_back(LookAt(hip, knee, 0.5 * (1 / hip.p_C.z() + 1 / knee.p_C.z()),
                           std::hypot(0.05, 0.06), std::hypot(0.02, 0.02)));
  }
  ExpectLength(lengths, kRightThigh, Posterior(looks, 0.43, false));
  ExpectLength(lengths, kLeftThigh, Posterior(looks, 0.43, false));
}

TEST(SegmentPosterior, HipsTurnLevel) {
  const MeasuredJoint right = Joint({0.1, 0.3, 5}, 0.07, 0.02);
  const MeasuredJoint left = Joint({-0.02, 0.31, 5.08}, 0.07, 0.02);
  SegmentLengths lengths;
  lengths.Add({{kRightHip, right}, {kLeftHip, left}});
  const Look look =
      LookAt(right, left, 0.5 * (1 / 5. + 1 / 5.08), 0.07 * std::sqrt(2.0), 0.02 * std::sqrt(2.0));
  ExpectLength(lengths, kHips, Posterior({look}, 0.25, true));
  EXPECT_GT(
      std::abs(Posterior({look}, 0.25, true).mean_m / Posterior({look}, 0.25, false).mean_m - 1),
      0.03);
}

TEST(SegmentPosterior, AtTheEdgeOfTheImage) {
  // The rays are of unlike length, the depths too, and both are measured better than a joint is
  // one.
  const MeasuredJoint hip = Joint({2.0, 0.5, 3}, 0.005, 0.02);
  const MeasuredJoint knee = Joint({2.3, 0.75, 3.2}, 0.006, 0.03);
  SegmentLengths lengths;
  lengths.Add({{kRightHip, hip}, {kRightKnee, knee}});
  const Look look =
      LookAt(hip, knee, 0.5 * (1 / 3. + 1 / 3.2), std::hypot(0.005, 0.006), std::hypot(0.02, 0.03));
  ExpectLength(lengths, kRightThigh, Posterior({look}, 0.43, false));
}

TEST(SegmentPosterior, EachEndStandsAtItsOwnDepth) {
  const MeasuredJoint hip = Joint({0.1, 0.2, 2}, 0.005, 0.01);
  const MeasuredJoint knee = Joint({0.4, 0.4, 2.4}, 0.006, 0.01);
  for (const bool is_hip_first : {true, false}) {
    SegmentLengths lengths;
    lengths.Add({{kRightHip, is_hip_first ? hip : knee}, {kRightKnee, is_hip_first ? knee : hip}});
    const Look look = LookAt(hip, knee, 0.5 * (1 / 2. + 1 / 2.4), std::hypot(0.005, 0.006),
                             std::hypot(0.01, 0.01));
    ExpectLength(lengths, kRightThigh, Posterior({look}, 0.43, false));
  }
}

TEST(SegmentPosterior, OneEndIsMeasuredWorse) {
  for (const bool is_hip_worse : {true, false}) {
    const MeasuredJoint hip =
        Joint({0.1, 0.2, 4}, is_hip_worse ? 0.3 : 0.02, is_hip_worse ? 0.2 : 0.01);
    const MeasuredJoint knee =
        Joint({0.3, 0.45, 4.3}, is_hip_worse ? 0.02 : 0.3, is_hip_worse ? 0.01 : 0.2);
    SegmentLengths lengths;
    lengths.Add({{kRightHip, hip}, {kRightKnee, knee}});
    const Look look =
        LookAt(hip, knee, 0.5 * (1 / 4. + 1 / 4.3), std::hypot(0.3, 0.02), std::hypot(0.2, 0.01));
    EXPECT_GT(look.across_m, 0.15);
    ExpectLength(lengths, kRightThigh, Posterior({look}, 0.43, false));
  }
}

TEST(SegmentPosterior, ABadlyMeasuredDepthIsThePersons) {
  // Both ends of the forearm came out far behind the rest, at 5 m, and do not know it.
  const MeasuredJoint elbow = Joint({0.5, 0.1, 8}, 3, 0.02);
  const MeasuredJoint wrist = Joint({0.55, 0.45, 8.2}, 3, 0.02);
  SegmentLengths lengths;
  lengths.Add({{kRightElbow, elbow},
               {kRightWrist, wrist},
               {kNeck, Joint({0, 0, 5}, 0.1, 0.02)},
               {kNose, Joint({0, -0.2, 5.1}, 0.1, 0.02)},
               {kLeftHip, Joint({0, 0.5, 4.9}, 0.1, 0.02)}});
  // The middle of five: 1 / 5.1. Between their rays the variance is what it is along them.
  const Look look = LookAt(elbow, wrist, 1 / 5.1, 3 * std::sqrt(2.0), 0.02 * std::sqrt(2.0));
  ExpectLength(lengths, 6, Posterior({look}, 0.26, false));
  EXPECT_LT(lengths.Find(6)->mean_m, 0.27);
}

}  // namespace
}  // namespace airdos
