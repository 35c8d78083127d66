#include "common/human/joint_triangulator.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <cstddef>
#include <tuple>

namespace airdos {
namespace {

// One joint as measured by the two detections, or by one detection and the images, before
// triangulation.
struct Measurement {
  double u_left_px;
  double v_px;
  double disparity_px;
  double sigma_u_px;  // of u_left and of u_right
  double sigma_v_px;
  double sigma_disparity_px;
  double confidence;
};

double FocalBaseline(const StereoCamera& camera) { return camera.fx_px * camera.baseline_m; }

double SurfaceToJoint(const JointTriangulatorOptions& options, const StereoCamera& camera,
                      double disparity_px) {
  const double depth_m = FocalBaseline(camera) / disparity_px;
  return FocalBaseline(camera) / (depth_m + options.surface_depth_m);
}

double ExtentPx(const JointTriangulatorOptions& options, const StereoCamera& camera,
                double disparity_px) {
  return options.body_extent_m * disparity_px * disparity_px / FocalBaseline(camera);
}

std::optional<TriangulatedJoint> MakeObservation(const JointTriangulatorOptions& options,
                                                 const StereoCamera& camera, const Measurement& m) {
  if (!(m.disparity_px > FocalBaseline(camera) / options.max_depth_m) ||
      !(m.disparity_px < FocalBaseline(camera) / options.min_depth_m)) {
    return std::nullopt;
  }
  const std::optional<Eigen::Vector3d> p_C =
      camera.Triangulate(m.u_left_px, m.v_px, m.u_left_px - m.disparity_px);
  if (!p_C) return std::nullopt;
  TriangulatedJoint joint;
  joint.u_left_px = m.u_left_px;
  joint.v_px = m.v_px;
  joint.u_right_px = m.u_left_px - m.disparity_px;
  joint.sigma_px = m.sigma_u_px;
  joint.confidence = m.confidence;
  joint.p_C = *p_C;
  // (u_left, v, u_right) with u_right = u_left - d: from Var(u_left) = Var(u_right) = s^2 and the
  // known Var(d) follows Cov(u_left, u_right) = s^2 - Var(d) / 2.
  const double variance_u = m.sigma_u_px * m.sigma_u_px;
  const double common = variance_u - m.sigma_disparity_px * m.sigma_disparity_px / 2;
  Eigen::Matrix3d covariance_uvu;
  covariance_uvu << variance_u, 0, common, 0, m.sigma_v_px * m.sigma_v_px, 0, common, 0, variance_u;
  const Eigen::Matrix3d inverse_jacobian = camera.ProjectStereoJacobian(*p_C).inverse();
  joint.covariance_C = inverse_jacobian * covariance_uvu * inverse_jacobian.transpose();
  return joint;
}

// Disparity from the images, of the joint rather than of the surface in front of it.
std::optional<double> DisparityFromImages(const JointTriangulatorOptions& options,
                                          const StereoCamera& camera, const StereoImages& images,
                                          const Eigen::Vector2d& uv_left_px, double expected_px,
                                          double search_px, double height_px) {
  const std::optional<double> surface =
      RefineDisparity(options.refiner, images.left_gray, images.right_gray, uv_left_px, expected_px,
                      search_px, height_px);
  if (!surface || *surface <= 0) return std::nullopt;
  return SurfaceToJoint(options, camera, *surface);
}

// The weighted mean of two measurements of the same quantity, and its standard deviation.
struct Fused {
  double value;
  double sigma;
};
Fused Fuse(double a, double sigma_a, double b, double sigma_b) {
  const double weight_a = 1 / (sigma_a * sigma_a);
  const double weight_b = 1 / (sigma_b * sigma_b);
  return {(weight_a * a + weight_b * b) / (weight_a + weight_b),
          1 / std::sqrt(weight_a + weight_b)};
}

std::optional<TriangulatedJoint> TriangulateJoint(const JointTriangulatorOptions& options,
                                                  const StereoCamera& camera,
                                                  const StereoImages& images, const BodyKeypoint& l,
                                                  const BodyKeypoint& r, double person_px) {
  if (l.confidence < options.min_confidence || r.confidence < options.min_confidence) {
    return std::nullopt;
  }
  const double height_px = kPersonHeightM * person_px / camera.baseline_m;
  const double sigma_l = options.noise.Sigma(l.confidence, height_px);
  const double sigma_r = options.noise.Sigma(r.confidence, height_px);
  const double sigma_difference = std::hypot(sigma_l, sigma_r);
  if (std::abs(l.v_px - r.v_px) > options.max_row_error_sigmas * sigma_difference)
    return std::nullopt;
  const double disparity_px = l.u_px - r.u_px;
  const double extent_px = ExtentPx(options, camera, person_px);
  if (std::abs(disparity_px - person_px) >
      options.max_extent_error_sigmas * std::hypot(sigma_difference, extent_px)) {
    return std::nullopt;
  }
  const Fused row = Fuse(l.v_px, sigma_l, r.v_px, sigma_r);
  Measurement m{l.u_px,
                row.value,
                disparity_px,
                sigma_difference / std::sqrt(2.0),
                row.sigma,
                sigma_difference,
                std::min(l.confidence, r.confidence)};
  if (options.is_refined && m.confidence >= options.min_refined_confidence) {
    // Both the keypoints and the person as a whole tell where to search.
    const Fused expected = Fuse(disparity_px, sigma_difference, person_px, extent_px);
    const std::optional<double> refined =
        DisparityFromImages(options, camera, images, {l.u_px, row.value}, expected.value,
                            3 * expected.sigma + 1, height_px);
    if (refined) {
      // Once the disparity is known, the right keypoint measures u_left as well.
      const Fused u_left = Fuse(l.u_px, sigma_l, r.u_px + *refined, sigma_r);
      m.u_left_px = u_left.value;
      m.sigma_u_px = u_left.sigma;
      m.disparity_px = *refined;
      m.sigma_disparity_px = options.refined_sigma_px;
    }
  }
  return MakeObservation(options, camera, m);
}

bool IsImpossible(const JointTriangulatorOptions& options, const Segment& segment,
                  const TriangulatedJoint& a, const TriangulatedJoint& b) {
  const Eigen::Vector3d along = a.p_C - b.p_C;
  const double length_m = along.norm();
  const Eigen::Matrix3d covariance = a.covariance_C + b.covariance_C;
  const Eigen::Vector3d direction = along / std::max(length_m, 1e-9);
  const double variance = direction.dot(covariance * direction);
  const double margin_m = options.limb_sigmas * std::sqrt(std::max(variance, 0.0));
  return length_m > options.max_limb_ratio * segment.typical_length_m + margin_m ||
         length_m < options.min_limb_ratio * segment.typical_length_m - margin_m;
}

}  // namespace

int NumObserved(const JointObservations& joints) {
  return static_cast<int>(std::count_if(joints.begin(), joints.end(),
                                        [](const auto& joint) { return joint.has_value(); }));
}

int RemoveImpossibleLimbs(const JointTriangulatorOptions& options, JointObservations* joints) {
  int num_removed = 0;
  while (true) {
    std::array<int, kNumJoints> num_impossible{};
    std::array<int, kNumJoints> num_good{};
    for (const Segment& segment : kSegments) {
      const std::size_t a = static_cast<std::size_t>(segment.joint_a);
      const std::size_t b = static_cast<std::size_t>(segment.joint_b);
      if (!(*joints)[a] || !(*joints)[b]) continue;
      const bool is_bad = IsImpossible(options, segment, *(*joints)[a], *(*joints)[b]);
      for (const std::size_t end : {a, b}) ++(is_bad ? num_impossible : num_good)[end];
    }
    const auto badness = [&](std::size_t joint) {
      const auto& seen = (*joints)[joint];
      return std::tuple(num_impossible[joint], -num_good[joint], seen ? -seen->confidence : 0.0);
    };
    std::size_t worst = 0;
    for (std::size_t joint = 1; joint < joints->size(); ++joint) {
      if (num_impossible[joint] > 0 && badness(joint) > badness(worst)) worst = joint;
    }
    if (num_impossible[worst] == 0) return num_removed;
    (*joints)[worst].reset();
    ++num_removed;
  }
}

JointObservations TriangulatePerson(const JointTriangulatorOptions& options,
                                    const StereoCamera& camera, const StereoImages& images,
                                    const BodyKeypoints& left, const BodyKeypoints& right,
                                    double disparity_px) {
  JointObservations joints;
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    joints[joint] =
        TriangulateJoint(options, camera, images, left[joint], right[joint], disparity_px);
  }
  RemoveImpossibleLimbs(options, &joints);
  return joints;
}

JointObservations TriangulateLeftOnly(const JointTriangulatorOptions& options,
                                      const StereoCamera& camera, const StereoImages& images,
                                      const BodyKeypoints& left, double disparity_px,
                                      double sigma_factor) {
  JointObservations joints;
  const double height_px = kPersonHeightM * disparity_px / camera.baseline_m;
  const double search_px = 3 * ExtentPx(options, camera, disparity_px) + 1;
  for (std::size_t joint = 0; joint < joints.size(); ++joint) {
    const BodyKeypoint& l = left[joint];
    if (l.confidence < std::max(options.min_confidence, options.min_refined_confidence)) continue;
    const std::optional<double> refined =
        DisparityFromImages(options, camera, images, l.uv_px(), disparity_px, search_px, height_px);
    if (!refined) continue;
    const double sigma_px = sigma_factor * options.noise.Sigma(l.confidence, height_px);
    joints[joint] = MakeObservation(
        options, camera,
        {l.u_px, l.v_px, *refined, sigma_px, sigma_px, options.refined_sigma_px, l.confidence});
  }
  RemoveImpossibleLimbs(options, &joints);
  return joints;
}

}  // namespace airdos
