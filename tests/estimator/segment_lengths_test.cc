#include "common/optimization/window/segment_lengths.h"

#include <gtest/gtest.h>

#include <Eigen/LU>
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <random>
#include <vector>

#include "common/geometry/stereo_camera.h"

namespace airdos {
namespace {

constexpr std::size_t kRightSide = 2;  // shoulder to hip
constexpr std::size_t kLeftSide = 3;
constexpr std::size_t kRightForearm = 6;
constexpr std::array<std::size_t, 3> kWalkersSegments = {kRightSide, 5, kRightForearm};

StereoCamera Camera() {
  StereoCamera camera;
  camera.width = 640;
  camera.height = 360;
  camera.fx_px = camera.fy_px = 770;
  camera.cx_px = 320;
  camera.cy_px = 180;
  camera.baseline_m = 0.25;
  return camera;
}

/// What a camera measures of a joint whose three image coordinates are `noise_px` off.
MeasuredJoint Measure(const Eigen::Vector3d& p_C, double sigma_px,
                      const Eigen::Vector3d& noise_px = Eigen::Vector3d::Zero()) {
  const Eigen::Vector3d uvu = Camera().ProjectStereo(p_C) + noise_px;
  MeasuredJoint joint;
  joint.p_C = *Camera().Triangulate(uvu.x(), uvu.y(), uvu.z());
  joint.covariance_C = Camera().TriangulationCovariance(joint.p_C, sigma_px);
  return joint;
}

/// A person of lengths that are not the typical ones, who walks past and swings arms and legs.
class Walker {
 public:
  static double TrueLength(std::size_t segment) {
    return kSegments[segment].typical_length_m * (segment % 2 == 0 ? 0.85 : 1.0);
  }
  std::map<int, Eigen::Vector3d> At(int frame, double depth_m) const {
    // Swings in the direction of the walk, half across and half along the ray.
    const double swing = 0.5 * std::sin(0.6 * frame);
    const auto swung = [](double angle) {
      const double forward = std::sin(angle) * std::sqrt(0.5);
      return Eigen::Vector3d(forward, std::cos(angle), forward);
    };
    const Eigen::Vector3d shoulder(-2 + 0.1 * frame, -0.4, depth_m);
    const double side_m = TrueLength(kRightSide);
    const double arm_m = TrueLength(5);
    const double forearm_m = TrueLength(kRightForearm);
    std::map<int, Eigen::Vector3d> joints;
    joints[kRightShoulder] = shoulder;
    joints[kRightHip] = shoulder + side_m * Eigen::Vector3d(0.05, std::sqrt(1 - 0.0025), 0);
    joints[kRightElbow] = shoulder + arm_m * swung(swing);
    joints[kRightWrist] = joints[kRightElbow] + forearm_m * swung(0.5 + swing);
    return joints;
  }
};

TEST(SegmentLengths, NothingBeforeBothEndsWereSeen) {
  SegmentLengths lengths;
  EXPECT_FALSE(lengths.Find(kRightSide));
  lengths.Add({});
  lengths.Add({{kRightShoulder, Measure({0, 0, 5}, 1)}});
  EXPECT_FALSE(lengths.Find(kRightSide));
  EXPECT_DOUBLE_EQ(SegmentLengths::Ratio(0), 0.45);
  EXPECT_NEAR(SegmentLengths::Ratio(SegmentLengths::kGridSize - 1), 1.7, 1e-12);
}

TEST(SegmentLengths, NearAndExactIsTheLengthItself) {
  SegmentLengths lengths;
  for (int frame = 0; frame < 20; ++frame) {
    lengths.Add(
        {{kRightShoulder, Measure({0, 0, 2}, 0.5)}, {kRightHip, Measure({0, 0.44, 2}, 0.5)}});
  }
  ASSERT_TRUE(lengths.Find(kRightSide));
  EXPECT_NEAR(lengths.Find(kRightSide)->mean_m, 0.44, 0.01);
  EXPECT_LT(lengths.Find(kRightSide)->sigma_m, 0.01);
  // Left is as long as right; of the forearm nothing is known.
  EXPECT_EQ(lengths.Find(kLeftSide)->mean_m, lengths.Find(kRightSide)->mean_m);
  EXPECT_FALSE(lengths.Find(kRightForearm));
}

TEST(SegmentLengths, AFirstLookFromFarLeavesWhatIsTypical) {
  SegmentLengths lengths;
  // 30 m away and 4 px of noise: 0.16 m across, metres along the ray.
  lengths.Add({{kRightElbow, Measure({0, 0, 30}, 4)}, {kRightWrist, Measure({0, 0.3, 30}, 4)}});
  const double typical_m = kSegments[kRightForearm].typical_length_m;
  EXPECT_NEAR(lengths.Find(kRightForearm)->mean_m, typical_m, 0.2 * typical_m);
  EXPECT_GT(lengths.Find(kRightForearm)->sigma_m, 0.15 * typical_m);
}

TEST(SegmentLengths, OfAWalkerWhoseTriangulatedLengthsAreFarTooLong) {
  std::vector<double> errors;  // relative
  for (const unsigned seed : {1u, 2u, 3u, 4u, 5u, 6u}) {
    std::mt19937_64 generator(seed);
    std::normal_distribution<double> noise_px(0, 1.2);
    SegmentLengths lengths;
    std::map<std::size_t, double> naive_m;
    constexpr int kNumFrames = 40;
    for (int frame = 0; frame < kNumFrames; ++frame) {
      std::map<int, MeasuredJoint> joints;
      for (const auto& [joint, p_C] : Walker().At(frame, 14)) {
        const double u = noise_px(generator);
        const double v = noise_px(generator);
        const double u_right = noise_px(generator);
        joints[joint] = Measure(p_C, 1.2, {u, v, u_right});
      }
      lengths.Add(joints);
      for (const std::size_t segment : kWalkersSegments) {
        const auto& [a, b, typical] = kSegments[segment];
        naive_m[segment] += (joints[a].p_C - joints[b].p_C).norm() / kNumFrames;
      }
    }
    for (const std::size_t segment : kWalkersSegments) {
      const double truth_m = Walker::TrueLength(segment);
      EXPECT_GT(naive_m[segment], 2 * truth_m);
      errors.push_back(std::abs(lengths.Find(segment)->mean_m / truth_m - 1));
      EXPECT_LT(errors.back(), 0.12) << segment << ", seed " << seed;
      EXPECT_LT(lengths.Find(segment)->sigma_m, 0.1 * truth_m);
    }
  }
  std::nth_element(errors.begin(), errors.begin() + 9, errors.end());
  EXPECT_LT(errors[9], 0.05);  // median of 18: the bar that the chain is held to
}

TEST(SegmentLengths, AFewFalseJointsDoNotDecide) {
  SegmentLengths lengths;
  for (int frame = 0; frame < 40; ++frame) {
    const bool is_false = frame % 10 == 3;
    // Within what an outlier may be, and far beyond anything.
    const Eigen::Vector3d hip(0, is_false ? 1.1 : 0.44, frame == 13 ? 12 : 4);
    lengths.Add({{kRightShoulder, Measure({0, 0, 4}, 1)}, {kRightHip, Measure(hip, 1)}});
  }
  EXPECT_NEAR(lengths.Find(kRightSide)->mean_m, 0.44, 0.022);
}

}  // namespace
}  // namespace airdos
