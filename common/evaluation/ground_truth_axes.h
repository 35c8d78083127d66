#ifndef AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_
#define AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// Axes of a ground truth, for body and world: any of the 48 ways to align the optical axes (x
/// right, y down, z forward, as in the estimate) with the file's axes. 24 of these are
/// right-handed; left-handed engines write files in one of the others.
class GroundTruthAxes {
 public:
  GroundTruthAxes() : S_(Eigen::Matrix3d::Identity()) {}  // optical
  static GroundTruthAxes Optical() { return {}; }
  static GroundTruthAxes Ned();  ///< x forward, y right, z down

  /// All 48: optical and NED first, then the other right-handed ones, then the left-handed ones.
  static std::vector<GroundTruthAxes> All();
  /// Parses "optical", "NED" (in any case), or the directions of right, down and forward: "y,-z,x".
  static std::optional<GroundTruthAxes> Parse(const std::string& text);
  std::string Name() const;  ///< in the format of Parse()

  bool is_right_handed() const;
  bool is_optical_or_ned() const { return *this == Optical() || *this == Ned(); }
  /// The columns are the optical axes in the file's axes.
  const Eigen::Matrix3d& matrix() const { return S_; }
  bool operator==(const GroundTruthAxes& other) const { return S_ == other.S_; }

 private:
  explicit GroundTruthAxes(const Eigen::Matrix3d& S) : S_(S) {}
  Eigen::Matrix3d S_;
};

/// Converts the pose of a body in `axes` to optical axes. Body and world are both rotated (and
/// mirrored) by the same S: R' = S^T R S, p' = S^T p. The orientation of the world does not matter
/// after an alignment.
TrajectoryPose ToOptical(const TrajectoryPose& pose, const GroundTruthAxes& axes);

/// Result of DetectAxes().
struct AxesDecision {
  GroundTruthAxes axes;
  /// False if nothing fits well, or if optical axes fit as well as NED: do not guess.
  bool is_known = false;
  /// Axes that fit as well as `axes` because the motion does not distinguish them: a camera that
  /// neither pitches nor rolls nor rises looks the same in a mirror.
  std::vector<GroundTruthAxes> alternatives;
  bool uses_rotation = false;
  bool uses_translation = false;
  double agreement = 0;         ///< of `axes`: 1 means equal motions, 0 nothing in common
  double best_agreement = 0;    ///< of the axes that fit best
  double best_other = 0;        ///< best of those that are neither `axes` nor an alternative
  std::string Explain() const;  ///< one line for the user
};

/// Determines the axes of the ground truth by comparing motions over up to ten poses, in body axes,
/// with those of the estimate. The agreement of a convention is the cosine of the angle between the
/// two series of rotation vectors (whose signs mirrored axes invert) and the same for the
/// displacements: their mean, or only one of them if the ground truth hardly moves in the other
/// (0.5 deg or 5 cm RMS over such a motion). It depends on neither scale nor world. The axes are
/// known if the best agreement is at least 0.7. Other axes fit as well if their agreement is below
/// the best by less than three times what the best lacks to 1, limited to 0.01 .. 0.1. Among those
/// that fit, optical axes and NED are preferred, then right-handed ones.
AxesDecision DetectAxes(const MatchedTrajectories& matched);

/// The agreement of these axes, as computed by DetectAxes().
double AgreementIn(const GroundTruthAxes& axes, const MatchedTrajectories& matched);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_
