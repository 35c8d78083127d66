#ifndef AIRDOS_COMMON_OPTIMIZATION_FACTORS_HUMAN_FACTORS_H_
#define AIRDOS_COMMON_OPTIMIZATION_FACTORS_HUMAN_FACTORS_H_

#include <ceres/sized_cost_function.h>

#include <Eigen/Core>
#include <array>

#include "common/optimization/solver/pose_manifold.h"

namespace airdos {

/// Rigidity of a body segment (paper, eq. 3): the distance between its two joints equals the
/// segment's length s, which is shared by the whole track:
///
///   r = (|p_a - p_b| - s) / sigma
///
/// Blocks: p_a (3), p_b (3), s (1), all in m. Where the joints coincide, the direction is undefined
/// and the derivatives of the distance are taken to be zero.
class RigidityFactor final : public ceres::SizedCostFunction<1, 3, 3, 1> {
 public:
  explicit RigidityFactor(double sigma_m) : weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double weight_;
};

/// Prior on a segment's length from the track's earlier frames: r = (s - s_known) / sigma.
/// Block: s (1), m.
class LengthPriorFactor final : public ceres::SizedCostFunction<1, 1> {
 public:
  LengthPriorFactor(double known_m, double sigma_m) : known_m_(known_m), weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double known_m_;
  double weight_;
};

/// Motion of a joint between consecutive frames as a translation shared by the joints of one person
/// (the default form of eq. 4 and 5):
///
///   r = (p_k - p_km1 - v dt) / sigma
///
/// Blocks: p_km1 (3), p_k (3), m; v (3), m/s; all in W.
class VelocityFactor final : public ceres::SizedCostFunction<3, 3, 3, 3> {
 public:
  VelocityFactor(double dt_s, double sigma_m) : dt_s_(dt_s), weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double dt_s_;
  double weight_;
};

/// A person's velocity changes little from one frame pair to the next:
///
///   r = (v_kp1 - v_k) / sigma
///
/// Blocks: v_k (3), v_kp1 (3), m/s, in W.
class VelocitySmoothnessFactor final : public ceres::SizedCostFunction<3, 3, 3> {
 public:
  explicit VelocitySmoothnessFactor(double sigma_m_s) : weight_(1 / sigma_m_s) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double weight_;
};

/// The rigid motion of a part changes little from one frame pair to the next; the pairs span h_1
/// and h_2 seconds:
///
///   r = ((t_2 / h_2 - t_1 / h_1) / sigma_v, (Log R_2 / h_2 - Log R_1 / h_1) / sigma_w)
///
/// Blocks: both motions (7 each: t, R, of a PartMotionFactor). sigma_v in m/s, sigma_w in rad/s.
class PartSmoothnessFactor final
    : public ceres::SizedCostFunction<6, kPoseBlockSize, kPoseBlockSize> {
 public:
  PartSmoothnessFactor(double step_1_s, double step_2_s, double sigma_m_s, double sigma_rad_s)
      : step_s_{step_1_s, step_2_s},
        weight_linear_(1 / sigma_m_s),
        weight_angular_(1 / sigma_rad_s) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  std::array<double, 2> step_s_;
  double weight_linear_;
  double weight_angular_;
};

/// Prior on a track's first velocity: how fast people are. Without it, a camera that sees nothing
/// but people could move along with all of them at any speed.
///
///   r = v / sigma
///
/// Block: v (3), m/s, in W.
class VelocityPriorFactor final : public ceres::SizedCostFunction<3, 3> {
 public:
  explicit VelocityPriorFactor(double sigma_m_s) : weight_(1 / sigma_m_s) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  double weight_;
};

/// Motion of a joint as one rigid motion (R, t) per rigid part and frame pair (paper, eq. 4 and 5),
/// about the part's centroid c so that R and t do not trade off against each other far from the
/// origin:
///
///   r = (p_k - R (p_km1 - c) - c - t) / sigma
///
/// Blocks: p_km1 (3), p_k (3), motion (7: t, R); all in W.
class PartMotionFactor final : public ceres::SizedCostFunction<3, 3, 3, kPoseBlockSize> {
 public:
  PartMotionFactor(const Eigen::Vector3d& centroid_W, double sigma_m)
      : centroid_W_(centroid_W), weight_(1 / sigma_m) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Vector3d centroid_W_;
  double weight_;
};

/// Damps the rotation of a part's motion where its points do not constrain it: two points leave the
/// rotation about the line through them free.
///
///   r = A Log(R)
///
/// A is the square-root information, 1 / rad: a a^T / sigma for a two-point part with axis a.
/// Block: motion (7).
class RotationDampingFactor final : public ceres::SizedCostFunction<3, kPoseBlockSize> {
 public:
  explicit RotationDampingFactor(const Eigen::Matrix3d& sqrt_information)
      : sqrt_information_(sqrt_information) {}
  bool Evaluate(double const* const* parameters, double* residuals,
                double** jacobians) const override;

 private:
  Eigen::Matrix3d sqrt_information_;
};

}  // namespace airdos

#endif  // AIRDOS_COMMON_OPTIMIZATION_FACTORS_HUMAN_FACTORS_H_
