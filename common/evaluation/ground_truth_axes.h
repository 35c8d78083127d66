#ifndef AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_
#define AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_

#include <string>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// Axes of a ground truth's body and world alike. Optical: x right, y down, z forward. NED: x
/// forward, y right, z down. Estimates are always optical.
enum class GroundTruthAxes { kOptical, kNed };

/// The pose in optical axes of a body given in `axes`. For NED, body and world are both turned by
/// the same fixed rotation S (columns: optical axes in NED axes): R' = S^T R S, p' = S^T p.
TrajectoryPose ToOptical(const TrajectoryPose& pose, GroundTruthAxes axes);

/// How well the motions of estimate and ground truth agree in body axes if the ground truth is in
/// certain axes: the cosine of the angle between the two series of motion vectors, 1 = same
/// directions and proportions, 0 = nothing in common. It knows no scale and no world.
struct AxesAgreement {
  double rotation = 0;     ///< of the rotation vectors between poses
  double translation = 0;  ///< of the displacements between poses
};

struct AxesDecision {
  GroundTruthAxes axes = GroundTruthAxes::kOptical;
  bool is_known = false;        ///< false: neither fits, or both fit as well
  bool by_translation = false;  ///< decided by displacements, as there was hardly any rotation
  AxesAgreement optical;
  AxesAgreement ned;
  double rotation_rms_deg = 0;  ///< of the ground truth's motions that were compared
  std::string Explain() const;  ///< one line for the user
};

/// Finds out the axes of the ground truth by comparing motions over up to ten poses in body axes
/// with those of the estimate. Rotations decide where they are large enough (0.5 deg rms over such
/// a motion), else displacements. Known where the better agreement is at least 0.7 and at least 0.1
/// above the other.
AxesDecision DetectAxes(const MatchedTrajectories& matched);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_
