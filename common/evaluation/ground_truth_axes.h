#ifndef AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_
#define AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_

#include <Eigen/Core>
#include <optional>
#include <string>
#include <vector>

#include "common/evaluation/trajectory.h"

namespace airdos {

/// Axes of a ground truth's body and world alike: any of the 48 ways in which the optical axes
/// (x right, y down, z forward, as estimates have them) can lie along the file's axes. 24 of them
/// are right-handed; a file in one of the others is what a left-handed engine writes.
class GroundTruthAxes {
 public:
  GroundTruthAxes() : S_(Eigen::Matrix3d::Identity()) {}  // optical
  static GroundTruthAxes Optical() { return {}; }
  static GroundTruthAxes Ned();  ///< x forward, y right, z down

  /// All 48: optical and NED first, then the other right-handed ones, then the left-handed ones.
  static std::vector<GroundTruthAxes> All();
  /// "optical", "NED" (small letters, too), or where right, down and forward lie: "y,-z,x".
  static std::optional<GroundTruthAxes> Parse(const std::string& text);
  std::string Name() const;  ///< as Parse() reads it

  bool is_right_handed() const;
  bool is_optical_or_ned() const { return *this == Optical() || *this == Ned(); }
  /// Columns: the optical axes in the file's axes.
  const Eigen::Matrix3d& matrix() const { return S_; }
  bool operator==(const GroundTruthAxes& other) const { return S_ == other.S_; }

 private:
  explicit GroundTruthAxes(const Eigen::Matrix3d& S) : S_(S) {}
  Eigen::Matrix3d S_;
};

/// The pose in optical axes of a body given in `axes`. Body and world are both turned (and
/// mirrored) by the same S: R' = S^T R S, p' = S^T p. Which way the world is turned is of no
/// importance after an alignment.
TrajectoryPose ToOptical(const TrajectoryPose& pose, const GroundTruthAxes& axes);

struct AxesDecision {
  GroundTruthAxes axes;
  /// False: nothing fits well, or optical axes fit as well as NED: do not guess.
  bool is_known = false;
  /// What fits as well as `axes`, because the motion does not tell them apart: a camera that
  /// neither nods nor rolls nor rises looks the same in a mirror.
  std::vector<GroundTruthAxes> alternatives;
  bool uses_rotation = false;
  bool uses_translation = false;
  double agreement = 0;         ///< of `axes`: 1 = same motions, 0 = nothing in common
  double best_agreement = 0;    ///< of the best of all
  double best_other = 0;        ///< of those that are neither `axes` nor an alternative
  std::string Explain() const;  ///< one line for the user
};

/// Finds out the axes of the ground truth by comparing motions over up to ten poses in body axes
/// with those of the estimate. The agreement of a convention is the cosine of the angle between the
/// two series of rotation vectors (mirrored axes reverse them), and the same of displacements;
/// their mean, or one of them where the ground truth hardly moves in the other (0.5 deg, 5 cm rms
/// over such a motion). It knows no scale and no world. Known where the best is at least 0.7.
/// Others fit as well where they lie less than three times the best's lack of agreement below it,
/// but at least 0.01 and at most 0.1. Of those that fit, optical axes and NED are preferred, then
/// right-handed ones.
AxesDecision DetectAxes(const MatchedTrajectories& matched);

/// The agreement of these axes, as DetectAxes() computes it.
double AgreementIn(const GroundTruthAxes& axes, const MatchedTrajectories& matched);

}  // namespace airdos

#endif  // AIRDOS_COMMON_EVALUATION_GROUND_TRUTH_AXES_H_
